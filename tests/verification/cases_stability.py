"""Where an equilibrium loses its stability: the column that buckles under its own weight."""

from __future__ import annotations

import numpy as np
from closed_forms import NEO_HOOKE
from figure import Figure
from solving import BLOCKS, BoolArray, FloatArray, elastomer, held, label, solid_of

from pagd.fem.assembly import Assembly
from pagd.fem.continuation import Continuation, StepControl
from pagd.fem.gravity import Gravity
from pagd.fem.linear_solver import linear_solver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.mesh.primitives import box
from pagd.mesh.types import Mesh

#: Thickness, in which it bends, width and height in mm.
THICKNESS, WIDTH, HEIGHT = 4.0, 6.0, 80.0
#: kg/m³ and m/s²; the weight by volume is 1e-9 of their product in N/mm³.
DENSITY, ACCELERATION = 1130.0, 9.81

#: q L³ / (E I) at which a clamped column with a free end buckles under its weight q by length:
#: x² · 9/4 at the first zero x = 1.86635 of the Bessel function of order −1/3.
GREENHILL = 7.8373

#: The weight is raised through this share of the critical one, by steps down to the other.
_BEYOND, _STEP, _SMALLEST = 1.5, 0.25, 1e-3


def heavy_column() -> list[Figure]:
    """A straight column under growing weight: where its straight form loses its stability.

    The straight column stays an equilibrium at any weight. What ends the path is the sign of the
    pivots, of which those of the pressures of P2-P1 are known. The foot is free to widen; held, it
    makes a stiffer column (8.02 on this mesh).
    """
    return [_column("taylor_hood"), _column("hexahedron")]


def _column(element: str) -> Figure:
    mesh = box((THICKNESS, WIDTH, HEIGHT), (2, 3, 20), blocks=BLOCKS.get(element))
    material = elastomer(NEO_HOOKE)
    solid = solid_of(mesh, material, element)
    fixed = np.zeros(mesh.points.size + getattr(solid, "pressures", 0), np.bool_)
    fixed[: mesh.points.size] = _base(mesh).ravel()
    gravity = Gravity(mesh.points, mesh.tets, DENSITY, (0.0, 0.0, -ACCELERATION))
    shear = 2 * NEO_HOOKE[0]
    stiffness = 2 * shear * (1 + material.poisson_ratio) * WIDTH * THICKNESS**3 / 12
    critical = GREENHILL * stiffness / HEIGHT**3
    weight = DENSITY * ACCELERATION * 1e-9 * THICKNESS * WIDTH

    def heavier(load: float, unknowns: FloatArray) -> None:
        gravity.share = load * critical / weight

    settings = NewtonSettings(tolerance=1e-6, iterations=15, largest_correction=1e3)
    assembly = Assembly([solid, gravity], len(fixed), fixed)
    solver = linear_solver()
    newton = Newton(assembly, solver, mesh.points.size, settings)
    control = StepControl(first=_STEP, smallest=_SMALLEST, wanted_correction=1e3, growth=1.0)
    path = Continuation(newton, control, heavier).follow([_BEYOND], lambda step: None)
    solver.free()
    what = f"column under its own weight{label(element)}"
    return Figure(
        name=f"{what}: weight at which it buckles, q L³ / (E I)",
        source="Greenhill 1881; Timoshenko and Gere, *Theory of Elastic Stability*, 1961, "
        "section 2.12",
        reference=GREENHILL,
        value=GREENHILL * path.load,
        tolerance=0.01,
    )


def _base(mesh: Mesh) -> BoolArray:
    """The foot is held on the ground, its middle line across the thickness, one node altogether."""
    result = held(mesh, z0="z")
    foot = mesh.nodes_of("z0")
    away = np.abs(mesh.points[foot] - [THICKNESS / 2, WIDTH / 2, 0.0])
    result[foot[away[:, 0] < 1e-9], 0] = True
    result[foot[away.sum(axis=1).argmin()], 1] = True
    return result
