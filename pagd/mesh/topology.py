"""Faces, edges and connected pieces of tetrahedral meshes (corner nodes only)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pagd.errors import InputError
from pagd.mesh.types import TET_FACES, FloatArray, IntArray

BoolArray = NDArray[np.bool_]


def row_numbers(rows: IntArray) -> IntArray:
    """Return a number (k,) for each row of (k, c) non-negative integers, equal for equal rows."""
    numbers = rows[:, 0]
    size = 1 + int(rows.max(initial=0))
    # One column at a time, or the packed keys would overflow on large meshes.
    for column in rows.T[1:]:
        numbers = np.unique(numbers * size + column, return_inverse=True)[1]
    return np.asarray(numbers, dtype=np.int64)


def occurrences(rows: IntArray) -> IntArray:
    """Return how often (k,) each row occurs among the rows (k, c) of non-negative integers."""
    numbers = row_numbers(rows)
    return np.asarray(np.bincount(numbers)[numbers])


def all_faces(tets: IntArray) -> tuple[IntArray, IntArray]:
    """Return all outward faces (4m, 3) of tetrahedra (m, ≥4) and the tetrahedron of each."""
    faces = tets[:, TET_FACES[:, :3]].reshape(-1, 3)
    return faces, np.repeat(np.arange(len(tets)), 4)


def shared_faces(tets: IntArray) -> tuple[IntArray, IntArray]:
    """Return each face once, outward from its first owner, and its owners (k, 2).

    The second owner is −1 for a face on the boundary. InputError if tetrahedra overlap: three
    share a face, or two that lie on the same side of it.
    """
    faces, owner = all_faces(tets)
    numbers = row_numbers(np.sort(faces, axis=1))
    counts = np.bincount(numbers)
    # Seen from its two owners, an inner face turns either way.
    turns = np.bincount(numbers, weights=_parity(faces))
    if counts.max() > 2 or (turns[counts == 2] != 0.0).any():
        raise InputError("The mesh has tetrahedra that overlap at a common face.")
    order = np.argsort(numbers, kind="stable")
    first = np.concatenate(([True], np.diff(numbers[order]) > 0))
    owners = np.full((int(first.sum()), 2), -1, dtype=np.int64)
    owners[:, 0] = owner[order[first]]
    owners[numbers[order[~first]], 1] = owner[order[~first]]
    return faces[order[first]], owners


def _parity(triangles: IntArray) -> FloatArray:
    """Return +1 or −1 (k,): whether an even or odd permutation sorts the corners."""
    a, b, c = triangles.T
    return np.asarray(np.sign(b - a) * np.sign(c - b) * np.sign(c - a), dtype=np.float64)


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
    return np.asarray(edges[occurrences(np.sort(edges, axis=1)) == 1])


def crowded_edges(triangles: IntArray) -> IntArray:
    """Return the edges (k, 2) that more than two triangles share, each once."""
    edges = np.sort(triangle_edges(triangles), axis=1)
    return np.unique(edges[occurrences(edges) > 2], axis=0)


def edge_neighbours(triangles: IntArray, labels: IntArray | None = None) -> IntArray:
    """Return pairs (k, 2) of triangles that share an edge and, if given, have equal labels."""
    edges = np.sort(triangle_edges(triangles), axis=1)
    owner = np.tile(np.arange(len(triangles)), 3)
    marks = np.zeros(len(triangles), dtype=np.int64) if labels is None else labels
    numbers = row_numbers(np.column_stack((edges, np.tile(marks, 3))))
    order = np.argsort(numbers, kind="stable")
    same = np.diff(numbers[order]) == 0
    sorted_owner = owner[order]
    return np.column_stack((sorted_owner[:-1][same], sorted_owner[1:][same]))


def components(pairs: IntArray, size: int) -> IntArray:
    """Return the number (size,) of the connected component of each of `size` linked items."""
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
    _, labels = connected_components(graph, directed=False)
    return np.asarray(labels, dtype=np.int64)


def doubled_areas(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the vector areas (k, 3) in mm², doubled, of the corner triangles."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def unit_normals(points: FloatArray, triangles: IntArray) -> FloatArray:
    """Return the unit normals (k, 3) of the corner triangles."""
    normals = doubled_areas(points, triangles)
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))
