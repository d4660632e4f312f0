"""Deformed cells: at one pressure, and along a path."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from pagd.fem.dense_output import unknowns_at
from pagd.fem.screw import ScrewTie
from pagd.reduced.cell_mesh import CellMesh
from pagd.rigid import RigidMotion

FloatArray = NDArray[np.float64]

__all__ = ["CellPath", "CellShape", "around", "between"]

# Shapes between recorded ones are those of a polynomial through so many of them.
_AROUND = 4


def around(known: Sequence[float] | FloatArray, place: float) -> slice:
    """The four of the ``known`` places, which rise, that are around a place."""
    first = bisect(known, place) - _AROUND // 2
    first = max(min(first, len(known) - _AROUND), 0)
    return slice(first, first + _AROUND)


def between(known: FloatArray, values: FloatArray, place: float) -> FloatArray:
    """Values at a place, of the polynomial through the four around it; values (p, …)."""
    some = around(known, place)
    return unknowns_at(list(values[some]), [float(k) for k in known[some]], place)


@dataclass(frozen=True, eq=False, slots=True)
class CellShape:
    """The deformed cell of one kind at one pressure.

    displacement: (n, 3) of its mesh's nodes, in mm.
    screw: the motion that carries it into the next cell.
    """

    displacement: FloatArray
    screw: RigidMotion


@dataclass(frozen=True, eq=False, slots=True)
class CellPath:
    """Shapes at rising pressures.

    pressure_kPa: (p,) pressures, 0 first.
    displacement: (p, n, 3) of the nodes of the cell's mesh, in mm.
    motion: (p, 2, 3) rotation vectors and displacements of the screw motion.
    tie: what the motion is of.
    """

    pressure_kPa: FloatArray
    displacement: FloatArray
    motion: FloatArray
    tie: ScrewTie

    def at(self, pressure_kPa: float) -> CellShape:
        """The shape at a pressure, between the recorded ones by a polynomial through four."""
        screw = self.tie.rigid(*between(self.pressure_kPa, self.motion, pressure_kPa))
        return CellShape(between(self.pressure_kPa, self.displacement, pressure_kPa), screw)

    def unfolded(self, half: CellMesh, whole: CellMesh) -> CellPath:
        """The same of a whole cell, where this one is of the half y ≥ 0."""
        points = whole.mesh.points.copy()
        points[:, 1] = np.abs(points[:, 1])
        _, node = cKDTree(half.mesh.points).query(points)
        displacement = self.displacement[:, node]
        displacement[:, whole.mesh.points[:, 1] < 0, 1] *= -1.0
        return CellPath(self.pressure_kPa, displacement, self.motion, self.tie)
