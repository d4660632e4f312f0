"""Nested refinement: every edge halved, so that the meshes of a series differ by their size alone.

Meshes drawn anew for another size differ by chance too, in where the elements lie; halves of one
mesh do not.
"""

from __future__ import annotations

import numpy as np
from solving import FloatArray

from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.types import IntArray, Mesh

#: Parts at the corners of a ten-node tetrahedron, in its node numbers.
_CORNERS = np.array([(0, 4, 6, 7), (4, 1, 5, 9), (6, 5, 2, 8), (7, 9, 8, 3)])
#: The octahedron between them: for each of its diagonals, its ends and the ring around it, such
#: that (start, end, ring[i], ring[i + 1]) has a positive volume.
_DIAGONALS = (
    ((4, 8), (6, 7, 9, 5)),
    ((5, 7), (6, 4, 9, 8)),
    ((6, 9), (4, 5, 8, 7)),
)
#: Parts of a six-node triangle.
_FACES = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])


def halved(mesh: Mesh) -> Mesh:
    """The mesh with every edge halved: eight times as many tetrahedra; its edges are straight.

    The octahedron that is left of a tetrahedron without its corners is cut along its shortest
    diagonal, which keeps the shapes as good as they can be (Bey 1995).
    """
    parts = [mesh.tets[:, corner] for corner in _CORNERS] + _cut_octahedra(mesh)
    surfaces = {
        name: np.vstack([faces[:, part] for part in _FACES])
        for name, faces in mesh.surfaces.items()
    }
    return quadratic_mesh(mesh.points, np.vstack(parts), surfaces)


def _cut_octahedra(mesh: Mesh) -> list[IntArray]:
    shortest = np.argmin([_lengths(mesh, ends) for ends, _ in _DIAGONALS], axis=0)
    parts = []
    for k, ((start, end), ring) in enumerate(_DIAGONALS):
        tets = mesh.tets[shortest == k]
        parts += [tets[:, [start, end, ring[i], ring[(i + 1) % 4]]] for i in range(4)]
    return parts


def _lengths(mesh: Mesh, ends: tuple[int, int]) -> FloatArray:
    first, second = (mesh.points[mesh.tets[:, end]] for end in ends)
    return np.linalg.norm(second - first, axis=1)
