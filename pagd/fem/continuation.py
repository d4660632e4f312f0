"""Following the equilibrium path under rising load, with states at given loads."""

from __future__ import annotations

import math
from bisect import bisect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import State
from pagd.fem.dense_output import (
    FEWEST,
    at_load,
    state_between,
    states_to_use,
    unknowns_at,
)
from pagd.fem.newton import Newton, NewtonResult
from pagd.fem.stability import Critical, StabilityWatch

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """How far to step. Loads are in the unit of the load factor (MPa for a pressure).

    The first guess of a step is a polynomial through the last states. Its error, which the first
    Newton correction measures, grows with the power ``order + 1`` of the step, and the step is
    chosen so that the error comes out as wanted.

    Attributes
    ----------
    first, smallest
        First step, and the step below which the path is given up.
    wanted_correction
        Largest first correction of a node, in mm, that a step is chosen for.
    growth, cut
        Largest factor from one step to the next, and the smallest.
    retry, retry_again
        Largest factor after a try that did not converge, and after more than one on end.
    order
        Highest degree of the polynomial.
    trust
        A first correction beyond so many times the wanted one gives up a try at once, where the
        guess is made of three states or more: something new has begun, such as a contact.
    patience
        Tries on end that may fail to converge, however large the step is.
    dense
        Whether steps may pass over wanted loads where nothing touches; the states there are
        interpolated (see :mod:`pagd.fem.dense_output`), or solved for where that is too rough.
    wary
        Whether steps do not pass over wanted loads to where the first guess touches.
    foresight
        How near, as a share of the load, a path is followed to where it is foretold to lose its
        stability (see :mod:`pagd.fem.stability`) once a try beyond that has failed; 0: foretell
        nothing.
    resolution
        How near, as a share of the load, a path comes to a load that is tried in vain: that is
        tried again from ever nearer states, a quarter as far each time, and the last time from so
        near, or from a third of that where nothing explains it. 0: other, higher loads are tried,
        up to the ``patience``.
    """

    first: float = 2.5e-4
    smallest: float = 2e-5
    wanted_correction: float = 1.0
    growth: float = 3.0
    cut: float = 0.25
    retry: float = 0.6
    retry_again: float = 0.3
    order: int = 4
    trust: float = 4.0
    patience: int = 20
    dense: bool = False
    wary: bool = False
    foresight: float = 0.0
    resolution: float = 0.0

    def next_step(self, taken: float, first_correction: float, states: int) -> float:
        """The step after one that converged from a guess through ``states`` states."""
        return max(taken * self.factor(first_correction, states), self.smallest)

    def retry_step(
        self, taken: float, first_correction: float, states: int, rejections: int
    ) -> float:
        """The step after one that did not converge, the last of so many ``rejections`` on end."""
        largest = self.retry if rejections <= 1 else self.retry_again
        return taken * min(max(self._factor(first_correction, states), self.cut), largest)

    def factor(self, first_correction: float, states: int) -> float:
        """Factor from a step that converged to the next one, within the limits."""
        return min(max(self._factor(first_correction, states), self.cut), self.growth)

    def largest_first(self, states: int) -> float:
        """Largest first correction, in mm, of a guess through ``states`` states."""
        return self.trust * self.wanted_correction if states > 2 else math.inf

    def _factor(self, first_correction: float, states: int) -> float:
        if not 0 < first_correction < math.inf:
            return self.cut if first_correction else self.growth
        return float((self.wanted_correction / first_correction) ** (1 / states))


@dataclass(frozen=True, slots=True)
class Step:
    """One converged step."""

    state: State
    iterations: int
    wanted: bool
    """Whether the load is one of those asked for."""
    interpolated: bool = False
    """Whether the state lies between those of steps, and was not solved for."""


