"""What an energy term is: the one interface everything that does work goes through.

The potential of a body is a sum of terms. Each term sees the whole vector of
unknowns through small elements: it yields their energy, their residual (first
derivative) and their tangent (second derivative, symmetric, upper triangle
only). A term may also own *internal variables*, quantities iterated beside the
unknowns and condensed out element by element, such as an element pressure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class ElementSystem:
    """Residuals (elements, size) and packed upper triangles (elements, size (size + 1)/2).

    The triangle is stored row by row: entry (i, j ≥ i) of an element stands at
    i size − i (i − 1)/2 + j − i.
    """

    residual: FloatArray
    tangent: FloatArray

    @classmethod
    def of(cls, dofs: IntArray) -> ElementSystem:
        """Room for the elements whose unknowns are ``dofs`` (elements, size)."""
        count, size = dofs.shape
        return cls(np.zeros((count, size)), np.zeros((count, size * (size + 1) // 2)))


class EnergyTerm(Protocol):
    """One part of the potential."""

    name: str

    @property
    def dofs(self) -> IntArray:
        """Numbers (elements, size) of the unknowns each element sees."""
        ...

    def internal_at_rest(self) -> FloatArray:
        """The internal variables of the undeformed body; an empty array where there are none."""
        ...

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill ``system`` at the given state and return the energy.

        The energy is infinite, and ``system`` not to be used, where the state is
        inadmissible: an inverted element, a law beyond its limit.
        """
        ...

    def advance(self, correction: FloatArray) -> FloatArray:
        """Internal variables after ``correction`` of all unknowns.

        To be called after :meth:`linearize`, whose state the correction starts from.
        """
        ...

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """The energy alone, internal variables taken as consistent with the unknowns."""
        ...


@runtime_checkable
class CondensingTerm(EnergyTerm, Protocol):
    """A term with internal variables that can be corrected with a tangent known already."""

    def residual_near(
        self, unknowns: FloatArray, internal: FloatArray, load: float, residual: FloatArray
    ) -> float:
        """Fill the residual (elements, size) near the state linearised last; the energy.

        The internal variables are condensed with the slopes of that state, so that a correction
        by its tangent, followed by :meth:`advance`, is one of unknowns and internal variables
        together. Condensed with slopes of its own, a stiff internal variable would keep the
        iteration from converging. The energy is infinite where the state is inadmissible.
        """
        ...


@runtime_checkable
class LaggingTerm(EnergyTerm, Protocol):
    """A term whose residual has what its internal variables, iterated, lack of the state's."""

    def lagging(self, internal: FloatArray, elements: IntArray) -> FloatArray:
        """That part of the residual (k, size) of ``elements`` (k,) at the state linearised last.

        The geometric part of the tangent is that of the internal variables, without it.
        """
        ...


@runtime_checkable
class StressedTerm(EnergyTerm, Protocol):
    """A term whose geometric stiffness may be that of stresses which are iterated."""

    iterates_stresses: bool


class LoadTerm(EnergyTerm, Protocol):
    """The term through which the load λ acts: −λ c(u), linear in λ."""

    def conjugate(self, unknowns: FloatArray) -> tuple[float, FloatArray]:
        """The quantity c conjugate to the load, such as a volume, and its gradient (size,)."""
        ...


@runtime_checkable
class SearchingTerm(EnergyTerm, Protocol):
    """A term that couples what happens to be near: its ``dofs`` grow along the path."""

    @property
    def is_complete(self) -> bool:
        """Whether all that acts at the state linearised last is coupled in ``dofs``."""
        ...

    def update(self, unknowns: FloatArray) -> bool:
        """Look around at a state; whether ``dofs`` has grown."""
        ...

    def look(self, unknowns: FloatArray) -> None:
        """Look around at a state that is not to be assembled: ``dofs`` stays as it is."""
        ...


@runtime_checkable
class TouchingTerm(EnergyTerm, Protocol):
    """A term that begins to act where something touches, far stiffer than the rest."""

    @property
    def excess(self) -> float:
        """How much deeper (mm) than can be trusted the touching is at the state linearised last."""
        ...

    @property
    def touching(self) -> int:
        """How many points touch at the state linearised last."""
        ...


def node_dofs(nodes: IntArray) -> IntArray:
    """Numbers (elements, 3·nodes) of the displacements of nodes (elements, nodes), x y z apiece."""
    return np.asarray((nodes[:, :, None] * 3 + np.arange(3)).reshape(len(nodes), -1))


NO_INTERNAL: FloatArray = np.zeros(0)
