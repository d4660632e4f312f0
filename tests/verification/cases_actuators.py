"""The example designs: element table, NGSolve's values, balances, symmetries."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from actuators import (
    default_elastomer,
    default_paper,
    mesh_of,
    mirrored,
    trajectory,
    whole_of,
)
from closed_forms import YEOH
from figure import Figure
from solving import FloatArray, elastomer, held, solve

from pagd.actuation import Actuation, ActuationResult, Body, free_actuation
from pagd.errors import Status
from pagd.fem.term import ElementSystem, EnergyTerm
from pagd.mesh.types import Mesh
from pagd.metrics import energy_balance, work_of_pressure

#: The element table's material: Yeoh of Elastosil M4601, K = 20 MPa.
SOFT_BULK = elastomer(YEOH, bulk=20.0)
#: The paper as a membrane: the same E h, a thousandth of the thickness.
MEMBRANE = replace(default_paper(), youngs_modulus=6.5e6, thickness=1e-4)
#: Tip z in mm at 5 kPa: cubic displacements and quadratic pressure.
CUBIC_REFERENCE = -10.1
#: Tip z in mm by pressure in kPa: NGSolve 6.2.2608, P2–P0, 5 mm mesh, the same energies.
NGSOLVE = {5: -9.965, 10: -20.05, 15: -30.01, 20: -39.73}

MIRROR = "symmetry: slanted the other way, the mirror image"
HALVES = "symmetry: the half model"


def actuate(
    mesh: Mesh, maximum_kPa: float, *, membrane: bool = False, element: str = "taylor_hood"
) -> ActuationResult:
    """Solve an actuator of the default materials, or of those of the element table."""
    wanted = Actuation(maximum_pressure_kPa=maximum_kPa, element=element, tolerance_mm=1e-3)
    materials = (SOFT_BULK, MEMBRANE) if membrane else (default_elastomer(), default_paper())
    result = free_actuation(mesh, *materials, wanted)
    assert result.status is Status.ok, result.reason
    return result


def tip_z(mesh: Mesh, displacement: FloatArray) -> float:
    """Mean displacement of the nodes of the tip along z, in mm."""
    return float(displacement[mesh.nodes_of("tip"), 2].mean())


def element_table() -> list[Figure]:
    """P2–P1 on meshes of 3 and 2 mm against the cubic reference, at 5 kPa.

    Whole models, as those of the reference were. Meshes of one size differ by some 0.2 % in the
    tip; at about 2 mm three whole models gave −9.86 to −9.89 mm, six halves −9.83 to −9.86.
    """
    figures = []
    for size, tolerance in ((3.0, 0.04), (2.0, 0.025)):
        mesh = mesh_of("bending", size)
        state = actuate(mesh, 5.0, membrane=True).states[-1]
        figures.append(
            Figure(
                name=f"bending, P2-P1, {size:g} mm, K = 20 MPa, membrane: tip z at 5 kPa",
                source="P3-P2 elements on 5 and 3 mm meshes (-9.93, -10.07), extrapolated",
                reference=CUBIC_REFERENCE,
                value=tip_z(mesh, state.displacement),
                tolerance=tolerance,
                unit="mm",
            )
        )
    return figures


def other_library() -> list[Figure]:
    """P2–P0 on the 5 mm mesh against NGSolve on another 5 mm mesh of the same design."""
    mesh = mesh_of("bending", 5.0)
    result = actuate(mesh, 20.0, membrane=True, element="element_pressure")
    return [
        Figure(
            name=f"bending, P2-P0, 5 mm, K = 20 MPa, membrane: tip z at {pressure} kPa (NGSolve)",
            source="NGSolve 6.2.2608, P2-P0, the same energies, another 5 mm mesh",
            reference=NGSOLVE[pressure],
            value=tip_z(mesh, state.displacement),
            tolerance=0.015,
            unit="mm",
        )
        for pressure, state in zip(NGSOLVE, result.states[1:], strict=True)
    ]


def balance_of_energy() -> list[Figure]:
    """∫ p dV by trapezoids over the steps against the stored energy, to 50 kPa."""
    history = actuate(mesh_of("bending", 5.0, half=True), 50.0).history
    work = work_of_pressure(history["pressure_kPa"], history["cavity_volume_mm3"])
    stored = history["stored_energy_mJ"]
    recorded = np.isclose(history["pressure_kPa"] % 5, 0) & (history["pressure_kPa"] > 0)
    worst = float(energy_balance(work, stored)[recorded].max())
    return [
        Figure(
            name="bending, 5 mm: |∫ p dV − U| / U, largest at a recorded pressure to 50 kPa",
            source="identity: a conservative load stores its work",
            reference=0.0,
            value=worst,
            tolerance=0.01,
            scale=1.0,
        )
    ]


@lru_cache
def solved(name: str, half: bool = False) -> tuple[Mesh, ActuationResult]:
    """A design on a 5 mm mesh to 10 kPa."""
    mesh = mesh_of(name, 5.0, half)
    return mesh, actuate(mesh, 10.0)


def angles(name: str, mesh: Mesh, result: ActuationResult) -> tuple[float, float]:
    """Bending and twist of the tip in degrees, at the last state."""
    displacement = np.array([s.displacement for s in result.states])
    pressure = np.array([s.pressure_kPa for s in result.states])
    path = trajectory(name, mesh, pressure, displacement)
    return float(path.bending_deg[-1, -1]), float(path.twist_deg[-1, -1])


def resultants() -> list[Figure]:
    """The twisting design at 10 kPa: neither the pressure nor the support has a resultant.

    The support acts on the fixed nodes and, through its clamped edge, on the paper. Forces are
    relative to the pressure times the cross-section of the actuator, moments (about the origin)
    to that times its length.
    """
    mesh, load = mesh_of("twisting", 5.0), 0.01
    body = Body(mesh, default_elastomer(), default_paper())
    terms = body.terms
    fixed = held(mesh, fixed="xyz")
    (state,) = solve(mesh.points, terms, fixed, [load], first=2.5e-4, tolerance=1e-6)
    clamp = [_nodal_forces(t, state.displacement, load) for t in terms if t.name == "held edges"]
    assert clamp
    forces = {
        "pressure": _nodal_forces(body.pressure, state.displacement, load),
        "support": np.where(fixed, state.reactions, 0.0) - sum(clamp),
    }
    places = mesh.points + state.displacement
    length, width, height = np.ptp(mesh.points, axis=0)
    scale = load * width * height
    return [
        Figure(
            name=f"twisting, 5 mm, 10 kPa: resultant {kind} of the {what}",
            source="identity: a closed cavity; equilibrium",
            reference=0.0,
            value=float(np.linalg.norm(vectors.sum(axis=0))),
            tolerance=1e-8,
            unit=unit,
            scale=size,
        )
        for what, nodal in forces.items()
        for kind, unit, vectors, size in (
            ("force", "N", nodal, scale),
            ("moment", "N mm", np.cross(places, nodal), scale * length),
        )
    ]


def _nodal_forces(term: EnergyTerm, displacement: FloatArray, load: float) -> FloatArray:
    """Derivative (n, 3) of a term's energy with respect to the places of the nodes."""
    system = ElementSystem.of(term.dofs)
    unknowns = displacement.ravel()
    term.linearize(unknowns, term.internal_at_rest(), load, system)
    result = np.zeros_like(unknowns)
    np.add.at(result, term.dofs, system.residual)
    return result.reshape(-1, 3)


