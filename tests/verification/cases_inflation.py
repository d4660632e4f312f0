"""Thick spheres and cylinders under internal pressure, against their closed forms.

Two ways each: the pressure by work conjugacy while the inner wall is moved to a given stretch
(which passes the limit point of the neo-Hookean sphere), and the stretch under a follower
pressure, where the pressure is well below a limit point.
"""

from __future__ import annotations

import numpy as np
from closed_forms import (
    NEO_HOOKE,
    YEOH,
    Coefficients,
    cylinder_pressure,
    sphere_pressure,
)
from figure import Figure
from solving import BLOCKS, FloatArray, elastomer, held, label, solid_of, solve

from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.term import ElementSystem
from pagd.mesh.blocks import block_faces
from pagd.mesh.primitives import cylinder_quarter, sphere_octant
from pagd.mesh.types import Mesh

INNER, OUTER = 10.0, 15.0
STRETCHES = (1.1, 1.2, 1.5, 2.0)
MATERIALS = {"neo-Hooke": NEO_HOOKE, "Yeoh": YEOH}
#: Stretches λa at which the inner wall is under follower pressure, by body and material.
UNDER_PRESSURE = {
    ("sphere", "neo-Hooke"): (1.1, 1.2),
    ("sphere", "Yeoh"): (1.1, 1.2, 1.5),
    ("cylinder", "neo-Hooke"): (1.1, 1.2, 1.5),
    ("cylinder", "Yeoh"): (1.1, 1.2, 1.5, 2.0),
}
#: Nearly incompressible: p/K stays below 1e-4.
POISSON_RATIO = 0.4999
ELEMENTS = ("taylor_hood", "element_pressure")


class Sphere:
    """An octant, 4 layers of 4 × 4 × 3 curved elements, or of 4 × 4 curved wedges."""

    name = "sphere"
    block = "wedge"
    source = "closed form: thick sphere, Ogden 1984, by quadrature"
    axis_weights = (1 / 3, 1 / 3, 1 / 3)
    symmetry = {"x0": "x", "y0": "y", "z0": "z"}  # noqa: RUF012
    exact_pressure = staticmethod(sphere_pressure)

    @staticmethod
    def mesh(element: str = "taylor_hood") -> Mesh:
        return sphere_octant(INNER, OUTER, (4, 4), BLOCKS.get(element))

    @staticmethod
    def radial(points: FloatArray) -> FloatArray:
        return points


class Cylinder:
    """A quarter, 4 × 6 × 1 cells of curved elements, or as many curved hexahedra."""

    name = "cylinder"
    block = "hexahedron"
    source = "closed form: thick cylinder in plane strain, by quadrature"
    axis_weights = (1 / 2, 1 / 2, 0.0)
    symmetry = {"x0": "x", "y0": "y", "z0": "z", "z1": "z"}  # noqa: RUF012
    exact_pressure = staticmethod(cylinder_pressure)

    @staticmethod
    def mesh(element: str = "taylor_hood") -> Mesh:
        return cylinder_quarter(INNER, OUTER, 2.0, (4, 6, 1), BLOCKS.get(element))

    @staticmethod
    def radial(points: FloatArray) -> FloatArray:
        return points * [1, 1, 0]


Body = type[Sphere] | type[Cylinder]


PAIRS = [(body, material) for body in (Sphere, Cylinder) for material in MATERIALS]


def pressures_at_stretches(
    body: Body, coefficients: Coefficients, element: str = "taylor_hood"
) -> list[float]:
    """Pressure (MPa) of the moved inner wall at :data:`STRETCHES`: dE/dV along the motion."""
    mesh = body.mesh(element)
    wall = mesh.nodes_of("cavity")
    fixed = held(mesh, **body.symmetry)
    fixed[wall] |= body.radial(np.ones((len(wall), 3))).astype(bool)
    radial = body.radial(mesh.points)
    solved = solve(
        mesh.points,
        [solid_of(mesh, elastomer(coefficients, POISSON_RATIO), element)],
        fixed,
        [s - 1 for s in STRETCHES],
        lambda load: load * radial,
    )
    pressure = _pressure(mesh, element, body.axis_weights)
    result = []
    for state in solved:
        system = ElementSystem.of(pressure.dofs)
        pressure.linearize(state.displacement.ravel(), np.zeros(0), -1.0, system)
        growth = (system.residual * radial.ravel()[pressure.dofs]).sum()
        result.append(float((state.reactions[wall] * radial[wall]).sum() / growth))
    return result


