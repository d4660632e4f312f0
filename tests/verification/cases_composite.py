"""The paper in its own setting: a strip of the base of an actuator, the paper in the middle.

The ways: the paper as pagd's shell, between tetrahedra and between hexahedra; as a membrane of the
same stretch stiffness without bending stiffness; as a layer of thin solid elements of its own, with
no theory of shells at all.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from actuators import default_paper
from cases_solid import edge_load
from closed_forms import NEO_HOOKE, elastica_tip
from figure import Figure
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from solving import FloatArray, Solved, elastomer, held, solid_of, solve

from pagd.fem.bending import bending_terms
from pagd.fem.membrane import Membrane
from pagd.fem.solid import TaylorHoodSolid
from pagd.fem.term import EnergyTerm
from pagd.materials import Elastomer
from pagd.mesh.primitives import box
from pagd.mesh.types import Mesh

#: Thickness of the base of the bending design of Table 2, in mm.
HEIGHT = 2.12
#: ν = 0.4999: against closed forms of incompressible bodies.
BASE = elastomer(NEO_HOOKE, poisson_ratio=0.4999)
SHEAR = 2 * NEO_HOOKE[0]
PAPER = default_paper()
BETWEEN_BLOCKS = "shell between hexahedra"
WAYS = ("shell", "layer", "membrane", BETWEEN_BLOCKS)


@dataclass(frozen=True)
class Strip:
    """Length (mm), width (mm), and cells along both."""

    length: float
    width: float
    cells: tuple[int, int]

    def mesh(self, way: str) -> Mesh:
        """The strip, z from −h/2 to h/2; ``paper`` is the middle, or there is a layer for it."""
        layers = 3 if way == "layer" else 2
        size = (self.length, self.width, HEIGHT)
        blocks = "hexahedra" if way == BETWEEN_BLOCKS else None
        flat = box(size, (*self.cells, layers), None if way == "layer" else 1, blocks)
        heights = np.array([0, HEIGHT / 2, HEIGHT])
        if way == "layer":
            half = PAPER.thickness / 2
            heights = np.array([0, HEIGHT / 2 - half, HEIGHT / 2 + half, HEIGHT])
        even = np.linspace(0, HEIGHT, layers + 1)
        points = flat.points.copy()
        points[:, 2] = np.interp(points[:, 2], even, heights) - HEIGHT / 2
        return replace(flat, points=points)


def terms_of(mesh: Mesh, way: str, *, is_bent: bool) -> list[EnergyTerm]:
    """Elastomer and paper; a strip that is bent goes on at its sides and is clamped at x = 0."""
    if way == "layer":
        inside = np.abs(mesh.points[mesh.tets[:, :4]].mean(axis=1)[:, 2]) < PAPER.thickness / 2
        around = TaylorHoodSolid(mesh.points, mesh.tets[~inside], BASE, mesh.points.size)
        # Not the other element: a constant pressure has no part in bending, and ν = 0.2 needs one.
        first = mesh.points.size + around.pressures
        return [around, TaylorHoodSolid(mesh.points, mesh.tets[inside], _solid_paper(), first)]
    faces = mesh.surfaces["paper"]
    element = "hexahedron" if way == BETWEEN_BLOCKS else "taylor_hood"
    terms: list[EnergyTerm] = [solid_of(mesh, BASE, element), Membrane(mesh.points, faces, PAPER)]
    if way != "membrane":
        nodes, y = np.unique(faces), mesh.points[np.unique(faces), 1]
        sides = nodes[np.isclose(y, 0) | np.isclose(y, mesh.points[:, 1].max())]
        clamped = nodes[np.isclose(mesh.points[nodes, 0], 0)]
        held = {"clamped": clamped, "symmetry": sides} if is_bent else {}
        terms += bending_terms(mesh.points, faces, PAPER, **held)
    return terms


def _solid_paper() -> Elastomer:
    """A neo-Hookean solid of the paper's E and ν at small strains."""
    shear = PAPER.youngs_modulus / (2 * (1 + PAPER.poisson_ratio))
    return Elastomer(
        name="paper",
        law="neo_hookean",
        coefficients={"C10": shear / 2},
        poisson_ratio=PAPER.poisson_ratio,
    )


#: Two cells wide: else the end would count as a side.
BENT = Strip(60.0, 3.0, (30, 2))
#: P L²/EI of the strip with the paper; its tip turns by some 9°.
LOAD = 0.3
#: Bending stiffness per width in plane strain, in N mm.
ELASTOMER_STIFFNESS = 4 * SHEAR * HEIGHT**3 / 12


