"""Chambers that are not like their neighbours: the first, the last, and where the kind changes.

Beyond a cut there are cells, whose shapes are given at every pressure. A cut at the left has that
shape where it is. A cut at the right is carried to where it bears no force beyond the air's: by a
screw motion, which is unknown.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.body import facing_walls
from pagd.actuation.settings import Actuation
from pagd.fem.contact import ContactLaw
from pagd.fem.screw import ScrewTie
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import IntArray, Mesh
from pagd.reduced.caps import Cap
from pagd.reduced.cell import seen_from_left
from pagd.reduced.cell_mesh import CellMesh, cut_nodes
from pagd.reduced.rows import Rows
from pagd.reduced.segment import Beyond, Segment, paper_along
from pagd.reduced.shape import CellShape
from pagd.rigid import RigidMotion

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

__all__ = ["Behind", "Piece"]


@dataclass(frozen=True, eq=False, slots=True)
class Behind:
    """The cells behind a piece: the chamber of the first one begins at ``start`` (mm)."""

    cell: CellMesh
    start: float


class Piece(Segment):
    """One chamber or two between a clamp, cells and nothing.

    Parameters
    ----------
    mesh
        The piece; its first chamber begins at x = 0. What it has of the surface ``fixed`` is held.
    before
        The cells before it, if there are any; the chamber of the last one begins one pitch before
        that of the piece.
    behind
        The cells behind it, if there are any.
    material, paper, actuation, law
        See :class:`Segment`.
    """

    def __init__(
        self,
        mesh: Mesh,
        before: CellMesh | None,
        behind: Behind | None,
        material: Elastomer,
        paper: Sheet,
        actuation: Actuation | None = None,
        law: ContactLaw | None = None,
    ) -> None:
        self.before, self.behind = before, behind
        rows = Rows(mesh.points)
        left, left_caps = self._look_back(mesh, rows) if before else (None, _NO_CAPS)
        right, right_caps, tied = self._look_on(mesh, rows) if behind else (None, _NO_CAPS, None)
        points = rows.points()
        tie = None if tied is None else ScrewTie(points, *tied, self._motion)
        super().__init__(
            mesh,
            points,
            np.vstack([left_caps, right_caps]),
            left,
            right,
            self._held(mesh, points),
            tie,
            material,
            paper,
            actuation,
            law,
        )

    def _look_back(self, mesh: Mesh, rows: Rows) -> tuple[Beyond, IntArray]:
        """What is seen of the cells before, whose shape is given, and the cap of the cut."""
        cell = self.before
        assert cell is not None
        self._cut = cut_nodes(mesh.points, cell.first, cell.skew)
        cap = Cap(mesh, self._cut, cell.skew)
        cap_points = rows.add(cap.points)
        self._near, walls, column = _seen_from_right(cell)
        self._images = rows.add(cell.mesh.points[self._near] - [cell.pitch, 0.0, 0.0])
        self._held_rows = np.concatenate([self._cut, cap_points, self._images])
        image = np.full(len(cell.mesh.points), -1, np.int64)
        image[cell.right], image[self._near] = self._cut, self._images
        return Beyond(image[walls], image[column]), cap.triangles(cap_points)

    def _look_on(
        self, mesh: Mesh, rows: Rows
    ) -> tuple[Beyond, IntArray, tuple[IntArray, IntArray]]:
        """What is seen of the cells behind, the cap of the cut, and who follows whom."""
        behind = self.behind
        assert behind is not None
        cell = behind.cell
        cut = cut_nodes(mesh.points, behind.start + cell.first, cell.skew)
        cap = Cap(mesh, cut, cell.skew)
        cap_points = rows.add(cap.points)
        near, walls, column = seen_from_left(cell)
        images = rows.add(cell.mesh.points[near] + [behind.start, 0.0, 0.0])
        slaves = np.concatenate([cut, cap_points, images])
        # Nodes of the cell that have the shape to follow; what spans the cap keeps its place.
        self._sources = np.concatenate([cell.left, np.full(len(cap_points), -1), near])
        self._given = rows.add(rows.points()[slaves])
        self._motion = int(rows.add(np.zeros((2, 3)))[0])
        image = np.full(len(cell.mesh.points), -1, np.int64)
        image[cell.left], image[near] = cut, images
        return Beyond(image[walls], image[column]), cap.triangles(cap_points), (slaves, self._given)

    def _held(self, mesh: Mesh, points: FloatArray) -> BoolArray:
        fixed = np.zeros(points.shape, dtype=np.bool_)
        if self.before is None:
            fixed[mesh.nodes_of("fixed")] = True
        else:
            fixed[self._held_rows] = True
        if self.behind is not None:
            fixed[self._given] = True
        if "symmetry" in mesh.surfaces:
            fixed[mesh.nodes_of("symmetry"), 1] = True
            if self.behind is not None:
                fixed[self._motion, [0, 2]] = fixed[self._motion + 1, 1] = True
        return fixed

    def prescribe(
        self, before: CellShape | None, behind: CellShape | None, unknowns: FloatArray
    ) -> None:
        """Give both cuts, in place, the shapes of the cells beyond them."""
        rows = unknowns.reshape(-1, 3)
        if self.before is not None and before is not None:
            rows[self._cut] = before.displacement[self.before.left]
            moved = self.before.mesh.points[self._near] + before.displacement[self._near]
            rows[self._images] = before.screw.inverse()(moved) - self.points[self._images]
        if self.behind is not None and behind is not None:
            found = behind.displacement[self._sources]
            rows[self._given] = np.where(self._sources[:, None] < 0, 0.0, found)

    def place_behind(self, rows: FloatArray) -> RigidMotion:
        """Where the first cell behind is carried, its own coordinates, by solved ``rows``."""
        assert self.tie is not None
        assert self.behind is not None
        motion = rows[self.tie.motion], rows[self.tie.motion + 1]
        return self.tie.rigid(*motion) @ RigidMotion.shift(self.behind.start)


_NO_CAPS: IntArray = np.zeros((0, 6), np.int64)


def _seen_from_right(cell: CellMesh) -> tuple[IntArray, IntArray, IntArray]:
    """What the neighbour behind a cell sees of it, beside the cut between them.

    Nodes (k,), faces (w, 6) of the wall and faces (c, 6) of the paper.
    """
    walls, _ = facing_walls(cell.mesh)
    column = paper_along(cell.mesh, cell.right)
    nodes = np.unique(np.concatenate([walls.ravel(), column.ravel()]))
    return np.setdiff1d(nodes, cell.right), walls, column
