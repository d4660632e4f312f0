"""Where the outside of a deformed body touches itself."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from pagd.fem.shapes import triangle_values
from pagd.figures.surface import OUTSIDE, is_half, split_faces
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = ["TOUCHING_MM", "outside_faces", "refined", "touching_triangles"]

#: Walls nearer than this count as touching: contact by a penalty holds them a little apart.
TOUCHING_MM: Final = 0.1
# How much farther than the touching distance a facing triangle's middle may lie, sideways.
_SLACK_MM: Final = 0.4
# Faces are divided into triangles whose sides are about this long.
_SIDE_MM: Final = 0.5
# A place farther behind the other is no penetration, but the far side of a thin wall.
_DEEPEST_MM: Final = 0.2
# Normals of faces that touch are opposite, this being their product at most: those of the two
# sides of a slanted wall's sharp edge are not.
_OPPOSITE: Final = -0.8


def outside_faces(mesh: Mesh, displacement: FloatArray) -> FloatArray:
    """Return the deformed six-node faces (f, 6, 3) that are seen from outside, in mm.

    Those of a half model come with their mirror images.
    """
    nodes = np.vstack([mesh.surfaces[name] for name in OUTSIDE if name in mesh.surfaces])
    faces = (mesh.points + displacement)[nodes]
    if not is_half(mesh):
        return np.asarray(faces)
    # A mirror image turns inside out: the other way round, it faces outward again.
    mirrored = faces[:, [0, 2, 1, 5, 4, 3]] * [1.0, -1.0, 1.0]
    return np.concatenate([faces, mirrored])


def touching_triangles(faces: FloatArray, distance_mm: float = TOUCHING_MM) -> FloatArray:
    """Return the parts of a closed surface whose distance to a part facing it is small.

    Parameters
    ----------
    faces
        Six-node faces (f, 6, 3) in mm, outward, corners before the middles of the sides.
    distance_mm
        Largest gap.

    Returns
    -------
    triangles
        (t, 3, 3) corners of the small triangles, on the curved faces, that touch others.
    """
    coarse = _split(faces)
    near, _, _ = _facing(coarse, _longest_side(coarse) + distance_mm)
    # Only what may touch is divided finely: it is a small part of the surface.
    fine = refined(faces[near.reshape(-1, 4).any(axis=1)], _SIDE_MM)
    found, gap, opposite = _facing(fine, distance_mm + _SLACK_MM)
    touching = found & opposite & (gap < distance_mm) & (gap > -_DEEPEST_MM)
    return np.asarray(fine[touching])


def refined(faces: FloatArray, side_mm: float) -> FloatArray:
    """Return triangles (t, 3, 3) of about `side_mm` whose corners lie on the curved faces."""
    if len(faces) == 0:
        return np.zeros((0, 3, 3))
    parts = int(np.ceil(_longest_side(faces[:, :3]) / side_mm))
    places, triangles = _lattice(parts)
    points = np.einsum("pk,fki->fpi", triangle_values(places), faces)
    return np.asarray(points[:, triangles].reshape(-1, 3, 3))


def _lattice(parts: int) -> tuple[FloatArray, IntArray]:
    """Return barycentric points and triangles of a triangle whose sides have so many parts."""
    pairs = [(i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
    number = {pair: k for k, pair in enumerate(pairs)}
    upright = [((i, j), (i + 1, j), (i, j + 1)) for i, j in pairs if i + j < parts]
    turned = [((i + 1, j), (i + 1, j + 1), (i, j + 1)) for i, j in pairs if i + j < parts - 1]
    triangles = [[number[pair] for pair in three] for three in (*upright, *turned)]
    second, third = np.array(pairs, dtype=np.float64).T / parts
    return np.column_stack([1.0 - second - third, second, third]), np.array(triangles)


def _split(faces: FloatArray) -> FloatArray:
    """Return the four flat triangles (4f, 3, 3) of each face, one face after the other."""
    four = split_faces(np.arange(6)[None])
    return np.asarray(faces[:, four].reshape(-1, 3, 3))


def _facing(
    corners: FloatArray, reach_mm: float
) -> tuple[NDArray[np.bool_], FloatArray, NDArray[np.bool_]]:
    """Tell which triangles have another facing them within reach, the gap, and if it is opposite.

    The gap is that along the normal; what it is of those without another means nothing.
    """
    if len(corners) == 0:
        nothing = np.zeros(0, np.bool_)
        return nothing, np.zeros(0), nothing
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
    gap = np.einsum("ij,ij->i", middles[other] - middles, normals)
    opposite = np.einsum("ij,ij->i", normals, normals[other]) < _OPPOSITE
    return found, gap, opposite


def _longest_side(corners: FloatArray) -> float:
    sides = corners - np.roll(corners, 1, axis=1)
    return float(np.linalg.norm(sides, axis=2).max(initial=0.0))
