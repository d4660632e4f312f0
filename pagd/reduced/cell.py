"""One chamber of an endless row as a finite-element model.

Under uniform pressure all cells of a long row deform alike but for a screw motion, which is
unknown: the right cut of a cell is where that motion carries its left one, and so are the
neighbour's wall and paper.
"""

from __future__ import annotations

import numpy as np

from pagd.actuation.body import facing_walls
from pagd.actuation.settings import Actuation
from pagd.fem.contact import ContactLaw
from pagd.fem.screw import ScrewTie
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import IntArray
from pagd.reduced.caps import Cap
from pagd.reduced.cell_mesh import CellMesh
from pagd.reduced.rows import Rows
from pagd.reduced.segment import Beyond, Segment, paper_along

__all__ = ["Cell", "seen_from_left"]


def seen_from_left(cell: CellMesh) -> tuple[IntArray, IntArray, IntArray]:
    """What the neighbour before a cell sees of it, beside the cut between them.

    Nodes (k,), faces (w, 6) of the wall and faces (c, 6) of the paper.
    """
    _, walls = facing_walls(cell.mesh)
    column = paper_along(cell.mesh, cell.left)
    nodes = np.unique(np.concatenate([walls.ravel(), column.ravel()]))
    return np.setdiff1d(nodes, cell.left), walls, column


class Cell(Segment):
    """A cell, with everything beyond it an image of itself.

    Parameters
    ----------
    cell
        The mesh.
    material, paper, actuation, law
        See :class:`Segment`.
    """

    def __init__(
        self,
        cell: CellMesh,
        material: Elastomer,
        paper: Sheet,
        actuation: Actuation | None = None,
        law: ContactLaw | None = None,
    ) -> None:
        self.cell = cell
        mesh, pitch = cell.mesh, np.array([cell.pitch, 0.0, 0.0])
        rows = Rows(mesh.points)
        left_cap, right_cap = (Cap(mesh, cut, cell.skew) for cut in (cell.left, cell.right))
        left_points, right_points = rows.add(left_cap.points), rows.add(right_cap.points)
        near, walls, column = seen_from_left(cell)
        images = rows.add(mesh.points[near] + pitch)
        motion = int(rows.add(np.zeros((2, 3)))[0])
        points = rows.points()
        slaves = np.concatenate([cell.right, right_points, images])
        masters = np.concatenate([cell.left, left_points, near])
        image = np.full(rows.count, -1, np.int64)
        image[masters] = slaves
        fixed = np.zeros(points.shape, dtype=np.bool_)
        fixed[left_points] = True
        self._hold(fixed, motion)
        super().__init__(
            mesh,
            points,
            np.vstack([left_cap.triangles(left_points), right_cap.triangles(right_points)]),
            None,
            Beyond(image[walls], image[column]),
            fixed,
            ScrewTie(points, slaves, masters, motion),
            material,
            paper,
            actuation,
            law,
        )

    def _hold(self, fixed: np.ndarray, motion: int) -> None:
        """Hold what symmetry does, and what a rigid motion of all would be: no force is needed."""
        mesh = self.cell.mesh
        lowest, across, highest = self._pins()
        if "symmetry" in mesh.surfaces:
            fixed[mesh.nodes_of("symmetry"), 1] = True
            fixed[lowest, [0, 2]] = fixed[highest, 0] = True
            fixed[motion, [0, 2]] = fixed[motion + 1, 1] = True
        else:
            fixed[lowest] = True
            fixed[across, [0, 2]] = fixed[highest, 0] = True

    def _pins(self) -> tuple[int, int, int]:
        """Nodes of the left cut: its lowest ones at both sides, and one of the highest."""
        left, places = self.cell.left, self.cell.mesh.points[self.cell.left]
        heights = places[:, 2]
        low = np.flatnonzero(heights < heights.min() + 1e-6)
        first, second = low[places[low, 1].argmin()], low[places[low, 1].argmax()]
        return int(left[first]), int(left[second]), int(left[heights.argmax()])
