"""Which points lie inside a closed triangulated surface."""

from __future__ import annotations

import numpy as np

from pagd.mesh.topology import BoolArray, doubled_areas
from pagd.mesh.types import FloatArray, IntArray

__all__ = ["inside", "winding_numbers"]

#: Points times triangles that are worked on at a time, to bound the memory.
_BLOCK = 1_000_000


def inside(queries: FloatArray, points: FloatArray, triangles: IntArray) -> BoolArray:
    """Tell which queries (q, 3) the closed surface winds around (it points outwards)."""
    low, high = points.min(axis=0), points.max(axis=0)
    result = ((queries > low) & (queries < high)).all(axis=1)
    result[result] = winding_numbers(queries[result], points, triangles) > 0.5
    return np.asarray(result)


def winding_numbers(queries: FloatArray, points: FloatArray, triangles: IntArray) -> FloatArray:
    """Generalised winding numbers (q,): 1 inside and 0 outside of a closed outward surface.

    The sum of the triangles' solid angles (van Oosterom and Strackee 1983) over 4 pi. It does
    not depend on rays that might hit an edge, and tolerates small cracks (Jacobson et al. 2013).
    """
    normals = doubled_areas(points, triangles)
    offsets = np.einsum("ij,ij->i", normals, points[triangles[:, 0]])
    edges = points[triangles] - points[np.roll(triangles, -1, axis=1)]
    squares = np.einsum("tij,tij->it", edges, edges)
    step = max(1, _BLOCK // len(triangles))
    blocks = [queries[i : i + step] for i in range(0, len(queries), step)]
    sums = [_solid_angles(q, points, triangles, normals, offsets, squares) for q in blocks]
    return np.concatenate([np.empty(0), *sums]) / (4.0 * np.pi)


def _solid_angles(
    queries: FloatArray,
    points: FloatArray,
    triangles: IntArray,
    normals: FloatArray,
    offsets: FloatArray,
    squares: FloatArray,
) -> FloatArray:
    """Sum of signed solid angles (q,), from distances and edge lengths alone.

    Parameters
    ----------
    normals, offsets
        Doubled vector areas (t, 3) and their products with a corner: the triple product.
    squares
        Squared lengths (3, t) of the edges from corner 0 to 1, 1 to 2 and 2 to 0.
    """
    distances = np.linalg.norm(queries[:, None] - points[None], axis=2)
    a, b, c = (distances[:, triangles[:, i]] for i in range(3))
    triple = offsets - queries @ normals.T
    # By the law of cosines, the product of two corner vectors needs no vectors.
    ab, bc, ca = (
        (p * p + q * q - s) / 2.0 for p, q, s in zip((a, b, c), (b, c, a), squares, strict=True)
    )
    return np.asarray(2.0 * np.arctan2(triple, a * b * c + ab * c + bc * a + ca * b).sum(axis=1))
