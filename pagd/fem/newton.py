"""Newton's method at a fixed load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.linear_solver import LinearSolver, SingularMatrixError

FloatArray = NDArray[np.float64]


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
        A correction is halved while it leads to an inadmissible state, down to this.
    """

    tolerance: float = 1e-2
    iterations: int = 8
    largest_correction: float = 50.0
    smallest_fraction: float = 1 / 16


@dataclass(frozen=True, slots=True)
class NewtonResult:
    """A converged state, or none and the reason; the number of systems solved."""

    state: State | None
    iterations: int
    corrections: tuple[float, ...]
    reason: str = ""


class Newton:
    """Newton's method for one assembly; keeps the linear solver's analysis.

    Parameters
    ----------
    assembly
        The body.
    solver
        The linear solver.
    displacements
        The first so many unknowns are displacements, in mm; the tolerance is theirs.
    settings
        Tolerance and limits.
    """

    def __init__(
        self,
        assembly: Assembly,
        solver: LinearSolver,
        displacements: int,
        settings: NewtonSettings | None = None,
    ) -> None:
        self.assembly = assembly
        self.solver = solver
        self.settings = settings or NewtonSettings()
        self._displacements = displacements
        solver.analyse(assembly.pattern.starts, assembly.pattern.columns)

    def solve(self, guess: State) -> NewtonResult:
        """Iterate from ``guess``; failing to converge is a result, not an error."""
        settings = self.settings
        corrections: list[float] = []
        state = guess
        energy, residual, values = self.assembly.linearize(state)
        if not np.isfinite(energy):
            return NewtonResult(None, 0, (), "the first guess inverts elements")
        while len(corrections) < settings.iterations:
            try:
                correction = self._correction(residual, values)
            except SingularMatrixError as error:
                return NewtonResult(None, len(corrections), tuple(corrections), str(error))
            size = float(np.abs(correction[: self._displacements]).max())
            corrections.append(size)
            if not size < settings.largest_correction or _diverges(corrections, settings):
                break
            if size < settings.tolerance:
                final = self.assembly.advance(state, correction)
                return NewtonResult(final, len(corrections), tuple(corrections))
            step = self._admissible_step(state, correction)
            if step is None:
                return NewtonResult(
                    None, len(corrections), tuple(corrections), "the correction inverts elements"
                )
            state, residual, values = step
        reason = "corrections in mm: " + ", ".join(f"{c:.1e}" for c in corrections)
        return NewtonResult(None, len(corrections), tuple(corrections), reason)

    def _correction(self, residual: FloatArray, values: FloatArray) -> FloatArray:
        """The Newton correction (size,), zero for held unknowns."""
        free = self.assembly.free
        correction = np.zeros(self.assembly.size)
        correction[free] = self.solver.solve(values, -residual[free])
        return correction

    def _admissible_step(
        self, state: State, correction: FloatArray
    ) -> tuple[State, FloatArray, FloatArray] | None:
        """The corrected state, linearised; a part of the correction where all of it inverts."""
        fraction = 1.0
        while fraction >= self.settings.smallest_fraction:
            if fraction < 1.0:
                # advance() starts from the state linearised last: go back to it.
                self.assembly.linearize(state)
            trial = self.assembly.advance(state, fraction * correction)
            energy, residual, values = self.assembly.linearize(trial)
            if np.isfinite(energy):
                return trial, residual, values
            fraction /= 2
        return None


def _diverges(corrections: Sequence[float], settings: NewtonSettings) -> bool:
    """Whether the corrections grow again after the second, which may exceed the first."""
    grows = len(corrections) > 2 and corrections[-1] > corrections[-2]
    return grows and corrections[-1] > 10 * settings.tolerance
