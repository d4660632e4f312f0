"""Every energy term's derivatives against differences of its energy and of its forces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from actuators import default_elastomer, default_paper
from figure import Figure
from solving import FloatArray, solid_of

from pagd.fem.bending import bending_terms
from pagd.fem.contact import ContactLaw, FaceContact
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.membrane import Membrane
from pagd.fem.solid import ElementPressureSolid
from pagd.fem.term import ElementSystem, EnergyTerm
from pagd.mesh.blocks import hexahedra, wedges
from pagd.mesh.primitives import hollow_block
from pagd.mesh.types import Mesh

LOAD, STEP = 0.02, 1e-5
#: So many until the iterated pressures of contact are those of the gaps.
ROUNDS = 30


def tangents() -> list[Figure]:
    """Forces and tangents of every energy term along a random direction, by central differences.

    On a small block with a cavity and paper, displaced at random by some 0.1 mm. The largest
    difference relative to the largest entry; differences with a step of 1e-5 mm leave some 1e-8.
    Contact is shown with a soft law that reaches far, and with the default law where walls overlap;
    both with iterated pressures that have converged.
    """
    void = ((1, 2), (1, 2), (1, 2))
    mesh = hollow_block((3.0, 6.0, 4.5), (3, 3, 3), void, 1, blocks="both")
    return [
        *(figure for name, make in TERMS.items() for figure in _derivatives(name, mesh, make)),
        *_derivatives("contact, default law", mesh, _default_contact),
    ]


def _exact_contact(mesh: Mesh) -> EnergyTerm:
    """The walls of the cavity that look along x, some 1 mm apart, under a law that reaches as far.

    The displacement of this case leaves them near each other, neither parallel nor flat.
    """
    law = ContactLaw(stiffness=5.0, width=1.5, reach=2.0)
    return _walls(mesh, law, distance=1.0)


def _default_contact(mesh: Mesh) -> EnergyTerm:
    """The same walls under the default law, moved until they overlap."""
    return _walls(mesh, ContactLaw(), distance=-0.04)


def _walls(mesh: Mesh, law: ContactLaw, distance: float) -> FaceContact:
    faces = mesh.surfaces["cavity"]
    middles = mesh.points[faces[:, :3]].mean(axis=1)
    slaves, masters = (faces[np.isclose(middles[:, 0], x)] for x in (1.0, 2.0))
    points = mesh.points.copy()
    points[:, 0] = np.interp(points[:, 0], (0, 1, 2, 3), (0, 1, 1 + distance, 2 + distance))
    contact = FaceContact(points, slaves, masters, law)
    contact.update(_displacement(mesh, mesh.points.size))
    return contact


def _bending(mesh: Mesh) -> EnergyTerm:
    terms = bending_terms(mesh.points, mesh.surfaces["paper"], default_paper())
    return next(term for term in terms if term.name == "hinges")


TERMS: dict[str, Callable[[Mesh], EnergyTerm]] = {
    "solid, P2-P1": lambda mesh: solid_of(mesh, default_elastomer()),
    "solid, P2-P0": lambda mesh: solid_of(mesh, default_elastomer(), "element_pressure"),
    "solid, Q2-P-1, hexahedra": lambda mesh: ElementPressureSolid(
        mesh.points, hexahedra(mesh), default_elastomer()
    ),
    "solid, Q2-P-1, wedges": lambda mesh: ElementPressureSolid(
        mesh.points, wedges(mesh), default_elastomer()
    ),
    "membrane of the paper": lambda mesh: Membrane(
        mesh.points, mesh.surfaces["paper"], default_paper()
    ),
    "bending of the paper": _bending,
    "follower pressure": lambda mesh: FollowerPressure(mesh.points, mesh.surfaces["cavity"]),
    "contact, exact tangent": _exact_contact,
}


def _displacement(mesh: Mesh, size: int) -> FloatArray:
    """Unknowns (size,): smooth displacements with some noise, and small pressures behind them."""
    random = np.random.default_rng(1)
    places = mesh.points / np.ptp(mesh.points)
    field = 0.1 * places @ random.normal(size=(3, 3)) + 0.01 * random.normal(size=places.shape)
    result = 0.01 * random.normal(size=size)
    result[: field.size] = field.ravel()
    return result


def _derivatives(name: str, mesh: Mesh, make: Callable[[Mesh], EnergyTerm]) -> list[Figure]:
    term = make(mesh)
    size = mesh.points.size + getattr(term, "pressures", 0)
    unknowns = _displacement(mesh, size)
    direction = np.random.default_rng(2).normal(size=size)
    forces, product = _linearized(term, unknowns, direction)
    ahead, behind = (unknowns + s * STEP * direction for s in (1, -1))
    slope = (term.energy(ahead, LOAD) - term.energy(behind, LOAD)) / (2 * STEP)
    change = (_linearized(term, ahead)[0] - _linearized(term, behind)[0]) / (2 * STEP)
    row = Figure(
        name=f"{name}: forces along the direction",
        source="central difference of the energy",
        reference=slope,
        value=float(forces @ direction),
        tolerance=1e-6,
        scale=float(np.abs(forces).max()),
    )
    return [
        row,
        replace(
            row,
            name=f"{name}: change of the forces along the direction, largest difference",
            source="central difference of the forces",
            reference=0.0,
            value=float(np.abs(product - change).max()),
            scale=float(np.abs(product).max()),
        ),
    ]


def _linearized(
    term: EnergyTerm, unknowns: FloatArray, direction: FloatArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """Forces (size,), and the tangent times the direction, at consistent internal variables."""
    system = ElementSystem.of(term.dofs)
    internal = term.internal_at_rest()
    for _ in range(ROUNDS):
        term.linearize(unknowns, internal, LOAD, system)
        internal = term.advance(np.zeros_like(unknowns))
    term.linearize(unknowns, internal, LOAD, system)
    forces, product = np.zeros_like(unknowns), np.zeros_like(unknowns)
    np.add.at(forces, term.dofs, system.residual)
    if direction is not None:
        rows, columns = np.triu_indices(term.dofs.shape[1])
        full = np.zeros((*term.dofs.shape, term.dofs.shape[1]))
        full[:, rows, columns] = full[:, columns, rows] = system.tangent
        np.add.at(product, term.dofs, np.einsum("eij,ej->ei", full, direction[term.dofs]))
    return forces, product
