"""The walls of the cavity as a boundary region of FElupe, which makes none of tetrahedra itself."""

from __future__ import annotations

from typing import Any

import felupe
import numpy as np
from felupe.quadrature import Scheme
from job import FloatArray, IntArray

__all__ = ["FELUPE_ORDER", "cavity_field"]

#: FElupe's tetrahedra have the last two edge nodes the other way round than gmsh's.
FELUPE_ORDER = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]

# Corner pairs that nodes 4…9 of FElupe's tetrahedron halve.
_EDGES = np.array([(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)])

# Triangle, exact to degree 4 (Dunavant 1985): weights by area, and one coordinate of each three.
_WEIGHTS = np.repeat([0.223381589678011, 0.109951743655322], 3)
_NEAR = np.repeat([0.445948490915965, 0.091576213509771], 3)


def cavity_field(points: FloatArray, tets: IntArray, faces: IntArray) -> Any:
    """Displacements on the faces of a cavity, for ``felupe.SolidBodyPressure``.

    Parameters
    ----------
    points, tets
        Coordinates (n, 3), and tetrahedra (m, 10) in FElupe's order.
    faces
        Triangles (k, 6) that point out of the solid.
    """
    mesh = felupe.Mesh(points, _standing_on(tets, faces), "tetra10")
    region = felupe.Region(mesh, felupe.QuadraticTetra(), _scheme())
    a, b, c = (points[faces[:, i]] for i in range(3))
    vectors = np.cross(b - a, c - a) / 2
    areas = np.linalg.norm(vectors, axis=1)
    # Of shapes (quadrature points, faces) and (3, quadrature points, faces).
    region.dV = _WEIGHTS[:, None] * areas
    region.normals = np.repeat((vectors / areas[:, None]).T[:, None, :], len(_WEIGHTS), axis=1)
    return felupe.FieldContainer([felupe.Field(region, dim=3)])


def _scheme() -> Any:
    """Points of the face of the first three corners, where the third coordinate is zero."""
    points = np.column_stack((_NEAR, _NEAR, np.zeros(6)))
    for start in (0, 3):
        points[start + 1, 0] = 1 - 2 * _NEAR[start]
        points[start + 2, 1] = 1 - 2 * _NEAR[start]
    return Scheme(points, _WEIGHTS / 2)


def _standing_on(tets: IntArray, faces: IntArray) -> IntArray:
    """The tetrahedron of each face, its nodes turned so that the face is its first three."""
    corners = np.sort(tets[:, [(1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2)]], axis=-1).reshape(-1, 3)
    rows = {tuple(row): number for number, row in enumerate(corners.tolist())}
    found = np.array([rows[tuple(sorted(face))] for face in faces[:, :3].tolist()])
    opposite = tets[found // 4, found % 4]
    # Seen from inside the solid, hence the second and third corner change places.
    turned = np.column_stack((faces[:, [0, 2, 1]], opposite))
    mids: dict[tuple[int, ...], int] = {}
    for k, (i, j) in enumerate(_EDGES):
        ends = np.sort(tets[:, [i, j]], axis=1).tolist()
        mids |= dict(zip(map(tuple, ends), tets[:, 4 + k].tolist(), strict=True))
    edges = np.sort(turned[:, _EDGES], axis=-1).tolist()
    return np.column_stack((turned, [[mids[tuple(ends)] for ends in row] for row in edges]))