def _pressure(
    mesh: Mesh, element: str, axis_weights: tuple[float, float, float]
) -> FollowerPressure:
    """Pressure on the faces of the element: triangles, and quadrilaterals where it is a block."""
    if element not in BLOCKS:
        return FollowerPressure(mesh.points, mesh.surfaces["cavity"], axis_weights)
    quadrilaterals, triangles = block_faces(mesh, "cavity")
    return FollowerPressure(mesh.points, triangles, axis_weights, quadrilaterals)


def stretches_under_pressure(body: Body, material: str, element: str) -> list[float]:
    """Stretch λa under the closed form's pressure for :data:`UNDER_PRESSURE`: by cavity volume."""
    mesh = body.mesh(element)
    coefficients = MATERIALS[material]
    pressure = _pressure(mesh, element, body.axis_weights)
    loads = [
        body.exact_pressure(coefficients, INNER, OUTER, s)
        for s in UNDER_PRESSURE[body.name, material]
    ]
    solved = solve(
        mesh.points,
        [solid_of(mesh, elastomer(coefficients, POISSON_RATIO), element), pressure],
        held(mesh, **body.symmetry),
        loads,
    )
    empty = pressure.volume(np.zeros(mesh.points.size))
    power = 3 if body is Sphere else 2
    return [float((pressure.volume(s.displacement.ravel()) / empty) ** (1 / power)) for s in solved]


def moved_wall(body: Body, material: str, element: str = "taylor_hood") -> list[Figure]:
    """Pressures at the stretches."""
    coefficients = MATERIALS[material]
    found = pressures_at_stretches(body, coefficients, element)
    return [
        Figure(
            name=f"{body.name}, {material}, {element}: pressure at λa = {stretch}",
            source=body.source,
            reference=1e3 * body.exact_pressure(coefficients, INNER, OUTER, stretch),
            value=1e3 * value,
            tolerance=0.003,
            unit="kPa",
        )
        for stretch, value in zip(STRETCHES, found, strict=True)
    ]


def follower(body: Body, material: str, element: str = "taylor_hood") -> list[Figure]:
    """Displacement of the inner wall under the closed form's pressures."""
    wanted = UNDER_PRESSURE[body.name, material]
    found = stretches_under_pressure(body, material, element)
    what = f"{body.name}, {material}{label(element)}"
    return [
        Figure(
            name=f"{what}: λa − 1 under the pressure of λa = {stretch}",
            source=body.source,
            reference=stretch - 1,
            value=value - 1,
            tolerance=0.003,
        )
        for stretch, value in zip(wanted, found, strict=True)
    ]


def moved_walls() -> list[Figure]:
    """Thick spheres and cylinders, the inner wall moved to a stretch λa: pressure by work.

    Radii 10 and 15 mm, four layers of curved elements; both elements of tetrahedra, wedges in the
    sphere and hexahedra in the cylinder; beyond the limit point of
    the neo-Hookean sphere too, since it is the motion that is given. Nearly incompressible,
    ν = 0.4999, against closed forms of incompressible bodies.
    """
    figures = [f for element in ELEMENTS for pair in PAIRS for f in moved_wall(*pair, element)]
    return figures + [f for pair in PAIRS for f in moved_wall(*pair, pair[0].block)]


def walls_under_pressure() -> list[Figure]:
    """The same spheres and cylinders under follower pressure: motion of the inner wall.

    λa − 1 by the volume of the cavity, at pressures well below a limit point. Pressure acts on
    faces of nine nodes on hexahedra, of six on tetrahedra and on wedges in the sphere.
    """
    figures = [f for pair in PAIRS for f in follower(*pair)]
    return figures + [f for pair in PAIRS for f in follower(*pair, pair[0].block)]
