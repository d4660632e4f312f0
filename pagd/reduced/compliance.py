"""How a cell answers a moment beside the pressure.

A moment on the right cut turns and moves it against the left one. By how much is known from the
tangents of two states: the one without a moment, and one with a moment m* as large as the row has
to bear when its tip is held. Between them the compliance is linear in the moment:

    C(m) = C₀ + s (C₁ − C₀),   s = m · m* / m* · m*,

and the answer to m is its integral, (C₀ + ½ s (C₁ − C₀)) m. Cells that are alike hand a moment on
to each other; the small part that turns with them the pins of the left cut take.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.linear_solver import LinearSolver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.fem.tied_assembly import TiedAssembly
from pagd.reduced.segment import Segment

FloatArray = NDArray[np.float64]

__all__ = ["Answers", "Compliance", "Loaded"]

_SETTINGS = NewtonSettings(
    tolerance=1e-3, iterations=14, growth=2.0, contraction=0.55, reuses=8, largest_correction=10.0
)


@dataclass(frozen=True, eq=False, slots=True)
class Compliance:
    """Rotation and displacement of the right cut by a moment on it, at one pressure.

    without, loaded: (6, 3) of the state without a moment and of that with ``moment`` (3,), in N mm:
    rows 0 to 2 in 1/(N mm), of the rotation in space, rows 3 to 5 in 1/N, of the image of the
    tie's centre.
    """

    without: FloatArray
    loaded: FloatArray
    moment: FloatArray

    @classmethod
    def constant(cls, without: FloatArray) -> Compliance:
        """The compliance (6, 3) whatever the moment."""
        return cls(without, without, np.zeros(3))

    def changed_as(self, other: Compliance) -> Compliance:
        """The same without a moment, changed by one as the ``other`` is."""
        return Compliance(self.without, self.without + other.loaded - other.without, other.moment)

    def answers(self, moments: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rotation vectors and displacements (k, 3) by moments (k, 3)."""
        square = float(self.moment @ self.moment)
        share = moments @ self.moment / square if square else np.zeros(len(moments))
        further = 0.5 * share[:, None] * (moments @ (self.loaded - self.without).T)
        found = moments @ self.without.T + further
        return found[:, :3], found[:, 3:]


class Answers:
    """The compliances of a segment whose right cut is tied.

    Parameters
    ----------
    segment
        The segment.
    assembly
        The segment's terms, tied.
    solver
        The linear solver; what it knows of the assembly's pattern is used.
    """

    def __init__(self, segment: Segment, assembly: Assembly, solver: LinearSolver) -> None:
        if not isinstance(assembly, TiedAssembly):
            raise TypeError("only a cut that is tied can be loaded")
        self._segment, self._assembly, self._solver = segment, assembly, solver
        self._newton = Newton(assembly, self._solver, 3 * segment.nodes, _SETTINGS)

    def at(self, state: State) -> FloatArray:
        """The compliance (6, 3) of a state, and of what acts on it; its factors are kept.

        Raises
        ------
        SingularMatrixError
            Where the tangent is singular.
        """
        assembly, rows = self._assembly, self._rows
        self._newton.linearise_at(state)
        result = np.zeros((6, 3))
        for column in range(3):
            load = np.zeros(assembly.size)
            # Of a half model the other half bears as much.
            load[rows[0] + column] = 1.0 / self._segment.copies
            found = assembly.full(self._solver.solve_again(load[assembly.free]))
            result[:, column] = found[rows[0] : rows[0] + 6]
        return result

    def under(self, state: State, moment: FloatArray) -> FloatArray | None:
        """The compliance (6, 3) of the state that a moment (3,) makes of one without; or none.

        To be asked after :meth:`at` that state.
        """
        assembly, rows = self._assembly, self._rows
        load = np.zeros(assembly.size)
        load[rows[0] : rows[0] + 3] = moment / self._segment.copies
        step = assembly.full(self._solver.solve_again(load[assembly.free]))
        assembly.moment = moment / self._segment.copies
        try:
            result = self._newton.solve(assembly.advance(state, step))
            return None if result.state is None else self.at(result.state)
        finally:
            assembly.moment = np.zeros(3)

    @property
    def _rows(self) -> NDArray[np.int64]:
        return 3 * self._assembly.tie.motion + np.arange(3)


@dataclass(frozen=True, eq=False, slots=True)
class Loaded:
    """Compliances at rising pressures (p,)."""

    pressure_kPa: FloatArray
    known: list[Compliance]

    def at(self, pressure_kPa: float) -> Compliance:
        """The compliance at a pressure: linear between those that are known."""
        count = len(self.known)
        place = float(np.interp(pressure_kPa, self.pressure_kPa, np.arange(count)))
        low = min(int(place), max(count - 2, 0))
        high, share = min(low + 1, count - 1), place - low
        a, b = self.known[low], self.known[high]
        return Compliance(
            (1 - share) * a.without + share * b.without,
            (1 - share) * a.loaded + share * b.loaded,
            (1 - share) * a.moment + share * b.moment,
        )
