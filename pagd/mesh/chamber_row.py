"""A row of chambers as blocks between planes: the walls of the design are layers of the mesh.

Planes across the row follow the walls of each chamber, x = a + s y with the chamber's skew s;
horizontal and upright ones follow base, paper, channel, roof, cavity and outside. Between two
planes of equal skew the blocks are parallelepipeds, hexahedra with affine maps. Where the skew
changes (at both ends of slanted chambers, and where helical chambers give way to straight ones)
each block is cut into two wedges, or is one where the planes meet.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from pagd.design import Channel, Design
from pagd.errors import StageFailure, Status
from pagd.mesh.blocks import HEXAHEDRON_TETS, WEDGE_TETS
from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.tagging import name_surfaces
from pagd.mesh.topology import BoolArray
from pagd.mesh.types import FloatArray, IntArray, Mesh

__all__ = ["chamber_row", "gap_plane"]

# Planes nearer than this (mm) are one; a design's sizes are far larger or equal.
_SAME = 1e-6

# A layer is divided so that no part exceeds the size by more than this share of it.
_SLACK = 0.25

# Walls, cavities and gaps are at least so many blocks long: the row bends in the floors of its gaps
# and cavities, and its walls swell as clamped plates. With one block in a wall a mesh is too soft,
# however small its blocks are in the other directions.
_LEAST_BLOCKS = {"wall": 2, "cavity": 2, "gap": 2, "end": 1}

_CORNERS = np.array(list(np.ndindex(2, 2, 2)))


class _Plane(NamedTuple):
    """x = ``x`` + ``skew`` y, and what lies behind it: ``wall``, ``cavity``, ``gap`` or ``end``."""

    x: float
    skew: float
    behind: str


@dataclass(frozen=True, slots=True)
class _Grid:
    """Planes across (nx + 1), their kinds (nx), upright (ny + 1) and horizontal (nz + 1) ones."""

    planes: list[_Plane]
    y: FloatArray
    z: FloatArray

    def points(self) -> FloatArray:
        """Where the planes meet: ((nx + 1)(ny + 1)(nz + 1), 3)."""
        x = np.array([plane.x for plane in self.planes])
        skew = np.array([plane.skew for plane in self.planes])
        i, j, k = np.indices((len(x), len(self.y), len(self.z)))
        places = (x[i] + skew[i] * self.y[j], self.y[j], self.z[k])
        return np.stack(places, axis=-1).reshape(-1, 3)


def chamber_row(design: Design, channel: Channel, size: float, *, half: bool = False) -> Mesh:
    """Mesh a design with hexahedra and wedges of edges up to about ``size`` (mm).

    Parameters
    ----------
    design
        A design that passes :func:`pagd.design.check`.
    channel
        The air channel.
    size
        Longest edge of a block. Along the row walls, cavities and gaps are two blocks at least.
    half
        Mesh the half y ≥ 0 of a straight design.

    Raises
    ------
    StageFailure
        ``mesh_failed`` where the blocks do not make an actuator.
    """
    if half and not design.is_straight:
        raise StageFailure(Status.mesh_failed, "Half of a slanted row has no plane of symmetry.")
    grid = _grid(design, channel, size, half)
    solid = _solid(design, channel, grid)
    points, numbers = _merged(grid)
    six, three = _blocks(points, numbers, solid)
    tets = np.vstack([six.reshape(-1, 4), three.reshape(-1, 4)])
    surfaces = name_surfaces(points, tets, -design.t_b / 2, half, _SAME)
    return quadratic_mesh(points, tets, surfaces, hexahedra=len(six), wedges=len(three))


def _grid(design: Design, channel: Channel, size: float, half: bool) -> _Grid:
    inside, outside = design.W / 2 - design.t, design.W / 2
    upright = [0.0, channel.width / 2, inside, outside]
    if not half:
        upright = [-y for y in upright[1:]] + upright[1:]
    horizontal = [
        -design.t_b,
        -design.t_b / 2,
        0.0,
        channel.height,
        channel.gap_floor,
        design.H - design.t_h,
        design.H,
    ]
    return _Grid(_planes(design, size), _divided(upright, size), _divided(horizontal, size))


def _planes(design: Design, size: float) -> list[_Plane]:
    """All planes across, those that divide layers included."""
    marks = [_Plane(0.0, 0.0, "end")]
    chambers = zip(
        design.chamber_starts(), design.chamber_skews(), design.end_wall_lengths(), strict=True
    )
    for start, skew, wall in chambers:
        end = start + design.L
        marks += [
            _Plane(start, skew, "wall"),
            _Plane(start + wall, skew, "cavity"),
            _Plane(end - wall, skew, "wall"),
            _Plane(end, skew, "gap"),
        ]
    marks[-1] = marks[-1]._replace(behind="end")
    marks.append(_Plane(design.L_T, 0.0, "end"))
    planes = [marks[0]]
    for before, after in pairwise(marks):
        length = after.x - before.x
        if length < _SAME:
            # No slanted chamber: the row ends where its chambers do.
            planes[-1] = after
            continue
        parts = max(_parts(length, size), _LEAST_BLOCKS[before.behind])
        shares = np.arange(1, parts + 1) / parts
        planes += [
            _Plane(
                before.x + share * length,
                before.skew + share * (after.skew - before.skew),
                before.behind if share < 1 else after.behind,
            )
            for share in shares
        ]
    return planes


def gap_plane(design: Design, size: float) -> float:
    """Distance (mm) behind a chamber of that plane of a row's mesh in the gap that halves it best.

    Parameters
    ----------
    design, size
        As of :func:`chamber_row`.
    """
    parts = max(_parts(design.t_n, size), _LEAST_BLOCKS["gap"])
    return design.t_n * (parts // 2) / parts


def _parts(length: float, size: float) -> int:
    # Differences of places have round-off: equal lengths must have equal parts.
    return max(1, math.ceil(length / size - _SLACK - _SAME))


def _divided(marks: Sequence[float], size: float) -> FloatArray:
    """The marks in order, and what divides the layers between them evenly."""
    places = [min(marks)]
    for mark in sorted(marks):
        length = mark - places[-1]
        if length > _SAME:
            parts = _parts(length, size)
            places += [places[-1] + length * part / parts for part in range(1, parts)] + [mark]
    return np.array(places)


def _solid(design: Design, channel: Channel, grid: _Grid) -> BoolArray:
    """Which of the blocks (nx, ny, nz) are elastomer."""
    behind = np.array([plane.behind for plane in grid.planes[:-1]])[:, None, None]
    y = np.abs(grid.y[:-1] + grid.y[1:])[None, :, None] / 2
    z = (grid.z[:-1] + grid.z[1:])[None, None, :] / 2
    in_chamber = (behind == "wall") | (behind == "cavity")
    cavity = (behind == "cavity") & (y < design.W / 2 - design.t) & (z < design.H - design.t_h)
    between = np.flatnonzero(behind.ravel() == "cavity")
    place = np.arange(len(behind))[:, None, None]
    along = (place >= between[0]) & (place <= between[-1])
    air = along & (y < channel.width / 2) & (z < channel.height)
    chamber = (in_chamber | (z < channel.gap_floor)) & ~cavity & ~air
    return np.asarray(np.where(z < 0, True, chamber), dtype=np.bool_)


def _merged(grid: _Grid) -> tuple[FloatArray, IntArray]:
    """Points, and their numbers (nx + 1, ny + 1, nz + 1): one where planes of two skews meet."""
    points = grid.points()
    keys = np.round(points / _SAME).astype(np.int64)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    shape = (len(grid.planes), len(grid.y), len(grid.z))
    return points, np.asarray(first[inverse.ravel()].reshape(shape))


def _blocks(points: FloatArray, numbers: IntArray, solid: BoolArray) -> tuple[IntArray, IntArray]:
    """Tetrahedra (k, 6, 4) of the hexahedra and (m, 3, 4) of the wedges."""
    lowest = np.argwhere(solid)
    at = lowest[:, None, :] + _CORNERS
    corners = numbers[at[..., 0], at[..., 1], at[..., 2]]
    low = points[corners]
    front, back = low[:, 4] - low[:, 0], low[:, 6] - low[:, 2]
    is_block = np.linalg.norm(front - back, axis=1) < _SAME
    meets_front = np.linalg.norm(front, axis=1) < _SAME
    meets_back = np.linalg.norm(back, axis=1) < _SAME
    # Of a wedge the corners 0, 2, 6 or 0, 4, 6 at the bottom, and those above them.
    left, right = corners[:, [0, 6, 2, 1, 7, 3]], corners[:, [0, 4, 6, 1, 5, 7]]
    hexahedra = corners[is_block]
    wedges = [
        (left[~is_block & ~meets_back], WEDGE_TETS[1]),
        (right[~is_block & ~meets_front], WEDGE_TETS[0]),
    ]
    corner_numbers = np.array([0, 2, 6, 8, 18, 20, 24, 26])
    six = _cut(hexahedra, HEXAHEDRON_TETS, corner_numbers)
    three = [_cut(nodes, table, np.array([0, 1, 2, 12, 13, 14])) for nodes, table in wedges]
    return six, np.concatenate(three)


def _cut(corners: IntArray, table: IntArray, corner_numbers: IntArray) -> IntArray:
    """Linear tetrahedra (k, T, 4) of blocks with ``corners`` (k, c) by a table (T, 10)."""
    among = np.searchsorted(corner_numbers, table[:, :4])
    return np.asarray(corners[:, among])
