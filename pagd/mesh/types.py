"""The mesh every stage after meshing works on: quadratic tetrahedra with named surfaces.

They may come as blocks, of which a solver makes hexahedra and wedges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Corner pairs that nodes 4…9 of a ten-node tetrahedron halve (gmsh's order).
TET_EDGES: IntArray = np.array([(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)], dtype=np.int64)
#: Corner pairs that nodes 3…5 of a six-node triangle halve (gmsh's order).
TRI_EDGES: IntArray = np.array([(0, 1), (1, 2), (2, 0)], dtype=np.int64)
#: Local nodes of the four faces of a ten-node tetrahedron as outward six-node triangles.
TET_FACES: IntArray = np.array(
    [(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 9, 7), (0, 3, 2, 7, 8, 6), (1, 2, 3, 5, 8, 9)],
    dtype=np.int64,
)


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Mesh:
    """Ten-node tetrahedra and the named six-node triangles on and in them.

    points: (n, 3) coordinates in mm.
    tets: (m, 10) node numbers, corners first, then edge nodes in the order of TET_EDGES;
        positive volume.
    surfaces: name -> (k, 6) node numbers, corners first, then edge nodes in the order of
        TRI_EDGES. Faces on the boundary point out of the solid (those of the cavity into the
        cavity); those of an internal surface (the paper) all point to the same side.

    hexahedra, wedges: how many of the tetrahedra come as blocks: six on end make up each of the
        hexahedra, three each of the wedges behind them (:mod:`pagd.mesh.blocks`); 0 where the
        tetrahedra are not arranged so.

    An actuator has ``fixed``, ``cavity`` and mostly ``paper``, ``tip``, ``outer`` and, as a
    half model, ``symmetry``.
    """

    points: FloatArray
    tets: IntArray
    surfaces: dict[str, IntArray]
    hexahedra: int = 0
    wedges: int = 0

    def nodes_of(self, name: str) -> IntArray:
        """Return the sorted node numbers (k,) of surface `name`; InputError if there is none."""
        if name not in self.surfaces:
            found = ", ".join(sorted(self.surfaces)) or "none"
            raise InputError(f"The mesh has no surface '{name}'; it has: {found}.")
        return np.unique(self.surfaces[name])

    def check(self) -> None:
        """Raise InputError unless arrays, numbering and orientation are as documented."""
        _check_array("points", self.points, 3, np.float64)
        _check_array("tets", self.tets, 10, np.int64)
        for name, faces in self.surfaces.items():
            _check_array(f"surfaces['{name}']", faces, 6, np.int64)
            _check_numbers(f"surfaces['{name}']", faces, len(self.points))
        _check_numbers("tets", self.tets, len(self.points))
        _check_finite(self.points)
        _check_orphans(self.tets, len(self.points))
        _check_orientation(self.points, self.tets)


def corner_volumes(points: FloatArray, tets: IntArray) -> FloatArray:
    """Return the signed volumes (m,) in mm³ of the tetrahedra spanned by the corner nodes."""
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    return np.asarray(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0)


def _check_array(name: str, array: NDArray[np.generic], columns: int, dtype: type) -> None:
    if array.ndim != 2 or array.shape[1] != columns or array.dtype != dtype:
        raise InputError(
            f"Mesh {name} must be a (n, {columns}) array of {np.dtype(dtype)}, "
            f"got {array.shape} of {array.dtype}."
        )
    if len(array) == 0:
        raise InputError(f"Mesh {name} is empty.")


def _check_numbers(name: str, numbers: IntArray, n_points: int) -> None:
    if numbers.min() < 0 or numbers.max() >= n_points:
        raise InputError(
            f"Mesh {name} refers to nodes {numbers.min()}…{numbers.max()}, "
            f"outside 0…{n_points - 1}."
        )


def _check_finite(points: FloatArray) -> None:
    if not np.isfinite(points).all():
        raise InputError("Mesh points hold coordinates that are not finite.")


def _check_orphans(tets: IntArray, n_points: int) -> None:
    orphans = n_points - len(np.unique(tets))
    if orphans:
        raise InputError(f"The mesh has {orphans} nodes that belong to no tetrahedron.")


def _check_orientation(points: FloatArray, tets: IntArray) -> None:
    inverted = int(np.count_nonzero(corner_volumes(points, tets) <= 0.0))
    if inverted:
        raise InputError(f"The mesh has {inverted} inverted or flat tetrahedra.")
