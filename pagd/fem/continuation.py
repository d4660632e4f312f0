"""Following the equilibrium path under rising load, landing on given loads."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import State
from pagd.fem.newton import Newton

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class StepControl:
    """How far to step. Loads are in the unit of the load factor (MPa for a pressure).

    Attributes
    ----------
    first, smallest
        First step, and the step below which the path is given up.
    growth
        Factor on the step after a step that took fewer than ``quick`` iterations.
    cut
        Factor on the step after a try that did not converge.
    quick
        See ``growth``.
    order
        Degree of the polynomial through the last states that gives the first guess.
    """

    first: float = 1e-3
    smallest: float = 2e-5
    growth: float = 1.4
    cut: float = 0.5
    quick: int = 4
    order: int = 2


@dataclass(frozen=True, slots=True)
class Step:
    """One converged step."""

    state: State
    iterations: int
    wanted: bool
    """Whether the load is one of those asked for."""


@dataclass(frozen=True, slots=True)
class LoadPath:
    """How following the path ended.

    ``stopped`` is what the observer gave as its reason, ``failure`` why no further
    step converged; both are empty where the last load was reached.
    """

    load: float
    steps: int
    iterations: int
    rejected: int
    stopped: str = ""
    failure: str = ""


Observer = Callable[[Step], str | None]
Boundary = Callable[[float, FloatArray], None]


def extrapolate(states: Sequence[State], load: float) -> State:
    """The Lagrange polynomial through ``states`` at ``load``, internal variables included."""
    loads = [s.load for s in states]
    factors = [
        math.prod((load - b) / (a - b) for j, b in enumerate(loads) if j != i)
        for i, a in enumerate(loads)
    ]
    unknowns = sum((f * s.unknowns for f, s in zip(factors, states, strict=True)), np.zeros(1))
    internal = tuple(
        np.asarray(sum(f * s.internal[k] for f, s in zip(factors, states, strict=True)))
        for k in range(len(states[0].internal))
    )
    return State(load, unknowns, internal)


class Continuation:
    """Steps along the path; every converged step goes to the observer.

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

    def follow(self, loads: Sequence[float], observe: Observer) -> LoadPath:
        """Raise the load from rest through each of ``loads``, which must increase.

        ``observe`` gets every converged step and may return a reason to stop.
        """
        path = LoadPath(0.0, 0, 0, 0)
        states = [self._newton.assembly.at_rest()]
        step = self._control.first
        for target in loads:
            while states[-1].load < target:
                load = _next_load(states[-1].load, target, step)
                result = self._newton.solve(self._guess(states, load))
                path = replace(path, iterations=path.iterations + result.iterations)
                taken = load - states[-1].load
                if result.state is None:
                    step = taken * self._control.cut
                    path = replace(path, rejected=path.rejected + 1)
                    if step < self._control.smallest:
                        return replace(path, failure=result.reason)
                    continue
                states = [*states, result.state][-self._control.order - 1 :]
                path = replace(path, load=load, steps=path.steps + 1)
                stop = observe(Step(result.state, result.iterations, load == target))
                if stop:
                    return replace(path, stopped=stop)
                quick = result.iterations < self._control.quick
                step = step * self._control.growth if quick else taken
        return path

    def _guess(self, states: Sequence[State], load: float) -> State:
        guess = extrapolate(states, load)
        if self._boundary:
            self._boundary(load, guess.unknowns)
        return guess


def _next_load(load: float, target: float, step: float) -> float:
    """The load after a step; the way to the target is divided evenly."""
    remaining = target - load
    parts = math.ceil(remaining / step - 1e-9)
    return target if parts <= 1 else load + remaining / parts
