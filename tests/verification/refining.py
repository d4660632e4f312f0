"""Uniform refinement: every tetrahedron becomes eight, every triangle four."""

from __future__ import annotations

import numpy as np

from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.types import IntArray, Mesh, corner_volumes

# Local nodes of the four tetrahedra at the corners, and of the four around the diagonal from
# edge (0,1) to edge (2,3) of the octahedron that they leave.
_EIGHT = np.array(
    [
        *[(0, 4, 6, 7), (1, 5, 4, 9), (2, 6, 5, 8), (3, 7, 8, 9)],
        *[(4, 8, 6, 7), (4, 8, 7, 9), (4, 8, 9, 5), (4, 8, 5, 6)],
    ]
)
_FOUR = np.array([(0, 3, 5), (1, 4, 3), (2, 5, 4), (3, 4, 5)])


def refined(mesh: Mesh) -> Mesh:
    """The mesh with edges of half the length; straight edges stay straight."""
    tets = mesh.tets[:, _EIGHT].reshape(-1, 4)
    faces = {name: nodes[:, _FOUR].reshape(-1, 3) for name, nodes in mesh.surfaces.items()}
    return quadratic_mesh(mesh.points, _turned(mesh, tets), faces)


def _turned(mesh: Mesh, tets: IntArray) -> IntArray:
    """The same tetrahedra with positive volumes."""
    inverted = corner_volumes(mesh.points, tets) < 0
    return np.where(inverted[:, None], tets[:, [0, 2, 1, 3]], tets)
