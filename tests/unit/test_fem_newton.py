"""Newton's method and the continuation, on springs whose answers are known."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.continuation import Continuation, Step, StepControl
from pagd.fem.dense_output import at_load
from pagd.fem.linear_solver import SingularMatrixError, SuperLUSolver
from pagd.fem.newton import Newton, NewtonResult, NewtonSettings
from pagd.fem.term import NO_INTERNAL, ElementSystem

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass
class Spring:
    """One unknown u: the energy u²/2 + c u⁴/4 − load u, infinite from ``limit`` on."""

    stiffening: float = 0.0
    limit: float = math.inf
    name: str = "spring"
    dofs: IntArray = field(default_factory=lambda: np.array([[0]]))

    def internal_at_rest(self) -> FloatArray:
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        u = float(unknowns[0])
        return math.inf if u >= self.limit else u**2 / 2 + self.stiffening * u**4 / 4 - load * u

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        u = unknowns[0]
        system.residual[0] = u + self.stiffening * u**3 - load
        system.tangent[0] = 1 + 3 * self.stiffening * u**2
        return self.energy(unknowns, load)

    def advance(self, correction: FloatArray) -> FloatArray:
        return NO_INTERNAL


@dataclass
class Snapping(Spring):
    """Energy u²/2 − u⁴/4 − load u: no equilibrium u > 0 beyond the load 2/√27 at u = 1/√3."""

    stiffening: float = -1.0

    def energy(self, unknowns: FloatArray, load: float) -> float:
        return math.inf if unknowns[0] < 0 else Spring.energy(self, unknowns, load)


@dataclass
class Stop(Spring):
    """A spring that meets a stop at 1, a hundred times as stiff; beyond 1.1 it is too deep."""

    seen: list[float] = field(default_factory=list)

    def energy(self, unknowns: FloatArray, load: float) -> float:
        u = float(unknowns[0])
        return Spring.energy(self, unknowns, load) + 50 * max(u - 1, 0) ** 2

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        self.seen.append(float(unknowns[0]))
        Spring.linearize(self, unknowns, internal, load, system)
        deep = max(self.seen[-1] - 1, 0)
        system.residual[0] += 100 * deep
        system.tangent[0] += 100 * (deep > 0)
        return self.energy(unknowns, load)

    @property
    def excess(self) -> float:
        return max(self.seen[-1] - 1.1, 0.0) if self.seen else 0.0

    @property
    def touching(self) -> int:
        return int(bool(self.seen) and self.seen[-1] > 1)


def newton(spring: Spring, **settings: float | int) -> Newton:
    assembly = Assembly([spring], 1, np.array([False]))
    return Newton(assembly, SuperLUSolver(), 1, NewtonSettings(**settings))  # type: ignore[arg-type]


def at(load: float, unknown: float = 0.0) -> State:
    return State(load, np.array([unknown]), (NO_INTERNAL,))


def test_a_linear_spring_takes_one_factorisation() -> None:
    result = newton(Spring()).solve(at(0.5))
    assert result.state is not None
    assert result.state.unknowns[0] == pytest.approx(0.5, rel=1e-14)
    assert result.iterations == 1
    assert result.corrections == pytest.approx((0.5, 0.0))
    again = newton(Spring(), reuses=0).solve(at(0.5))
    assert (again.iterations, again.corrections) == (2, pytest.approx((0.5, 0.0)))


def test_a_solution_has_its_reaction_more_exactly() -> None:
    """The reaction is asked for at the solution, which is corrected once more."""
    assembly = Assembly([Spring(stiffening=1.0)], 1, np.array([False]))
    settings = NewtonSettings(tolerance=0.1)
    rough = Newton(assembly, SuperLUSolver(), 1, settings).solve(at(2.0, 0.95))
    asked: list[float] = []

    def reaction(state: State) -> float:
        asked.append(float(state.unknowns[0]))
        return 7.0 * asked[-1]

    fine = Newton(assembly, SuperLUSolver(), 1, settings, reaction=reaction).solve(at(2.0, 0.95))
    assert rough.state is not None
    assert np.isnan(rough.state.reaction)
    assert fine.state is not None
    assert fine.iterations == rough.iterations == 1
    assert fine.state.reaction == 7.0 * fine.state.unknowns[0] == 7.0 * asked[-1]
    assert abs(fine.state.unknowns[0] - 1) < 0.1 * abs(rough.state.unknowns[0] - 1)


def test_convergence_is_quadratic() -> None:
    stiffening = newton(Spring(stiffening=1.0), tolerance=1e-10, iterations=20, reuses=0)
    result = stiffening.solve(at(2.0, 0.9))
    assert result.state is not None
    assert result.state.unknowns[0] == pytest.approx(1.0, rel=1e-14)  # 1 + 1³ = 2
    small = [c for c in result.corrections if 1e-12 < c < 0.1]
    assert len(small) >= 3
    for before, after in itertools.pairwise(small):
        assert after < before**2


def test_factors_are_used_again_while_corrections_shrink_with_them() -> None:
    """From 0.99 the tangent is nearly that of the solution: one factorisation is enough."""
    result = newton(Spring(stiffening=1.0), tolerance=1e-3).solve(at(2.0, 0.99))
    assert result.state is not None
    assert result.iterations == 1
    assert len(result.corrections) >= 2
    assert abs(result.state.unknowns[0] - 1.0) < 1e-5
    far = newton(Spring(stiffening=1.0), tolerance=1e-3).solve(at(2.0, 0.0))
    assert far.state is not None
    assert far.iterations > 1


def test_factors_that_are_too_stiff_do_not_feign_convergence() -> None:
    """From inside the stop, a hundred times as stiff, the solution lies outside, at 0.95."""
    result = newton(Stop(), tolerance=1e-2).solve(at(0.95, 1.05))
    assert result.state is not None
    assert result.state.unknowns[0] == pytest.approx(0.95)


def test_the_last_correction_is_applied() -> None:
    """Convergence is judged by the last correction, which then has been made."""
    result = newton(Spring(stiffening=1.0), tolerance=1e-2).solve(at(2.0, 0.995))
    assert result.iterations == 1
    assert result.state is not None
    assert abs(result.state.unknowns[0] - 1.0) < 2e-4


def test_a_correction_into_the_inadmissible_is_halved() -> None:
    """u + 1000 u³ = 10 from u = 0: the full first correction, 10, would pass the limit of 3."""
    spring = Spring(stiffening=1000.0, limit=3.0)
    result = newton(spring, iterations=30, tolerance=1e-8).solve(at(10.0))
    assert result.state is not None
    u = result.state.unknowns[0]
    assert u + 1000 * u**3 == pytest.approx(10.0)
    assert result.corrections[0] == pytest.approx(10.0)  # halved twice: to 2.5


def test_corrections_that_stay_inadmissible_end_the_try() -> None:
    result = newton(Spring(limit=0.01)).solve(at(10.0))
    assert result.state is None
    assert "inverts" in result.reason


def test_a_correction_too_deep_into_a_contact_is_halved() -> None:
    """From 0 under a load of 3 the first correction leads to 3: to 1.5, 0.75 it is taken."""
    stop = Stop()
    result = newton(stop).solve(at(3.0))
    assert result.state is not None
    assert result.state.unknowns[0] == pytest.approx(103 / 101)
    # Halving starts from the state before; what is admissible is then linearised.
    assert stop.seen[:6] == pytest.approx([0, 3, 0, 1.5, 0.75, 0.75])


def test_what_stays_too_deep_is_taken_at_last() -> None:
    """A true solution beyond what is trusted: the penetration is 0.5 at a load of 51.5."""
    result = newton(Stop(), largest_correction=100.0, iterations=12).solve(at(51.5))
    assert result.state is not None
    assert result.state.unknowns[0] == pytest.approx(1.5)


@pytest.mark.parametrize("spring", [Spring(limit=1.0), Stop()])
def test_a_guess_that_goes_too_far_is_shortened(spring: Spring) -> None:
    """From 0.9 on to 2.5, half-way back to 1.7 and 1.3 and 1.1, and so on; the load is kept."""
    before, guess = at(0.9, 0.9), at(0.95, 2.5)
    refused = newton(Spring(limit=1.0)).solve(guess)
    assert refused.state is None
    result = newton(spring).solve(guess, before=before)
    assert result.state is not None
    assert (result.state.load, result.state.unknowns[0]) == pytest.approx((0.95, 0.95))


def test_a_first_correction_that_is_too_large_ends_the_try() -> None:
    refused = newton(Spring()).solve(at(0.5), largest_first=0.4)
    assert (refused.state, refused.iterations) == (None, 1)
    assert newton(Spring()).solve(at(0.5), largest_first=0.6).state is not None


def test_guesses_through_few_states_are_not_expected_to_be_good() -> None:
    fake = FakeNewton()
    follow(fake, [1.0], first=0.1, wanted_correction=0.5, trust=4.0)
    assert fake.trusts[:2] == [math.inf, math.inf]
    assert set(fake.trusts[2:]) == {2.0}


class Turning(Spring):
    """A spring whose iterated stress spoils the iteration: with it the residual never shrinks."""

    iterates_stresses = True

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        energy = Spring.linearize(self, unknowns, internal, load, system)
        if self.iterates_stresses:
            system.tangent[0] = -2.0
        return energy


def test_where_iterated_stresses_fail_those_of_the_displacements_are_tried() -> None:
    spring = Turning()
    method = newton(spring)
    result = method.solve(at(0.5))
    assert result.state is not None
    assert result.state.unknowns[0] == pytest.approx(0.5)
    assert result.iterations > 1
    # The next solve does without them at once, the one after that tries them again.
    assert method.solve(at(0.6)).iterations == 1
    assert method.solve(at(0.7)).iterations > 1


def test_where_something_touches_a_shorter_step_is_tried_first() -> None:
    class Touched(Turning):
        excess, touching = 0.0, 1

    method = newton(Touched())
    assert method.solve(at(0.7)).state is None
    assert method.solve(at(0.5)).state is not None


def test_an_inadmissible_guess_is_refused() -> None:
    result = newton(Spring(limit=1.0)).solve(at(0.5, 1.5))
    assert (result.state, result.iterations) == (None, 0)
    assert "first guess" in result.reason


def test_a_try_ends_after_the_allowed_iterations() -> None:
    result = newton(Snapping(), iterations=5).solve(at(0.4))  # the limit is 0.385
    assert result.state is None
    assert result.iterations <= 5
    assert "corrections in mm" in result.reason


def test_a_correction_too_large_ends_the_try() -> None:
    result = newton(Spring(), largest_correction=3.0).solve(at(4.0))
    assert (result.state, result.iterations) == (None, 1)


def test_a_singular_matrix_ends_the_try() -> None:
    class Failing(SuperLUSolver):
        def solve(self, values: FloatArray, right: FloatArray) -> FloatArray:
            raise SingularMatrixError("the matrix is singular")

    assembly = Assembly([Spring()], 1, np.array([False]))
    result = Newton(assembly, Failing(), 1).solve(at(1.0))
    assert (result.state, result.reason) == (None, "the matrix is singular")


def test_held_unknowns_stay() -> None:
    spring = Spring()
    assembly = Assembly([spring], 2, np.array([False, True]))
    guess = State(0.5, np.array([0.0, 7.0]), (NO_INTERNAL,))
    result = Newton(assembly, SuperLUSolver(), 2).solve(guess)
    assert result.state is not None
    np.testing.assert_allclose(result.state.unknowns, [0.5, 7.0])


# --- Continuation ------------------------------------------------------------------------------


@dataclass
class FakeNewton:
    """Converges to u = load if the step is at most ``largest``; remembers the tries."""

    largest: float = math.inf
    first_correction: float = 0.1
    tries: list[tuple[float, float]] = field(default_factory=list)
    trusts: list[float] = field(default_factory=list)
    reached: float = 0.0
    assembly: Assembly = field(default_factory=lambda: Assembly([Spring()], 1, np.array([False])))

    def solve(
        self, guess: State, before: State | None = None, largest_first: float = math.inf
    ) -> NewtonResult:
        self.trusts.append(largest_first)
        self.tries.append((guess.load, float(guess.unknowns[0])))
        corrections = (self.first_correction, 0.0)
        if guess.load - self.reached > self.largest * (1 + 1e-12):
            return NewtonResult(None, 2, corrections, "too far")
        self.reached = guess.load
        return NewtonResult(at(guess.load, guess.load), 2, corrections)

    def largest_displacement(self, correction: FloatArray) -> float:
        return float(np.abs(correction).max())


def follow(
    fake: FakeNewton, loads: list[float], **control: float | int
) -> tuple[list[Step], object]:
    steps: list[Step] = []
    path = Continuation(fake, StepControl(**control)).follow(loads, steps.append)  # type: ignore[arg-type]
    return steps, path


def test_lands_exactly_on_the_wanted_loads() -> None:
    wanted = [0.1, 0.30000000000000004, 0.7, 1.0]
    steps, path = follow(FakeNewton(), wanted, first=0.0173, smallest=1e-6)
    assert [s.state.load for s in steps if s.wanted] == wanted
    assert sum(not s.wanted for s in steps) > 0
    assert (path.load, path.steps, path.rejected) == (1.0, len(steps), 0)
    assert (path.stopped, path.failure) == ("", "")
    assert path.iterations == 2 * len(steps)


def test_loads_rise() -> None:
    steps, _ = follow(FakeNewton(), [0.5, 1.0], first=0.013)
    loads = [s.state.load for s in steps]
    assert loads == sorted(set(loads))


def test_steps_grow_while_guesses_are_good() -> None:
    fake = FakeNewton(first_correction=0.1)
    steps, _ = follow(fake, [10.0], first=0.01, growth=2.0, wanted_correction=1.0, order=2)
    sizes = np.diff([0.0, *(s.state.load for s in steps)])
    # The first guess is constant: an error of 0.1 allows ten times the step, but it may only
    # double; the quadratic ones (∛10 = 2.15) too.
    np.testing.assert_allclose(sizes[1:5] / sizes[:4], 2.0, rtol=0.1)
    assert len(steps) < 14


def test_steps_shrink_while_guesses_are_bad() -> None:
    fake = FakeNewton(first_correction=8.0)
    steps, path = follow(fake, [1.0], first=0.4, wanted_correction=1.0, smallest=0.01, cut=0.25)
    sizes = np.diff([0.0, *(s.state.load for s in steps)])
    assert sizes[1] == pytest.approx(0.25 * sizes[0])  # 1/8, but not less than the cut
    assert sizes.min() > 0.009  # never below the smallest, however bad the guesses
    assert path.load == 1.0


def test_a_try_that_fails_is_repeated_with_a_smaller_step() -> None:
    fake = FakeNewton(largest=0.1, first_correction=1.0)
    steps, path = follow(fake, [0.4], first=0.4, retry=0.5, retry_again=0.5)
    assert [load for load, _ in fake.tries[:3]] == pytest.approx([0.4, 0.2, 0.1])
    sooner = FakeNewton(largest=0.1, first_correction=1.0)
    follow(sooner, [0.4], first=0.4, retry=0.5, retry_again=0.25)
    assert [load for load, _ in sooner.tries[:3]] == pytest.approx([0.4, 0.2, 0.05])
    assert path.rejected >= 2
    assert steps[-1].state.load == 0.4
    assert not path.failure


def test_gives_up_below_the_smallest_step() -> None:
    fake = FakeNewton(largest=0.0)
    steps, path = follow(fake, [1.0], first=0.1, smallest=0.01)
    assert steps == []
    assert (path.load, path.steps) == (0.0, 0)
    assert path.failure == "too far"
    tried = [load for load, _ in fake.tries]
    assert min(tried) >= 0.01
    assert min(tried) < 0.04


def test_the_observer_can_stop() -> None:
    seen: list[float] = []

    def observe(step: Step) -> str | None:
        seen.append(step.state.load)
        return "enough" if step.state.load > 0.3 else None

    path = Continuation(FakeNewton(), StepControl(first=0.1)).follow([1.0, 2.0], observe)  # type: ignore[arg-type]
    assert path.stopped == "enough"
    assert path.load == seen[-1] > 0.3
    assert all(load <= 0.3 for load in seen[:-1])


def test_guesses_are_extrapolated() -> None:
    """u = load is linear: from the second step on every first guess is already right."""
    fake = FakeNewton()
    follow(fake, [1.0], first=0.05)
    assert fake.tries[0][1] == 0.0
    for load, guess in fake.tries[1:]:
        assert guess == pytest.approx(load, rel=1e-10)


def test_held_unknowns_are_set_at_every_guess() -> None:
    def boundary(load: float, unknowns: FloatArray) -> None:
        unknowns[0] = 10 * load

    fake = FakeNewton()
    Continuation(fake, StepControl(first=0.2), boundary).follow([1.0], lambda step: None)  # type: ignore[arg-type]
    assert all(guess == pytest.approx(10 * load) for load, guess in fake.tries)


def test_extrapolation_is_exact_for_polynomials() -> None:
    """Three states of a quadratic in the load, internal variables included."""

    def state(load: float) -> State:
        return State(load, np.array([load**2 - load, 3.0]), (np.array([2 * load**2]), NO_INTERNAL))

    guess = at_load([state(0.1), state(0.25), state(0.3)], 0.5)
    assert guess.load == 0.5
    np.testing.assert_allclose(guess.unknowns, [-0.25, 3.0], atol=1e-13)
    np.testing.assert_allclose(guess.internal[0], [0.5], atol=1e-13)
    assert guess.internal[1].size == 0


def test_a_real_path_follows_a_stiffening_spring() -> None:
    steps: list[Step] = []
    control = StepControl(first=0.01, wanted_correction=0.05)
    body = newton(Spring(stiffening=1.0), tolerance=1e-9, iterations=20)
    path = Continuation(body, control).follow([1.0, 2.0, 10.0], steps.append)
    assert not path.failure
    for step in steps:
        u = step.state.unknowns[0]
        assert u + u**3 == pytest.approx(step.state.load, rel=1e-8)


def test_a_real_path_ends_at_a_limit_point() -> None:
    steps: list[Step] = []
    control = StepControl(first=0.01, smallest=1e-7, wanted_correction=0.05)
    body = newton(Snapping(), tolerance=1e-9, iterations=12)
    path = Continuation(body, control).follow([1.0], steps.append)
    assert path.failure
    assert path.load == pytest.approx(2 / 27**0.5, abs=1e-4)
    assert path.load < 2 / 27**0.5
