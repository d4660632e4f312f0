"""The default elastomer in homogeneous states, and the limit point of a balloon."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from actuators import default_elastomer
from cases_inflation import INNER, OUTER, POISSON_RATIO, Sphere
from closed_forms import NEO_HOOKE, limit_point, sphere_pressure
from figure import Figure
from solving import BLOCKS, FloatArray, elastomer, held, label, solid_of, solve, tolerance_of

from pagd.fem.assembly import Assembly
from pagd.fem.conjugate import ConjugatePath
from pagd.fem.continuation import Continuation, LoadPath, Step, StepControl
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.linear_solver import linear_solver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.mesh.primitives import box


@dataclass(frozen=True)
class Homogeneous:
    """Axes that are stretched by λ, axes that are held, and the stretch λ^``across`` along y.

    The stretch along z is what keeps the volume, λ^−(1 + ``across``).
    """

    name: str
    stretched: str
    held: str
    across: float

    def stress(self, stretch: float, c10: float, c20: float) -> float:
        """Nominal stress (MPa) of an incompressible Yeoh solid: (λ_x² − λ_z²) 2 W′(I₁)/λ_x."""
        squares = np.array([stretch, stretch**self.across, stretch ** -(1 + self.across)]) ** 2
        slope = c10 + 2 * c20 * (squares.sum() - 3)
        return float(2 * slope * (squares[0] - squares[2]) / stretch)


STATES = (
    Homogeneous("uniaxial", "x", "", -0.5),
    Homogeneous("equibiaxial", "xy", "", 1.0),
    Homogeneous("planar", "x", "y", 0.0),
)
STRETCHED = (1.5, 2.0)


def homogeneous_states() -> list[Figure]:
    """A cube of the default elastomer, stretched in one direction, in two, and between clamps.

    Nominal stress by the reactions. Nearly incompressible (ν = 0.49999) against closed forms of
    incompressible bodies, which differ by p/K, some 1e-4.
    """
    elements = ("taylor_hood", "hexahedron", "wedge")
    return [figure for e in elements for state in STATES for figure in _homogeneous(state, e)]


def _homogeneous(state: Homogeneous, element: str) -> list[Figure]:
    material = replace(default_elastomer(), poisson_ratio=0.49999)
    mesh = box((1.0, 1.0, 1.0), (1, 1, 1), blocks=BLOCKS.get(element))
    sides = {f"{axis}1": axis for axis in state.stretched + state.held}
    fixed = held(mesh, x0="x", y0="y", z0="z", **sides)
    along = np.array([axis in state.stretched for axis in "xyz"], dtype=np.float64)
    solved = solve(
        mesh.points,
        [solid_of(mesh, material, element)],
        fixed,
        [s - 1 for s in STRETCHED],
        lambda load: load * mesh.points * along,
        tolerance=tolerance_of(element),
    )
    end = mesh.nodes_of("x1")
    c10, c20 = (material.coefficients[name] for name in ("C10", "C20"))
    return [
        Figure(
            name=f"Elastosil M4601, {state.name}{label(element)}, λ = {stretch:g}: nominal stress",
            source=f"closed form: Yeoh, incompressible, {state.name}",
            reference=1e3 * state.stress(stretch, c10, c20),
            value=1e3 * float(found.reactions[end, 0].sum()),
            tolerance=3e-4,
            unit="kPa",
        )
        for stretch, found in zip(STRETCHED, solved, strict=True)
    ]


def balloon() -> list[Figure]:
    """A thick neo-Hookean sphere beyond the limit point of its pressure, by control of the volume.

    From rest under rising pressure, then under rising volume to λa = 2. The limit point by a
    parabola through the three states around it; the largest error of the pressure over all
    states, each beside the closed form at the λa of its volume.
    """
    stretches, pressures = _inflated(2.0)
    exact = np.array([sphere_pressure(NEO_HOOKE, INNER, OUTER, s) for s in stretches])
    at, highest = _maximum(stretches, pressures)
    known_at, known = limit_point(NEO_HOOKE, INNER, OUTER)
    source = "closed form: maximum of the thick sphere's pressure"
    return [
        Figure(
            name="sphere, neo-Hooke: pressure of the limit point",
            source=source,
            reference=1e3 * known,
            value=1e3 * highest,
            tolerance=0.003,
            unit="kPa",
        ),
        Figure(
            name="sphere, neo-Hooke: λa of the limit point",
            source=source,
            reference=known_at,
            value=at,
            tolerance=0.005,
        ),
        Figure(
            name=f"sphere, neo-Hooke, {len(stretches)} states to λa = 2: largest error of pressure",
            source=Sphere.source,
            reference=0.0,
            value=float(np.abs(pressures / exact - 1).max()),
            tolerance=0.005,
            scale=1.0,
        ),
    ]


def _maximum(places: FloatArray, values: FloatArray) -> tuple[float, float]:
    """Place and value of the vertex of the parabola through the highest value's neighbours."""
    k = int(values.argmax())
    around = slice(k - 1, k + 2)
    a, b, c = np.polyfit(places[around], values[around], 2)
    return float(-b / (2 * a)), float(c - b**2 / (4 * a))


def _inflated(largest: float) -> tuple[FloatArray, FloatArray]:
    """Stretches λa by the cavity's volume, and pressures in MPa, of the states to the largest."""
    mesh = Sphere.mesh()
    solid = solid_of(mesh, elastomer(NEO_HOOKE, POISSON_RATIO))
    pressure = FollowerPressure(mesh.points, mesh.surfaces["cavity"])
    size = mesh.points.size + solid.pressures
    fixed = np.zeros(size, np.bool_)
    fixed[: mesh.points.size] = held(mesh, **Sphere.symmetry).ravel()
    # Short steps, so that a parabola through three states is near the curve.
    solver, control = linear_solver(), StepControl(first=0.02, wanted_correction=0.02)
    settings = NewtonSettings(tolerance=1e-6, iterations=15)
    assembly = Assembly([solid, pressure], size, fixed)
    newton = Newton(assembly, solver, mesh.points.size, settings, pressure)
    empty = pressure.volume(np.zeros(size))
    found: list[tuple[float, float]] = []

    def observe(step: Step) -> str | None:
        stretch = (pressure.volume(step.state.unknowns) / empty) ** (1 / 3)
        found.append((stretch, step.state.load))
        return "far enough" if stretch > largest else None

    rising = Continuation(newton, control)
    rising.follow([0.05, 0.08], observe)
    unreached = 1.0
    ConjugatePath(newton, control).follow(
        rising.states, [unreached], observe, LoadPath(0.08, 0, 0, 0)
    )
    solver.free()
    stretches, pressures = np.array(found).T
    assert stretches[-1] > largest, "the path ended early"
    return stretches, pressures