@dataclass(frozen=True, slots=True)
class LoadPath:
    """How following the path ended.

    ``stopped`` is what the observer gave as its reason, ``failure`` why no further
    step converged; both are empty where the last load was reached. ``is_unstable`` tells that
    the equilibrium of the last step, or of a try beyond it, is unstable under the load.
    ``iterations`` counts those of Newton's method, ``corrections`` all corrections. ``critical`` is
    where stability is lost, if that is foretold, and ``unstable_load`` the lowest one beyond the
    last step where a try has led to an unstable equilibrium.
    """

    load: float
    steps: int
    iterations: int
    rejected: int
    stopped: str = ""
    failure: str = ""
    is_unstable: bool = False
    corrections: int = 0
    critical: Critical | None = None
    unstable_load: float = math.inf


@dataclass(frozen=True, slots=True)
class Begun:
    """A path so far: its last states, rising, and how it went."""

    states: Sequence[State]
    path: LoadPath = LoadPath(0.0, 0, 0, 0)


#: Why a path ends where Newton's method converged, but on states that nothing rests in.
UNSTABLE = "the equilibrium is unstable"

# So much of the way to where stability is lost is the next step.
_APPROACH = 0.6

# A load that was tried in vain is tried again from no more than so much of that step.
_AGAIN_FROM = 0.25

# What is foretold within this share of the load beyond the last state explains why the path ends.
_AHEAD = 0.05

# Where nothing does, steps have to fail that are smaller than the resolution by this factor.
_UNEXPLAINED = 1 / 3

# A step that would end so near a wanted load, as a share of it, ends there.
_NEAR = 0.05

_load = attrgetter("load")

Observer = Callable[[Step], str | None]
Boundary = Callable[[float, FloatArray], None]


def tried(path: LoadPath, result: NewtonResult) -> LoadPath:
    """A path after the work of one more try, whatever came of it."""
    return replace(
        path,
        iterations=path.iterations + result.iterations,
        corrections=path.corrections + len(result.corrections),
    )


def failed(path: LoadPath, result: NewtonResult, load: float = math.inf) -> LoadPath:
    """A path after one more try that led nowhere, at ``load`` if that was given."""
    path = replace(path, rejected=path.rejected + 1)
    if result.unstable_directions <= 0:
        return path
    return replace(path, is_unstable=True, unstable_load=min(path.unstable_load, load))


def longer(path: LoadPath, load: float, result: NewtonResult) -> LoadPath:
    """A path after one more step."""
    # An unstable equilibrium is still ahead, or it was of another branch.
    beyond = path.unstable_load if load < path.unstable_load < math.inf else math.inf
    unstable = result.unstable_directions > 0 or beyond < math.inf
    return replace(
        path, load=load, steps=path.steps + 1, is_unstable=unstable, unstable_load=beyond
    )


