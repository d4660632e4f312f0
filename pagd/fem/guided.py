"""Equilibria at given loads from first guesses that come from elsewhere, a cheaper model of it.

The path need not be followed: each wanted load has a guess so near that Newton's method gets there
at once. What states have beyond their guesses, the deviation, is small and smooth. So few loads are
solved for, far apart; at the others the deviation is interpolated, where two polynomials agree on
it. Where a guess fails, the ordinary path goes on from the last state.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import State
from pagd.fem.continuation import UNSTABLE, LoadPath, Observer, Step, failed, longer, tried
from pagd.fem.dense_output import lagrange_factors
from pagd.fem.newton import Newton

FloatArray = NDArray[np.float64]

__all__ = ["GuidedPath"]

# The first loads that are solved for, as shares of their number.
_ANCHORS = (0.4, 1.0)
# mm: a first correction beyond this is no refinement of a guess.
_FARTHEST = 5.0
# A deviation is interpolated where what it leaves out is below this share of the tolerance.
_SHARE = 0.25
# Deviations are polynomials through so many states at most.
_AROUND = 4


@dataclass(slots=True)
class _Deviation:
    """What solved states have beyond their guesses: unknowns, internal variables, by load."""

    loads: list[float] = field(default_factory=list)
    unknowns: list[FloatArray] = field(default_factory=list)
    internal: list[tuple[FloatArray, ...]] = field(default_factory=list)

    def add(self, state: State, guess: State) -> None:
        self.loads.append(state.load)
        self.unknowns.append(state.unknowns - guess.unknowns)
        self.internal.append(
            tuple(a - b for a, b in zip(state.internal, guess.internal, strict=True))
        )

    def forget_beyond(self, load: float) -> None:
        """Leave out the states from a load on."""
        count = range(len(self.loads))
        kept = [k for k in count if self.loads[k] < load]
        self.unknowns = [self.unknowns[k] for k in kept]
        self.internal = [self.internal[k] for k in kept]
        self.loads = [self.loads[k] for k in kept]

    def near(self, load: float) -> list[int]:
        """Numbers of the states around a load, nearest first."""
        order = np.argsort([abs(known - load) for known in self.loads], kind="stable")
        return [int(k) for k in order[:_AROUND]]

    def at(self, load: float, among: Sequence[int], guess: State) -> State:
        """The guess with the deviation of the polynomial through some of the states."""
        factors = lagrange_factors([self.loads[k] for k in among], load)
        unknowns, internal = guess.unknowns.copy(), [x.copy() for x in guess.internal]
        for factor, k in zip(factors, among, strict=True):
            unknowns += factor * self.unknowns[k]
            for values, further in zip(internal, self.internal[k], strict=True):
                values += factor * further
        return replace(guess, unknowns=unknowns, internal=tuple(internal))


class GuidedPath:
    """States at wanted loads, solved for or between those that are.

    Parameters
    ----------
    newton
        Newton's method for the body.
    guess
        The first guess at a load.
    """

    def __init__(self, newton: Newton, guess: Callable[[float], State]) -> None:
        self._newton = newton
        self._guess = guess
        self._unwanted: frozenset[float] = frozenset()
        #: The states that were solved for, in the order of their loads.
        self.states: list[State] = []

    def follow(
        self,
        loads: Sequence[float],
        observe: Observer,
        start: State,
        unwanted: Collection[float] = (),
    ) -> LoadPath:
        """Find the states at rising ``loads`` beyond that of ``start``, an equilibrium.

        Those that are ``unwanted`` are solved for, as steps between wanted ones. ``observe`` gets
        all in order and may return a reason to stop. The path has a failure where a load is not
        reached by its guess; it ends at the last one before that is.
        """
        path = LoadPath(start.load, 0, 0, 0)
        self._unwanted = frozenset(unwanted)
        deviation = _Deviation()
        deviation.add(start, start)
        solved: dict[int, Step] = {}
        end, failure = len(loads), ""
        while (number := self._next(loads, end, solved, deviation)) is not None:
            path, step = self._solve(loads, number, deviation, path)
            if step is None:
                end, failure = number, path.failure
                # What lies beyond may be of another branch.
                solved = {k: known for k, known in solved.items() if k < end}
                deviation.forget_beyond(loads[end])
            else:
                solved[number] = step
        self.states = [start, *(solved[k].state for k in sorted(solved))]
        path = self._told(loads[:end], solved, deviation, observe, path)
        return replace(path, failure=failure)

    def _next(
        self, loads: Sequence[float], end: int, solved: dict[int, Step], deviation: _Deviation
    ) -> int | None:
        """The number of the load to solve for next, before ``end``; none where all are known."""
        last = max(solved, default=-1)
        if last < end - 1:
            if end < len(loads):
                return (last + end) // 2
            anchors = (max(round(share * end), 1) - 1 for share in _ANCHORS)
            return next(number for number in anchors if number > last)
        return self._least_certain(loads[:end], solved, deviation)

    def _solve(
        self, loads: Sequence[float], number: int, deviation: _Deviation, path: LoadPath
    ) -> tuple[LoadPath, Step | None]:
        load = loads[number]
        guess = self._guess(load)
        first = deviation.at(load, deviation.near(load)[:2], guess)
        result = self._newton.solve(first, largest_first=_FARTHEST)
        path = tried(path, result)
        if result.state is None or result.is_unstable:
            path = failed(path, result, load)
            return replace(path, failure=result.reason or UNSTABLE), None
        deviation.add(result.state, guess)
        path = replace(longer(path, load, result), failure="")
        return path, Step(result.state, result.iterations, load not in self._unwanted)

    def _least_certain(
        self, loads: Sequence[float], solved: dict[int, Step], deviation: _Deviation
    ) -> int | None:
        """The load whose interpolated deviation is the least certain, if it is not good enough."""
        errors = {
            k: np.inf if load in self._unwanted else self._error(load, deviation)
            for k, load in enumerate(loads)
            if k not in solved
        }
        worst = max(errors, key=lambda k: errors[k], default=None)
        if worst is None or errors[worst] <= _SHARE * self._newton.settings.tolerance:
            return None
        return worst

    def _error(self, load: float, deviation: _Deviation) -> float:
        """Largest difference of a node's place by the polynomials with and without one state."""
        near = deviation.near(load)
        if len(near) < 3:
            return np.inf
        loads = [deviation.loads[k] for k in near]
        factors = np.array(lagrange_factors(loads, load))
        factors[:-1] -= lagrange_factors(loads[:-1], load)
        between = sum(
            (f * deviation.unknowns[k] for f, k in zip(factors, near, strict=True)), np.zeros(1)
        )
        return self._newton.largest_displacement(between)

    def _told(
        self,
        loads: Sequence[float],
        solved: dict[int, Step],
        deviation: _Deviation,
        observe: Observer,
        path: LoadPath,
    ) -> LoadPath:
        """The path after all its steps were told."""
        last = self.states[0].load
        for k, load in enumerate(loads):
            step = solved.get(k)
            if step is None:
                state = deviation.at(load, deviation.near(load), self._guess(load))
                step = Step(state, 0, True, interpolated=True)
            self._newton.assembly.look_around(step.state)
            last = load
            stop = observe(step)
            if stop:
                return replace(path, load=load, stopped=stop)
        return replace(path, load=last)
