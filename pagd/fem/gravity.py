"""Gravity: the potential −∫ ρ g · u dV of a body force that keeps its direction.

ρ is the density of the undeformed body. In the units of the solver, mm, N and mJ, a density in
kg/m³ times an acceleration in m/s² is 1e-9 N/mm³.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pagd.fem import shapes
from pagd.fem.cells import reference_geometry
from pagd.fem.quadrature import tetrahedron
from pagd.fem.term import NO_INTERNAL, ElementSystem

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: N/mm³ in a N/m³.
_FORCE_DENSITY = 1e-9


class Gravity:
    """A dead body force on a solid of ten-node tetrahedra, independent of the load factor.

    Each element of the term is a single displacement, so that its tangent, which is zero, adds
    no entry to the matrix.

    Parameters
    ----------
    points, nodes
        Coordinates (n, 3) in mm and ten-node tetrahedra (E, 10).
    density
        In kg/m³.
    acceleration
        (3,) in m/s².

    Attributes
    ----------
    share
        The part of gravity that acts, 0 … 1; may be set at any time.
    weight
        Weight (3,) of the whole body in N, whatever the share.

    Raises
    ------
    InputError
        Where an element is inverted.
    """

    name = "gravity"

    def __init__(
        self, points: FloatArray, nodes: IntArray, density: float, acceleration: ArrayLike
    ) -> None:
        self.share = 1.0
        force = _FORCE_DENSITY * density * np.asarray(acceleration, dtype=np.float64)
        pulled = np.flatnonzero(force)
        numbers, volumes = _nodal_volumes(points, nodes)
        self.dofs: IntArray = (3 * numbers[:, None] + pulled).reshape(-1, 1)
        self._forces = (volumes[:, None] * force[pulled]).reshape(-1, 1)
        self.weight: FloatArray = force * float(volumes.sum())

    def internal_at_rest(self) -> FloatArray:
        """There are none."""
        return NO_INTERNAL

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        system.residual[:] = -self.share * self._forces
        system.tangent[:] = 0.0
        return self.energy(unknowns, load)

    def advance(self, correction: FloatArray) -> FloatArray:
        """Nothing to advance."""
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Potential energy in mJ, zero at rest."""
        return -self.share * float((self._forces * unknowns[self.dofs]).sum())


def _nodal_volumes(points: FloatArray, nodes: IntArray) -> tuple[IntArray, FloatArray]:
    """Numbers (k,) of the nodes and the integrals (k,) of their shape functions, in mm³.

    By the quadrature of the solid, which is exact for straight elements: corners get −1/20 of
    such an element and edge nodes 1/5.
    """
    weights = reference_geometry(points, nodes)[1]
    shares = weights @ shapes.tetrahedron_values(tetrahedron().points)
    numbers, places = np.unique(nodes, return_inverse=True)
    volumes = np.bincount(places.ravel(), shares.ravel())
    return numbers, np.asarray(volumes, dtype=np.float64)
