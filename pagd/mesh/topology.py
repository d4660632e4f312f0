"""Faces, edges and connected pieces of tetrahedral meshes (corner nodes only)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pagd.mesh.types import TET_FACES, FloatArray, IntArray

BoolArray = NDArray[np.bool_]


def all_faces(tets: IntArray) -> tuple[IntArray, IntArray]:
    """Return all outward faces (4m, 3) of tetrahedra (m, ≥4) and the tetrahedron of each."""
    faces = tets[:, TET_FACES[:, :3]].reshape(-1, 3)
    return faces, np.repeat(np.arange(len(tets)), 4)


def shared_faces(tets: IntArray) -> tuple[IntArray, IntArray]:
    """Return each face once, outward from its first owner, and its owners (k, 2).

    The second owner is −1 for a face on the boundary. ValueError if a face has three owners.
    """
    faces, owner = all_faces(tets)
    order = np.lexsort(np.sort(faces, axis=1).T)
    keys = np.sort(faces, axis=1)[order]
    same = (keys[1:] == keys[:-1]).all(axis=1)
    if (same[1:] & same[:-1]).any():
        raise ValueError("three tetrahedra share one face")
    first = np.concatenate(([True], ~same))
    second = np.concatenate((owner[order][1:], [-1]))
    paired = np.concatenate((same, [False]))
    owners = np.column_stack((owner[order], np.where(paired, second, -1)))
    return faces[order][first], owners[first]


def boundary_faces(tets: IntArray) -> IntArray:
    """Return the outward triangles (k, 3) that belong to one tetrahedron only."""
    faces, owners = shared_faces(tets)
    return np.asarray(faces[owners[:, 1] < 0])


def interface_faces(tets: IntArray, above: BoolArray) -> IntArray:
    """Return the faces (k, 3) between tetrahedra with `above` set and those without.

    They point from above to below.
    """
    faces, owners = shared_faces(tets)
    inner = owners[:, 1] >= 0
    faces, first, second = faces[inner], above[owners[inner, 0]], above[owners[inner, 1]]
    return np.vstack((faces[first & ~second], faces[second & ~first][:, ::-1]))


def triangle_edges(triangles: IntArray) -> IntArray:
    """Return the directed edges (3k, 2) of triangles (k, ≥3), grouped by local edge."""
    return np.vstack((triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]))


def open_edges(triangles: IntArray) -> IntArray:
    """Return the directed edges (k, 2) that no second triangle of the set shares."""
    edges = triangle_edges(triangles)
    _, inverse, counts = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    return np.asarray(edges[counts[inverse] == 1])


def edge_neighbours(triangles: IntArray, labels: IntArray | None = None) -> IntArray:
    """Return pairs (k, 2) of triangles that share an edge and, if given, have equal labels."""
    edges = np.sort(triangle_edges(triangles), axis=1)
    owner = np.tile(np.arange(len(triangles)), 3)
    marks = np.zeros(len(triangles), dtype=np.int64) if labels is None else labels
    keys = np.column_stack((edges, np.tile(marks, 3)))
    order = np.lexsort(keys.T)
    same = (keys[order][1:] == keys[order][:-1]).all(axis=1)
    return np.column_stack((owner[order][:-1][same], owner[order][1:][same]))


def components(pairs: IntArray, size: int) -> IntArray:
    """Return the number (size,) of the connected component of each of `size` linked items."""
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
    _, labels = connected_components(graph, directed=False)
    return labels.astype(np.int64)


def doubled_areas(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the vector areas (k, 3) in mm², doubled, of the corner triangles."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def unit_normals(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the unit normals (k, 3) of the corner triangles."""
    normals = doubled_areas(points, triangles)
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))
