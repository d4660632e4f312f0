"""Foretelling where stability is lost, on a spring and a column whose paths are known."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from fem_checks import PAPER, elastomer
from scipy.sparse import csr_array
from test_fem_conjugate import CONTROL, FIRST_LIMIT, Balloon, Column, force

from pagd.actuation import Actuation, Body
from pagd.fem.assembly import Assembly, State
from pagd.fem.continuation import Continuation, LoadPath, failed, longer
from pagd.fem.linear_solver import SuperLUSolver, linear_solver
from pagd.fem.newton import Newton, NewtonResult, NewtonSettings
from pagd.fem.stability import StabilityWatch, critical_load, smallest_stiffness
from pagd.fem.term import NO_INTERNAL
from pagd.mesh.primitives import hollow_block

LIMIT = float(force(FIRST_LIMIT))


def newton(term: Balloon) -> Newton:
    settings = NewtonSettings(tolerance=1e-9, iterations=20, largest_correction=0.3)
    assembly = Assembly([term], 2, np.zeros(2, bool))
    return Newton(assembly, SuperLUSolver(), 2, settings, load_term=term)


def shortened(place: float) -> State:
    """The straight column."""
    return State(place, np.array([place, 0.0]), (NO_INTERNAL,))


def stretched(place: float) -> State:
    """The spring, in equilibrium."""
    return State(float(force(place)), np.full(2, place), (NO_INTERNAL,))


def test_before_a_limit_point_the_square_of_the_stiffness_is_linear() -> None:
    loads = [3.0, 4.0]
    stiffnesses = [np.array([0.2 * np.sqrt(7.0 - load), 9.0]) for load in loads]
    assert critical_load(loads, stiffnesses) == pytest.approx(7.0)


def test_the_mode_that_vanishes_first_counts_not_the_softest_one() -> None:
    stiffnesses = [np.array([1.0, np.sqrt(6.0)]), np.array([1.0, np.sqrt(3.0)])]
    assert critical_load([1.0, 2.0], stiffnesses) == pytest.approx(3.0)


def test_what_grows_stiffer_or_is_not_known_foretells_nothing() -> None:
    soft, stiff = np.array([1.0, 2.0]), np.array([1.5, 2.5])
    assert critical_load([1.0, 2.0], [soft, stiff]) is None
    assert critical_load([1.0, 2.0], [None, soft]) is None


@pytest.mark.parametrize("place", [0.0, 0.3, 0.55])
def test_the_smallest_stiffness_is_an_eigenvalue_of_the_tangent(place: float) -> None:
    diagonal = 3 * place**2 - 6 * place + 2.5
    exact = np.linalg.eigvalsh([[diagonal + 1, -1.0], [-1.0, 1.0]])
    found = smallest_stiffness(newton(Balloon()), stretched(place))
    assert found == pytest.approx(exact[:1], rel=0.01)


def test_with_the_conjugate_held_only_the_rest_can_move() -> None:
    """Of the spring u is held, and v follows it with a stiffness of 1."""
    found = smallest_stiffness(newton(Balloon()), stretched(0.5), under_conjugate=True)
    assert found == pytest.approx([1.0])


def test_a_singular_tangent_has_no_stiffness_to_tell() -> None:
    assert smallest_stiffness(newton(Column()), shortened(1.0)) is None


def test_a_limit_point_is_one_of_the_load_alone() -> None:
    states = [stretched(FIRST_LIMIT - distance) for distance in (0.1, 0.05)]
    found = StabilityWatch(newton(Balloon())).critical(states)
    assert found is not None
    assert found.load == pytest.approx(LIMIT, rel=1e-3)
    assert not found.under_conjugate


def test_a_bifurcation_is_one_of_the_conjugate_too() -> None:
    found = StabilityWatch(newton(Column())).critical([shortened(0.9), shortened(0.95)])
    assert found is not None
    # Too early by a third of what is left: λ is linear here.
    assert found.load == pytest.approx(1.0 - 0.05 * 2 / 3, rel=1e-2)
    assert found.under_conjugate


def test_one_state_foretells_nothing() -> None:
    assert StabilityWatch(newton(Balloon())).critical([stretched(0.5)]) is None


def path_to_the_limit(foresight: float) -> LoadPath:
    control = replace(CONTROL, first=0.2, growth=1.0, foresight=foresight, patience=20)
    return Continuation(newton(Balloon()), control).follow([2 * LIMIT], lambda step: None)


def test_what_is_foretold_saves_tries_beyond_it() -> None:
    """Where it is not, tries are halved until the steps are the smallest ones."""
    blind, foreseeing = path_to_the_limit(0.0), path_to_the_limit(0.01)
    assert foreseeing.is_unstable
    assert foreseeing.critical is not None
    assert foreseeing.critical.load == pytest.approx(LIMIT, rel=0.01)
    assert 0.98 * LIMIT < foreseeing.load < LIMIT
    assert foreseeing.rejected < blind.rejected
    assert blind.critical is None


def actuator(solver: str, element: str = "taylor_hood") -> tuple[Body, Newton]:
    """A hollow beam over a sheet, half of it, clamped."""
    mesh = hollow_block((24.0, 3.0, 6.0), (4, 2, 4), ((1, 3), (0, 1), (1, 3)), 1, True)
    material = elastomer("yeoh", C10=0.11, C20=0.02)
    body = Body(mesh, material, PAPER, Actuation(element=element))
    method = linear_solver(solver)
    return body, Newton(body.assembly(), method, 3 * body.nodes, load_term=body.pressure)


def dense(newton: Newton, state: State) -> np.ndarray:
    """The stiffness of the free displacements, multipliers eliminated."""
    assembly = newton.assembly
    assembly.look_around(state)
    _, _, values = assembly.linearize(state)
    size = len(assembly.free)
    pattern = assembly.pattern
    upper = csr_array((values, pattern.columns, pattern.starts), shape=(size, size)).toarray()
    whole = np.triu(upper) + np.triu(upper, 1).T
    free = int((assembly.free < newton.displacements).sum())
    a, b, c = whole[:free, :free], whole[:free, free:], whole[free:, free:]
    return a - b @ np.linalg.solve(c, b.T) if c.size else a


@pytest.mark.parametrize("solver", ["auto", "superlu"])
@pytest.mark.parametrize("element", ["taylor_hood", "element_pressure"])
def test_of_an_actuator_the_three_smallest_ones(solver: str, element: str) -> None:
    body, method = actuator(solver, element)
    state = method.assembly.at_rest()
    stiffness = dense(method, state)
    exact = np.linalg.eigvalsh(stiffness)[:3]
    assert smallest_stiffness(method, state) == pytest.approx(exact, rel=0.01)
    free = method.assembly.free[: len(stiffness)]
    slopes = body.pressure.conjugate(state.unknowns)[1][free]
    keeps = np.linalg.svd(slopes[None, :])[2][1:].T
    held = np.linalg.eigvalsh(keeps.T @ stiffness @ keeps)[:3]
    found = smallest_stiffness(method, state, under_conjugate=True)
    assert found == pytest.approx(held, rel=0.01)
    assert held[0] > exact[0]


def test_a_state_that_is_known_is_not_factorised_again() -> None:
    method = newton(Balloon())
    watch, states = StabilityWatch(method), [stretched(place) for place in (0.4, 0.5, 0.55)]
    counts = []
    for last in (2, 2, 3):
        watch.critical_load(states[:last])
        counts.append(method.solver.factorisations)
    assert counts == [2, 2, 3]


def test_without_a_conjugate_there_is_nothing_to_hold() -> None:
    method = newton(Balloon())
    method.load_term = None
    found = StabilityWatch(method).critical([stretched(0.4), stretched(0.5)])
    assert found is not None
    assert not found.under_conjugate


def test_what_cannot_move_has_no_stiffness() -> None:
    settings = NewtonSettings(tolerance=1e-9)
    assembly = Assembly([Balloon()], 2, np.array([False, True]))
    method = Newton(assembly, SuperLUSolver(), 2, settings, load_term=Balloon())
    assert smallest_stiffness(method, stretched(0.5)) is None


def test_beyond_the_limit_the_stiffness_is_not_told() -> None:
    assert smallest_stiffness(newton(Balloon()), stretched(1.0)) is None


def test_what_is_foretold_is_told_where_steps_become_too_small() -> None:
    control = replace(CONTROL, first=0.2, smallest=0.05, growth=1.0, foresight=1e-6, patience=20)
    path = Continuation(newton(Balloon()), control).follow([2 * LIMIT], lambda step: None)
    assert path.is_unstable
    assert path.critical is not None
    assert path.critical.load == pytest.approx(LIMIT, rel=0.05)


def test_a_load_tried_in_vain_is_come_near_to() -> None:
    """The last try goes by one percent, and none beyond what has failed before."""
    tried = []

    class Listening(Newton):
        def solve(self, guess: State, *args: Any, **more: Any) -> NewtonResult:
            tried.append(guess.load)
            return super().solve(guess, *args, **more)

    method = newton(Balloon())
    listening = Listening(method.assembly, method.solver, 2, method.settings)
    control = replace(CONTROL, first=0.2, resolution=0.01, patience=20)
    path = Continuation(listening, control).follow([2 * LIMIT], lambda step: None)
    assert path.failure
    assert 0.98 * LIMIT < path.load < LIMIT
    failed = min(load for load in tried if load > LIMIT)
    assert failed - path.load <= 0.01 * failed
    highest = np.minimum.accumulate([load if load > LIMIT else np.inf for load in tried])
    assert all(b <= a for a, b in pairwise(highest))


def test_an_unstable_equilibrium_ahead_is_remembered_until_it_is_passed() -> None:
    stable = NewtonResult(stretched(0.5), 1, (0.1,))
    unstable = replace(stable, unstable_directions=1, is_unstable=True)
    path = failed(LoadPath(1.0, 1, 1, 0), unstable, 3.0)
    assert (path.is_unstable, path.unstable_load) == (True, 3.0)
    nearer = longer(path, 2.0, stable)
    assert (nearer.is_unstable, nearer.unstable_load) == (True, 3.0)
    passed = longer(path, 3.0, stable)
    assert (passed.is_unstable, passed.unstable_load) == (False, np.inf)


@pytest.mark.parametrize(("ahead", "explains"), [(1.04, True), (1.2, False)])
def test_what_is_foretold_a_little_farther_on_explains_the_end(
    ahead: float, explains: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        StabilityWatch, "critical_load", lambda watch, states: ahead * states[-1].load
    )
    control = replace(CONTROL, first=0.2, foresight=0.01, resolution=0.01, patience=20)
    path = Continuation(newton(Balloon()), control).follow([2 * LIMIT], lambda step: None)
    assert path.failure
    assert 0.98 * LIMIT < path.load < LIMIT
    assert path.is_unstable == explains
