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
from pagd.reduced.cell import Cell
from pagd.rigid import small_rotation

FloatArray = NDArray[np.float64]

__all__ = ["Answers", "Compliance", "Loaded"]

# The tangent that is wanted is that of the last iteration, so each has its own; between it and the
# solution are 5 µm at most, where moments as those of a held row move nodes by a tenth of a mm.
_SETTINGS = NewtonSettings(
    tolerance=5e-3, iterations=14, growth=2.0, reuses=0, largest_correction=10.0
)


@dataclass(frozen=True, eq=False, slots=True)
class Compliance:
    """Rotation and displacement of the right cut by a moment on it, at one pressure.

    without, loaded: (9, 3) of the state without a moment and of that with ``moment`` (3,), in N mm:
    rows 0 to 2 in 1/(N mm), of the rotation in space, rows 3 to 5 in 1/N, of the image of the
    tie's centre, rows 6 to 8 in 1/(N mm), of the rotation of the chamber's base from wall to wall,
    which is known of whole models only.
    """

    without: FloatArray
    loaded: FloatArray
    moment: FloatArray

    @classmethod
    def constant(cls, without: FloatArray) -> Compliance:
        """The compliance (9, 3) whatever the moment."""
        return cls(without, without, np.zeros(3))

    def changed_as(self, other: Compliance) -> Compliance:
        """The same without a moment, changed by one as the ``other`` is."""
        return Compliance(self.without, self.without + other.loaded - other.without, other.moment)

    def of_half_a_chamber(self) -> Compliance:
        """That of half of the chamber's base alone, which turns at one place."""

        def halved(whole: FloatArray) -> FloatArray:
            result = np.zeros_like(whole)
            result[:3] = 0.5 * whole[6:]
            return result

        return Compliance(halved(self.without), halved(self.loaded), self.moment)


class Answers:
    """The compliances of a cell.

    Parameters
    ----------
    cell
        The cell.
    assembly
        The cell's terms, tied.
    solver
        The linear solver; what it knows of the assembly's pattern is used.
    """

    def __init__(self, cell: Cell, assembly: Assembly, solver: LinearSolver) -> None:
        if not isinstance(assembly, TiedAssembly):
            raise TypeError("only a cut that is tied can be loaded")
        self._cell, self._assembly, self._solver = cell, assembly, solver
        self._newton = Newton(assembly, self._solver, 3 * cell.nodes, _SETTINGS)

    def at(self, state: State) -> FloatArray:
        """The compliance (9, 3) of a state, and of what acts on it; its factors are kept.

        Raises
        ------
        SingularMatrixError
            Where the tangent is singular.
        """
        self._newton.linearise_at(state)
        return self._by_last_factors(state)

    def _by_last_factors(self, state: State) -> FloatArray:
        """The compliance (9, 3) of a state by the factors there are, of one near it."""
        assembly, rows = self._assembly, self._rows
        result = np.zeros((9, 3))
        for column in range(3):
            load = np.zeros(assembly.size)
            # Of a half model the other half bears as much.
            load[rows[0] + column] = 1.0 / self._cell.copies
            found = assembly.full(self._solver.solve_again(load[assembly.free]))
            result[:6, column] = found[rows[0] : rows[0] + 6]
            if self._cell.copies == 1:
                result[6:, column] = self._turn(state, found, self._cell.cell.length)
                result[6:, column] -= self._turn(state, found, 0.0)
        return result

    def under(self, state: State, moment: FloatArray) -> FloatArray | None:
        """The compliance (9, 3) of the state that a moment (3,) makes of one without; or none.

        To be asked after :meth:`at` that state.
        """
        assembly, rows = self._assembly, self._rows
        load = np.zeros(assembly.size)
        load[rows[0] : rows[0] + 3] = moment / self._cell.copies
        step = assembly.full(self._solver.solve_again(load[assembly.free]))
        assembly.moment = moment / self._cell.copies
        try:
            result = self._newton.solve(assembly.advance(state, step))
            return None if result.state is None else self._by_last_factors(result.state)
        finally:
            assembly.moment = np.zeros(3)

    def _turn(self, state: State, change: FloatArray, plane: float) -> FloatArray:
        """The rotation vector (3,) of the base at a plane by a ``change`` (size,) of a state."""
        # Up to the chamber's floor: beside the channel the walls bend by themselves.
        nodes = self._cell.cell.base_at(plane, 0.0)
        places = self._cell.points[nodes] + state.unknowns.reshape(-1, 3)[nodes]
        return small_rotation(places, change.reshape(-1, 3)[nodes])

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
