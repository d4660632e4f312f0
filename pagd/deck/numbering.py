"""Node and face numbers of Abaqus' ten-node tetrahedron, which CalculiX shares."""

from __future__ import annotations

import numpy as np

from pagd.errors import InputError
from pagd.mesh.topology import row_numbers
from pagd.mesh.types import IntArray

__all__ = ["DECK_FACES", "DECK_ORDER", "face_numbers"]

#: Our local node at each place of the deck's tetrahedron: there the edges come in the order
#: (1,2) (2,3) (3,1) (1,4) (2,4) (3,4), gmsh has the last two the other way round.
DECK_ORDER: IntArray = np.array([0, 1, 2, 3, 4, 5, 6, 7, 9, 8], dtype=np.int64)
#: Corners, counted from 0, of the deck's faces S1 … S4: 1-2-3, 1-4-2, 2-4-3, 3-4-1.
DECK_FACES: IntArray = np.array([(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)], dtype=np.int64)


def face_numbers(tets: IntArray, faces: IntArray) -> tuple[IntArray, IntArray]:
    """Which face of which tetrahedron each triangle is.

    Parameters
    ----------
    tets
        (m, 10) nodes of the tetrahedra.
    faces
        (k, 6) nodes of triangles on the boundary.

    Returns
    -------
    tuple
        Numbers (k,) of the tetrahedra, from 0, and of the face, 1 … 4 as in :data:`DECK_FACES`.

    Raises
    ------
    InputError
        If a triangle is no face of the solid.
    """
    corners = tets[:, DECK_FACES].reshape(-1, 3)
    rows = row_numbers(np.sort(np.vstack((corners, faces[:, :3])), axis=1))
    known, wanted = rows[: len(corners)], rows[len(corners) :]
    order = np.argsort(known, kind="stable")
    found = np.searchsorted(known, wanted, sorter=order)
    places = order[np.minimum(found, len(order) - 1)]
    if (known[places] != wanted).any():
        raise InputError("The loaded surface has triangles that are no faces of the tetrahedra.")
    return places // 4, places % 4 + 1
