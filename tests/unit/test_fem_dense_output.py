"""States between steps: interpolated where that is good enough, solved for where it is not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import pytest
from test_fem_newton import Spring, newton

from pagd.fem.assembly import State
from pagd.fem.continuation import Continuation, LoadPath, Step, StepControl
from pagd.fem.dense_output import at_load, lagrange_factors, state_between, states_to_use
from pagd.fem.newton import Newton, NewtonResult

TOLERANCE = 1e-4
WANTED = [2.0, 4.0, 6.0, 8.0, 10.0]


def state(load: float, power: int) -> State:
    return State(load, np.array([(load / 10) ** power]), ())


def loose(spring: Spring) -> Newton:
    return newton(spring, tolerance=TOLERANCE, iterations=20)


@dataclass
class Jumpy:
    """A spring whose solution cannot be found at one load unless the guess is near."""

    method: Newton
    avoided: float
    tried: list[float] = field(default_factory=list)

    def __getattr__(self, name: str) -> object:
        return getattr(self.method, name)

    def solve(self, guess: State, **given: object) -> NewtonResult:
        self.tried.append(guess.load)
        if guess.load == self.avoided and self.tried.count(guess.load) == 1:
            return NewtonResult(None, 3, (1.0,), "avoided")
        return self.method.solve(guess, **given)  # type: ignore[arg-type]


def follow(method: object, **control: float | bool) -> tuple[list[Step], LoadPath]:
    steps: list[Step] = []
    settings = StepControl(first=0.5, wanted_correction=0.3, dense=True, **control)  # type: ignore[arg-type]
    path = Continuation(method, settings).follow(WANTED, steps.append)  # type: ignore[arg-type]
    return steps, path


def solved(load: float) -> float:
    roots = np.roots([1.0, 0.0, 1.0, -load])
    return float(roots[np.abs(roots.imag) < 1e-9].real[0])


def test_a_polynomial_of_low_degree_is_met() -> None:
    states = [state(load, 2) for load in (0.0, 1.0, 3.0, 4.0, 8.0)]
    found = state_between(loose(Spring()), states, 6.0)
    assert found is not None
    assert found.load == 6.0
    np.testing.assert_allclose(found.unknowns, 0.36, rtol=1e-12)


def test_a_state_that_is_not_known_well_enough_is_none() -> None:
    """Of a polynomial of degree 4 the one of degree 3 knows too little."""
    states = [state(load, 4) for load in (0.0, 1.0, 3.0, 4.0, 8.0)]
    assert state_between(loose(Spring()), states, 6.0) is None
    assert state_between(loose(Spring()), states[:3], 2.0) is None


def test_reactions_are_interpolated_and_have_to_agree() -> None:
    def bent(load: float, kink: float) -> State:
        return State(load, np.array([load**2]), (), 5 * load**2 + kink * abs(load - 3.0))

    loads, method = (0.0, 1.0, 3.0, 4.0, 8.0), loose(Spring())
    found = state_between(method, [bent(load, 0.0) for load in loads], 6.0)
    assert found is not None
    assert found.reaction == pytest.approx(180.0, rel=1e-12)
    # A kink of 1 makes them differ by 2 at 6, where half a percent of the reaction is 0.9.
    assert state_between(method, [bent(load, 0.3) for load in loads], 6.0) is not None
    assert state_between(method, [bent(load, 1.0) for load in loads], 6.0) is None


def test_one_in_the_middle_lets_others_be_interpolated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the loads that a step has passed over, the one in the middle is solved for first."""
    middle = 6.0

    def between(newton: Newton, states: Sequence[State], load: float) -> State | None:
        knows = any(state.load == middle for state in states)
        assert states[0].load < load < states[-1].load
        return at_load(states, load) if knows else None

    monkeypatch.setattr("pagd.fem.continuation.state_between", between)
    steps, path = follow(loose(Spring()), growth=100.0)
    passed = [step for step in steps if step.wanted and step.state.load < WANTED[-1]]
    assert [step.state.load for step in passed] == WANTED[:-1]
    assert [step.state.load for step in passed if not step.interpolated] == [middle]
    assert path.load == WANTED[-1]


