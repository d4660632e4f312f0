"""From the parts of a row to the row: where all nodes are when those of its parts are known.

The cell of chamber k is the one before it carried on by a screw motion. Without pieces of their
own at its ends a row begins where its first chamber does: all in front of it is clamped, or so
stiff that it counts as clamped. A straight first chamber turns by a share of what a cell does,
since its wall at the clamp does not bulge. Behind the last chamber the row is rigid, and so is the
wedge where slanted chambers give way to straight ones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from pagd.design import Design
from pagd.errors import InputError
from pagd.mesh.types import Mesh
from pagd.reduced.cell_mesh import CellMesh
from pagd.reduced.shape import CellShape
from pagd.rigid import RigidMotion

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
Shapes = Mapping[bool, CellShape]

__all__ = ["Group", "PieceShape", "Row", "unlike_their_neighbours"]

_SAME_PLACE = 1e-4

# The wall of a straight chamber that is clamped does not bulge: from the clamp to the first cut the
# row turns by about so much of what a cell does. Of random designs this brings the tips nearest to
# the full model's (benchmarks/reduced.py). A slanted chamber's wall is free but for its edge.
_FREE_SHARE = 0.68


def unlike_their_neighbours(design: Design) -> list[tuple[int, int]]:
    """The first and the last chamber, and those where the kind changes.

    Ranges of chambers (first, last), counted from 0, in order; what is adjacent is one range.
    """
    kinds = design.chamber_skews() != 0.0
    alone = {0, design.N - 1}
    for change in np.flatnonzero(kinds[1:] != kinds[:-1]):
        alone |= {int(change), int(change) + 1}
    ranges: list[tuple[int, int]] = []
    for k in sorted(alone):
        if ranges and ranges[-1][1] == k - 1:
            ranges[-1] = (ranges[-1][0], k)
        else:
            ranges.append((k, k))
    return ranges


@dataclass(frozen=True, eq=False, slots=True)
class PieceShape:
    """A solved piece at one pressure.

    mesh: its mesh; its first chamber, number ``first``, begins at x = 0. last: its last chamber.
    displacement: (n, 3) of its nodes in mm, in coordinates of the cell that its first chamber
        would be, or of the clamp.
    place_behind: where the cell of the chamber behind it is carried; none where there is none.
    """

    mesh: Mesh
    first: int
    last: int
    displacement: FloatArray
    place_behind: RigidMotion | None


@dataclass(frozen=True, eq=False, slots=True)
class Group:
    """Points of a row that are nodes of one part: their numbers (k,), the nodes, the sides.

    Of a point at y < 0 that a half part has the mirror image of, the side is −1.
    """

    points: IntArray
    nodes: IntArray
    side: FloatArray


class Row:
    """Nodes of a whole actuator as those of its parts.

    Parameters
    ----------
    design
        The design.
    cells
        Meshes of the cells by whether they are slanted; both for a mixed row.
    points
        Coordinates (n, 3) in mm of nodes of the row's mesh of the same size: all of them, or
        those of a surface; of the whole or, of a straight row, of its half.
    base_height
        Height (mm) up to which the walls of a chamber belong to the base: that of the gaps' floor.

    Raises
    ------
    InputError
        Where a node between two cuts is none of a cell's.
    """

    def __init__(
        self,
        design: Design,
        cells: Mapping[bool, CellMesh],
        points: FloatArray,
        base_height: float,
    ) -> None:
        self.design, self.points = design, points
        self._meshes = dict(cells)
        self._base_height = base_height
        self._kinds = [bool(skew) for skew in design.chamber_skews()]
        self._starts = design.chamber_starts()
        self._cells = [self._within(k) for k in range(len(self._kinds))]
        assigned = np.zeros(len(points), dtype=np.bool_)
        for group in self._cells:
            assigned[group.points] = True
        left = np.flatnonzero(~assigned)
        # What is before the first chamber is clamped and stays.
        behind = self._along(len(self._kinds) - 1)[left] > design.L
        self._behind = left[behind]
        self._wedge = left[~behind & (self._along(0)[left] > design.L)]
        self._pieces: dict[int, Group] = {}

    def _within(self, k: int) -> Group:
        """The points that are nodes of the cell of chamber ``k``."""
        cell, last = self._meshes[self._kinds[k]], len(self._kinds) - 1
        alike_before = k > 0 and self._kinds[k - 1] == self._kinds[k]
        alike_behind = k < last and self._kinds[k + 1] == self._kinds[k]
        low = cell.first if alike_before else 0.0
        high = cell.last if alike_behind else self.design.L
        along = self._along(k)
        inside = (along >= low - _SAME_PLACE) & (along <= high + _SAME_PLACE)
        group = self._matched(inside, k, cell.mesh)
        if alike_before and alike_behind and len(group.points) < np.count_nonzero(inside):
            raise InputError("The nodes of the row are not those of its cells.")
        return group

    def _along(self, k: int) -> FloatArray:
        """Distance (n,) of the points along x behind the plane where chamber ``k`` begins."""
        skew = self._meshes[self._kinds[k]].skew
        return np.asarray(self.points[:, 0] - self._starts[k] - skew * self.points[:, 1])

    def _matched(self, chosen: BoolArray, k: int, mesh: Mesh) -> Group:
        """The points that are ``chosen`` as nodes of a part whose first chamber is ``k``."""
        points = np.flatnonzero(chosen)
        local = self.points[points] - [self._starts[k], 0.0, 0.0]
        side = np.ones(len(points))
        if "symmetry" in mesh.surfaces:
            side[local[:, 1] < -_SAME_PLACE] = -1.0
            local[:, 1] *= side
        distance, nodes = cKDTree(mesh.points).query(local)
        found = distance < _SAME_PLACE
        return Group(points[found], nodes[found], side[found])

    def places(self, shapes: Shapes, pieces: Sequence[PieceShape] = ()) -> list[RigidMotion]:
        """Where the cell of each chamber is carried: motions of the cells' own coordinates.

        The first chamber of a piece at the clamp has the place of the clamp.
        """
        by_last = {piece.last: piece for piece in pieces}
        start = RigidMotion.shift(self._starts[0])
        found = [start @ self._clamped(shapes).inverse()]
        if any(piece.first == 0 for piece in pieces):
            found = [start]
        for k, (before, kind) in enumerate(zip(self._kinds, self._kinds[1:], strict=False), 1):
            piece = by_last.get(k - 1)
            if piece is not None and piece.place_behind is not None:
                found.append(found[piece.first] @ piece.place_behind)
            elif before == kind:
                found.append(found[-1] @ shapes[kind].screw)
            else:
                found.append(found[-1] @ self._over_the_wedge(k, shapes))
        return found

    def _clamped(self, shapes: Shapes) -> RigidMotion:
        """How the base of the first cell has moved where the clamp holds it."""
        kind = self._kinds[0]
        if kind:
            return self._frame(kind, 0.0, shapes)
        cell, screw = self._meshes[kind], shapes[kind].screw
        held = 1.0 - _FREE_SHARE
        return screw.power(held) @ RigidMotion.shift(-held * cell.pitch)

    def _over_the_wedge(self, k: int, shapes: Shapes) -> RigidMotion:
        """The motion from the cell before chamber ``k``, of another kind, to its own."""
        before, kind = self._kinds[k - 1], self._kinds[k]
        behind = self._frame(before, self._meshes[before].last, shapes)
        front = self._frame(kind, self._meshes[kind].first, shapes)
        shift = RigidMotion.shift(self._starts[k] - self._starts[k - 1])
        return behind @ shift @ front.inverse()

    def displacement(self, shapes: Shapes, pieces: Sequence[PieceShape] = ()) -> FloatArray:
        """Displacements (n, 3) in mm of the points when the parts have these shapes."""
        places = self.places(shapes, pieces)
        moved = self.points.copy()
        for place, kind, group in zip(places, self._kinds, self._cells, strict=True):
            mesh = self._meshes[kind].mesh
            moved[group.points] = _carried(place, group, mesh, shapes[kind].displacement)
        self._stiffen(moved, self._behind, self.design.N - 1, self.design.L, places, shapes)
        if len(self._wedge):
            chamber = self.design.N1 - 1
            plane = self._meshes[self._kinds[chamber]].last
            self._stiffen(moved, self._wedge, chamber, plane, places, shapes)
        for piece in pieces:
            group = self.group_of(piece)
            moved[group.points] = _carried(
                places[piece.first], group, piece.mesh, piece.displacement
            )
        return moved - self.points

    def group_of_cell(self, chamber: int) -> Group:
        """The points that are nodes of a chamber's cell."""
        return self._cells[chamber]

    def group_of(self, piece: PieceShape) -> Group:
        """The points that are nodes of a piece."""
        if piece.first not in self._pieces:
            x = self.points[:, 0] - self._starts[piece.first]
            low, high = piece.mesh.points[:, 0].min(), piece.mesh.points[:, 0].max()
            near = (x >= low - _SAME_PLACE) & (x <= high + _SAME_PLACE)
            self._pieces[piece.first] = self._matched(near, piece.first, piece.mesh)
        return self._pieces[piece.first]

    def _stiffen(
        self,
        moved: FloatArray,
        points: IntArray,
        chamber: int,
        plane: float,
        places: list[RigidMotion],
        shapes: Shapes,
    ) -> None:
        """Let points, in place, follow the base of a chamber at a plane across it."""
        frame = places[chamber] @ self._frame(self._kinds[chamber], plane, shapes)
        moved[points] = frame(self.points[points] - [self._starts[chamber], 0.0, 0.0])

    def _frame(self, kind: bool, plane: float, shapes: Shapes) -> RigidMotion:
        """How the base of a cell has moved at a plane across it."""
        cell, shape = self._meshes[kind], shapes[kind]
        points = cell.mesh.points
        nodes = cell.base_at(plane, self._base_height)
        reference, moved = points[nodes], points[nodes] + shape.displacement[nodes]
        if "symmetry" in cell.mesh.surfaces:
            mirror = np.array([1.0, -1.0, 1.0])
            reference = np.vstack([reference, reference * mirror])
            moved = np.vstack([moved, moved * mirror])
        return RigidMotion.of(reference, moved)


def _carried(place: RigidMotion, group: Group, mesh: Mesh, displacement: FloatArray) -> FloatArray:
    """Where nodes of a part are, mirrored at y = 0 where they are on the other side."""
    local = mesh.points[group.nodes] + displacement[group.nodes]
    local[:, 1] *= group.side
    return place(local)
