"""The elastomer: quadratic cells with a volumetric pressure of their own.

Two elements stand behind one interface:

* :class:`TaylorHoodSolid` (P2–P1, tetrahedra only): the pressure is continuous and
  linear, one global unknown per corner node. Stable for nearly incompressible
  solids; converges from the stiff side.
* :class:`ElementPressureSolid`: pressures of each element alone, condensed. On hexahedra and
  wedges linear (Q2–P−1), stable too; on tetrahedra constant (P2–P0), which behaves as Abaqus's
  C3D10H, to compare with results obtained there.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pagd.fem import field_kernels
from pagd.fem.cells import cell_of, reference_geometry
from pagd.fem.condensed_kernels import condensed_pressures, residuals_near
from pagd.fem.quadrature import tetrahedron
from pagd.fem.stress_kernels import advance_stresses
from pagd.fem.taylor_hood_kernels import taylor_hood
from pagd.fem.term import ElementSystem, node_dofs
from pagd.materials import Elastomer

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Solid(Protocol):
    """What both elements offer beside the interface of an energy term."""

    name: str
    nodes: IntArray
    gradients: FloatArray
    weights: FloatArray
    material: Elastomer


class IteratedStresses:
    """The stresses S* of a solid's geometric part; see :mod:`pagd.fem.stress_kernels`."""

    def __init__(self, solid: Solid) -> None:
        self._solid = solid
        self._unknowns = np.zeros(0)

    def at_rest(self) -> FloatArray:
        """Stresses (E, 6 Q) of the body without load."""
        elements, points = self._solid.weights.shape
        return np.zeros((elements, 6 * points))

    def look(self, unknowns: FloatArray) -> None:
        """Take the state that corrections start from."""
        self._unknowns = unknowns.copy()

    def advanced(self, correction: FloatArray) -> FloatArray:
        """The linearised stresses (E, 6 Q) after a correction."""
        solid, result = self._solid, np.empty((*self._solid.weights.shape, 6))
        advance_stresses(
            self._unknowns,
            correction,
            solid.nodes,
            solid.gradients,
            solid.material.kind,
            solid.material.parameters,
            result,
        )
        return result.reshape(len(result), -1)


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
    iterates_stresses = True

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
        self._stresses = IteratedStresses(self)

    @property
    def pressures(self) -> int:
        """How many pressure unknowns there are: one per corner node."""
        return len(self.corners)

    def internal_at_rest(self) -> FloatArray:
        """Stresses S* of the geometric part (E, 6 Q), zero at rest."""
        return self._stresses.at_rest()

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        self._stresses.look(unknowns)
        return taylor_hood(
            unknowns,
            self.nodes,
            internal.reshape(*self.weights.shape, 6),
            self.iterates_stresses,
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
        """The linearised stresses."""
        return self._stresses.advanced(correction)

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Stored elastic energy W(F̄) + p (J − 1) − p²/2K, in mJ."""
        isochoric, change = _energies(self, unknowns, self.material)
        pressure = unknowns[self._pressure_dofs] @ self._corner_values.T
        volumetric = pressure * (change - 0.5 * pressure / self.material.bulk_modulus)
        return float(isochoric.sum() + (self.weights * volumetric).sum())


class ElementPressureSolid:
    """Pressures of each element alone, iterated beside the displacements and condensed.

    One pressure for a tetrahedron (P2–P0); four for a hexahedron of 27 nodes or a wedge of 18,
    linear in the coordinates (Q2–P−1; Sussman and Bathe, *Comput. Struct.* 26 (1987) 357, 27/4).

    Parameters
    ----------
    points, nodes
        Coordinates (n, 3) in mm and cells (E, 10, 18 or 27) as :mod:`pagd.fem.shapes` has them.
    material
        The elastomer.
    """

    name = "solid"
    iterates_stresses = True

    def __init__(self, points: FloatArray, nodes: IntArray, material: Elastomer) -> None:
        self.nodes = nodes
        self.material = material
        self.gradients, self.weights = reference_geometry(points, nodes)
        self.dofs = node_dofs(nodes)
        self._values = self._pressure_functions(points)
        mass = np.einsum("eq,eqc,eqd->ecd", self.weights, self._values, self._values)
        self._stiffnesses = material.bulk_modulus * np.linalg.inv(mass)
        count = self._values.shape[2]
        self._slopes = np.zeros((len(nodes), count, self.dofs.shape[1]))
        self._changes = np.zeros((len(nodes), count))
        self._stresses = IteratedStresses(self)

    def _pressure_functions(self, points: FloatArray) -> FloatArray:
        """Values (E, Q, m): 1, and x, y, z from the centre where the cell has more than 10 nodes.

        Coordinates of the body, not of the reference cell: only so a linear pressure is exact in
        distorted cells too (Boffi and Gastaldi, *Int. J. Numer. Meth. Fluids* 39
        (2002) 1001).
        """
        one = np.ones((*self.weights.shape, 1))
        cell = cell_of(self.nodes)
        if len(cell.corners) == 4:
            return one
        places = np.einsum("qa,eai->eqi", cell.values(cell.rule.points), points[self.nodes])
        centres = np.einsum("eq,eqi->ei", self.weights, places) / self.weights.sum(axis=1)[:, None]
        # In mm they would differ from 1 by orders of magnitude.
        sizes = np.ptp(points[self.nodes], axis=1)
        return np.concatenate([one, (places - centres[:, None]) / sizes[:, None]], axis=2)

    def internal_at_rest(self) -> FloatArray:
        """Pressures (E, m) and stresses S* of the geometric part (E, 6 Q), zero at rest."""
        return np.hstack([np.zeros(self._changes.shape), self._stresses.at_rest()])

    def internal_at(self, unknowns: FloatArray, pressures: FloatArray) -> FloatArray:
        """Given ``pressures`` (E, m), and the stresses that the ``unknowns`` have."""
        self._stresses.look(unknowns)
        return np.hstack([pressures, self._stresses.advanced(np.zeros_like(unknowns))])

    def pressures_of(self, internal: FloatArray) -> FloatArray:
        """The pressures (E, m) among the internal variables."""
        return self._split(internal)[0]

    def _split(self, internal: FloatArray) -> tuple[FloatArray, FloatArray]:
        count = self._changes.shape[1]
        stresses = internal[:, count:].reshape(*self.weights.shape, 6)
        return np.ascontiguousarray(internal[:, :count]), np.ascontiguousarray(stresses)

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        self._stresses.look(unknowns)
        return condensed_pressures(
            unknowns,
            self.nodes,
            *self._split(internal),
            self.iterates_stresses,
            self.gradients,
            self.weights,
            self._values,
            self._stiffnesses,
            self.material.kind,
            self.material.parameters,
            system.residual,
            system.tangent,
            self._slopes,
            self._changes,
        )

    def residual_near(
        self, unknowns: FloatArray, internal: FloatArray, load: float, residual: FloatArray
    ) -> float:
        """Fill the residual; see :class:`pagd.fem.term.CondensingTerm`."""
        self._stresses.look(unknowns)
        return residuals_near(
            unknowns,
            self.nodes,
            self._split(internal)[0],
            self.gradients,
            self.weights,
            self._values,
            self._stiffnesses,
            self.material.kind,
            self.material.parameters,
            residual,
            self._slopes,
            self._changes,
        )

    def lagging(self, internal: FloatArray, elements: IntArray) -> FloatArray:
        """What the pressures lack, by the slopes; see :class:`pagd.fem.term.LaggingTerm`."""
        stiffness, changes = self._stiffnesses[elements], self._changes[elements]
        wanted = np.einsum("ecd,ed->ec", stiffness, changes)
        lack = wanted - self._split(internal)[0][elements]
        return np.asarray(np.einsum("ec,eci->ei", lack, self._slopes[elements]))

    def advance(self, correction: FloatArray) -> FloatArray:
        """The pressures of the linearised volume constraint, K M⁻¹ (∫ φ (J−1) dV + b·Δu).

        And the linearised stresses.
        """
        step = np.einsum("eci,ei->ec", self._slopes, correction[self.dofs])
        pressures = np.einsum("ecd,ed->ec", self._stiffnesses, self._changes + step)
        return np.hstack([pressures, self._stresses.advanced(correction)])

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Stored elastic energy W(F̄) + ½ v · K M⁻¹ v with v = ∫ φ (J−1) dV, in mJ."""
        isochoric, change = _energies(self, unknowns, self.material)
        changes = np.einsum("eq,eqc,eq->ec", self.weights, self._values, change)
        volumetric = 0.5 * np.einsum("ec,ecd,ed->", changes, self._stiffnesses, changes)
        return float(isochoric.sum() + volumetric)


def _energies(
    solid: Solid, unknowns: FloatArray, material: Elastomer
) -> tuple[FloatArray, FloatArray]:
    """Isochoric energies (E,) in mJ and J − 1 (E, Q)."""
    isochoric = np.empty(len(solid.nodes))
    change = np.empty(solid.weights.shape)
    field_kernels.energies(
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
    field_kernels.largest_stretches(unknowns, solid.nodes, solid.gradients, threshold, result)
    return result
