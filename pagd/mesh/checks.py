"""What a mesh must be for an actuator to be solved on it, said in words a user can act on."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from pagd.errors import InputError
from pagd.mesh.blocks import check_blocks
from pagd.mesh.quality import node_jacobians
from pagd.mesh.topology import boundary_faces, components, open_edges, row_numbers, shared_faces
from pagd.mesh.types import FloatArray, IntArray, Mesh, corner_volumes

__all__ = ["EXTENT_MM", "REQUIRED", "SURFACES", "check_actuator", "check_volumes", "require_names"]

#: The surface names pagd knows.
SURFACES = ("fixed", "cavity", "paper", "tip", "outer", "symmetry")
#: Without these there is nothing to hold and nothing to inflate.
REQUIRED = ("fixed", "cavity")
#: Planes may be off by this share of the mesh's extent.
_FLATNESS = 1e-6
#: Lengths are in mm: an actuator this short (or long) was surely drawn in another unit.
#: Lengths in mm that an actuator may have: others are in another unit.
EXTENT_MM = (1.0, 1e5)


def check_actuator(mesh: Mesh) -> None:
    """Raise InputError with one sentence unless ``mesh`` is that of an actuator.

    On top of ``mesh.check()``: the mandatory surfaces are there, lengths look like mm, no
    element is inverted anywhere, blocks are whole, the solid is one piece, every boundary face
    has exactly one name and none is named that is not on the boundary, the paper is flat, the
    symmetry plane is y = 0, and the cavity is closed but for that plane.
    """
    require_names(mesh.surfaces)
    _check_extent(mesh.points)
    mesh.check()
    check_volumes(mesh.points, mesh.tets)
    check_blocks(mesh)
    _check_connected(mesh)
    _check_boundary(mesh)
    _check_cavity(mesh)
    if "paper" in mesh.surfaces:
        _check_flat(mesh)
    if "symmetry" in mesh.surfaces:
        _check_symmetry(mesh)


def require_names(names: Iterable[str]) -> None:
    """Raise InputError, naming what is missing and what there is, unless all are there."""
    found = sorted(names)
    missing = [name for name in REQUIRED if name not in found]
    if missing:
        raise InputError(
            f"The mesh lacks the surface{'s' if len(missing) > 1 else ''} "
            f"{' and '.join(missing)}; it has: {', '.join(found) or 'none'}."
        )


def check_volumes(points: FloatArray, tets: IntArray) -> None:
    """Raise InputError if some of the tetrahedra (m, 4 or 10) are inverted or flat."""
    bad = corner_volumes(points, tets) <= 0.0
    if tets.shape[1] == 10:
        bad |= node_jacobians(points, tets).min(axis=1) <= 0.0
    if bad.any():
        where = ", ".join(f"{value:.4g}" for value in points[tets[np.argmax(bad), 0]])
        raise InputError(
            f"The mesh has {int(bad.sum())} inverted or flat tetrahedra, the first at ({where})."
        )


def _check_connected(mesh: Mesh) -> None:
    owners = shared_faces(mesh.tets)[1]
    pieces = 1 + int(components(owners[owners[:, 1] >= 0], len(mesh.tets)).max())
    if pieces > 1:
        raise InputError(
            f"The solid falls into {pieces} pieces that share no faces; "
            "are nodes doubled between them?"
        )


def _check_extent(points: FloatArray) -> None:
    extent = float(np.ptp(points, axis=0).max())
    if not EXTENT_MM[0] <= extent <= EXTENT_MM[1]:
        raise InputError(
            f"The mesh is {extent:g} mm long, expected {EXTENT_MM[0]:g} to {EXTENT_MM[1]:g}; "
            "coordinates must be in mm."
        )


def _check_boundary(mesh: Mesh) -> None:
    named = np.vstack([faces for name, faces in mesh.surfaces.items() if name != "paper"])
    boundary = boundary_faces(mesh.tets)
    keys = row_numbers(np.sort(np.vstack((boundary, named[:, :3])), axis=1))
    own, given = keys[: len(boundary)], keys[len(boundary) :]
    twice = len(given) - len(np.unique(given))
    strange = int((~np.isin(given, own)).sum())
    nameless = int((~np.isin(own, given)).sum())
    if twice:
        raise InputError(f"The mesh has {twice} faces with more than one name.")
    if strange:
        raise InputError(f"The mesh names {strange} faces that are not on its boundary.")
    if nameless:
        raise InputError(f"The mesh has {nameless} boundary faces without a name.")


def _check_cavity(mesh: Mesh) -> None:
    edges = np.sort(open_edges(mesh.surfaces["cavity"]), axis=1)
    if "symmetry" in mesh.surfaces:
        cut = np.sort(open_edges(mesh.surfaces["symmetry"]), axis=1)
        keys = row_numbers(np.vstack((edges, cut)))
        edges = edges[~np.isin(keys[: len(edges)], keys[len(edges) :])]
    if len(edges):
        where = ", ".join(f"{value:.4g}" for value in mesh.points[edges[0, 0]])
        raise InputError(
            f"The surface 'cavity' is not closed: {len(edges)} edges have a cavity face on one "
            f"side only, the first at ({where})."
        )


def _check_flat(mesh: Mesh) -> None:
    points = mesh.points[mesh.nodes_of("paper")]
    smallest = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2][2]
    away = float(np.abs((points - points.mean(axis=0)) @ smallest).max())
    if away > _FLATNESS * float(np.ptp(mesh.points, axis=0).max()):
        raise InputError(
            f"The surface 'paper' is not flat: nodes lie up to {away:.3g} mm off its mean plane."
        )


def _check_symmetry(mesh: Mesh) -> None:
    away = float(np.abs(mesh.points[mesh.nodes_of("symmetry"), 1]).max())
    if away > _FLATNESS * float(np.ptp(mesh.points, axis=0).max()):
        raise InputError(
            f"The surface 'symmetry' must lie on y = 0, but nodes lie up to {away:.3g} mm off it."
        )
