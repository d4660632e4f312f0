"""Hexahedra and wedges: order of convergence, and no locking of nearly incompressible bodies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from cases_inflation import INNER, OUTER, Body, Cylinder, Sphere
from cases_solid import bent_block_rows
from closed_forms import NEO_HOOKE, cylinder_mean_stress, sphere_mean_stress
from figure import Figure
from scipy.interpolate import CubicSpline
from solving import BLOCKS, FloatArray, Solved, elastomer, held, solid_of, solve, tolerance_of

from pagd.fem.cells import cell_of
from pagd.fem.solid import ElementPressureSolid
from pagd.fem.term import ElementSystem
from pagd.mesh.primitives import cylinder_quarter, sphere_octant
from pagd.mesh.types import Mesh

STRETCH = 1.3


@dataclass(frozen=True)
class Wall:
    """A thick wall of one kind of blocks: its meshes by layers, and its closed form."""

    body: Body
    mesh: Callable[[int], Mesh]
    #: Layers of two meshes in the asymptotic range.
    layers: tuple[int, int]
    mean_stress: Callable[..., float]

    @property
    def element(self) -> str:
        return self.body.block

    @property
    def power(self) -> int:
        """d of r^d = R^d + A^d (λa^d − 1)."""
        return 3 if self.body is Sphere else 2


WALLS = (
    Wall(
        Cylinder,
        lambda n: cylinder_quarter(INNER, OUTER, 1.0, (n, 2 * n, 1), BLOCKS["hexahedron"]),
        (4, 8),
        cylinder_mean_stress,
    ),
    Wall(
        Sphere,
        lambda n: sphere_octant(INNER, OUTER, (n, n), BLOCKS["wedge"]),
        (6, 9),
        sphere_mean_stress,
    ),
)


def convergence_of_blocks() -> list[Figure]:
    """Orders of Q2-P-1 in L2: 3 for the quadratic displacement, 2 for the linear pressure.

    Neo-Hookean walls of radii 10 and 15 mm, the inner one moved to λa = 1.3: a cylinder of curved
    hexahedra and a sphere of curved wedges. The mean stress is the pressure of each element.
    """
    return [figure for wall in WALLS for figure in _orders(wall)]


def _orders(wall: Wall) -> list[Figure]:
    n, m = wall.layers
    coarse, fine = (wall_errors(wall, layers) for layers in wall.layers)
    fields = (("displacement", 3.0, 0.05), ("pressure", 2.0, 0.1))
    return [
        Figure(
            name=f"{wall.body.name}, {wall.element}, {n} to {m} layers: order of the {field}",
            source="theory: Q2-P-1 elements",
            reference=order,
            value=float(np.log(coarse[column] / fine[column]) / np.log(m / n)),
            tolerance=tolerance,
        )
        for column, (field, order, tolerance) in enumerate(fields)
    ]


def wall_errors(wall: Wall, layers: int) -> tuple[float, float]:
    """Root mean square errors of displacement (mm) and pressure (MPa), the inner wall moved."""
    mesh = wall.mesh(layers)
    solid = solid_of(mesh, elastomer(NEO_HOOKE, poisson_ratio=0.499999), wall.element)
    assert isinstance(solid, ElementPressureSolid)
    fixed = held(mesh, **wall.body.symmetry)
    inside = mesh.nodes_of("cavity")
    fixed[inside] |= wall.body.radial(np.ones((len(inside), 3))).astype(bool)
    radial = wall.body.radial(mesh.points)
    (found,) = solve(
        mesh.points,
        [solid],
        fixed,
        [STRETCH - 1],
        lambda load: load * radial,
        tolerance=tolerance_of(wall.element),
    )
    return _errors(wall, mesh, solid, found)


def _errors(
    wall: Wall, mesh: Mesh, solid: ElementPressureSolid, found: Solved
) -> tuple[float, float]:
    cell, d = cell_of(solid.nodes), wall.power
    values = cell.values(cell.rule.points)
    places = wall.body.radial(np.einsum("qa,eai->eqi", values, mesh.points[solid.nodes]))
    moved = np.einsum("qa,eai->eqi", values, found.displacement[solid.nodes])
    radius = np.linalg.norm(places, axis=-1, keepdims=True)
    now = (radius**d + INNER**d * (STRETCH**d - 1)) ** (1 / d)
    squares = ((moved - places * (now / radius - 1)) ** 2).sum(axis=-1)
    radii = np.linspace(INNER, OUTER, 201)
    stresses = [wall.mean_stress(NEO_HOOKE, INNER, OUTER, STRETCH, r) for r in radii]
    exact = CubicSpline(radii, stresses)(radius[..., 0])
    differences = _pressures(solid, found) - exact
    return tuple(
        float(np.sqrt((solid.weights * s).sum() / solid.weights.sum()))
        for s in (squares, differences**2)
    )


def _pressures(solid: ElementPressureSolid, found: Solved) -> FloatArray:
    """The pressures (E, Q) of the elements at their quadrature points, in MPa."""
    solid.linearize(found.unknowns, solid.internal_at_rest(), 0.0, ElementSystem.of(solid.dofs))
    own = solid.advance(np.zeros_like(found.unknowns))[:, :4]
    return np.einsum("eqc,ec->eq", solid._values, own)


def no_locking() -> list[Figure]:
    """The bent block on a coarse mesh, nearer and nearer to incompressible: it does not stiffen.

    2 x 8 hexahedra, which bend stably by 180°; those of 4 x 16 buckle at 126°, where the inside is
    compressed to 0.81 of its length, and tetrahedra on the same nodes do not. Mixed elements that
    do not lock may do so at large compression (Pantuso and Bathe, *Finite Elem. Anal. Des.* 28
    (1997) 83).
    """
    return [
        replace(figure, name=f"{figure.name}, 2 x 8 cells, ν = {poisson_ratio}")
        for poisson_ratio in (0.4999, 0.499999)
        for figure in bent_block_rows("hexahedron", (2, 8), poisson_ratio)
    ]
