"""Blocked force of a beam-like actuator: superposition, balance, on the edge and on a plate."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from actuators import default_elastomer, default_paper
from figure import Figure
from solving import FloatArray, Solved, held, solve

from pagd.actuation import Actuation, ActuationResult, Body, blocked_force, free_actuation
from pagd.actuation.blocked import tip_edge
from pagd.mesh.primitives import hollow_block
from pagd.mesh.types import Mesh

#: Pressures in kPa: so small that all is linear, and one that bends the beam visibly.
SMALL, LARGE = 0.01, 20.0

SUPERPOSITION = "superposition: tip stiffness times free deflection"


@lru_cache(maxsize=1)
def beam() -> Mesh:
    """60 × 6 × 6 mm with walls of 1 mm around the cavity, and a base of 2 mm with the paper."""
    return hollow_block((60.0, 6.0, 6.0), (15, 6, 6), ((1, 14), (1, 5), (2, 5)), 1)


def analysed(pressure_kPa: float, **settings: object) -> tuple[ActuationResult, ActuationResult]:
    """Free actuation and blocked force at one pressure."""
    wanted = Actuation(
        maximum_pressure_kPa=pressure_kPa,
        recorded_step_kPa=pressure_kPa,
        first_step_kPa=pressure_kPa / 4,
        smallest_step_kPa=pressure_kPa / 1000,
        tolerance_mm=1e-3 * min(pressure_kPa, 1.0),
        **settings,  # type: ignore[arg-type]
    )
    materials = default_elastomer(), default_paper()
    return free_actuation(beam(), *materials, wanted), blocked_force(beam(), *materials, wanted)


def _supported(pressure_kPa: float, moved: FloatArray | None = None) -> Solved:
    """The beam with its edge held in z, or moved so far (n, 3); by the tests' own solver."""
    mesh = beam()
    body = Body(mesh, default_elastomer(), default_paper(), Actuation(contact=False))
    fixed = held(mesh, fixed="xyz")
    fixed[tip_edge(mesh), 2] = True
    terms = [term for term in body.terms if pressure_kPa or term is not body.pressure]
    prescribed = None if moved is None else (lambda share: share * moved)
    loads = [pressure_kPa * 1e-3 or 1.0]
    return solve(mesh.points, terms, fixed, loads, prescribed, tolerance=1e-7)[0]


def small_pressure() -> list[Figure]:
    """In the limit of small pressures, the blocked force is that of moving the free tip back.

    The force that moves the edge of the beam without pressure by the negative of its free
    deflection is the beam's tip stiffness times that deflection. The
    deflection of each node counts, since the cavity's walls bulge and the edge with them.
    """
    free, blocked = analysed(SMALL)
    edge = tip_edge(beam())
    back = np.zeros(beam().points.shape)
    back[edge, 2] = -free.states[-1].displacement[edge, 2]
    assert back[edge, 2].min() > 0, "the beam bends towards the paper"
    stiff = _supported(0.0, back)
    return [
        Figure(
            name=f"beam with a cavity, {SMALL:g} kPa: blocked force",
            source=SUPERPOSITION,
            reference=float(stiff.reactions[edge, 2].sum()),
            value=float(blocked.figures["blocked_force_N"]),
            tolerance=2e-3,
            unit="N",
        )
    ]


def balance_of_forces() -> list[Figure]:
    """The beam at 20 kPa: the clamp holds what the edge gives, since pressure has no resultant."""
    _, blocked = analysed(LARGE)
    force, edge = float(blocked.figures["blocked_force_N"]), tip_edge(beam())
    state = _supported(LARGE)
    clamp = state.reactions[beam().nodes_of("fixed"), 2].sum()
    name = f"beam with a cavity, {LARGE:g} kPa: "
    return [
        Figure(
            name=name + "blocked force, by another way of stepping",
            source="identity: one equilibrium",
            reference=float(state.reactions[edge, 2].sum()),
            value=force,
            tolerance=1e-5,
            unit="N",
        ),
        Figure(
            name=name + "reaction of the clamp and of the edge together",
            source="identity: balance of forces",
            reference=0.0,
            value=float(clamp + state.reactions[edge, 2].sum()),
            tolerance=1e-8,
            unit="N",
            scale=force,
        ),
    ]


def plate_and_edge() -> list[Figure]:
    """A plate 0.5 mm below the base, which the tip reaches at 12 kPa, takes part of the force.

    By superposition the part that is left is 1 − distance / free deflection; the beam's stiffness
    under pressure and the place of the contact make it inexact.
    """
    pressure, distance = LARGE, 0.5
    free, edge = analysed(pressure)
    _, plate = analysed(pressure, blocked_force="plate", plate_distance_mm=distance)
    nodes = tip_edge(beam())
    deflection = -float(free.states[-1].displacement[nodes, 2].mean())
    left = 1 - distance / deflection
    assert 0.2 < left < 0.95
    return [
        Figure(
            name=f"beam with a cavity, {pressure:g} kPa, plate {distance:g} mm below: force",
            source=SUPERPOSITION + " beyond the plate",
            reference=left * float(edge.figures["blocked_force_N"]),
            value=float(plate.figures["blocked_force_N"]),
            tolerance=0.05,
            unit="N",
        )
    ]
