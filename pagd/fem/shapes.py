"""Shape functions of the quadratic tetrahedron and triangle, in Gmsh's node order.

Tetrahedron: corners 0–3, then the edges (0,1) (1,2) (2,0) (3,0) (2,3) (1,3).
Triangle: corners 0–2, then the edges (0,1) (1,2) (2,0).
The functions are written in barycentric coordinates l: corner a has
l_a (2 l_a − 1), the edge between a and b has 4 l_a l_b.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))
TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))


def _values(points: FloatArray, edges: tuple[tuple[int, int], ...]) -> FloatArray:
    corners = points * (2 * points - 1)
    middles = np.stack([4 * points[:, a] * points[:, b] for a, b in edges], axis=1)
    return np.hstack([corners, middles])


def _derivatives(points: FloatArray, edges: tuple[tuple[int, int], ...]) -> FloatArray:
    """Derivatives (points, nodes, corners) with respect to each barycentric coordinate."""
    count, corners = points.shape
    result = np.zeros((count, corners + len(edges), corners))
    for a in range(corners):
        result[:, a, a] = 4 * points[:, a] - 1
    for k, (a, b) in enumerate(edges):
        result[:, corners + k, a] = 4 * points[:, b]
        result[:, corners + k, b] = 4 * points[:, a]
    return result


def _reference_derivatives(points: FloatArray, edges: tuple[tuple[int, int], ...]) -> FloatArray:
    """Derivatives (points, nodes, d) along the reference axes r_k = l_k, k = 1 … d."""
    barycentric = _derivatives(points, edges)
    return barycentric[:, :, 1:] - barycentric[:, :, :1]


def tetrahedron_values(points: FloatArray) -> FloatArray:
    """Values (points, 10) of the ten functions at barycentric points (points, 4)."""
    return _values(points, TETRAHEDRON_EDGES)


def tetrahedron_derivatives(points: FloatArray) -> FloatArray:
    """Derivatives (points, 10, 3) along the three reference axes."""
    return _reference_derivatives(points, TETRAHEDRON_EDGES)


def triangle_values(points: FloatArray) -> FloatArray:
    """Values (points, 6) of the six functions at barycentric points (points, 3)."""
    return _values(points, TRIANGLE_EDGES)


def triangle_derivatives(points: FloatArray) -> FloatArray:
    """Derivatives (points, 6, 2) along the two reference axes."""
    return _reference_derivatives(points, TRIANGLE_EDGES)


def triangle_hessians() -> FloatArray:
    """Second derivatives (6, 2, 2) along the two reference axes; they are constant."""
    slopes = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    result = np.empty((6, 2, 2))
    for a in range(3):
        result[a] = 4 * np.outer(slopes[a], slopes[a])
    for k, (a, b) in enumerate(TRIANGLE_EDGES):
        result[3 + k] = 4 * (np.outer(slopes[a], slopes[b]) + np.outer(slopes[b], slopes[a]))
    return result
