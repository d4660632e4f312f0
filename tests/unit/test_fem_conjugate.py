"""Past limit points of the load, on a spring whose path is known: f(u) = u³ − 3u² + 2.5u.

And to where a path loses its stability, on a column that buckles.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.conjugate import ConjugatePath
from pagd.fem.continuation import Continuation, LoadPath, Step, StepControl
from pagd.fem.linear_solver import LinearSolver, PardisoSolver, SuperLUSolver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.fem.term import NO_INTERNAL, ElementSystem

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

FIRST_LIMIT = 1 - 1 / np.sqrt(6)


def force(u: FloatArray | float) -> FloatArray | float:
    return u**3 - 3 * u**2 + 2.5 * u


@dataclass
class Balloon:
    """Two unknowns: the spring, and one that follows it; the load acts on the spring alone."""

    name: str = "balloon"
    dofs: IntArray = field(default_factory=lambda: np.array([[0, 1]]))

    def internal_at_rest(self) -> FloatArray:
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        u, v = unknowns
        return float(u**4 / 4 - u**3 + 1.25 * u**2 + 0.5 * (v - u) ** 2 - load * u)

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        u, v = unknowns
        system.residual[0] = [force(u) - (v - u) - load, v - u]
        system.tangent[0] = [3 * u**2 - 6 * u + 2.5 + 1, -1.0, 1.0]
        return self.energy(unknowns, load)

    def advance(self, correction: FloatArray) -> FloatArray:
        return NO_INTERNAL

    def conjugate(self, unknowns: FloatArray) -> tuple[float, FloatArray]:
        return float(unknowns[0]), np.array([1.0, 0.0])


def newton() -> Newton:
    term = Balloon()
    assembly = Assembly([term], 2, np.zeros(2, bool))
    # Large corrections are refused: else the load jumps to the far branch.
    settings = NewtonSettings(tolerance=1e-9, iterations=20, largest_correction=0.3)
    return Newton(assembly, SuperLUSolver(), 2, settings, load_term=term)


CONTROL = StepControl(
    first=0.05, smallest=1e-4, wanted_correction=0.02, growth=2.0, order=2, patience=3
)


def follow(
    loads: list[float], stop_at: float = np.inf
) -> tuple[LoadPath, LoadPath, list[Step], Newton]:
    """Rise as far as the load goes, then by the displacement."""
    method, steps = newton(), []

    def observe(step: Step) -> str | None:
        steps.append(step)
        return "far enough" if step.state.unknowns[0] > stop_at else None

    rising = Continuation(method, CONTROL)
    first = rising.follow(loads, observe)
    left = [load for load in loads if load > first.load]
    path = ConjugatePath(method, CONTROL).follow(rising.states, left, observe, first)
    return first, path, steps, method


def test_at_a_fixed_conjugate_the_load_is_found() -> None:
    result = newton().solve(State(0.0, np.array([0.9, 0.8]), (NO_INTERNAL,)), conjugate=1.0)
    assert result.state is not None
    np.testing.assert_allclose(result.state.unknowns, [1.0, 1.0], rtol=1e-12)
    assert result.state.load == pytest.approx(force(1.0))


def test_the_path_goes_through_both_limit_points() -> None:
    first, path, steps, _ = follow([0.2, 0.4, 0.6, 0.8, 1.0])
    assert first.failure  # a rising load has no equilibrium near by
    assert first.load < force(FIRST_LIMIT) < 0.8
    assert not path.failure
    assert path.load == 1.0
    for step in steps:
        u = step.state.unknowns[0]
        assert step.state.load == pytest.approx(force(u), abs=1e-8)
    loads = np.array([step.state.load for step in steps])
    assert loads[np.argmax(loads > 0.63) :].min() < 0.4  # down to the second limit point, 0.365
    assert path.steps == len(steps)


def test_wanted_loads_are_landed_on_where_the_path_reaches_them_first() -> None:
    _, _, steps, _ = follow([0.2, 0.4, 0.6, 0.8, 1.0])
    wanted = [(step.state.load, step.state.unknowns[0]) for step in steps if step.wanted]
    assert [load for load, _ in wanted] == [0.2, 0.4, 0.6, 0.8, 1.0]
    places = [u for _, u in wanted]
    assert all(u < FIRST_LIMIT for u in places[:3])
    assert all(u > 1 + 1 / np.sqrt(6) for u in places[3:])
    assert places == sorted(places)


def test_the_observer_ends_the_path() -> None:
    _, path, steps, _ = follow([0.2, 0.8], stop_at=1.2)
    assert path.stopped == "far enough"
    assert 1.2 < steps[-1].state.unknowns[0] < 2.0
    assert steps[-1].state.load < 0.6


def test_what_has_no_conjugate_cannot_step_by_it() -> None:
    method = Newton(Assembly([Balloon()], 2, np.zeros(2, bool)), SuperLUSolver(), 2)
    with pytest.raises(ValueError, match="its term"):
        ConjugatePath(method, CONTROL)
    with pytest.raises(ValueError, match="needs its term"):
        method.solve(State(0.0, np.zeros(2), (NO_INTERNAL,)), conjugate=1.0)


@dataclass
class Column(Balloon):
    """Shortened by u under the load, it can go aside by v: u²/2 + (1 − u) v²/2 + v⁴/4 − load u.

    Straight, v = 0, it is stable up to u = 1, with the load held or with u.
    """

    def energy(self, unknowns: FloatArray, load: float) -> float:
        u, v = unknowns
        return float(u**2 / 2 + (1 - u) * v**2 / 2 + v**4 / 4 - load * u)

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        u, v = unknowns
        system.residual[0] = [u - v**2 / 2 - load, (1 - u) * v + v**3]
        system.tangent[0] = [1.0, -v, 1 - u + 3 * v**2]
        return self.energy(unknowns, load)


def column(solver: LinearSolver) -> tuple[LoadPath, LoadPath]:
    """The path of the column as the load rises, and on from there as it is shortened."""
    method = Newton(Assembly([Column()], 2, np.zeros(2, bool)), solver, 2, load_term=Column())
    control = replace(CONTROL, patience=20)
    rising = Continuation(method, control)
    first = rising.follow([0.5, 2.0], lambda step: None)
    if not first.failure:
        return first, first
    return first, ConjugatePath(method, control).follow(
        rising.states, [2.0], lambda step: None, first
    )


def test_a_path_ends_where_its_equilibria_become_unstable() -> None:
    pytest.importorskip("pypardiso", reason="MKL exists for x86-64 only")
    for path in column(PardisoSolver()):
        assert path.failure == "the equilibrium is unstable"
        assert path.is_unstable
        assert path.load == pytest.approx(1.0, abs=2 * CONTROL.smallest)


def test_a_solver_that_cannot_tell_goes_on() -> None:
    first, _ = column(SuperLUSolver())
    assert (first.load, first.failure, first.is_unstable) == (2.0, "", False)


def test_behind_a_limit_point_it_is_unstable_under_the_load_alone() -> None:
    pytest.importorskip("pypardiso", reason="MKL exists for x86-64 only")
    term = Balloon()
    method = Newton(Assembly([term], 2, np.zeros(2, bool)), PardisoSolver(), 2, load_term=term)
    for place, directions in ((0.5, 0), (1.0, 1), (1.5, 0)):
        found = method.solve(State(0.0, np.full(2, place), (NO_INTERNAL,)), conjugate=place)
        assert (found.unstable_directions, found.is_unstable) == (directions, False)
    found = method.solve(State(force(1.0), np.full(2, 1.0), (NO_INTERNAL,)))
    assert (found.unstable_directions, found.is_unstable) == (1, True)


def test_what_was_unstable_under_the_load_is_forgotten_under_its_conjugate() -> None:
    method = newton()
    rising = Continuation(method, CONTROL)
    first = rising.follow([2.0], lambda step: None)
    ahead = replace(first, is_unstable=True, unstable_load=1.0)
    path = ConjugatePath(method, CONTROL).follow(rising.states, [2.0], lambda step: None, ahead)
    assert path.load == pytest.approx(2.0)
    assert (path.failure, path.is_unstable, path.unstable_load) == ("", False, np.inf)
