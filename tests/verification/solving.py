"""Bodies with held and prescribed displacements, solved step by step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.continuation import Continuation, Step, StepControl
from pagd.fem.linear_solver import linear_solver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.fem.solid import ElementPressureSolid, TaylorHoodSolid
from pagd.fem.term import ElementSystem, EnergyTerm
from pagd.materials import Elastomer
from pagd.mesh.blocks import hexahedra, wedges
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
Solid = TaylorHoodSolid | ElementPressureSolid
#: What a mesh has to be made up of for an element (see :mod:`pagd.mesh.primitives`).
BLOCKS = {"hexahedron": "hexahedra", "wedge": "wedges"}

#: Displacements (n, 3) of all nodes at a load; those that are held are used.
Prescribed = Callable[[float], FloatArray]


@dataclass(frozen=True)
class Solved:
    """A body at a load: displacement (n, 3), all unknowns, and the forces (n, 3) that hold it."""

    load: float
    displacement: FloatArray
    unknowns: FloatArray
    reactions: FloatArray
    energies: dict[str, float]


def elastomer(
    coefficients: tuple[float, float], poisson_ratio: float = 0.499, bulk: float | None = None
) -> Elastomer:
    """Yeoh with C10 and C20 (MPa); the bulk modulus (MPa) sets Poisson's ratio where given."""
    c10, c20 = coefficients
    if bulk is not None:
        shear = 2 * c10
        poisson_ratio = (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear)
    given = {"C10": c10, "C20": c20}
    return Elastomer(name="elastomer", law="yeoh", coefficients=given, poisson_ratio=poisson_ratio)


def solid_of(mesh: Mesh, material: Elastomer, element: str = "taylor_hood") -> Solid:
    """The solid of a mesh; its pressure unknowns follow the displacements.

    Elements: ``taylor_hood`` (P2–P1), ``element_pressure`` (P2–P0), ``hexahedron`` and ``wedge``
    (Q2–P−1), of which the whole mesh is made up.
    """
    if element == "taylor_hood":
        return TaylorHoodSolid(mesh.points, mesh.tets, material, 3 * len(mesh.points))
    if element == "element_pressure":
        return ElementPressureSolid(mesh.points, mesh.tets, material)
    nodes = {"hexahedron": hexahedra, "wedge": wedges}[element](mesh)
    assert len(np.unique(nodes)) == len(mesh.points), f"the mesh is not of {BLOCKS[element]} alone"
    return ElementPressureSolid(mesh.points, nodes, material)


def tolerance_of(element: str) -> float:
    """Newton's tolerance (mm) for forces: those of condensed pressures are off by K times it."""
    return 1e-5 if element == "taylor_hood" else 1e-9


def label(element: str) -> str:
    """What tells the rows of an element from those of the first one."""
    return "" if element == "taylor_hood" else f", {element}"


def held(mesh: Mesh, **surfaces: str) -> BoolArray:
    """Which displacements (n, 3) are held: surface name = components, as in x0="x"."""
    result = np.zeros(mesh.points.shape, np.bool_)
    for name, components in surfaces.items():
        for component in components:
            result[mesh.nodes_of(name), "xyz".index(component)] = True
    return result


def solve(
    points: FloatArray,
    terms: Sequence[EnergyTerm],
    fixed: BoolArray,
    loads: Sequence[float],
    prescribed: Prescribed | None = None,
    *,
    first: float | None = None,
    wanted_correction: float = 1.0,
    tolerance: float = 1e-5,
) -> list[Solved]:
    """Equilibria at the given loads.

    Parameters
    ----------
    points
        Reference coordinates (n, 3) in mm.
    terms
        The potential.
    fixed
        Which displacements (n, 3) are held: at zero, or as ``prescribed``.
    loads
        Rising values of the load factor.
    prescribed
        Values of held displacements at a load.
    first
        First step of the load; a quarter of the first load unless given.
    wanted_correction, tolerance
        Of the step control and of Newton's method, in mm.
    """
    displacements = points.size
    size = displacements + sum(getattr(term, "pressures", 0) for term in terms)
    flat = np.zeros(size, np.bool_)
    flat[:displacements] = fixed.ravel()
    assembly = Assembly(terms, size, flat)
    solver = linear_solver()
    settings = NewtonSettings(tolerance=tolerance, iterations=15, largest_correction=1e3)
    newton = Newton(assembly, solver, displacements, settings)
    control = StepControl(
        first=first or loads[0] / 4, smallest=1e-6 * loads[-1], wanted_correction=wanted_correction
    )

    def boundary(load: float, unknowns: FloatArray) -> None:
        if prescribed:
            unknowns[:displacements][fixed.ravel()] = prescribed(load)[fixed]

    states: list[State] = []

    def observe(step: Step) -> None:
        if step.wanted:
            states.append(step.state)

    path = Continuation(newton, control, boundary).follow(loads, observe)
    solver.free()
    assert not path.failure, path.failure
    return [_solved(assembly, state, displacements) for state in states]


def equilibrium(
    terms: Sequence[EnergyTerm],
    fixed: BoolArray,
    load: float,
    guess: FloatArray,
    *,
    tolerance: float,
) -> Solved:
    """The equilibrium at a load from a first guess near to it.

    Parameters
    ----------
    terms
        The potential; the solid of P2–P1 elements among them.
    fixed
        Which unknowns (size,) are held, at the values of the guess.
    load
        The load factor.
    guess
        All unknowns (size,); terms take their internal variables from them.
    tolerance
        Of Newton's method, in mm.
    """
    displacements = guess.size - sum(getattr(term, "pressures", 0) for term in terms)
    assembly, solver = Assembly(terms, guess.size, fixed), linear_solver()
    # The forces of the paper settle first, with corrections that may grow meanwhile.
    settings = NewtonSettings(tolerance=tolerance, iterations=25, growth=5.0)
    newton = Newton(assembly, solver, displacements, settings)
    result = newton.solve(State(load, guess, tuple(_internal(t, guess, load) for t in terms)))
    solver.free()
    assert result.state, result.reason
    return _solved(assembly, result.state, displacements)


def _internal(term: EnergyTerm, unknowns: FloatArray, load: float) -> FloatArray:
    """The internal variables that belong to the unknowns."""
    term.linearize(unknowns, term.internal_at_rest(), load, ElementSystem.of(term.dofs))
    return term.advance(np.zeros_like(unknowns))


def _solved(assembly: Assembly, state: State, displacements: int) -> Solved:
    residual = assembly.linearize(state)[1][:displacements].reshape(-1, 3)
    return Solved(
        state.load,
        state.unknowns[:displacements].reshape(-1, 3),
        state.unknowns,
        residual,
        assembly.energies(state),
    )
