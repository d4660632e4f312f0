"""What supports and loads a body from outside: a rigid plane, and gravity."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from closed_forms import YEOH
from figure import Figure
from scipy.integrate import quad
from scipy.optimize import brentq
from solving import FloatArray, Prescribed, Solved, elastomer, held, solid_of, solve

from pagd.fem.contact import ContactLaw
from pagd.fem.contact_kernels import pressure_law
from pagd.fem.gravity import Gravity
from pagd.fem.plane_contact import PlaneContact
from pagd.mesh.primitives import box
from pagd.mesh.types import Mesh

UP = np.array([0.0, 0.0, 1.0])
MATERIAL = elastomer(YEOH)
LAW = ContactLaw(stiffness=20.0, width=0.04)

#: Where the references come from.
PENALTY = "closed form: uniaxial stress and the penalty's give"
UNIAXIAL = "quadrature: uniaxial stress under the weight beyond"
BALANCE = "identity: balance of forces"

#: Block: side, height, gap below it and by how much its top is moved down, in mm.
SIDE, HEIGHT, GAP, PRESSED = 4.0, 3.0, 0.1, 0.7

#: Bar: a quarter of it, side and length in mm.
SLENDER, LENGTH = 1.0, 24.0
#: kg/m³ and m/s². In a centrifuge of a thousand g, so that the bar's own weight strains it much.
DENSITY, ACCELERATION = 1130.0, 9810.0
#: Weight by volume, in N/mm³.
SPECIFIC = DENSITY * ACCELERATION * 1e-9


def nominal_stress(stretch: float) -> float:
    """Force by undeformed area, MPa, of an incompressible bar; ν = 0.499 differs by 0.1 %."""
    c10, c20 = YEOH
    excess = stretch**2 + 2 / stretch - 3
    return 2 * (c10 + 2 * c20 * excess) * (stretch - 1 / stretch**2)


def stretch_at(stress: float) -> float:
    """The stretch of an incompressible bar at a nominal stress in MPa."""
    return float(brentq(lambda stretch: nominal_stress(stretch) - stress, 0.05, 10.0))


def gap_at(pressure: float) -> float:
    """The gap (mm) at which the penalty presses by so much, in MPa."""
    return float(brentq(lambda g: pressure_law(g, LAW.stiffness, LAW.width)[1] + pressure, -9, 0.1))


def block_on_plane() -> list[Figure]:
    """A block is moved down on a rigid plane 0.1 mm below it, and compressed by 0.6 mm.

    Expected: uniaxial stress at the stretch that is left, with the gap that the penalty keeps.
    """
    mesh = box((SIDE, SIDE, HEIGHT), (2, 2, 2))
    plane = PlaneContact(mesh.points, mesh.surfaces["z0"], np.array([0.0, 0.0, -GAP]), UP, LAW)
    top = mesh.nodes_of("z1")

    def pressed(load: float) -> FloatArray:
        field = np.zeros(mesh.points.shape)
        field[top, 2] = -load * PRESSED
        return field

    fixed = held(mesh, x0="x", y0="y", z1="z")
    terms = [solid_of(mesh, MATERIAL), plane]
    (solved,) = solve(mesh.points, terms, fixed, [1.0], pressed, first=0.1)

    def unbalanced(gap: float) -> float:
        stretch = 1 - (PRESSED - GAP + gap) / HEIGHT
        return pressure_law(gap, LAW.stiffness, LAW.width)[1] - nominal_stress(stretch)

    gap = float(brentq(unbalanced, -LAW.width, LAW.width))
    force = -pressure_law(gap, LAW.stiffness, LAW.width)[1] * SIDE**2
    found = plane.force(solved.unknowns)
    return [
        Figure(
            name="block on a rigid plane: force",
            source=PENALTY,
            reference=force,
            value=float(found[2]),
            tolerance=5e-3,
            unit="N",
        ),
        Figure(
            name="block on a rigid plane: force of the plane against that on the top",
            source=BALANCE,
            reference=float(-solved.reactions[top, 2].sum()),
            value=float(found[2]),
            tolerance=1e-6,
            unit="N",
        ),
        Figure(
            name="block on a rigid plane: gap",
            source=PENALTY,
            reference=gap,
            value=plane.smallest_gap,
            tolerance=0.02,
            unit="mm",
            scale=LAW.width,
        ),
    ]


def own_weight() -> list[Figure]:
    """A slender bar that hangs, and one that stands on a rigid plane, in a centrifuge.

    At the height Z above its free end a bar carries the weight of what is beyond, P(λ) = ± ρ g Z;
    it gets longer by ∫ (λ − 1) dZ. Its cross-section changes slowly along it, so that each one
    is in uniaxial stress to within the square of side by length.
    """
    return _hanging() + _standing()


def _hanging() -> list[Figure]:
    mesh = _bar()
    gravity = Gravity(mesh.points, mesh.tets, DENSITY, (0.0, 0.0, -ACCELERATION))
    fixed = held(mesh, x0="x", y0="y", z1="z")
    solved = _under_gravity(mesh, gravity, [], fixed)
    weight = SPECIFIC * SLENDER**2 * LENGTH
    return [
        Figure(
            name="bar hanging under its own weight: elongation",
            source=UNIAXIAL,
            reference=_elongation(SPECIFIC),
            value=float(-solved.displacement[mesh.nodes_of("z0"), 2].mean()),
            tolerance=5e-3,
            unit="mm",
        ),
        Figure(
            name="bar hanging under its own weight: force at the top against the weight",
            source=BALANCE,
            reference=weight,
            value=float(solved.reactions[mesh.nodes_of("z1"), 2].sum()),
            tolerance=1e-6,
            unit="N",
        ),
        Figure(
            name="bar hanging under its own weight: potential of gravity",
            source=UNIAXIAL,
            reference=_potential(),
            value=solved.energies["gravity"],
            tolerance=5e-3,
            unit="mJ",
        ),
    ]


def _standing() -> list[Figure]:
    mesh = _bar()
    gravity = Gravity(mesh.points, mesh.tets, DENSITY, (0.0, 0.0, -ACCELERATION))
    plane = PlaneContact(mesh.points, mesh.surfaces["z0"], np.zeros(3), UP, LAW)
    fixed = held(mesh, x0="x", y0="y")
    solved = _under_gravity(mesh, gravity, [plane], fixed)
    weight = SPECIFIC * SLENDER**2 * LENGTH
    return [
        Figure(
            name="bar standing on a rigid plane: force of the plane against the weight",
            source=BALANCE,
            reference=weight,
            value=float(plane.force(solved.unknowns)[2]),
            tolerance=1e-6,
            unit="N",
        ),
        Figure(
            name="bar standing on a rigid plane: lowering of its top",
            source=UNIAXIAL,
            reference=-_elongation(-SPECIFIC) - gap_at(SPECIFIC * LENGTH),
            value=float(-solved.displacement[mesh.nodes_of("z1"), 2].mean()),
            tolerance=5e-3,
            unit="mm",
        ),
    ]


def _bar() -> Mesh:
    return box((SLENDER, SLENDER, LENGTH), (1, 1, 24))


def _under_gravity(
    mesh: Mesh, gravity: Gravity, others: list[PlaneContact], fixed: FloatArray
) -> Solved:
    """The state under all of gravity, whose share is raised as a load is."""
    terms = [solid_of(mesh, MATERIAL), gravity, *others]
    return solve(mesh.points, terms, fixed, [1.0], _raised(mesh, gravity), first=0.1)[0]


def _raised(mesh: Mesh, gravity: Gravity) -> Prescribed:
    """Called at every new load: sets the share of gravity and holds what is held at zero."""

    def raise_to(load: float) -> FloatArray:
        gravity.share = load
        return np.zeros(mesh.points.shape)

    return raise_to


def _elongation(specific_weight: float) -> float:
    """∫ (λ − 1) dZ in mm, of a bar pulled by its specific weight in N/mm³."""
    return _along(lambda z: stretch_at(specific_weight * z) - 1)


def _potential() -> float:
    """−∫ ρ g · u dV in mJ, of the bar that hangs.

    Every mm of it at Z lowers all that is below it: −ρ g A ∫ Z (λ − 1) dZ.
    """
    area = SLENDER**2
    return -SPECIFIC * area * _along(lambda z: z * (stretch_at(SPECIFIC * z) - 1))


def _along(function: Callable[[float], float]) -> float:
    return float(quad(function, 0, LENGTH)[0])
