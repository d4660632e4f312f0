"""Following the path past limit points of the load, by what is conjugate to it.

A thin wall under rising pressure balloons: the pressure passes a maximum, falls, and rises again
as the material stiffens. A rising pressure has no equilibrium there, a rising volume has. Beyond
the first limit point the wanted loads are those of the branch that reaches them next.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from pagd.fem.assembly import State
from pagd.fem.continuation import (
    UNSTABLE,
    LoadPath,
    Observer,
    Step,
    StepControl,
    failed,
    longer,
    tried,
)
from pagd.fem.dense_output import interpolate, states_to_use
from pagd.fem.newton import Newton, NewtonResult
from pagd.fem.term import LoadTerm

# Tries to land on a wanted load between two states, each of which brings them nearer.
_LANDINGS = 6

# A step below this share of the largest one between the known states is the end.
_SMALLEST = 1e-2


@dataclass(frozen=True, slots=True)
class _Point:
    """A state and its conjugate."""

    state: State
    conjugate: float


class ConjugatePath:
    """Goes on from known states by steps of the conjugate.

    Parameters
    ----------
    newton
        Newton's method, with its load term.
    control
        How the error of a first guess chooses the next step; its loads do not matter here.
    most_steps
        More steps than this are the end.
    """

    def __init__(
        self,
        newton: Newton,
        control: StepControl,
        most_steps: int = 300,
    ) -> None:
        if newton.load_term is None:
            raise ValueError("to step by the conjugate of the load, its term is needed")
        self._newton, self._control = newton, control
        self._most_steps = most_steps
        self._term: LoadTerm = newton.load_term

    def follow(
        self, known: Sequence[State], loads: Sequence[float], observe: Observer, path: LoadPath
    ) -> LoadPath:
        """Raise the conjugate from the last of the ``known`` states, two at least.

        ``loads`` are those still wanted; ``path`` is what there is of the path. Ends where the
        last load is reached, or ``observe`` stops it, or no step converges to an equilibrium that
        is stable while the conjugate is held.
        """
        control, wanted = self._control, list(loads)
        path = replace(path, failure="", is_unstable=False, unstable_load=math.inf)
        points = [_Point(s, self._term.conjugate(s.unknowns)[0]) for s in known]
        steps = [b.conjugate - a.conjugate for a, b in pairwise(points)]
        step, smallest = steps[-1], _SMALLEST * max(steps)
        end, rejections = path.steps + self._most_steps, 0
        while wanted:
            if path.steps >= end:
                reason = f"{self._most_steps} steps were not enough"
                return replace(path, failure=reason, is_unstable=False)
            taken, count = step, self._known(points)
            result = self._try(points[-count:], points[-1].conjugate + step)
            correction = result.corrections[0] if result.corrections else math.inf
            path = tried(path, result)
            if result.state is None or result.is_unstable:
                rejections += 1
                step = control.retry_step(taken, correction, count, rejections)
                path = failed(path, result)
                if step <= smallest:
                    return replace(path, failure=result.reason or UNSTABLE)
                continue
            point = _Point(result.state, self._term.conjugate(result.state.unknowns)[0])
            path = self._land_between(points[-1], point, wanted, observe, path)
            if path.failure or path.stopped or not wanted:
                return path
            points, rejections = [*points, point][-control.order - 2 :], 0
            reached = Step(result.state, result.iterations, False)
            path = longer(path, result.state.load, result)
            stop = observe(reached)
            if stop:
                return replace(path, stopped=stop)
            step = taken * control.factor(correction, count)
        return path

    def _land_between(
        self, before: _Point, after: _Point, wanted: list[float], observe: Observer, path: LoadPath
    ) -> LoadPath:
        """The path after landing on the wanted loads between two points, taken off the list."""
        while wanted and before.state.load < wanted[0] <= after.state.load:
            start = path.iterations
            path, landed = self._land(before, after, wanted[0], path)
            if landed.state is None:
                reason = f"no state found at the wanted {wanted[0]:g}"
                return replace(path, failure=reason, is_unstable=False)
            path = longer(path, landed.state.load, landed)
            del wanted[0]
            stop = observe(Step(landed.state, path.iterations - start, True))
            if stop:
                return replace(path, stopped=stop)
        return path

    def _known(self, points: Sequence[_Point]) -> int:
        """How many of the last points the next guess is made of."""
        states, places = [p.state for p in points], [p.conjugate for p in points]
        return states_to_use(self._newton, states, places, self._control.order)

    def _try(self, points: Sequence[_Point], conjugate: float) -> NewtonResult:
        places = [point.conjugate for point in points]
        guess = interpolate([point.state for point in points], places, conjugate)
        return self._newton.solve(guess, conjugate, points[-1].state)

    def _land(
        self, before: _Point, after: _Point, load: float, path: LoadPath
    ) -> tuple[LoadPath, NewtonResult]:
        """The path with all tries, and what they led to, at a load between two points'."""
        for _ in range(_LANDINGS):
            ends = [before.state, after.state]
            guess = interpolate(ends, [s.load for s in ends], load)
            result = self._newton.solve(guess)
            path = tried(path, result)
            if result.state is not None and self._lies_between(before, result.state, after):
                return path, result
            middle = self._try([before, after], (before.conjugate + after.conjugate) / 2)
            path = tried(path, middle)
            if middle.state is None:
                break
            point = _Point(middle.state, (before.conjugate + after.conjugate) / 2)
            before, after = (point, after) if point.state.load < load else (before, point)
        return path, replace(result, state=None)

    def _lies_between(self, before: _Point, state: State, after: _Point) -> bool:
        """Whether a state is of the branch between two points, and not of one before or beyond."""
        conjugate = self._term.conjugate(state.unknowns)[0]
        return before.conjugate <= conjugate <= after.conjugate
