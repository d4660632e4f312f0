"""Shape functions of quadratic cells.

Tetrahedron and triangle are in Gmsh's node order, hexahedron and wedge by layers.

Tetrahedron: corners 0–3, then the edges (0,1) (1,2) (2,0) (3,0) (2,3) (1,3).
Triangle: corners 0–2, then the edges (0,1) (1,2) (2,0).
The functions are written in barycentric coordinates l: corner a has
l_a (2 l_a − 1), the edge between a and b has 4 l_a l_b.
Hexahedron: node 9 i + 3 j + k at (i/2, j/2, k/2) of the unit cube, products of the quadratic
functions of a line; the quadrilateral likewise. Wedge: node 6 k + a at node a of the triangle
and the height k/2.
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


def _line_values(places: FloatArray) -> FloatArray:
    """Values (points, 3) of the quadratic functions with nodes at 0, 1/2 and 1."""
    x = places
    return np.stack([(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)], axis=-1)


def _line_derivatives(places: FloatArray) -> FloatArray:
    x = places
    return np.stack([4 * x - 3, 4 - 8 * x, 4 * x - 1], axis=-1)


def hexahedron_values(points: FloatArray) -> FloatArray:
    """Values (points, 27) of the functions at points (points, 3) of the unit cube."""
    x, y, z = (_line_values(points[:, k]) for k in range(3))
    return np.asarray(np.einsum("qi,qj,qk->qijk", x, y, z).reshape(len(points), 27))


def hexahedron_derivatives(points: FloatArray) -> FloatArray:
    """Derivatives (points, 27, 3) along the three reference axes."""
    values = [_line_values(points[:, k]) for k in range(3)]
    result = np.empty((len(points), 27, 3))
    for axis in range(3):
        x, y, z = (_line_derivatives(points[:, k]) if k == axis else values[k] for k in range(3))
        result[:, :, axis] = np.einsum("qi,qj,qk->qijk", x, y, z).reshape(len(points), 27)
    return result


def quadrilateral_values(points: FloatArray) -> FloatArray:
    """Values (points, 9) of the functions at points (points, 2) of the unit square."""
    x, y = (_line_values(points[:, k]) for k in range(2))
    return np.asarray(np.einsum("qi,qj->qij", x, y).reshape(len(points), 9))


def quadrilateral_derivatives(points: FloatArray) -> FloatArray:
    """Derivatives (points, 9, 2) along the two reference axes."""
    x, y = (_line_values(points[:, k]) for k in range(2))
    slope_x, slope_y = (_line_derivatives(points[:, k]) for k in range(2))
    pairs = ((slope_x, y), (x, slope_y))
    both = [np.einsum("qi,qj->qij", *pair).reshape(len(points), 9) for pair in pairs]
    return np.stack(both, axis=-1)


def wedge_values(points: FloatArray) -> FloatArray:
    """Values (points, 18) at points (points, 4): barycentric coordinates, then the height."""
    flat, height = triangle_values(points[:, :3]), _line_values(points[:, 3])
    return np.asarray(np.einsum("qa,qk->qka", flat, height).reshape(len(points), 18))


def wedge_derivatives(points: FloatArray) -> FloatArray:
    """Derivatives (points, 18, 3) along the two axes of the triangle and the height."""
    flat, height = triangle_values(points[:, :3]), _line_values(points[:, 3])
    within = np.einsum("qai,qk->qkai", triangle_derivatives(points[:, :3]), height)
    along = np.einsum("qa,qk->qka", flat, _line_derivatives(points[:, 3]))
    both = np.concatenate([within, along[..., None]], axis=-1)
    return np.asarray(both.reshape(len(points), 18, 3))
