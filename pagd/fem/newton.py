"""Newton's method at a fixed load, or at a fixed value of what is conjugate to it.

At a fixed load λ a correction solves K δu = −r. At a fixed conjugate c(u) = c*, the volume for a
pressure, the load is an unknown too. With b = ∂c/∂u, and r growing by −b with the load,

    K δu − b δλ = −r,    b · δu = c* − c,

which takes one more solution with the same factors, K w = b. K is singular at a limit point of the
load, and only there; the path passes through it from step to step.

An equilibrium is stable where the energy grows in all directions: where K has as many negative
eigenvalues as there are multipliers (the pressures of a mixed element). With c held, the
directions are those with b · δu = 0; K may then have one more, exactly if b · K⁻¹ b < 0.

A factorisation costs ten times what a residual and a solution do. So the factors are used again
(the chord method; Kelley, *Iterative Methods for Linear and Nonlinear Equations*, SIAM 1995,
section 5.4) as long as each correction is much smaller than the one before.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.linear_solver import LinearSolver, SingularMatrixError
from pagd.fem.term import LoadTerm

FloatArray = NDArray[np.float64]

#: Energy, residual and values of the matrix.
Linearised = tuple[float, FloatArray, FloatArray]

# So many corrections on end, after as many, show whether an iteration comes nearer.
_TO_AND_FRO = 3

# Corrections with old factors do not shrink quadratically: they end below this share of the
# tolerance, so that the error left is below the tolerance as well.
_SHARE = 0.1

# A reaction is stiffer than what is free: a micrometre of the walls is a per cent of the force.
_SHARE_FOR_REACTION = 0.01


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
    reuses
        Most corrections with the same factors; 0 factorises for each.
    contraction
        Largest ratio of such a correction to the one before it.
    """

    tolerance: float = 1e-2
    iterations: int = 8
    largest_correction: float = 50.0
    smallest_fraction: float = 1 / 16
    shortenings: int = 5
    growth: float | None = None
    reuses: int = 6
    contraction: float = 0.4


@dataclass(frozen=True, slots=True)
class NewtonResult:
    """A converged state, or none and the reason; the number of factorisations, all corrections.

    Of a converged state, ``unstable_directions`` is the number of those in which the energy falls
    under the load, and ``is_unstable`` tells whether it does in any that what is held allows.
    """

    state: State | None
    iterations: int
    corrections: tuple[float, ...]
    reason: str = ""
    unstable_directions: int = 0
    is_unstable: bool = False


