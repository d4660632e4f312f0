"""Sum of energy terms: from element systems to one residual and one sparse matrix."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.clock import Clock
from pagd.fem.compiled import compiled
from pagd.fem.pattern import Pattern, build_pattern
from pagd.fem.term import (
    CondensingTerm,
    ElementSystem,
    EnergyTerm,
    SearchingTerm,
    StressedTerm,
    TouchingTerm,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class State:
    """A point of the load path: load factor, all unknowns, internal variables per term.

    ``reaction`` is the force in N on what holds the body; NaN where nothing tells it.
    """

    load: float
    unknowns: FloatArray
    internal: tuple[FloatArray, ...]
    reaction: float = math.nan


@compiled
def _add_vector(dofs: IntArray, local: FloatArray, result: FloatArray) -> None:
    for e in range(dofs.shape[0]):
        for i in range(dofs.shape[1]):
            result[dofs[e, i]] += local[e, i]


@compiled
def add_matrix(positions: NDArray[np.int32], local: FloatArray, result: FloatArray) -> None:
    """Add entries (elements, entries) of elements to those of a matrix at their ``positions``."""
    for e in range(positions.shape[0]):
        for i in range(positions.shape[1]):
            result[positions[e, i]] += local[e, i]


class Assembly:
    """A body as a sum of terms, with some unknowns held.

    Parameters
    ----------
    terms
        The energy terms.
    size
        Number of unknowns: three displacements per node, then whatever terms add.
    fixed
        Which unknowns (size,) are held at the values of the state.
    """

    def __init__(self, terms: Sequence[EnergyTerm], size: int, fixed: BoolArray) -> None:
        self.terms = tuple(terms)
        self.size = size
        #: Whether its ends are tied to each other.
        self.is_ring = False
        self.free = np.flatnonzero(~fixed)
        self._numbering = np.full(size, -1, np.int64)
        self._numbering[self.free] = np.arange(len(self.free))
        self._searching = [t for t in self.terms if isinstance(t, SearchingTerm)]
        self._stressed = [t for t in self.terms if isinstance(t, StressedTerm)]
        self._touching = [t for t in self.terms if isinstance(t, TouchingTerm)]
        #: Where its time goes: ``pattern``, ``assembly`` of tangents, ``residual``, ``update`` of
        #: what is condensed, ``contact search``.
        self.clock = Clock()
        self._make_room()

    def _make_room(self) -> None:
        with self.clock.part("pattern"):
            self.pattern = self._build_pattern()
            self._systems = [ElementSystem.of(t.dofs) for t in self.terms]
        # One more place than there are entries: what concerns held unknowns goes there.
        self._values = np.empty(self.pattern.entries + 1)

    def _build_pattern(self) -> Pattern:
        return build_pattern([t.dofs for t in self.terms], self._numbering)

    @property
    def iterates_stresses(self) -> bool:
        """Whether the geometric part of the tangent has stresses that are iterated."""
        return any(term.iterates_stresses for term in self._stressed)

    @iterates_stresses.setter
    def iterates_stresses(self, wanted: bool) -> None:
        for term in self._stressed:
            term.iterates_stresses = wanted

    def at_rest(self) -> State:
        """The undeformed, unloaded state."""
        return State(0.0, np.zeros(self.size), tuple(t.internal_at_rest() for t in self.terms))

    def settle(self, unknowns: FloatArray) -> None:
        """Set, in place, those of ``unknowns`` (size,) that depend on others; here none do."""

    def full(self, solution: FloatArray) -> FloatArray:
        """All unknowns (size,) of a solution for the free ones; zero where they are held."""
        result = np.zeros(self.size)
        result[self.free] = solution
        return result

    def reduced(self, gradient: FloatArray, unknowns: FloatArray) -> FloatArray:
        """A gradient (size,) at ``unknowns`` by those of them that depend on no others."""
        return gradient

    def look_around(self, state: State) -> None:
        """Let the terms that search see what is near; :attr:`pattern` is a new one if it grew."""
        with self.clock.part("contact search"):
            grown = [term.update(state.unknowns) for term in self._searching]
        if any(grown):
            self._make_room()

    def touches(self, state: State) -> bool:
        """Whether anything touches at a state; looks around at it."""
        self.look_around(state)
        for term in self._touching:
            if not isinstance(term, SearchingTerm):
                term.energy(state.unknowns, state.load)
        return any(self.touching)

    def would_touch(self, unknowns: FloatArray, load: float) -> bool:
        """Whether anything touches at ``unknowns`` (size,); couples nothing that is near there."""
        with self.clock.part("contact search"):
            for term in self._touching:
                if isinstance(term, SearchingTerm):
                    term.look(unknowns)
                else:
                    term.energy(unknowns, load)
        return any(self.touching)

    def linearize(self, state: State) -> tuple[float, FloatArray, FloatArray]:
        """Energy, residual (size,) and matrix values (z,) of the pattern.

        Where the energy is infinite the state is inadmissible and the rest not to be used. The
        pattern may be a new one where something has come near since :meth:`look_around`.
        """
        with self.clock.part("assembly"):
            result = self._linearize(state)
        if np.isfinite(result[0]) and not self.is_complete:
            self.look_around(state)
            with self.clock.part("assembly"):
                return self._linearize(state)
        return result

    def _linearize(self, state: State) -> tuple[float, FloatArray, FloatArray]:
        energy = 0.0
        residual = np.zeros(self.size)
        self._values[:] = 0.0
        maps = self.pattern.maps[: len(self.terms)]
        parts = zip(self.terms, state.internal, self._systems, maps, strict=True)
        for term, internal, system, positions in parts:
            energy += term.linearize(state.unknowns, internal, state.load, system)
            if not np.isfinite(energy):
                return np.inf, residual, self._values[:-1]
            _add_vector(term.dofs, system.residual, residual)
            add_matrix(positions, system.tangent, self._values)
        self._reduce_system(state, residual)
        return energy, residual, self._values[:-1]

    def _reduce_system(self, state: State, residual: FloatArray) -> None:
        """Make residual and tangent those of what depends on nothing else; here they are."""

    def residual_near(self, state: State) -> tuple[float, FloatArray]:
        """Energy and residual (size,) of a state near the one linearised last.

        For a correction with the tangent of that one: internal variables are condensed with its
        slopes. The energy is infinite where the state is inadmissible.
        """
        with self.clock.part("residual"):
            return self._residual_near(state)

    def _residual_near(self, state: State) -> tuple[float, FloatArray]:
        energy, residual = 0.0, np.zeros(self.size)
        parts = zip(self.terms, state.internal, self._systems, strict=True)
        for term, internal, system in parts:
            if isinstance(term, CondensingTerm):
                energy += term.residual_near(state.unknowns, internal, state.load, system.residual)
            else:
                energy += term.linearize(state.unknowns, internal, state.load, system)
            if not np.isfinite(energy):
                return np.inf, residual
            _add_vector(term.dofs, system.residual, residual)
        return energy, residual

    @property
    def is_complete(self) -> bool:
        """Whether the pattern couples all that acts at the state linearised last."""
        return all(term.is_complete for term in self._searching)

    @property
    def excess(self) -> float:
        """How much deeper (mm) than can be trusted any touching is at the state linearised last."""
        return max((term.excess for term in self._touching), default=0.0)

    @property
    def excess_near(self) -> float:
        """The same at the state that was looked around at last; of the terms that search."""
        known = [term for term in self._touching if isinstance(term, SearchingTerm)]
        return max((term.excess for term in known), default=0.0)

    @property
    def touching(self) -> tuple[int, ...]:
        """How many points touch at the state linearised last, by term."""
        return tuple(term.touching for term in self._touching)

    def advance(self, state: State, correction: FloatArray) -> State:
        """The state after ``correction`` (size,) of the unknowns, at the same load.

        To be called after :meth:`linearize` at ``state``.
        """
        with self.clock.part("update"):
            internal = tuple(term.advance(correction) for term in self.terms)
        return State(state.load, state.unknowns + correction, internal)

    def energies(self, state: State) -> dict[str, float]:
        """Energy of each term by name, in mJ; terms of one name are added up."""
        result: dict[str, float] = {}
        for term in self.terms:
            value = term.energy(state.unknowns, state.load)
            result[term.name] = result.get(term.name, 0.0) + value
        return result
