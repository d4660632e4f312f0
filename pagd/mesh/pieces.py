"""Pieces of a mesh of blocks, cut along its own planes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pagd.errors import InputError
from pagd.mesh.types import FloatArray, IntArray, Mesh

__all__ = ["Piece", "nodes_on", "piece_between"]

# Distance (mm) up to which a node lies on a plane.
_SAME_PLACE = 1e-5


@dataclass(frozen=True, eq=False, slots=True)
class Piece:
    """A part of a mesh.

    mesh: its blocks, and the faces of the surfaces that it has.
    numbers: (n,) numbers of its nodes in the whole mesh, rising.
    """

    mesh: Mesh
    numbers: IntArray


def piece_between(
    mesh: Mesh, first: float, last: float, skew: float = 0.0, last_skew: float | None = None
) -> Piece:
    """Return the blocks between the planes x = `first` + `skew` y and x = `last` + `last_skew` y.

    The second plane is parallel to the first one unless it has a skew of its own; either may be
    infinitely far. Surfaces that the piece has nothing of are left out. InputError where the mesh
    has no planes there, or is not one of blocks.
    """
    six, three = 6 * mesh.hexahedra, 3 * mesh.wedges
    if not six or six + three != len(mesh.tets):
        raise InputError("Only a mesh of blocks, of the mesher 'structured', has planes to cut at.")
    hexahedra = mesh.tets[:six].reshape(-1, 6, 10)
    wedges = mesh.tets[six:].reshape(-1, 3, 10)
    x, y = mesh.points[:, 0], mesh.points[:, 1]
    behind = x - skew * y - first
    before = last - x + (skew if last_skew is None else last_skew) * y

    def within(blocks: IntArray) -> IntArray:
        inside = [distance[blocks].mean(axis=(1, 2)) > 0 for distance in (behind, before)]
        return np.asarray(blocks[inside[0] & inside[1]])

    inside_six, inside_three = within(hexahedra), within(wedges)
    tets = np.vstack([inside_six.reshape(-1, 10), inside_three.reshape(-1, 10)])
    numbers = np.unique(tets)
    gaps = [d[numbers].min(initial=np.inf) for d in (behind, before) if np.isfinite(d).all()]
    if len(numbers) == 0 or any(abs(gap) > _SAME_PLACE for gap in gaps):
        raise InputError(f"The mesh has no planes at x = {first:g} and {last:g} mm to cut it at.")
    renumbered = np.full(len(mesh.points), -1, dtype=np.int64)
    renumbered[numbers] = np.arange(len(numbers))
    surfaces = {
        name: renumbered[faces[(renumbered[faces] >= 0).all(axis=1)]]
        for name, faces in mesh.surfaces.items()
    }
    piece = Mesh(
        points=mesh.points[numbers],
        tets=renumbered[tets],
        surfaces={name: faces for name, faces in surfaces.items() if len(faces)},
        hexahedra=len(inside_six),
        wedges=len(inside_three),
    )
    return Piece(piece, numbers)


def nodes_on(points: FloatArray, place: float, skew: float = 0.0) -> IntArray:
    """Return the numbers (k,) of the points (n, 3) on the plane x = `place` + `skew` y."""
    along = points[:, 0] - skew * points[:, 1]
    return np.flatnonzero(np.abs(along - place) < _SAME_PLACE)
