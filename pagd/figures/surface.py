"""Triangles to draw: the skin of a quadratic mesh, cut-away meshes, mirrored halves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.mesh.types import TET_FACES, Mesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

__all__ = ["OUTSIDE", "Skin", "cut_faces", "is_half", "sharp_edges", "skin_of", "split_faces"]

#: Surfaces that are seen from outside.
OUTSIDE = ("fixed", "outer", "tip")


@dataclass(frozen=True, eq=False, slots=True)
class Skin:
    """Triangles over some nodes of a mesh, and over their mirror images for a half model.

    nodes: (v,) node of the mesh behind each vertex.
    side: (v,) −1 for vertices mirrored about y = 0, else 1.
    triangles: (t, 3) vertex numbers, outward.
    """

    nodes: IntArray
    side: FloatArray
    triangles: IntArray

    def vectors(self, field: NDArray[np.floating]) -> FloatArray:
        """Return a nodal vector field (n, 3), points or displacements, at the vertices (v, 3)."""
        values = np.asarray(field[self.nodes], dtype=np.float64)
        values[:, 1] *= self.side
        return values

    def scalars(self, field: NDArray[np.floating]) -> FloatArray:
        """Return a nodal field (n,) at the vertices (v,)."""
        return np.asarray(field[self.nodes], dtype=np.float64)


def is_half(mesh: Mesh) -> bool:
    """Tell whether the mesh is the half y ≥ 0 of a symmetric body."""
    return "symmetry" in mesh.surfaces


def skin_of(mesh: Mesh, names: Iterable[str] = OUTSIDE, *, corners_only: bool = False) -> Skin:
    """Return the skin of the whole body over the named surfaces; absent names are left out.

    With `corners_only` a face gives one triangle between its corners instead of four.
    """
    faces = np.vstack([mesh.surfaces[name] for name in names if name in mesh.surfaces])
    corners = faces[:, :3] if corners_only else split_faces(faces)
    nodes, triangles = np.unique(corners, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    if is_half(mesh):
        return _doubled(mesh.points, nodes, triangles)
    return Skin(nodes, np.ones(len(nodes)), triangles)


def split_faces(faces: IntArray) -> IntArray:
    """Return the four triangles (4k, 3) of each six-node face (k, 6)."""
    a, b, c, ab, bc, ca = faces.T
    return np.stack(
        [np.stack(t, axis=-1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))],
        axis=1,
    ).reshape(-1, 3)


def sharp_edges(points: FloatArray, triangles: IntArray, degrees: float = 35.0) -> IntArray:
    """Return the edges (e, 2) where two triangles meet at more than an angle, or only one ends."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    owner = np.repeat(np.arange(len(triangles)), 3)
    unique, inverse, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    # |Σ n|² of the triangles at an edge: 2 + 2 cos(angle) for two of them.
    total = np.zeros((len(unique), 3))
    np.add.at(total, inverse.ravel(), normals[owner])
    flat = (total**2).sum(axis=1) >= 2.0 + 2.0 * np.cos(np.radians(degrees))
    return np.asarray(unique[(count != 2) | ~flat])


def cut_faces(mesh: Mesh, kept: BoolArray) -> dict[str, IntArray]:
    """Return the faces around the kept tetrahedra (m,) by surface name, cuts as "cut".

    Faces (k, 6) of the paper are shared by two tetrahedra; they appear where one of the two is
    left out.
    """
    faces = mesh.tets[kept][:, TET_FACES].reshape(-1, 6)
    keys = np.sort(faces[:, :3], axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    bare, bare_keys = faces[first[count == 1]], keys[first[count == 1]]
    found, left = {}, np.ones(len(bare), dtype=bool)
    for name, named in mesh.surfaces.items():
        here = _rows_in(bare_keys, np.sort(named[:, :3], axis=1))
        found[name] = bare[here]
        left &= ~here
    return {**found, "cut": bare[left]}


def _doubled(points: FloatArray, nodes: IntArray, triangles: IntArray) -> Skin:
    """Return the skin with its mirror image; vertices on the plane of symmetry are shared."""
    on_plane = np.abs(points[nodes, 1]) < 1e-9 * max(1.0, float(np.ptp(points[:, 0])))
    copies = np.flatnonzero(~on_plane)
    image = np.arange(len(nodes))
    image[copies] = len(nodes) + np.arange(len(copies))
    return Skin(
        nodes=np.concatenate([nodes, nodes[copies]]),
        side=np.concatenate([np.ones(len(nodes)), -np.ones(len(copies))]),
        # A mirror image turns inside out: the other way round, it faces outward again.
        triangles=np.vstack([triangles, image[triangles][:, ::-1]]),
    )


def _rows_in(rows: IntArray, others: IntArray) -> BoolArray:
    """Tell which rows (k, 3) are among the others (j, 3)."""
    base = int(max(rows.max(initial=0), others.max(initial=0))) + 1
    weights = np.array([base * base, base, 1], dtype=np.int64)
    return np.isin(rows @ weights, others @ weights)
