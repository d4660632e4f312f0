"""Repair of triangulated surfaces with pymeshlab, and the proof that nothing is left to repair.

What is repaired: triangles with a corner that is not finite go; vertices nearer than the merge
distance become one; duplicate and null triangles go; holes of a few edges are closed, cracks
along T-junctions among them; triangles are turned so that every component is coherent, the
outside looks outwards and a cavity looks into the cavity.

What is refused, because no repair can guess what was meant: larger holes, surfaces that touch
or pass through themselves (an STL file has no connectivity, so that vertices split apart would
be one again on reading), components without volume, and another number of components than
asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pymeshlab
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pagd.errors import InputError, StageFailure, Status
from pagd.files import replaced_file

__all__ = ["RepairReport", "repair"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Longest edge over smallest height from which a triangle is taken for a closed crack. The long
# triangles of an intact actuator stay well under 1,000.
_SLIVER = 1e4


@dataclass(frozen=True, slots=True, kw_only=True)
class RepairReport:
    """What was repaired, and what the surface is now.

    An STL file repeats every vertex in every triangle, so ``merged_vertices`` is never 0;
    ``moved_vertices`` are those among them that were not exactly equal. ``sliver_faces`` were
    flat triangles in a crack, merged into their neighbours by an edge flip; ``flipped_faces``
    were turned over. ``outside`` and ``cavities`` count components, ``euler_numbers`` (V - E +
    F, 2 for a ball) has one for each; ``volume`` (mm^3) is that of the solid, without cavities.
    """

    merged_vertices: int
    moved_vertices: int
    nonfinite_faces: int
    duplicate_faces: int
    null_faces: int
    sliver_faces: int
    closed_holes: int
    flipped_faces: int
    vertices: int
    faces: int
    outside: int
    cavities: int
    euler_numbers: tuple[int, ...]
    volume: float

    @property
    def components(self) -> int:
        """Number of closed components."""
        return self.outside + self.cavities

    @property
    def repairs(self) -> int:
        """Number of repairs beyond joining equal vertices; 0 for a sound file."""
        return (
            self.moved_vertices
            + self.nonfinite_faces
            + self.duplicate_faces
            + self.null_faces
            + self.sliver_faces
            + self.closed_holes
            + self.flipped_faces
        )

    def as_dict(self) -> dict[str, Any]:
        """All figures by name, for a record."""
        return asdict(self) | {"components": self.components, "repairs": self.repairs}


def repair(
    in_path: Path,
    out_path: Path,
    components: int | None = None,
    max_hole_edges: int = 8,
    merge_distance: float = 1e-4,
) -> RepairReport:
    """Repair a surface and write it as a binary STL file.

    Parameters
    ----------
    in_path
        STL file, binary or text, in mm.
    out_path
        The STL file; it appears only if the surface is sound.
    components
        How many closed components there must be, exactly one of them an outside: 2 for a body
        with a cavity, 1 for a base or half a body. ``None`` leaves the number free.
    max_hole_edges
        Holes with more edges are not closed.
    merge_distance
        Vertices nearer than this (mm) are one vertex.

    Raises
    ------
    InputError
        If there is no such file.
    StageFailure
        ``invalid_geometry``, with what could not be repaired.
    """
    meshes, nonfinite = _load(in_path)
    counts = _clean(meshes, max_hole_edges, merge_distance)
    _require_sound(meshes)
    mesh = meshes.current_mesh()
    points = mesh.vertex_matrix()
    before = mesh.face_matrix().astype(np.int64)
    meshes.meshing_re_orient_faces_coherently()
    faces = mesh.face_matrix().astype(np.int64)
    _require_coherent(faces)
    labels = _component_of_face(faces, len(points))
    depths = _turn_by_nesting(points, faces, labels, merge_distance)
    _require_components(depths, components)
    _save(points, faces, out_path)
    return RepairReport(
        **counts,
        nonfinite_faces=nonfinite,
        flipped_faces=_turned(points, before, faces),
        vertices=len(points),
        faces=len(faces),
        outside=int(np.sum(depths % 2 == 0)),
        cavities=int(np.sum(depths % 2 == 1)),
        euler_numbers=tuple(_euler_number(faces[labels == k]) for k in range(len(depths))),
        volume=_signed_volume(points, faces),
    )


def _load(path: Path) -> tuple[Any, int]:
    """A mesh set with the surface, vertices as in the file, and how many triangles were lost."""
    if not path.is_file():
        raise InputError(f"The surface file {path} does not exist.")
    meshes = pymeshlab.MeshSet(verbose=False)
    try:
        meshes.load_new_mesh(str(path), unify_vertices=False)
    except pymeshlab.PyMeshLabException:
        raise _failure("the file holds no triangles that can be read") from None
    return meshes, _triangles_in_file(path) - meshes.current_mesh().face_number()


def _triangles_in_file(path: Path) -> int:
    """Number of triangles; pymeshlab leaves out, without a word, those that are not finite."""
    content = path.read_bytes()
    declared = int.from_bytes(content[80:84], "little")
    if len(content) == 84 + 50 * declared:
        return declared
    return content.count(b"endfacet")


def _clean(meshes: Any, max_hole_edges: int, merge_distance: float) -> dict[str, int]:
    """Remove and close what can be; how many of each, by the names of the report."""
    near = pymeshlab.PureValue(merge_distance)
    # Merging takes along the triangles that it leaves with fewer than three corners.
    equal, null_1 = _losses(meshes, meshes.meshing_remove_duplicate_vertices)
    moved, null_2 = _losses(meshes, lambda: meshes.meshing_merge_close_vertices(threshold=near))
    _, duplicates = _losses(meshes, meshes.meshing_remove_duplicate_faces)
    if meshes.current_mesh().face_number() == 0:
        raise _failure("the file holds no triangles with an area")
    _require_simple_edges(meshes)
    # pymeshlab closes holes with fewer edges than the number it is given.
    holes = meshes.meshing_close_holes(maxholesize=max_hole_edges + 1)["closed_holes"]
    slivers = _flip_slivers(meshes)
    _, null_3 = _losses(meshes, meshes.meshing_remove_null_faces)
    meshes.meshing_remove_unreferenced_vertices()
    return {
        "merged_vertices": equal + moved,
        "moved_vertices": moved,
        "duplicate_faces": duplicates,
        "null_faces": null_1 + null_2 + null_3,
        "sliver_faces": slivers,
        "closed_holes": holes,
    }


def _require_simple_edges(meshes: Any) -> None:
    """Fail where more than two faces meet at an edge; what follows needs this."""
    edges, counts = _edges(meshes.current_mesh())
    crowded = edges[counts > 2]
    if len(crowded):
        where = _place(meshes.current_mesh(), crowded)
        raise _failure(f"the surface touches itself at {len(crowded)} edge(s), {where}")


def _edges(mesh: Any) -> tuple[IntArray, IntArray]:
    """Every edge (k, 2) and the number of faces that meet at it (k,)."""
    faces = mesh.face_matrix().astype(np.int64)
    sides = np.concatenate((faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]))
    edges, counts = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
    return edges, counts.astype(np.int64)


def _place(mesh: Any, edges: IntArray) -> str:
    """Where the first of the edges lies, for people."""
    x, y, z = mesh.vertex_matrix()[edges[0]].mean(axis=0)
    return f"the first at ({x:.4g}, {y:.4g}, {z:.4g}) mm"


def _losses(meshes: Any, action: Callable[[], object]) -> tuple[int, int]:
    """How many vertices and faces the action takes away."""
    mesh = meshes.current_mesh()
    vertices, faces = mesh.vertex_number(), mesh.face_number()
    action()
    return vertices - mesh.vertex_number(), faces - mesh.face_number()


def _flip_slivers(meshes: Any) -> int:
    """Merge flat triangles into their neighbours, keeping the surface closed; how many."""
    mesh = meshes.current_mesh()
    slivers = _count_slivers(mesh.vertex_matrix(), mesh.face_matrix())
    if slivers:
        meshes.meshing_remove_t_vertices(method="Edge Flip", threshold=_SLIVER, repeat=True)
    return slivers


def _count_slivers(points: FloatArray, faces: NDArray[np.integer[Any]]) -> int:
    corners = points[faces]
    longest = np.max(np.sum((corners - np.roll(corners, 1, axis=1)) ** 2, axis=2), axis=1)
    doubled_area = np.linalg.norm(_normals(points, faces), axis=1)
    # Height over the longest edge is twice the area over that edge squared.
    return int(np.sum(doubled_area * _SLIVER < longest))


def _require_sound(meshes: Any) -> None:
    """Fail unless the surface is closed, two-manifold and free of self-intersections."""
    mesh = meshes.current_mesh()
    edges, counts = _edges(mesh)
    border = edges[counts == 1]
    if len(border):
        raise _failure(
            f"the surface is not closed: {len(border)} edge(s) border on one triangle only,"
            f" {_place(mesh, border)}"
        )
    _require_simple_edges(meshes)
    vertices = meshes.get_topological_measures()["non_two_manifold_vertices"]
    if vertices:
        raise _failure(f"the surface touches itself at {vertices} corner(s)")
    meshes.compute_selection_by_self_intersections_per_face()
    crossing = mesh.selected_face_number()
    if crossing:
        raise _failure(f"the surface passes through itself at {crossing} triangle(s)")


def _require_coherent(faces: IntArray) -> None:
    """Fail unless every edge is walked once in each direction."""
    edges = np.concatenate((faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]))
    if len(np.unique(edges, axis=0)) != len(edges):
        raise _failure("the surface has only one side, so that it encloses nothing")


def _component_of_face(faces: IntArray, n_points: int) -> IntArray:
    """Number of the connected component of each face, from 0."""
    ones = np.ones(len(faces))
    starts, ends = faces[:, [0, 1]].T, faces[:, [1, 2]].T
    links = coo_array(
        (np.tile(ones, 2), (np.ravel(starts), np.ravel(ends))), shape=(n_points, n_points)
    )
    _, labels = connected_components(links, directed=False)
    return np.unique(labels[faces[:, 0]], return_inverse=True)[1].astype(np.int64)


def _turn_by_nesting(
    points: FloatArray, faces: IntArray, labels: IntArray, merge_distance: float
) -> IntArray:
    """Turn the components (in ``faces``) by how deep they lie in others: even ones outwards.

    Returns the depth of each component: 0 is an outside, 1 a cavity in it, and so on.
    """
    n = int(labels.max()) + 1
    parts = [faces[labels == k] for k in range(n)]
    samples = [points[part[0]].mean(axis=0) for part in parts]
    depths = np.zeros(n, dtype=np.int64)
    for k, part in enumerate(parts):
        others = (parts[j] for j in range(n) if j != k)
        depths[k] = sum(_encloses(points, other, samples[k]) for other in others)
        volume = _signed_volume(points, part)
        area = np.linalg.norm(_normals(points, part), axis=1).sum() / 2
        if abs(volume) < merge_distance * area:
            raise _failure("a component encloses no volume")
        if (volume > 0) == (depths[k] % 2 == 1):
            faces[labels == k] = part[:, ::-1]
    return depths


def _encloses(points: FloatArray, faces: IntArray, point: FloatArray) -> bool:
    """Whether a closed surface winds around a point.

    The winding number is the sum of the triangles' solid angles over 4 pi; van Oosterom and
    Strackee, "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30 (1983).
    """
    a, b, c = np.moveaxis(points[faces] - point, 1, 0)
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    triple = np.sum(a * np.cross(b, c), axis=1)
    ab, bc, ca = (np.sum(p * q, axis=1) for p, q in ((a, b), (b, c), (c, a)))
    angles = 2 * np.arctan2(triple, la * lb * lc + ab * lc + bc * la + ca * lb)
    return bool(abs(angles.sum()) > 2 * np.pi)


def _require_components(depths: IntArray, components: int | None) -> None:
    if components is None:
        return
    outside = int(np.sum(depths == 0))
    if len(depths) != components or outside != 1:
        raise _failure(
            f"it has {len(depths)} closed components, {outside} of them outside, instead of"
            f" {components} with 1 outside"
        )


def _save(points: FloatArray, faces: IntArray, path: Path) -> None:
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(points, faces.astype(np.int32)))
    with replaced_file(path) as temporary:
        meshes.save_current_mesh(str(temporary), binary=True)


def _normals(points: FloatArray, faces: NDArray[np.integer[Any]]) -> FloatArray:
    """Normals of the faces, twice the area long, shape (m, 3)."""
    a, b, c = np.moveaxis(points[faces], 1, 0)
    return np.asarray(np.cross(b - a, c - a), dtype=np.float64)


def _signed_volume(points: FloatArray, faces: IntArray) -> float:
    """Enclosed volume (mm^3), positive where the faces look outwards."""
    return float(np.sum(points[faces[:, 0]] * _normals(points, faces)) / 6)


def _turned(points: FloatArray, before: IntArray, after: IntArray) -> int:
    """Number of faces that look the other way."""
    return int(np.sum(np.sum(_normals(points, before) * _normals(points, after), axis=1) < 0))


def _euler_number(faces: IntArray) -> int:
    """V - E + F of a closed component, whose edges belong to two faces each."""
    return len(np.unique(faces)) - len(faces) // 2


def _failure(reason: str) -> StageFailure:
    return StageFailure(Status.invalid_geometry, f"The surface cannot be repaired: {reason}.")
