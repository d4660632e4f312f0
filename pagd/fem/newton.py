"""Newton's method at a fixed load, or at a fixed value of what is conjugate to it.

At a fixed load λ a correction solves K δu = −r. At a fixed conjugate c(u) = c*, the volume for a
pressure, the load is an unknown too. With b = ∂c/∂u, and r growing by −b with the load,

    K δu − b δλ = −r,    b · δu = c* − c,

which takes one more solution with the same factors, K w = b. K is singular at a limit point of the
load, and only there; the path passes through it from step to step.

An equilibrium is stable where the energy grows in all directions: where K has as many negative
eigenvalues as there are multipliers (the pressures of a mixed element). With c held, the
directions are those with b · δu = 0; K may then have one more, exactly if b · K⁻¹ b < 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.linear_solver import LinearSolver, SingularMatrixError
from pagd.fem.term import LoadTerm

FloatArray = NDArray[np.float64]

# So many corrections on end, after as many, show whether an iteration comes nearer.
_TO_AND_FRO = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class NewtonSettings:
    """When an iteration has converged, and when it is given up.

    Attributes
    ----------
    tolerance
        Largest displacement of a node, in mm, in the last iteration. Convergence is
        quadratic: the error left is far smaller than the last correction.
    iterations
        Most iterations of one try.
    largest_correction
        A correction of a node beyond this, in mm, ends the try.
    smallest_fraction
        A correction is halved while it leads to an inadmissible state, down to this; so is one
        that leads too deep into a contact, or twice as deep as it was; it is taken at the end.
    shortenings
        A first guess that is either is taken half-way back to the state before, so many times.
    growth
        A correction larger than the one before it, after the second, ends the try; with a number,
        one larger than so many times the larger of the first two, and so do several on end none
        of which is smaller than any before: the iteration goes to and fro.
    """

    tolerance: float = 1e-2
    iterations: int = 8
    largest_correction: float = 50.0
    smallest_fraction: float = 1 / 16
    shortenings: int = 5
    growth: float | None = None


@dataclass(frozen=True, slots=True)
class NewtonResult:
    """A converged state, or none and the reason; the number of systems solved.

    Of a converged state, ``unstable_directions`` is the number of those in which the energy falls
    under the load, and ``is_unstable`` tells whether it does in any that what is held allows.
    """

    state: State | None
    iterations: int
    corrections: tuple[float, ...]
    reason: str = ""
    unstable_directions: int = 0
    is_unstable: bool = False


class Newton:
    """Newton's method for one assembly; keeps the linear solver's analysis.

    Parameters
    ----------
    assembly
        The body.
    solver
        The linear solver.
    displacements
        The first so many unknowns are displacements, in mm; the tolerance is theirs. All others
        are multipliers.
    settings
        Tolerance and limits.
    load_term
        The term of the assembly that the load acts through; needed to hold its conjugate.
    """

    def __init__(
        self,
        assembly: Assembly,
        solver: LinearSolver,
        displacements: int,
        settings: NewtonSettings | None = None,
        load_term: LoadTerm | None = None,
    ) -> None:
        self.assembly = assembly
        self.load_term = load_term
        self.solver = solver
        self.settings = settings or NewtonSettings()
        self._displacements = displacements
        self._multipliers = int((assembly.free >= displacements).sum())
        self._analyse()

    def _analyse(self) -> None:
        self._pattern = self.assembly.pattern
        self.solver.analyse(self._pattern.starts, self._pattern.columns)

    def solve(
        self, guess: State, conjugate: float | None = None, before: State | None = None
    ) -> NewtonResult:
        """Iterate from ``guess``; failing to converge is a result, not an error.

        At the load of the guess, or at the given value of its ``conjugate``. From the state
        ``before`` the guess can be shortened.
        """
        settings = self.settings
        corrections: list[float] = []
        state, (energy, residual, values) = self._first(guess, before)
        if not np.isfinite(energy):
            return NewtonResult(None, 0, (), "the first guess inverts elements")
        while len(corrections) < settings.iterations:
            try:
                correction, load, falls = self._correction(state, residual, values, conjugate)
            except SingularMatrixError as error:
                return NewtonResult(None, len(corrections), tuple(corrections), str(error))
            size = float(np.abs(correction[: self._displacements]).max())
            corrections.append(size)
            if not size < settings.largest_correction or _diverges(corrections, settings):
                break
            if size < settings.tolerance:
                final = _loaded(self.assembly.advance(state, correction), load)
                unstable = self._unstable_directions()
                return NewtonResult(
                    final, len(corrections), tuple(corrections), "", unstable, unstable > falls
                )
            step = self._admissible_step(state, correction, load)
            if step is None:
                return NewtonResult(
                    None, len(corrections), tuple(corrections), "the correction inverts elements"
                )
            state, residual, values = step
        reason = "corrections in mm: " + ", ".join(f"{c:.1e}" for c in corrections)
        return NewtonResult(None, len(corrections), tuple(corrections), reason)

    def _first(
        self, guess: State, before: State | None
    ) -> tuple[State, tuple[float, FloatArray, FloatArray]]:
        """The guess, linearised, or what is left of it."""
        state = guess
        for _ in range(self.settings.shortenings):
            self.assembly.look_around(state)
            linearised = self.assembly.linearize(state)
            if before is None or (np.isfinite(linearised[0]) and self.assembly.excess == 0):
                return state, linearised
            state = _half_way(before, state)
        self.assembly.look_around(state)
        return state, self.assembly.linearize(state)

    def _correction(
        self, state: State, residual: FloatArray, values: FloatArray, conjugate: float | None
    ) -> tuple[FloatArray, float, bool]:
        """The Newton correction (size,), zero for held unknowns, and that of the load.

        And whether the load falls with its conjugate, if that is held.
        """
        if self.assembly.pattern is not self._pattern:
            self._analyse()
        free = self.assembly.free
        correction = np.zeros(self.assembly.size)
        correction[free] = self.solver.solve(values, -residual[free])
        if conjugate is None:
            return correction, 0.0, False
        if self.load_term is None:
            raise ValueError("to hold the conjugate of the load, Newton's method needs its term")
        value, slopes = self.load_term.conjugate(state.unknowns)
        by_load = np.zeros(self.assembly.size)
        by_load[free] = self.solver.solve_again(slopes[free])
        growth = float(slopes @ by_load)
        load = (conjugate - value - float(slopes @ correction)) / growth
        return correction + load * by_load, load, growth < 0

    def _unstable_directions(self) -> int:
        """Directions in which the energy falls from the state of the last correction."""
        negative = self.solver.negative_pivots
        return 0 if negative is None else negative - self._multipliers

    def _admissible_step(
        self, state: State, correction: FloatArray, load: float
    ) -> tuple[State, FloatArray, FloatArray] | None:
        """The corrected state, linearised; part of the correction where all of it goes too far."""
        trusted = 2 * self.assembly.excess
        fraction = 1.0
        while fraction >= self.settings.smallest_fraction:
            if fraction < 1.0:
                # advance() starts from the state linearised last: go back to it.
                self.assembly.linearize(state)
            trial = self.assembly.advance(state, fraction * correction)
            trial = _loaded(trial, fraction * load)
            energy, residual, values = self.assembly.linearize(trial)
            last = fraction < 2 * self.settings.smallest_fraction
            if np.isfinite(energy) and (last or self.assembly.excess <= trusted):
                return trial, residual, values
            fraction /= 2
        return None


def _half_way(before: State, guess: State) -> State:
    """Half-way back from a guess, at its load."""
    internal = tuple((a + b) / 2 for a, b in zip(before.internal, guess.internal, strict=True))
    return State(guess.load, (before.unknowns + guess.unknowns) / 2, internal)


def _loaded(state: State, more: float) -> State:
    return replace(state, load=state.load + more)


def _diverges(corrections: Sequence[float], settings: NewtonSettings) -> bool:
    """Whether the corrections grow again after the second, which may exceed the first."""
    if len(corrections) < 3 or corrections[-1] <= 10 * settings.tolerance:
        return False
    if settings.growth is None:
        return corrections[-1] > corrections[-2]
    if corrections[-1] > settings.growth * max(corrections[:2]):
        return True
    early, late = corrections[:-_TO_AND_FRO], corrections[-_TO_AND_FRO:]
    return len(early) >= _TO_AND_FRO and min(late) >= min(early)
