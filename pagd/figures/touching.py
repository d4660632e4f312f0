"""Where the outside of a deformed body touches itself.

Two walls touch where the gap between them is below the width of the contact law, that is where it
pushes. Curved faces are divided into pieces twice: coarsely, to leave out what is near nothing,
and finely, to mark what touches.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from pagd.figures.pieces import Pieces
from pagd.figures.surface import is_half
from pagd.mesh.types import Mesh

if TYPE_CHECKING:
    from pagd.fem.contact import ContactLaw

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = ["deformed_faces", "touching_mm", "touching_triangles"]

# Sides of the pieces that the search begins with, and of those that are marked.
_COARSE_MM, _FINE_MM = 5.0, 0.5
# Where pieces of these sides would be more than so many, as where walls balloon, they are larger.
_MOST_COARSE: Final = 25_000
_MOST_FINE: Final = 60_000
# So many pairs of pieces are looked at in one go: of crumpled balloons there are many millions.
_PAIRS: Final = 200_000
# Product of the normals of two pieces that may face each other, at most: coarse ones turn within;
# of the fine ones the two sides of a slanted wall's sharp edge must not count.
_TURNED, _OPPOSITE = -0.1, -0.8
# The closest point on a curved face, from a piece's middle on, is found in so many iterations.
_ITERATIONS: Final = 4


def touching_mm() -> float:
    """Return the gap in mm below which walls touch: there the contact law begins to push."""
    return _law().width


def deformed_faces(mesh: Mesh, displacement: FloatArray, names: Iterable[str]) -> FloatArray:
    """Return the deformed six-node faces (f, 6, 3) of the named surfaces there are, in mm.

    Those of a half model come with their mirror images.
    """
    nodes = np.vstack([mesh.surfaces[name] for name in names if name in mesh.surfaces])
    faces = (mesh.points + displacement)[nodes]
    if not is_half(mesh):
        return np.asarray(faces)
    # A mirror image turns inside out: the other way round, it faces outward again.
    mirrored = faces[:, [0, 2, 1, 5, 4, 3]] * [1.0, -1.0, 1.0]
    return np.concatenate([faces, mirrored])


def touching_triangles(faces: FloatArray, distance_mm: float | None = None) -> FloatArray:
    """Return the parts of a surface whose distance to a part facing it is small.

    Parameters
    ----------
    faces
        Six-node faces (f, 6, 3) in mm, outward, corners before the middles of the sides.
    distance_mm
        Gap below which parts touch; that of the contact law unless given.

    Returns
    -------
    triangles
        (t, 3, 3) corners of the small triangles, on the curved faces, that touch others.
    """
    law = _law()
    distance = law.width if distance_mm is None else distance_mm
    coarse = Pieces.of(faces).divided(_COARSE_MM, _MOST_COARSE)
    near = np.unique(_facing(coarse, distance, _TURNED))
    fine = coarse.at(near).divided(_FINE_MM, _MOST_FINE)
    one, other = _nearest(fine, _facing(fine, distance, _OPPOSITE))
    gap = _gaps(fine, one, other)
    return fine.corners[one[(gap < distance) & (gap > -law.deepest)]]


def _law() -> ContactLaw:
    from pagd.fem.contact import ContactLaw  # imports Numba

    return ContactLaw()


def _facing(pieces: Pieces, distance_mm: float, opposite: float) -> IntArray:
    """Return the pairs (p, 2) of pieces that may be nearer to each other than a distance.

    The product of the normals of a pair is below `opposite`.
    """
    if len(pieces.face) == 0:
        return np.zeros((0, 2), np.int64)
    # No point of a triangle is farther from its middle than two thirds of its longest side.
    reach = distance_mm + 4.0 / 3.0 * float(pieces.longest_sides.max())
    pairs = KDTree(pieces.middles).query_pairs(reach, output_type="ndarray")
    parts = np.array_split(pairs, len(pairs) // _PAIRS + 1)
    return np.vstack([_kept(pieces, part, distance_mm, opposite) for part in parts])


def _kept(pieces: Pieces, pairs: IntArray, distance_mm: float, opposite: float) -> IntArray:
    """Return the pairs that have opposite normals and are not far apart along either."""
    normals = pieces.normals
    pairs = pairs[_products(*(normals[side] for side in pairs.T)) < opposite]
    for side in (0, 1):
        axes = normals[pairs[:, side]]
        pairs = pairs[_are_near(pieces.hulls, axes, pairs, distance_mm)]
    return np.asarray(pairs, dtype=np.int64)


def _are_near(
    hulls: FloatArray, axes: FloatArray, pairs: IntArray, distance_mm: float
) -> NDArray[np.bool_]:
    """Tell of which pairs the hulls (t, 6, 3), along an axis (p, 3) each, are not far apart."""
    one, other = (np.einsum("pki,pi->pk", hulls[side], axes) for side in pairs.T)
    apart = np.maximum(
        other.min(axis=1) - one.max(axis=1),
        one.min(axis=1) - other.max(axis=1),
    )
    return np.asarray(apart < distance_mm)


def _nearest(pieces: Pieces, pairs: IntArray) -> tuple[IntArray, IntArray]:
    """Return the pieces that have others facing them, and of those the nearest to each."""
    one, other = np.vstack([pairs, pairs[:, ::-1]]).T
    middles = pieces.middles
    order = np.lexsort((np.linalg.norm(middles[other] - middles[one], axis=1), one))
    found, first = np.unique(one[order], return_index=True)
    return found, other[order][first]


def _gaps(pieces: Pieces, one: IntArray, other: IntArray) -> FloatArray:
    """Return the distances (k,) of the middles of pieces from the faces of others.

    They are negative behind a face. A foot may lie beyond the other piece by half of its size.
    """
    points, there = pieces.middles[one], pieces.at(other)
    low, high = there.places.min(axis=1), there.places.max(axis=1)
    slack = (high - low) / 2.0
    places = there.places.mean(axis=1)
    for _ in range(_ITERATIONS):
        tangents = there.tangents(places)
        step = _step(tangents, points - there.positions(places))
        second = np.clip(places[:, 1:] + step, (low - slack)[:, 1:], (high + slack)[:, 1:])
        places = np.column_stack([1.0 - second.sum(axis=1), second])
    away = points - there.positions(places)
    tangents = there.tangents(places)
    outward = _products(np.cross(tangents[:, 0], tangents[:, 1]), away)
    return np.asarray(np.copysign(np.linalg.norm(away, axis=1), outward))


def _step(tangents: FloatArray, away: FloatArray) -> FloatArray:
    """Return the changes (k, 2) of coordinates that lead along the tangents (k, 2, 3) by `away`."""
    first, second = tangents[:, 0], tangents[:, 1]
    aa, ab, bb = (_products(*two) for two in ((first, first), (first, second), (second, second)))
    a, b = _products(first, away), _products(second, away)
    determinant = np.maximum(aa * bb - ab**2, 1e-30)
    return np.column_stack([bb * a - ab * b, aa * b - ab * a]) / determinant[:, None]


def _products(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("ki,ki->k", one, other))
