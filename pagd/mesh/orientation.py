"""Express named triangles as faces of the tetrahedra, so that they point out of the solid."""

from __future__ import annotations

import numpy as np

from pagd.mesh.topology import row_numbers, unit_normals
from pagd.mesh.types import TET_FACES, FloatArray, IntArray

__all__ = ["as_solid_faces"]


def as_solid_faces(
    points: FloatArray, tets: IntArray, triangles: IntArray
) -> tuple[IntArray, IntArray]:
    """Replace triangles (k, 3 or 6) by the outward faces of ``tets`` (m, 4 or 10).

    A face between two tetrahedra can point either way; all of these are made to point to the
    negative side of the axis that is most nearly normal to them (paper: downwards).

    Returns
    -------
    tuple
        The faces (k', 3 or 6), and the numbers of the triangles that are no face of the solid.
    """
    width = 3 if tets.shape[1] == 4 else 6
    faces = tets[:, TET_FACES[:, :width]].reshape(-1, width)
    keys = np.vstack((faces[:, :3], triangles[:, :3]))
    ids = row_numbers(np.sort(keys, axis=1))
    face_ids, wanted = ids[: len(faces)], ids[len(faces) :]
    candidates = np.flatnonzero(np.isin(face_ids, wanted))
    normals = unit_normals(points, faces[candidates])
    axis = int(np.argmax(np.abs(normals).sum(axis=0)))
    candidates = candidates[np.argsort(normals[:, axis], kind="stable")]
    found, first = np.unique(face_ids[candidates], return_index=True)
    strangers = np.flatnonzero(~np.isin(wanted, found))
    positions = np.searchsorted(found, np.delete(wanted, strangers))
    return faces[candidates[first[positions]]], strangers