def mirror() -> list[Figure]:
    """The twisting design and its mirror image (−θ): bending equal, twist opposite."""
    mesh, result = solved("twisting")
    image = mirrored(mesh)
    reflected = actuate(image, 10.0)
    bending, twist = angles("twisting", mesh, result)
    other_bending, other_twist = angles("twisting", image, reflected)
    assert abs(twist) > 5, "the twisting design twists"
    difference = reflected.states[-1].displacement * [1, -1, 1] - result.states[-1].displacement
    name = "twisting, 5 mm, 10 kPa, mirror image: "
    return [
        Figure(
            name=name + "bending",
            source=MIRROR,
            reference=bending,
            value=other_bending,
            tolerance=1e-6,
            unit="°",
        ),
        Figure(
            name=name + "twist",
            source=MIRROR,
            reference=-twist,
            value=other_twist,
            tolerance=1e-6,
            unit="°",
        ),
        Figure(
            name=name + "displacement, largest difference",
            source=MIRROR,
            reference=0.0,
            value=float(np.abs(difference).max()),
            tolerance=1e-6,
            unit="mm",
            scale=1.0,
        ),
    ]


def no_twist() -> list[Figure]:
    """θ = 0: no twist, exactly on a symmetric mesh; another one is not symmetric itself."""
    mesh, result = solved("bending")
    whole, both = halves()
    figures = []
    for what, (bending, twist), tolerance in (
        ("symmetric mesh", angles("bending", whole, both), 1e-8),
        ("mesh without symmetry", angles("bending", mesh, result), 0.01),
    ):
        figures.append(
            Figure(
                name=f"bending, 5 mm, 10 kPa, {what}: twist (relative to the bending)",
                source="symmetry: no slant, no twist",
                reference=0.0,
                value=twist,
                tolerance=tolerance,
                unit="°",
                scale=bending,
            )
        )
    return figures


@lru_cache
def halves() -> tuple[Mesh, ActuationResult]:
    """The bending design to 10 kPa on a mesh made of the half one and its mirror image."""
    whole = whole_of(mesh_of("bending", 5.0, half=True))
    return whole, actuate(whole, 10.0)


def half_and_whole() -> list[Figure]:
    """A half model, and the whole made of it and its mirror image: one solution."""
    half, result = solved("bending", half=True)
    _, both = halves()
    difference = both.states[-1].displacement[: len(half.points)] - result.states[-1].displacement
    name = "bending, 5 mm, 10 kPa, whole model made of two halves: "
    figures = [
        Figure(
            name=name + "displacement, largest difference to the half model",
            source=HALVES,
            reference=0.0,
            value=float(np.abs(difference).max()),
            tolerance=1e-5,
            unit="mm",
            scale=1.0,
        )
    ]
    for key, unit in (("cavity_volume_mm3", "mm³"), ("stored_energy_mJ", "mJ")):
        reference, value = (float(r.history[key][-1]) for r in (result, both))
        figures.append(
            Figure(
                name=name + key,
                source=HALVES,
                reference=reference,
                value=value,
                tolerance=1e-5,
                unit=unit,
            )
        )
    return figures


def symmetries() -> list[Figure]:
    """Mirror image, no twist without slant, half and whole."""
    return mirror() + no_twist() + half_and_whole()