class Continuation:
    """Steps along the path; every state goes to the observer.

    Parameters
    ----------
    newton
        Newton's method for the body.
    control
        Step sizes.
    boundary
        Sets the held unknowns of a first guess at a load, where they are not zero.
    """

    def __init__(
        self, newton: Newton, control: StepControl | None = None, boundary: Boundary | None = None
    ) -> None:
        self._newton = newton
        self._control = control or StepControl()
        self._boundary = boundary
        #: The last states of the path: those a first guess is made of, and one to judge it by.
        self.states: list[State] = []
        self._touches = False
        # A load tried in vain, and the step to it.
        self._in_vain, self._vain_step = math.inf, 0.0
        self._watch = StabilityWatch(newton)

    def follow(
        self,
        loads: Sequence[float],
        observe: Observer,
        start: State | None = None,
        begun: Begun | None = None,
    ) -> LoadPath:
        """Raise the load through each of ``loads``, which must increase.

        From ``start``, an equilibrium, or from rest, or on from a path that has ``begun``.
        ``observe`` gets every converged step and may return a reason to stop. A step to an unstable
        equilibrium counts as one that failed.
        """
        control, wanted = self._control, list(loads)
        begun = begun or Begun((start or self._newton.assembly.at_rest(),))
        path = replace(begun.path, failure="", is_unstable=False, unstable_load=math.inf)
        self.states, self._in_vain = list(begun.states[-control.order - 2 :]), math.inf
        step, rejections = control.first, 0
        if len(self.states) > 1:
            step = self.states[-1].load - self.states[-2].load
            step = min(step, wanted[0] - self.states[-1].load) if wanted else step
        while wanted:
            known, before = self._known(), self.states[-1]
            load = self._next_load(wanted, step)
            result = self._try(load, known)
            correction = result.corrections[0] if result.corrections else math.inf
            path = tried(path, result)
            taken, between, state = load - before.load, list[Step](), result.state
            if state is None or result.is_unstable:
                path, state = failed(path, result, load), None
            else:
                path, found = self._pass_over(state, wanted, path)
                if isinstance(found, list):
                    between = found
                else:
                    (load, result), state = found, None
            if state is None:
                rejections += 1
                path, step = self._retry(path, load, result, known, rejections)
                if path.failure:
                    return path
                continue
            path, rejections = longer(path, load, result), 0
            self._in_vain = self._in_vain if load < self._in_vain else math.inf
            lands = bool(load in wanted)
            for reached in (*between, Step(state, result.iterations, lands)):
                self._newton.assembly.look_around(reached.state)
                stop = observe(reached)
                if stop:
                    return replace(path, load=reached.state.load, stopped=stop)
            del wanted[: len(between) + lands]
            # A step shortened only to land on a wanted load does not shorten the next.
            following = control.next_step(taken, correction, known)
            step = max(step, following) if following > taken else following
        return path

    def _retry(
        self, path: LoadPath, load: float, result: NewtonResult, known: int, rejections: int
    ) -> tuple[LoadPath, float]:
        """The path and the next step after the last of ``rejections`` tries in vain, at ``load``.

        The path has a ``failure`` where there is to be no other try.
        """
        control, last = self._control, self.states[-1].load
        correction = result.corrections[0] if result.corrections else math.inf
        step = control.retry_step(load - last, correction, known, rejections)
        if result.iterations > 1 and load <= self._in_vain:
            self._in_vain, self._vain_step = load, load - last
        share = (load - last) / load
        given_up = step < control.smallest or rejections > control.patience
        given_up = given_up or share <= control.resolution * _UNEXPLAINED
        fine = share <= control.resolution or given_up
        farthest = max(load, (1 + _AHEAD) * last) if fine else load
        # A first guess far off is told at once and costs less than foretelling.
        is_dear = result.iterations > 1
        critical = self._critical_before(farthest) if is_dear or fine else None
        if critical is not None:
            left = critical - last
            step = min(step, _APPROACH * left)
            near = left <= control.foresight * critical
            if near or fine or step < control.smallest:
                return self._ended_unstable(path), step
        if given_up or (fine and path.unstable_load < math.inf):
            return replace(path, failure=path.failure or result.reason or UNSTABLE), step
        return replace(path, failure=""), step

    def _critical_before(self, load: float) -> float | None:
        """Where stability is foretold to be lost up to a load; none if it is not."""
        if not self._control.foresight:
            return None
        found = self._watch.critical_load(self.states)
        return found if found is not None and found <= load else None

    def _ended_unstable(self, path: LoadPath) -> LoadPath:
        critical = self._watch.critical(self.states)
        return replace(path, failure=UNSTABLE, is_unstable=True, critical=critical)

    def _next_load(self, wanted: Sequence[float], step: float) -> float:
        """The load after a step; one that was tried in vain only from much nearer."""
        resolution, last, in_vain = self._control.resolution, self.states[-1].load, self._in_vain
        load = self._load_after(wanted, step)
        if not resolution or max(load, last + step) < in_vain:
            return load
        near = max(2 * resolution * in_vain, _AGAIN_FROM * self._vain_step)
        return min(load, in_vain if in_vain - last <= near else (last + in_vain) / 2)

    def _load_after(self, wanted: Sequence[float], step: float) -> float:
        """The load after a step; the way to a load to land on is divided evenly."""
        passes = self._control.dense and len(self.states) >= FEWEST - 1
        if not passes or self._touches:
            return self._step_towards(wanted[0], step)
        load = self._step_towards(wanted[-1], step)
        if self._control.wary and load > wanted[0] and self._would_touch(load):
            return self._step_towards(wanted[0], step)
        near = _NEAR * (load - self.states[-1].load)
        return next((w for w in wanted if abs(w - load) <= near), load)

    def _step_towards(self, target: float, step: float) -> float:
        load = self.states[-1].load
        parts = math.ceil((target - load) / step - 1e-9)
        return target if parts <= 1 else load + (target - load) / parts

    def _known(self) -> int:
        """How many of the last states the next guess is made of."""
        loads = [state.load for state in self.states]
        return states_to_use(self._newton, self.states, loads, self._control.order)

    def _try(self, load: float, known: int) -> NewtonResult:
        trust = self._control.largest_first(known)
        guess = self._prescribed(at_load(self.states[-known:], load))
        return self._newton.solve(guess, before=self._back(self.states[-1]), largest_first=trust)

    def _prescribed(self, guess: State) -> State:
        """The guess, with the values that are prescribed at its load."""
        if self._boundary:
            self._boundary(guess.load, guess.unknowns)
            self._newton.assembly.settle(guess.unknowns)
        return guess

    def _back(self, before: State) -> State | None:
        """The state that a guess may be shortened towards; it would lack prescribed values."""
        return None if self._boundary else before

    def _would_touch(self, load: float) -> bool:
        """Whether anything touches at the first guess for a load."""
        states = self.states[-self._known() :]
        guess = unknowns_at([s.unknowns for s in states], [s.load for s in states], load)
        self._newton.assembly.settle(guess)
        return self._newton.assembly.would_touch(guess, load)

    def _pass_over(
        self, reached: State, wanted: Sequence[float], path: LoadPath
    ) -> tuple[LoadPath, list[Step] | tuple[float, NewtonResult]]:
        """Steps at the wanted loads on the way to a state; it is the last of the path then.

        Where no state was found at one of these loads, that load and what the try led to; the path
        then has the reason as its ``failure``.
        """
        start, states, steps = path, [*self.states, reached], []
        touches = self._control.dense and self._newton.assembly.touches(reached)
        left = [load for load in wanted if load < reached.load]
        while left:
            if not touches:
                found = [(load, self._interpolated(states, load)) for load in left]
                steps += [Step(state, 0, True, interpolated=True) for _, state in found if state]
                left = [load for load, state in found if state is None]
                if not left:
                    break
            # One in the middle lets more of the others be interpolated.
            load = left.pop(0 if touches else len(left) // 2)
            place = bisect(states, load, key=_load)
            near = states[place - 1 : place + 1] if touches else self._around(states, load)
            guess = self._prescribed(at_load(near, load))
            result = self._newton.solve(guess, before=self._back(states[place - 1]))
            path = tried(path, result)
            if result.state is None or result.is_unstable:
                work = replace(start, iterations=path.iterations, corrections=path.corrections)
                path = replace(failed(work, result, load), failure=result.reason or UNSTABLE)
                return path, (load, result)
            path = longer(path, load, result)
            states.insert(place, result.state)
            steps.append(Step(result.state, result.iterations, True))
        self.states, self._touches = states[-self._control.order - 2 :], touches
        return path, sorted(steps, key=lambda step: step.state.load)

    def _interpolated(self, states: Sequence[State], load: float) -> State | None:
        found = state_between(self._newton, self._around(states, load), load)
        return None if found is None else self._prescribed(found)

    def _around(self, states: Sequence[State], load: float) -> Sequence[State]:
        """Those of the states that a polynomial at a load is best made of, two beyond it if any."""
        count = self._control.order + 2
        first = min(bisect(states, load, key=_load) + 2, len(states)) - count
        return states[max(first, 0) :][:count]
