"""A sum of energy terms of which some nodes are tied to others by a screw motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State, add_matrix
from pagd.fem.pattern import Pattern, build_pattern
from pagd.fem.screw import ScrewMotion, ScrewTie
from pagd.fem.term import EnergyTerm, LaggingTerm
from pagd.fem.tied_kernels import transformed

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

__all__ = ["TiedAssembly"]

# Where the packed upper triangle of a symmetric 6 × 6 matrix is.
_ROWS, _COLUMNS = np.triu_indices(6)


@dataclass(frozen=True, eq=False, slots=True)
class _Tied:
    """Elements (k,) of a term that see slaves; their unknowns (k, n + 6) and arms (k, n)."""

    elements: IntArray
    dofs: IntArray
    arms: IntArray
    tangent: FloatArray


class TiedAssembly(Assembly):
    """A body as a sum of terms, with some unknowns held and some tied.

    The unknowns of the slaves are among all unknowns, where every term finds them, but not free.
    A term that sees slaves must see all three components of its nodes in each element, on end.

    Parameters
    ----------
    terms
        The energy terms.
    size
        Number of unknowns, the rows of the motion and the slaves included.
    fixed
        Which unknowns (size,) are held; the slaves need not be among them.
    tie
        What ties which nodes.
    """

    def __init__(
        self, terms: Sequence[EnergyTerm], size: int, fixed: BoolArray, tie: ScrewTie
    ) -> None:
        self.tie = tie
        #: A moment (3,) in N mm on the motion, fixed in space, and not among the energies.
        self.moment = np.zeros(3)
        slaves = (3 * tie.slaves[:, None] + np.arange(3)).ravel()
        #: The number of the tie and the component that an unknown is of; −1 where it is not tied.
        self._arms = np.full(size, -1, np.int64)
        self._arms[slaves] = np.arange(len(slaves))
        self._follows = np.arange(size)
        self._follows[slaves] = (3 * tie.masters[:, None] + np.arange(3)).ravel()
        self._motion_dofs = 3 * tie.motion + np.arange(6)
        self._motion: ScrewMotion | None = None
        held = fixed.copy()
        held[slaves] = True
        super().__init__(terms, size, held)
        # Masters that are held belong to what is beyond an end.
        self.is_ring = not fixed.reshape(-1, 3)[tie.masters].all()

    def _build_pattern(self) -> Pattern:
        """The pattern of what is free; tied elements have maps of their own behind the others."""
        self._tied = [self._tied_of(term.dofs) for term in self.terms]
        turning = np.hstack(
            [
                3 * self.tie.masters[:, None] + np.arange(3),
                np.tile(self._motion_dofs[:3], (len(self.tie.masters), 1)),
            ]
        )
        # Slaves are not free, so that what an element has of its own finds no place.
        others = [self._without_tied(t.dofs, k.elements) for t, k in self._pairs()]
        tied = [k.dofs for k in self._tied]
        found = build_pattern([*others, *tied, turning], self._numbering)
        maps = list(found.maps)
        for (term, part), k in zip(self._pairs(), range(len(self.terms)), strict=True):
            positions = np.full(
                (len(term.dofs), maps[k].shape[1]), found.entries, dtype=maps[k].dtype
            )
            positions[np.setdiff1d(np.arange(len(term.dofs)), part.elements)] = maps[k]
            maps[k] = positions
        return replace(found, maps=tuple(maps))

    def _pairs(self) -> list[tuple[EnergyTerm, _Tied]]:
        return list(zip(self.terms, self._tied, strict=True))

    def _without_tied(self, dofs: IntArray, elements: IntArray) -> IntArray:
        return np.delete(dofs, elements, axis=0)

    def _tied_of(self, dofs: IntArray) -> _Tied:
        elements = np.flatnonzero((self._arms[dofs] >= 0).any(axis=1))
        motion = np.tile(self._motion_dofs, (len(elements), 1))
        reduced = np.hstack([self._follows[dofs[elements]], motion])
        own = dofs[elements]
        followed = np.where(self._arms[own] >= 0, self._follows[own], -1)
        if (followed[:, :, None] == own[:, None, :]).any():
            raise ValueError("an element sees a tied node and the one that it follows")
        size = reduced.shape[1]
        return _Tied(
            elements,
            reduced,
            np.ascontiguousarray(self._arms[dofs[elements]]),
            np.zeros((len(elements), size * (size + 1) // 2)),
        )

    def settle(self, unknowns: FloatArray) -> None:
        """Put the slaves where their masters and the motion have them."""
        self.tie.settle(unknowns)

    def full(self, solution: FloatArray) -> FloatArray:
        """All unknowns (size,) of a solution at the state linearised last, slaves included.

        What the motion has is a rotation in space, to be composed with that of the state.
        """
        result = super().full(solution)
        self.tie.complete(self._at_last(), result)
        return result

    def reduced(self, gradient: FloatArray, unknowns: FloatArray) -> FloatArray:
        """A gradient (size,) by what is not tied, at ``unknowns``."""
        result = gradient.copy()
        self.tie.reduce(self.tie.motion_at(unknowns), result)
        return result

    def advance(self, state: State, correction: FloatArray) -> State:
        """The state after ``correction`` (size,), which :meth:`full` has made."""
        advanced = super().advance(state, correction)
        return replace(advanced, unknowns=self.tie.compose(state.unknowns, correction))

    def _at_last(self) -> ScrewMotion:
        if self._motion is None:
            raise ValueError("a correction has to follow a linearisation")
        return self._motion

    def _residual_near(self, state: State) -> tuple[float, FloatArray]:
        energy, residual = super()._residual_near(state)
        self._motion = self.tie.motion_at(state.unknowns)
        self.tie.reduce(self._motion, residual)
        residual[self._motion_dofs[:3]] -= self.moment
        return energy, residual

    def _reduce_system(self, state: State, residual: FloatArray) -> None:
        motion = self._motion = self.tie.motion_at(state.unknowns)
        forces = residual[: 3 * self.tie.points].reshape(-1, 3) - self._lagging(state)
        turning = self.tie.turning(motion, forces[self.tie.slaves])[:, _ROWS, _COLUMNS]
        *maps, turning_map = self.pattern.maps[len(self.terms) :]
        add_matrix(turning_map, turning, self._values)
        for system, tied, positions in zip(self._systems, self._tied, maps, strict=True):
            if len(tied.elements):
                transformed(
                    system.tangent,
                    tied.elements,
                    tied.arms,
                    motion.arms,
                    motion.rotation,
                    tied.tangent,
                )
                add_matrix(positions, tied.tangent, self._values)
        self.tie.reduce(motion, residual)
        residual[self._motion_dofs[:3]] -= self.moment

    def _lagging(self, state: State) -> FloatArray:
        """What the residual (n, 3) at the slaves has from internal variables that lag behind."""
        result = np.zeros(self.size)
        for (term, tied), internal in zip(self._pairs(), state.internal, strict=True):
            if isinstance(term, LaggingTerm) and len(tied.elements):
                found = term.lagging(internal, tied.elements)
                np.add.at(result, term.dofs[tied.elements], found)
        return result[: 3 * self.tie.points].reshape(-1, 3)