@dataclass(frozen=True, slots=True)
class _Settled:
    """A corrected state, whether it is the solution, and whether it cannot even be linearised."""

    state: State
    converged: bool
    refused: bool = False


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
    reaction
        The force in N on what holds the body, at a state near the one that was linearised last;
        every solution gets it.
    """

    def __init__(
        self,
        assembly: Assembly,
        solver: LinearSolver,
        displacements: int,
        settings: NewtonSettings | None = None,
        load_term: LoadTerm | None = None,
        reaction: Callable[[State], float] | None = None,
    ) -> None:
        self.assembly = assembly
        self.load_term = load_term
        self._reaction = reaction
        self.solver = solver
        self.settings = settings or NewtonSettings()
        self.displacements = displacements
        self._multipliers = int((assembly.free >= displacements).sum())
        self._solution = self._by_load = np.zeros(0)
        # So many solves to come without iterated stresses, and after the next failure.
        self._plain_solves, self._back_off = 0, 1
        self._has_failed = False
        self._analyse()

    def _analyse(self) -> None:
        self._pattern = self.assembly.pattern
        pattern = self._pattern
        self.solver.analyse(pattern.starts, pattern.columns, is_ring=self.assembly.is_ring)

    def solve(
        self,
        guess: State,
        conjugate: float | None = None,
        before: State | None = None,
        largest_first: float = math.inf,
    ) -> NewtonResult:
        """Iterate from ``guess``; failing to converge is a result, not an error.

        At the load of the guess, or at the given value of its ``conjugate``. Given up at once where
        the first correction of a node is larger than ``largest_first``, in mm. From the state
        ``before`` the guess can be shortened. What fails with stresses that are iterated (where
        anything touches, twice on end) is tried with those of the displacements; where they do
        better, it stays so for a while.
        """
        self._plain_solves -= 1
        if self._plain_solves >= 0:
            self.assembly.iterates_stresses = False
            return self._solve(guess, conjugate, before, largest_first)
        self.assembly.iterates_stresses = True
        result = self._solve(guess, conjugate, before, largest_first)
        works, failed = result.state is not None and not result.is_unstable, self._has_failed
        self._has_failed = not works
        if works or result.iterations < 2 or not self.assembly.iterates_stresses:
            self._back_off = 1
            return result
        if any(self.assembly.touching) and not failed:
            # A shorter step is all that new contact takes, most often.
            return result
        # Far from the solution, where walls meet or the material stiffens much, a stress along
        # the tangent can be one that no state has: it spoils the iteration, and the signs of the
        # pivots.
        self.assembly.iterates_stresses = False
        again = self._solve(guess, conjugate, before, largest_first)
        if again.state is not None and not again.is_unstable:
            self._has_failed = False
            self._plain_solves, self._back_off = self._back_off, 2 * self._back_off
        elif again.state is None:
            # The other did find a state, one that nothing rests in.
            again = replace(again, unstable_directions=result.unstable_directions)
        return replace(
            again,
            iterations=again.iterations + result.iterations,
            corrections=again.corrections + result.corrections,
        )

    def linearise_at(self, state: State) -> None:
        """Factorise the tangent at a state, for solutions with other right-hand sides.

        Raises ``SingularMatrixError``.
        """
        self._look_around(state)
        self._factorise(state, *self.assembly.linearize(state)[1:], None)

    def with_reaction(self, state: State) -> State:
        """The state with its reaction, if that is wanted; it is near the one linearised last."""
        if self._reaction is None:
            return state
        self._look_around(state)
        return replace(state, reaction=self._reaction(state))

    def _solve(
        self, guess: State, conjugate: float | None, before: State | None, largest_first: float
    ) -> NewtonResult:
        settings = self.settings
        corrections: list[float] = []
        full: list[float] = []
        largest_first = min(largest_first, settings.largest_correction)
        state, linearised = self._first(guess, before)
        if not np.isfinite(linearised[0]):
            return NewtonResult(None, 0, (), "the first guess inverts elements")
        while len(full) < settings.iterations:
            try:
                self._factorise(state, *linearised[1:], conjugate)
            except SingularMatrixError as error:
                return NewtonResult(None, len(full), tuple(corrections), str(error))
            correction, load, falls = self._with_load(state, self._solution, conjugate)
            size = self.largest_displacement(correction)
            full.append(size)
            corrections.append(size)
            largest = settings.largest_correction if len(full) > 1 else largest_first
            if not size < largest or _diverges(full, settings):
                break
            unstable = self._unstable_directions()
            trial = _loaded(self.assembly.advance(state, correction), load)
            trusted = 2 * self.assembly.excess
            settled = _Settled(trial, size < settings.tolerance)
            # Where stability has to be judged, it is at the solution, by factors of its own.
            if unstable <= falls and (not settled.converged or self._refines):
                further = self._settle(trial, trusted, corrections, conjugate)
                settled = replace(further, converged=settled.converged or further.converged)
            if settled.converged:
                found = self.with_reaction(settled.state)
                return NewtonResult(
                    found, len(full), tuple(corrections), "", unstable, unstable > falls
                )
            step = self._admissible_step(settled, trusted, state, correction, load)
            if step is None:
                return NewtonResult(
                    None, len(full), tuple(corrections), "the correction inverts elements"
                )
            state, linearised = step
        reason = "corrections in mm: " + ", ".join(f"{c:.1e}" for c in corrections)
        return NewtonResult(None, len(full), tuple(corrections), reason)

    def largest_displacement(self, correction: FloatArray) -> float:
        """The largest displacement of a correction (size,) of the unknowns, in mm."""
        return float(np.abs(correction[: self.displacements]).max())

    @property
    def _refines(self) -> bool:
        """Whether states are solved for more exactly, for the sake of the reaction.

        Not where something touches: that would take more factorisations.
        """
        return self._reaction is not None and not any(self.assembly.touching)

    def _settle(
        self, state: State, trusted: float, corrections: list[float], conjugate: float | None
    ) -> _Settled:
        """Correct with the same factors as long as that works; adds to the ``corrections``.

        A tangent far too stiff, that of a contact which has opened, makes corrections small too,
        but not ever smaller: where other points touch than did, it takes two of them to tell.
        """
        touching = self.assembly.touching
        share = _SHARE_FOR_REACTION if self._refines else _SHARE
        for count in range(self.settings.reuses):
            energy, residual = self.assembly.residual_near(state)
            if not np.isfinite(energy) or self.assembly.excess > trusted:
                return _Settled(state, converged=False, refused=count == 0)
            if not self.assembly.is_complete:
                break
            is_alike = self.assembly.touching == touching
            solution = self.assembly.full(self.solver.solve_again(-residual[self.assembly.free]))
            correction, load, _ = self._with_load(state, solution, conjugate)
            size = self.largest_displacement(correction)
            if not size <= self.settings.contraction * corrections[-1]:
                break
            state = _loaded(self.assembly.advance(state, correction), load)
            corrections.append(size)
            if (is_alike or count > 0) and size < share * self.settings.tolerance:
                return _Settled(state, converged=True)
        return _Settled(state, converged=False)

    def _first(self, guess: State, before: State | None) -> tuple[State, Linearised]:
        """The guess, linearised, or what is left of it."""
        state = guess
        for _ in range(self.settings.shortenings):
            self.assembly.settle(state.unknowns)
            self._look_around(state)
            if before is not None and self.assembly.excess_near > 0:
                # To know that, no tangent is needed.
                state = _half_way(before, state)
                continue
            linearised = self.assembly.linearize(state)
            if before is None or (np.isfinite(linearised[0]) and self.assembly.excess == 0):
                return state, linearised
            state = _half_way(before, state)
        self.assembly.settle(state.unknowns)
        self._look_around(state)
        return state, self.assembly.linearize(state)

    def _look_around(self, state: State) -> None:
        self.assembly.look_around(state)
        if self.assembly.pattern is not self._pattern:
            # Not to have the old factors beside new tangents.
            self.solver.free()

    def _factorise(
        self, state: State, residual: FloatArray, values: FloatArray, conjugate: float | None
    ) -> None:
        """Solve K x = −r, and K w = b if the conjugate is held; solutions (size,) are kept."""
        if self.assembly.pattern is not self._pattern:
            self._analyse()
        free = self.assembly.free
        self._solution = self.assembly.full(self.solver.solve(values, -residual[free]))
        if conjugate is not None:
            slopes = self._conjugate(state)[1]
            self._by_load = self.assembly.full(self.solver.solve_again(slopes[free]))

    def _with_load(
        self, state: State, solution: FloatArray, conjugate: float | None
    ) -> tuple[FloatArray, float, bool]:
        """The correction (size,) and that of the load, from the solution x of K x = −r.

        And whether the load falls with its conjugate, if that is held.
        """
        if conjugate is None:
            return solution, 0.0, False
        value, slopes = self._conjugate(state)
        growth = float(slopes @ self._by_load)
        load = (conjugate - value - float(slopes @ solution)) / growth
        return solution + load * self._by_load, load, growth < 0

    def _conjugate(self, state: State) -> tuple[float, FloatArray]:
        if self.load_term is None:
            raise ValueError("to hold the conjugate of the load, Newton's method needs its term")
        value, slopes = self.load_term.conjugate(state.unknowns)
        return value, self.assembly.reduced(slopes, state.unknowns)

    def _unstable_directions(self) -> int:
        """Directions in which the energy falls from the state of the last correction."""
        negative = self.solver.negative_pivots
        return 0 if negative is None else negative - self._multipliers

    def _admissible_step(
        self, settled: _Settled, trusted: float, state: State, correction: FloatArray, load: float
    ) -> tuple[State, Linearised] | None:
        """The corrected state, linearised; part of the correction where all of it goes too far."""
        trial, fraction = settled.state, 1.0
        if not settled.refused:
            linearised = self.assembly.linearize(trial)
            if np.isfinite(linearised[0]) and self.assembly.excess <= trusted:
                return trial, linearised
        # advance() starts from the state linearised last: go back to it. What it gives is linear
        # in the correction.
        self.assembly.linearize(state)
        none = self.assembly.advance(state, 0.0 * correction)
        whole = _loaded(self.assembly.advance(state, correction), load)
        while fraction / 2 >= self.settings.smallest_fraction:
            fraction /= 2
            trial = _between(none, whole, fraction)
            self.assembly.settle(trial.unknowns)
            last = fraction < 2 * self.settings.smallest_fraction
            energy, _ = self.assembly.residual_near(trial)
            if not np.isfinite(energy) or (self.assembly.excess > trusted and not last):
                continue
            linearised = self.assembly.linearize(trial)
            if np.isfinite(linearised[0]):
                return trial, linearised
        return None


def _between(first: State, second: State, share: float) -> State:
    """The state that is a share of the way from one to another."""

    def mixed(a: FloatArray, b: FloatArray) -> FloatArray:
        return a + share * (b - a)

    internal = tuple(map(mixed, first.internal, second.internal))
    load = first.load + share * (second.load - first.load)
    return State(load, mixed(first.unknowns, second.unknowns), internal)


def _half_way(before: State, guess: State) -> State:
    """Half-way back from a guess, at its load."""
    return replace(_between(before, guess, 0.5), load=guess.load)


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
