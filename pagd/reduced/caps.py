"""Triangles that close the air channel where a part of a row is cut off."""

from __future__ import annotations

import numpy as np

from pagd.mesh.types import TRI_EDGES, FloatArray, IntArray, Mesh

__all__ = ["Cap"]


class Cap:
    """The cross section of the channel at a cut, as a fan of triangles.

    The fan's centre and the middles of its spokes are points of its own, :attr:`points`.

    Parameters
    ----------
    mesh
        A part of a row, with the surface ``cavity``.
    cut
        Its nodes (k,) on the cut, in the order of :func:`pagd.reduced.cell_mesh.cut_nodes`.
    skew
        Shear dx/dy of the cut.
    centre
        Of the fan; where the rim is no closed loop, on the planes of symmetry that close it.
    """

    def __init__(
        self,
        mesh: Mesh,
        cut: IntArray,
        skew: float = 0.0,
        centre: FloatArray | None = None,
    ) -> None:
        faces = mesh.surfaces["cavity"]
        edges = np.concatenate([faces[:, [*ends, 3 + i]] for i, ends in enumerate(TRI_EDGES)])
        self._rim = edges[np.isin(edges, cut).all(axis=1)]
        self._corners = cut[np.isin(cut, self._rim[:, :2])]
        places = mesh.points[self._corners]
        middle = places.mean(axis=0) if centre is None else centre
        if "symmetry" in mesh.surfaces:
            # On the plane of symmetry, and on the cut.
            middle = middle - middle[1] * np.array([skew, 1.0, 0.0])
        #: The centre, then the middle of each spoke (1 + c, 3), in the order of the cut's nodes.
        self.points: FloatArray = np.vstack([middle, (places + middle) / 2])

    def triangles(self, numbers: IntArray) -> IntArray:
        """Triangles (t, 6) into the cavity, the cap's points having ``numbers`` (1 + c,)."""
        order = np.argsort(self._corners)
        spokes = [
            numbers[1 + order[np.searchsorted(self._corners[order], self._rim[:, end])]]
            for end in (0, 1)
        ]
        centre = np.full(len(self._rim), numbers[0])
        first, second, middle = self._rim.T
        # The cavity's faces go along the rim one way, so that the cap goes the other.
        return np.column_stack([second, first, centre, middle, spokes[0], spokes[1]])
