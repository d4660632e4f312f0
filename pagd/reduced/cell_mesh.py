"""Meshes of the parts of a row: cells, and the pieces at its ends and where its chambers change."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pagd.design import Channel, Design
from pagd.errors import InputError
from pagd.mesh.chamber_row import chamber_row, gap_plane
from pagd.mesh.pieces import nodes_on, piece_between
from pagd.mesh.types import FloatArray, IntArray, Mesh

# Nodes nearer than so many mm are at the same place.
_SAME_PLACE = 1e-4

__all__ = ["CellMesh", "cell_mesh", "cut_nodes", "cuts_of"]


@dataclass(frozen=True, eq=False, slots=True)
class CellMesh:
    """A chamber and what there is of the gaps before and behind it; the chamber begins at x = 0.

    mesh: its blocks; with the surface ``symmetry`` it is the half y ≥ 0.
    skew: shear dx/dy of the chamber and of both cuts.
    first, last: the cuts are the planes x = ``first`` + ``skew`` y and x = ``last`` + ``skew`` y.
    length: L of the chamber, in mm.
    left, right: (k,) nodes on both, each pair one pitch apart.
    """

    mesh: Mesh
    skew: float
    first: float
    last: float
    length: float
    left: IntArray
    right: IntArray

    @property
    def pitch(self) -> float:
        """Distance (mm) from cell to cell along x."""
        return self.last - self.first

    def base_at(self, plane: float, height: float) -> IntArray:
        """Nodes (k,) of the base, up to a height (mm), on the plane x = ``plane`` + skew y."""
        nodes = nodes_on(self.mesh.points, plane, self.skew)
        return np.asarray(nodes[self.mesh.points[nodes, 2] <= height + _SAME_PLACE])


def cell_mesh(
    design: Design, channel: Channel, size: float, *, helical: bool, half: bool = False
) -> CellMesh:
    """Mesh a cell of a design as the meshes of its row have it.

    Parameters
    ----------
    design
        A design that passes :func:`pagd.design.check`.
    channel
        The air channel.
    size
        Longest edge of a block, in mm; see :func:`pagd.mesh.chamber_row.chamber_row`.
    helical
        A slanted cell; else a straight one.
    half
        Mesh the half y ≥ 0, of a straight cell.

    Raises
    ------
    InputError
        If the design has no such chambers.
    """
    if helical and not design.skew:
        raise InputError("A design without slanted chambers has no slanted cell.")
    row = replace(design, N=3, alpha=float(helical))
    whole = chamber_row(row, channel, size, half=half)
    start, skew = float(row.chamber_starts()[1]), float(row.chamber_skews()[1])
    first, last = cuts_of(design, size)
    mesh = piece_between(whole, start + first, start + last, skew).mesh
    mesh = replace(mesh, points=mesh.points - [start, 0.0, 0.0])
    left, right = (cut_nodes(mesh.points, place, skew) for place in (first, last))
    return CellMesh(mesh, skew, first, last, design.L, left, right)


def cuts_of(design: Design, size: float) -> tuple[float, float]:
    """Where a chamber is cut off, in mm from where it begins: before it and behind it."""
    behind = gap_plane(design, size)
    return behind - design.t_n, design.L + behind


def cut_nodes(points: FloatArray, place: float, skew: float) -> IntArray:
    """Nodes (k,) on the plane x = ``place`` + ``skew`` y, in the order of their height and width.

    So nodes of two cuts alike come in the same order.
    """
    found = nodes_on(points, place, skew)
    across = np.round(points[found, 1:], 6)
    return np.asarray(found[np.lexsort((across[:, 0], across[:, 1]))])
