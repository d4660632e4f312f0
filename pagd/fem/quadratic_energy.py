"""A term that is quadratic in the displacements, the same for each component."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.term import NO_INTERNAL, ElementSystem, node_dofs

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class QuadraticEnergy:
    """½ Σ_i u_iᵀ K u_i over elements, i the components x, y, z.

    Parameters
    ----------
    name
        Name of the term.
    nodes
        Node numbers (E, k), all different within an element.
    matrices
        Symmetric matrices (E, k, k), the same for every component.
    components
        The components that take part.
    coupled
        Whether one element has all components of its nodes, as nodes that are tied need it;
        else each component has small elements of its own.
    """

    def __init__(
        self,
        name: str,
        nodes: IntArray,
        matrices: FloatArray,
        components: tuple[int, ...] = (0, 1, 2),
        coupled: bool = False,
    ) -> None:
        self.name = name
        if coupled:
            taking_part = np.diag(np.isin(np.arange(3), components).astype(np.float64))
            self.dofs = node_dofs(nodes)
            self._matrices = np.kron(matrices, taking_part)
        else:
            self.dofs = np.concatenate([3 * nodes + i for i in components])
            self._matrices = np.concatenate([matrices] * len(components))
        rows, columns = np.triu_indices(self._matrices.shape[1])
        self._packed = self._matrices[:, rows, columns]

    def internal_at_rest(self) -> FloatArray:
        """There are none."""
        return NO_INTERNAL

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        local = unknowns[self.dofs]
        system.residual[:] = np.einsum("eij,ej->ei", self._matrices, local, optimize=True)
        system.tangent[:] = self._packed
        return float(0.5 * (local * system.residual).sum())

    def advance(self, correction: FloatArray) -> FloatArray:
        """Nothing to advance."""
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Stored energy, in mJ."""
        local = unknowns[self.dofs]
        return float(0.5 * np.einsum("ei,eij,ej->", local, self._matrices, local, optimize=True))
