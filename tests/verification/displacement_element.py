"""The quadratic tetrahedron without a pressure of its own, as CalculiX' C3D10 is."""

from __future__ import annotations

import numpy as np
from solving import FloatArray

from pagd.fem.solid import ElementPressureSolid
from pagd.fem.term import node_dofs
from pagd.materials import Elastomer
from pagd.mesh.types import IntArray


class DisplacementSolid(ElementPressureSolid):
    """W(F̄) + K/2 (J − 1)² at the four points of every ten-node tetrahedron.

    It locks as the material becomes incompressible and is of use only to compare programs: on
    one mesh, with one element, they have to agree to the last digits. One pressure for each
    point of integration, condensed, is that element; so each point counts as an element here.
    """

    def __init__(self, points: FloatArray, nodes: IntArray, material: Elastomer) -> None:
        super().__init__(points, nodes, material)
        self.nodes = np.repeat(nodes, self.weights.shape[1], axis=0)
        self.gradients = self.gradients.reshape(-1, 1, 3, 10)
        self.weights = self.weights.reshape(-1, 1)
        self.dofs = node_dofs(self.nodes)
        self._values = np.ones((len(self.nodes), 1, 1))
        self._stiffnesses = material.bulk_modulus / self.weights[:, :, None]
        self._slopes = np.zeros((len(self.nodes), 1, 30))
        self._changes = np.zeros((len(self.nodes), 1))
