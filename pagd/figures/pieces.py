"""Triangular pieces of curved six-node faces, which can be divided further."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pagd.fem.shapes import triangle_derivatives, triangle_values

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = ["Pieces"]

# Barycentric coordinates of the middles of the sides: (0,1) (1,2) (2,0).
_MIDDLES = np.array([[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]])
# By so much longer sides are tried where pieces would be too many.
_LONGER = 1.05


@dataclass(frozen=True, eq=False)
class Pieces:
    """Triangles whose corners lie on curved faces.

    faces: (f, 6, 3) nodes in mm, outward, corners before the middles of the sides.
    face: (t,) face of each piece.
    places: (t, 3, 3) barycentric coordinates, on that face, of the piece's corners.
    """

    faces: FloatArray
    face: IntArray
    places: FloatArray

    @classmethod
    def of(cls, faces: FloatArray) -> Pieces:
        """Return the faces (f, 6, 3), each as one piece."""
        return cls(faces, np.arange(len(faces)), np.tile(np.eye(3), (len(faces), 1, 1)))

    def at(self, which: IntArray) -> Pieces:
        """Return some of the pieces, by their numbers."""
        return Pieces(self.faces, self.face[which], self.places[which])

    def divided(self, side_mm: float, most: int) -> Pieces:
        """Return pieces whose sides are no longer than `side_mm`.

        Where these would be more than `most`, their sides are longer; of more pieces than that
        none is divided.
        """
        parts = self._parts(side_mm)
        while (parts**2).sum() > max(most, len(parts)):
            side_mm *= _LONGER
            parts = self._parts(side_mm)
        groups = [self._cut(np.flatnonzero(parts == count), int(count)) for count in set(parts)]
        if not groups:
            return self
        face, places = (np.concatenate(both) for both in zip(*groups, strict=True))
        return Pieces(self.faces, face, places)

    def _parts(self, side_mm: float) -> IntArray:
        """Return into how many parts (t,) the longest side of each piece is to be divided."""
        return np.maximum(np.ceil(self.longest_sides / side_mm), 1.0).astype(np.int64)

    def _cut(self, which: IntArray, parts: int) -> tuple[IntArray, FloatArray]:
        """Return faces and places of the pieces that some consist of, `parts` along each side."""
        inside = _lattice(parts)
        places = np.einsum("sck,tkb->tscb", inside, self.places[which])
        return np.repeat(self.face[which], len(inside)), places.reshape(-1, 3, 3)

    def positions(self, places: FloatArray) -> FloatArray:
        """Return the points (t, 3), one a piece, at places (t, 3) of their faces."""
        return np.asarray(np.einsum("tk,tki->ti", triangle_values(places), self.faces[self.face]))

    def tangents(self, places: FloatArray) -> FloatArray:
        """Return the derivatives (t, 2, 3) by the second and third coordinate at places (t, 3)."""
        slopes = triangle_derivatives(places)
        return np.asarray(np.einsum("tka,tki->tai", slopes, self.faces[self.face]))

    @cached_property
    def corners(self) -> FloatArray:
        """Corners (t, 3, 3)."""
        return np.stack([self.positions(self.places[:, i]) for i in range(3)], axis=1)

    @cached_property
    def middles(self) -> FloatArray:
        """Points (t, 3) on the curved faces in the middle of the pieces."""
        return self.positions(self.places.mean(axis=1))

    @cached_property
    def normals(self) -> FloatArray:
        """Unit normals (t, 3) of the curved faces in the middle of the pieces, outward."""
        tangents = self.tangents(self.places.mean(axis=1))
        normals = np.cross(tangents[:, 0], tangents[:, 1])
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.asarray(normals / np.maximum(lengths, 1e-30))

    @cached_property
    def longest_sides(self) -> FloatArray:
        """Bounds (t,) on the lengths of the curved sides, and of what is parallel to them inside.

        A derivative is linear over a quadratic face: it is longest at a corner.
        """
        sides = (np.roll(self.places, -1, axis=1) - self.places)[:, :, 1:]
        found = np.zeros(len(self.face))
        for i in range(3):
            along = np.einsum("tsa,tai->tsi", sides, self.tangents(self.places[:, i]))
            found = np.maximum(found, np.linalg.norm(along, axis=2).max(axis=1))
        return found

    @cached_property
    def hulls(self) -> FloatArray:
        """Points (t, 6, 3) within whose convex hull a curved piece lies: its Bézier points."""
        corners = self.corners
        between = np.einsum("mc,tcb->tmb", _MIDDLES, self.places)
        middles = np.stack([self.positions(between[:, i]) for i in range(3)], axis=1)
        controls = 2.0 * middles - np.einsum("mc,tci->tmi", _MIDDLES, corners)
        return np.concatenate([corners, controls], axis=1)


def _lattice(parts: int) -> FloatArray:
    """Return corners (parts², 3, 3), barycentric, of the parts of a triangle, of its sense."""
    pairs = [(i, j) for i in range(parts) for j in range(parts - i)]
    upright = [((i, j), (i + 1, j), (i, j + 1)) for i, j in pairs]
    turned = [((i + 1, j), (i + 1, j + 1), (i, j + 1)) for i, j in pairs if i + j < parts - 1]
    second = np.array([*upright, *turned], dtype=np.float64) / parts
    return np.concatenate([1.0 - second.sum(axis=2, keepdims=True), second], axis=2)