def count_of(function: Callable[[float], float], loads: list[float]) -> int:
    states = [State(load, np.array([function(load)]), ()) for load in loads]
    return states_to_use(loose(Spring()), states, loads, order=4)


def grows(load: float) -> float:
    return float(np.exp(load / 4))


def test_a_guess_is_made_of_as_many_states_as_are_of_use() -> None:
    loads = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    assert count_of(lambda load: load, loads) == 2
    assert count_of(lambda load: load**2, loads) == 3
    # The most that could be judged by the last state are as good as that: one more is taken.
    assert count_of(grows, loads) == 5
    assert count_of(grows, loads[:5]) == 5
    # Behind a kink what was before it tells nothing.
    assert count_of(lambda load: max(0.0, load - 2.5), loads) == 2
    # Of fewer, all.
    assert [count_of(grows, loads[:known]) for known in (1, 2, 3)] == [1, 2, 3]


def test_factors_are_one_at_their_place_and_zero_at_the_others() -> None:
    assert lagrange_factors([1.0, 2.0, 5.0], 2.0) == [0.0, 1.0, 0.0]
    assert sum(lagrange_factors([1.0, 2.0, 5.0], 3.3)) == pytest.approx(1.0)


def test_steps_pass_over_wanted_loads() -> None:
    steps, path = follow(loose(Spring(stiffening=1.0)), growth=5.0)
    assert [step.state.load for step in steps if step.wanted] == WANTED
    between = [step for step in steps if step.interpolated]
    assert between
    for step in steps:
        tolerance = TOLERANCE if step.interpolated else 1e-6
        assert step.state.unknowns[0] == pytest.approx(solved(step.state.load), abs=tolerance)
        assert (step.iterations == 0) == step.interpolated
    assert path.load == WANTED[-1]
    assert path.steps == len(steps) - len(between)
    loads = [step.state.load for step in steps]
    assert loads == sorted(set(loads))


def test_with_prescribed_unknowns_every_wanted_load_is_solved_for() -> None:
    steps: list[Step] = []

    def boundary(load: float, unknowns: np.ndarray) -> None:
        unknowns[0] = 0.0

    control = StepControl(first=0.5, wanted_correction=10.0, dense=True)
    method = loose(Spring(stiffening=1.0))
    Continuation(method, control, boundary).follow(WANTED, steps.append)
    assert [step.state.load for step in steps if step.wanted] == WANTED
    assert not any(step.interpolated for step in steps)


def test_what_is_not_known_well_enough_is_solved_for() -> None:
    exact = newton(Spring(stiffening=1.0), tolerance=1e-12, iterations=20)
    steps, _ = follow(exact, growth=5.0)
    assert [step.state.load for step in steps if step.wanted] == WANTED
    assert not any(step.interpolated for step in steps)


def test_where_no_state_between_is_found_the_step_is_shorter() -> None:
    """The state at 4 is looked for behind a step that has passed over it, and then landed on."""
    exact = newton(Spring(stiffening=1.0), tolerance=1e-12, iterations=20)
    plain, _ = follow(exact, growth=5.0)
    avoided = next(s.state.load for s in plain if s.wanted)
    jumpy = Jumpy(exact, avoided)
    steps, path = follow(jumpy, growth=5.0)
    assert path.rejected == 1
    assert jumpy.tried.count(avoided) == 2
    assert [step.state.load for step in steps if step.wanted] == WANTED
    loads = [step.state.load for step in steps]
    assert loads == sorted(set(loads))


