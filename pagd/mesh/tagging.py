"""Name the surfaces of an actuator's mesh from its geometry alone, whoever made the mesh."""

from __future__ import annotations

import numpy as np

from pagd.errors import StageFailure, Status
from pagd.mesh.topology import (
    BoolArray,
    boundary_faces,
    components,
    edge_neighbours,
    interface_faces,
    unit_normals,
)
from pagd.mesh.types import FloatArray, IntArray

#: A face counts as lying on a plane if its normal is this near the plane's (cosine).
_PARALLEL = 0.9


def name_surfaces(
    points: FloatArray, tets: IntArray, plane_z: float, half: bool, tolerance: float
) -> dict[str, IntArray]:
    """Return the named triangles (k, 3) of linear tetrahedra (m, 4).

    ``paper``: the faces between the tetrahedra above and below z = `plane_z`.
    ``symmetry``: faces on y = 0, if `half`. ``cavity``: every connected piece of the remaining
    boundary other than the outside, which is the piece with the largest extent. ``fixed`` and
    ``tip``: faces of the outside on the planes of smallest and largest x. ``outer``: the rest.
    Raises StageFailure(mesh_failed) if a mandatory one is empty or the paper is not flat.
    """
    faces = boundary_faces(tets)
    normals = unit_normals(points, faces)

    def on_plane(axis: int, value: float, sign: float) -> BoolArray:
        near = (np.abs(points[faces][:, :, axis] - value) <= tolerance).all(axis=1)
        return np.asarray(near & (sign * normals[:, axis] > _PARALLEL))

    symmetry = on_plane(1, 0.0, -1.0) & half
    outside = _outside(points, faces, ~symmetry)
    x = points[faces][:, :, 0]
    fixed = outside & on_plane(0, float(x.min()), -1.0)
    tip = outside & on_plane(0, float(x.max()), 1.0)
    paper = interface_faces(tets, points[tets].mean(axis=1)[:, 2] > plane_z)
    _check_flat(points, paper, plane_z, tolerance)
    named = {
        "fixed": faces[fixed],
        "cavity": faces[~symmetry & ~outside],
        "paper": paper,
        "tip": faces[tip],
        "outer": faces[outside & ~fixed & ~tip],
    }
    if half:
        named["symmetry"] = faces[symmetry]
    _check_all_there(named)
    return named


def _check_all_there(named: dict[str, IntArray]) -> None:
    if len(named["cavity"]) == 0:
        raise StageFailure(
            Status.mesh_failed,
            "The solid has no cavity: there is no surface apart from the outside, "
            "so either it is not hollow or the air can get out.",
        )
    missing = [name for name, triangles in named.items() if len(triangles) == 0]
    if missing:
        raise StageFailure(
            Status.mesh_failed, f"The mesh has no face on surface {' or '.join(missing)}."
        )


def _outside(points: FloatArray, faces: IntArray, wanted: BoolArray) -> BoolArray:
    """Return which of the `wanted` faces belong to the connected piece of largest extent."""
    index = np.flatnonzero(wanted)
    labels = components(edge_neighbours(faces[index]), len(index))
    extents = [
        float(np.linalg.norm(np.ptp(points[faces[index[labels == k]]].reshape(-1, 3), axis=0)))
        for k in range(int(labels.max()) + 1)
    ]
    mask = np.zeros(len(faces), dtype=np.bool_)
    mask[index[labels == int(np.argmax(extents))]] = True
    return mask


def _check_flat(points: FloatArray, paper: IntArray, plane_z: float, tolerance: float) -> None:
    if len(paper) == 0:
        return
    away = float(np.abs(points[paper][:, :, 2] - plane_z).max())
    if away > tolerance:
        raise StageFailure(
            Status.mesh_failed,
            f"The mesh does not conform to the paper plane: nodes lie up to {away:.3g} mm off it.",
        )
