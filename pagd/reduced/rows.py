"""Rows of three unknowns, those of a mesh's nodes first."""

from __future__ import annotations

import numpy as np

from pagd.mesh.types import FloatArray, IntArray

__all__ = ["Rows"]


class Rows:
    """Collects rows that are added to the nodes of a mesh.

    Parameters
    ----------
    points
        Coordinates (n, 3) in mm of the mesh's nodes.
    """

    def __init__(self, points: FloatArray) -> None:
        self._parts = [points]
        #: How many there are.
        self.count = len(points)

    def add(self, points: FloatArray) -> IntArray:
        """Return the numbers (k,) of new rows at ``points`` (k, 3)."""
        numbers = np.arange(self.count, self.count + len(points))
        self._parts.append(points)
        self.count += len(points)
        return numbers

    def points(self) -> FloatArray:
        """Coordinates (m, 3) of all."""
        return np.vstack(self._parts)
