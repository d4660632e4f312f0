"""Where the outside of a deformed body touches itself."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = ["TOUCHING_MM", "refined", "touching_triangles"]

#: Walls nearer than this count as touching: contact by a penalty holds them a little apart.
TOUCHING_MM: Final = 0.1
# How much farther than the touching distance a facing triangle's middle may lie, sideways.
_SLACK_MM: Final = 0.4
# Triangles are divided until no side is longer than this.
_SIDE_MM: Final = 0.6
# A place farther behind the other is no penetration, but the far side of a thin wall.
_DEEPEST_MM: Final = 0.2
# Normals of faces that touch are opposite, this being their product at most: those of the two
# sides of a slanted wall's sharp edge are not.
_OPPOSITE: Final = -0.8


def touching_triangles(
    points: FloatArray, triangles: IntArray, distance_mm: float = TOUCHING_MM
) -> tuple[FloatArray, IntArray]:
    """Return the parts of a closed surface whose distance to a part facing it is small.

    Parameters
    ----------
    points, triangles
        Deformed points (v, 3) in mm and triangles (t, 3), outward.
    distance_mm
        Largest gap.

    Returns
    -------
    points, triangles
        (w, 3) and (u, 3): the touching part of the surface, in triangles of at most 0.6 mm; no
        triangles where nothing touches.
    """
    corners = points[triangles]
    near = _facing(corners, _longest_side(corners) + distance_mm)[0]
    # Only what may touch is divided: it is a small part of the surface.
    fine = refined(corners[near], _SIDE_MM)
    if len(fine) == 0:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64)
    found, gap = _facing(fine, distance_mm + _SLACK_MM)
    kept = fine[found & (gap < distance_mm) & (gap > -_DEEPEST_MM)]
    return kept.reshape(-1, 3), np.arange(3 * len(kept)).reshape(-1, 3)


def refined(corners: FloatArray, side_mm: float) -> FloatArray:
    """Return triangles (t, 3, 3), each divided into four until no side is longer than `side_mm`."""
    while len(corners) and _longest_side(corners) > side_mm:
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        ab, bc, ca = (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0
        parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        corners = np.concatenate([np.stack(part, axis=1) for part in parts])
    return corners


def _facing(corners: FloatArray, reach_mm: float) -> tuple[NDArray[np.bool_], FloatArray]:
    """Tell which triangles have another facing them within reach, and the gap along the normal."""
    if len(corners) == 0:
        return np.zeros(0, np.bool_), np.zeros(0)
    middles = corners.mean(axis=1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    # In places and normals together, a normal of length 1 counting as the reach: what faces a
    # triangle has the opposite normal, and what lies beside it on the same wall is twice as far.
    tree = KDTree(np.hstack([middles, reach_mm * normals]))
    wanted = np.hstack([middles, -reach_mm * normals])
    _, other = tree.query(wanted, distance_upper_bound=1.2 * reach_mm)
    found = other < len(corners)
    other = np.where(found, other, 0)
    found &= np.einsum("ij,ij->i", normals, normals[other]) < _OPPOSITE
    return found, np.asarray(np.einsum("ij,ij->i", middles[other] - middles, normals))


def _longest_side(corners: FloatArray) -> float:
    sides = corners - np.roll(corners, 1, axis=1)
    return float(np.linalg.norm(sides, axis=2).max(initial=0.0))