@lru_cache
def _bent(way: str) -> float:
    """Deflection of the tip over the length, sides held (plane strain), one end clamped."""
    mesh = BENT.mesh(way)
    stiffness = (ELASTOMER_STIFFNESS + PAPER.bending_stiffness) * BENT.width
    force = LOAD * stiffness / BENT.length**2
    terms = [*terms_of(mesh, way, is_bent=True), edge_load(mesh, "x1", (0.0, 0.0, force))]
    fixed = held(mesh, x0="x", y0="y", y1="y")
    fixed[np.isclose(mesh.points[:, [0, 2]], 0).all(axis=1), 2] = True
    (solved,) = solve(mesh.points, terms, fixed, [1.0], first=0.1, tolerance=1e-5)
    return float(solved.displacement[mesh.nodes_of("x1"), 2].mean() / BENT.length)


def bent_strip() -> list[Figure]:
    """A cantilever of elastomer and paper under a force at its tip, against a composite beam.

    Plane strain, 60 mm long, 2.12 mm thick (the base of the bending design), the paper of 0.1 mm
    in the middle: EI = 4 µ h³/12 + D per width, the paper's D = E t³/12(1 − ν²) nearly half of it.
    The tip moves by a tenth of the length. The beam is an elastica without shear, which would add
    0.3 %. The paper's own D is what the stiffnesses with and without it differ by.
    """
    found = {way: _bent(way) for way in WAYS}
    whole = ELASTOMER_STIFFNESS + PAPER.bending_stiffness
    expected = {way: ELASTOMER_STIFFNESS if way == "membrane" else whole for way in WAYS}
    figures = [
        Figure(
            name=f"strip, paper as {way}: tip z / length",
            source="composite beam as an elastica, by quadrature",
            reference=elastica_tip(LOAD * whole / expected[way])[1],
            value=found[way],
            tolerance=0.01,
        )
        for way in WAYS
    ]
    return [
        *figures,
        Figure(
            name="strip: tip z / length, paper as shell",
            source="paper as a layer of solid elements",
            reference=found["layer"],
            value=found["shell"],
            tolerance=0.005,
        ),
        *(
            Figure(
                name=f"strip, paper as {way}: bending stiffness of the paper",
                source="closed form: E t³/12(1 − ν²)",
                reference=PAPER.bending_stiffness,
                value=_stiffness(found[way]) - _stiffness(found["membrane"]),
                tolerance=0.02,
                unit="N mm",
            )
            for way in ("shell", "layer", BETWEEN_BLOCKS)
        ),
    ]


def _stiffness(deflection: float) -> float:
    """Bending stiffness per width of the elastica that the force deflects so far, in N mm."""
    whole = ELASTOMER_STIFFNESS + PAPER.bending_stiffness
    load = brentq(lambda load: elastica_tip(load)[1] - deflection, 0.01, 5.0, xtol=1e-9)
    return LOAD * whole / float(load)


TWISTED = Strip(40.0, 12.0, (20, 6))
TWIST = np.radians(1)


@lru_cache
def _torque(way: str) -> float:
    """Torque in N mm that turns one end against the other, both free to warp along x."""
    mesh = TWISTED.mesh(way)
    points = mesh.points - [0, TWISTED.width / 2, 0]
    end = mesh.nodes_of("x1")

    def turned(load: float) -> FloatArray:
        rotation = Rotation.from_rotvec([load, 0, 0]).as_matrix()
        return points @ (rotation - np.eye(3)).T * (points[:, :1] > TWISTED.length / 2)

    fixed = held(mesh, x0="yz", x1="yz")
    fixed[np.isclose(points, 0).all(axis=1), 0] = True
    (solved,) = solve(
        mesh.points,
        terms_of(mesh, way, is_bent=False),
        fixed,
        [TWIST],
        turned,
        first=TWIST / 4,
        tolerance=1e-6,
    )
    return _moment_about_x(points[end], end, solved)


def _moment_about_x(points: FloatArray, nodes: np.ndarray, solved: Solved) -> float:
    places, forces = points + solved.displacement[nodes], solved.reactions[nodes]
    return float(np.cross(places, forces)[:, 0].sum())


def twisted_strip() -> list[Figure]:
    """The same strip, 40 x 12 mm, turned by 1° about its axis: torque.

    Both ends turn as a whole and may warp along x. The paper's bending adds 2 D (1 − ν) per width
    and twist.
    """
    found = {way: _torque(way) for way in WAYS}
    rate = 2 * PAPER.bending_stiffness * (1 - PAPER.poisson_ratio)
    first = Figure(
        name="strip turned by 1°, paper as shell: torque",
        source="paper as a layer of solid elements",
        reference=found["layer"],
        value=found["shell"],
        tolerance=0.01,
        unit="N mm",
    )
    return [
        first,
        *(
            replace(
                first,
                name=f"strip turned by 1°, paper as {way}: torque that its bending adds",
                source="closed form: 2 D (1 − ν) per width and twist",
                reference=rate * TWISTED.width * TWIST / TWISTED.length,
                value=found[way] - found["membrane"],
                tolerance=0.01,
            )
            for way in ("shell", "layer", BETWEEN_BLOCKS)
        ),
    ]