def test_nothing_is_told_of_a_step_that_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two wanted loads in one step the first is interpolated, the second not found."""
    interpolated, avoided = WANTED[1], WANTED[2]

    def between(newton: Newton, states: Sequence[State], load: float) -> State | None:
        return at_load(states, load) if load == interpolated else None

    monkeypatch.setattr("pagd.fem.continuation.state_between", between)
    steps: list[Step] = []
    method = Jumpy(loose(Spring(stiffening=1.0)), avoided)
    control = StepControl(first=0.5, wanted_correction=50.0, dense=True, growth=20.0)
    path = Continuation(method, control).follow(WANTED, steps.append)  # type: ignore[arg-type]
    assert method.tried.count(avoided) > 1
    assert [step.state.load for step in steps if step.wanted] == WANTED
    loads = [step.state.load for step in steps]
    assert loads == sorted(set(loads))
    assert path.rejected >= 1
    assert path.steps == sum(step.iterations > 0 for step in steps)


def test_steps_do_not_pass_over_loads_where_something_touches() -> None:
    class Touched(Spring):
        excess, touching = 0.0, 1

    steps, _ = follow(loose(Touched(stiffening=1.0)), growth=5.0)
    assert [step.state.load for step in steps if step.wanted] == WANTED
    assert not any(step.interpolated for step in steps)


@dataclass
class Wall(Spring):
    """A spring that touches something, softly, from 1.2 on."""

    excess: float = 0.0
    seen: float = 0.0

    def energy(self, unknowns: np.ndarray, load: float) -> float:
        self.seen = float(unknowns[0])
        return Spring.energy(self, unknowns, load)

    @property
    def touching(self) -> int:
        return int(abs(self.seen) > 1.2)


@pytest.mark.parametrize(
    ("spring", "wary", "next_load"), [(Spring, True, 10.0), (Wall, True, 4.0), (Wall, False, 10.0)]
)
def test_wary_steps_do_not_pass_over_loads_to_where_the_guess_touches(
    spring: type[Spring], wary: bool, next_load: float
) -> None:
    """It touches from the load 2.928 on, between two that are wanted."""
    listening = Jumpy(loose(spring(stiffening=1.0)), avoided=-1.0)
    steps: list[Step] = []
    control = StepControl(first=0.5, wanted_correction=50.0, dense=True, growth=100.0, wary=wary)
    Continuation(listening, control).follow(WANTED, steps.append)  # type: ignore[arg-type]
    assert [step.state.load for step in steps if step.wanted] == WANTED
    assert listening.tried[:3] == [0.5, 2.0, next_load]


class Obstinate:
    """A linear path on which one load is not reached by steps of more than a given size."""

    def __init__(self, refused: float, smallest: float) -> None:
        self.method = loose(Spring())
        self.refused, self.smallest = refused, smallest
        self.steps: list[float] = []

    def __getattr__(self, name: str) -> object:
        return getattr(self.method, name)

    def solve(self, guess: State, before: State, **given: object) -> NewtonResult:
        if guess.load >= self.refused:
            self.steps.append(guess.load - before.load)
            if self.steps[-1] > self.smallest:
                return NewtonResult(None, 3, (1.0,), "refused")
        return self.method.solve(guess, before=before, **given)  # type: ignore[arg-type]


def test_a_load_tried_in_vain_is_tried_again_from_a_quarter_as_far() -> None:
    obstinate = Obstinate(refused=10.0, smallest=0.5)
    steps, path = follow(obstinate, growth=100.0, resolution=0.01)
    assert not path.failure
    assert path.load == WANTED[-1]
    assert len(obstinate.steps) > 2
    assert all(b <= 0.25 * a for a, b in pairwise(obstinate.steps))
    assert [step.state.load for step in steps if step.wanted] == WANTED


def test_where_a_load_passed_over_is_not_found_that_one_is_tried_in_vain() -> None:
    """The state at 6 is found only from near; what was reached beyond it is no load in vain."""
    exact = newton(Spring(stiffening=1.0), tolerance=1e-12, iterations=20)
    plain, _ = follow(exact, growth=5.0, resolution=0.01)
    passed = [s.state.load for s in plain if s.wanted]
    jumpy = Jumpy(exact, passed[2])
    steps, path = follow(jumpy, growth=5.0, resolution=0.01)
    assert path.rejected == 1
    assert [step.state.load for step in steps if step.wanted] == WANTED
    after = jumpy.tried[jumpy.tried.index(passed[2]) + 1]
    assert after < passed[2]


def test_the_observer_can_stop_at_a_state_between() -> None:
    seen: list[float] = []

    def observe(step: Step) -> str | None:
        seen.append(step.state.load)
        return "enough" if step.interpolated else None

    control = StepControl(first=0.5, wanted_correction=0.3, dense=True, growth=5.0)
    path = Continuation(loose(Spring(stiffening=1.0)), control).follow(WANTED, observe)
    assert path.stopped == "enough"
    assert path.load == seen[-1] in WANTED
