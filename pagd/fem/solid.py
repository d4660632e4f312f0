"""The elastomer: quadratic tetrahedra with a volumetric pressure of their own.

Two elements stand behind one interface:

* :class:`TaylorHoodSolid` (P2–P1, the default): the pressure is continuous and
  linear, one global unknown per corner node. Stable for nearly incompressible
  solids; converges from the stiff side.
* :class:`ElementPressureSolid` (P2–P0): one pressure per element, condensed.
  Behaves as Abaqus's C3D10H, to compare with results obtained there.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.fem import shapes, solid_kernels
from pagd.fem.quadrature import tetrahedron
from pagd.fem.term import NO_INTERNAL, ElementSystem, node_dofs
from pagd.materials import Elastomer

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Solid(Protocol):
    """What both elements offer beside the interface of an energy term."""

    name: str
    nodes: IntArray
    gradients: FloatArray
    weights: FloatArray


def reference_geometry(points: FloatArray, nodes: IntArray) -> tuple[FloatArray, FloatArray]:
    """Gradients (E, Q, 10, 3) in 1/mm and weights (E, Q) in mm³ at the quadrature points.

    Isoparametric, so that curved elements are right too. Raises ``InputError`` where
    an element is inverted.
    """
    rule = tetrahedron()
    derivatives = shapes.tetrahedron_derivatives(rule.points)
    jacobians = np.einsum("eai,qaj->eqij", points[nodes], derivatives, optimize=True)
    determinants = np.linalg.det(jacobians)
    if not determinants.min() > 0:
        raise InputError(f"the mesh has {(determinants <= 0).any(1).sum()} inverted tetrahedra")
    inverses = np.linalg.inv(jacobians)
    gradients = np.einsum("qaj,eqji->eqai", derivatives, inverses, optimize=True)
    return np.ascontiguousarray(gradients), determinants * rule.weights / 6


class TaylorHoodSolid:
    """P2–P1: W(F̄) + p (J − 1) − p²/2K with p continuous and linear.

    Parameters
    ----------
    points, nodes
        Coordinates (n, 3) in mm and ten-node tetrahedra (E, 10).
    material
        The elastomer.
    first_pressure
        Number of the first pressure unknown; there are :attr:`pressures` of them.
    """

    name = "solid"

    def __init__(
        self, points: FloatArray, nodes: IntArray, material: Elastomer, first_pressure: int
    ) -> None:
        self.nodes = nodes
        self.material = material
        self.gradients, self.weights = reference_geometry(points, nodes)
        self.corners, numbers = np.unique(nodes[:, :4], return_inverse=True)
        self._pressure_dofs = np.ascontiguousarray(first_pressure + numbers.reshape(-1, 4))
        self._corner_values = np.ascontiguousarray(tetrahedron().points)
        self.dofs = np.hstack([node_dofs(nodes), self._pressure_dofs])

    @property
    def pressures(self) -> int:
        """How many pressure unknowns there are: one per corner node."""
        return len(self.corners)

    def internal_at_rest(self) -> FloatArray:
        """There are none."""
        return NO_INTERNAL

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        return solid_kernels.taylor_hood(
            unknowns,
            self.nodes,
            self._pressure_dofs,
            self.gradients,
            self.weights,
            self._corner_values,
            self.material.kind,
            self.material.parameters,
            self.material.bulk_modulus,
            system.residual,
            system.tangent,
        )

    def advance(self, correction: FloatArray) -> FloatArray:
        """Nothing to advance."""
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Stored elastic energy W(F̄) + p (J − 1) − p²/2K, in mJ."""
        isochoric, change = _energies(self, unknowns, self.material)
        pressure = unknowns[self._pressure_dofs] @ self._corner_values.T
        volumetric = pressure * (change - 0.5 * pressure / self.material.bulk_modulus)
        return float(isochoric.sum() + (self.weights * volumetric).sum())


class ElementPressureSolid:
    """P2–P0: one pressure per element, iterated beside the displacements and condensed."""

    name = "solid"

    def __init__(self, points: FloatArray, nodes: IntArray, material: Elastomer) -> None:
        self.nodes = nodes
        self.material = material
        self.gradients, self.weights = reference_geometry(points, nodes)
        self.dofs = node_dofs(nodes)
        self._volumes = self.weights.sum(axis=1)
        self._slopes = np.zeros((len(nodes), 30))
        self._changes = np.zeros(len(nodes))

    def internal_at_rest(self) -> FloatArray:
        """Element pressures (E,), zero at rest."""
        return np.zeros(len(self.nodes))

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        return solid_kernels.element_pressure(
            unknowns,
            self.nodes,
            internal,
            self.gradients,
            self.weights,
            self.material.kind,
            self.material.parameters,
            self.material.bulk_modulus,
            system.residual,
            system.tangent,
            self._slopes,
            self._changes,
        )

    def advance(self, correction: FloatArray) -> FloatArray:
        """The pressures of the linearised volume constraint, K/V (∫(J−1) dV + b·Δu)."""
        step = np.einsum("ei,ei->e", self._slopes, correction[self.dofs])
        return np.asarray(self.material.bulk_modulus / self._volumes * (self._changes + step))

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Stored elastic energy W(F̄) + K/2V (∫(J−1) dV)², in mJ."""
        isochoric, change = _energies(self, unknowns, self.material)
        mean = (self.weights * change).sum(axis=1)
        volumetric = 0.5 * self.material.bulk_modulus / self._volumes * mean**2
        return float(isochoric.sum() + volumetric.sum())


def _energies(
    solid: Solid, unknowns: FloatArray, material: Elastomer
) -> tuple[FloatArray, FloatArray]:
    """Isochoric energies (E,) in mJ and J − 1 (E, Q)."""
    isochoric = np.empty(len(solid.nodes))
    change = np.empty(solid.weights.shape)
    solid_kernels.energies(
        unknowns,
        solid.nodes,
        solid.gradients,
        solid.weights,
        material.kind,
        material.parameters,
        isochoric,
        change,
    )
    return isochoric, change


def principal_stretches(solid: Solid, unknowns: FloatArray, threshold: float = 0.0) -> FloatArray:
    """Largest principal stretch (E, Q) at the quadrature points.

    Where it is certainly below ``threshold`` it may be given as 0, which is quicker.
    """
    result = np.empty(solid.weights.shape)
    solid_kernels.largest_stretches(unknowns, solid.nodes, solid.gradients, threshold, result)
    return result
