"""Join body and base at the paper plane into one conforming complex of triangles.

The two surfaces come from separate files. They cover the same area of the paper plane with
different triangles, and one may have vertices on the outline that the other lacks. Here points
are merged, the outline is split so that both sides have the same vertices on it, and the
interface is kept once.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from pagd.errors import StageFailure, Status
from pagd.mesh.surfaces import Surface, SurfacePair, merge_points
from pagd.mesh.topology import BoolArray, crowded_edges, doubled_areas, open_edges
from pagd.mesh.types import FloatArray, IntArray

__all__ = ["Complex", "Patch", "join"]

#: Largest relative difference between the areas with which body and base meet.
_AREA_TOLERANCE = 1e-3


class Patch(IntEnum):
    """Which part of the complex a triangle belongs to."""

    above = 0
    below = 1
    paper = 2


@dataclass(frozen=True, eq=False, slots=True)
class Complex:
    """Conforming triangles that bound two regions, one on either side of the paper.

    points: (n, 3); triangles: (m, 3), outward from the solid, those of the paper facing down
    (outward from the body); patches: (m,) values of Patch; plane_z: height of the paper plane;
    tolerance: distance in mm below which things coincide; half: see SurfacePair.
    """

    points: FloatArray
    triangles: IntArray
    patches: IntArray
    plane_z: float
    tolerance: float
    half: bool


def join(pair: SurfacePair) -> Complex:
    """Return the conforming complex of `pair`; StageFailure(mesh_failed) if they do not meet."""
    tolerance = pair.tolerance()
    for part, surface in (("body", pair.body), ("base", pair.base)):
        _check_closed(part, surface)
    plane_z = _paper_height(pair, tolerance)
    points, triangles, from_base = _merged(pair, plane_z, tolerance)
    flat = _on_plane(points, triangles, plane_z)
    _check_areas(points, triangles, flat, from_base)
    for side in (False, True):
        outline = np.unique(open_edges(triangles[flat & (from_base != side)]))
        triangles, flat, from_base = _split_outline(
            points, triangles, flat, from_base, outline, side, tolerance
        )
    _check_outlines(triangles, flat, from_base)
    patches = np.where(flat, int(Patch.paper), np.where(from_base, int(Patch.below), 0))
    keep = ~(flat & from_base)
    return Complex(
        points, triangles[keep], patches[keep].astype(np.int64), plane_z, tolerance, pair.half
    )


def _check_closed(part: str, surface: Surface) -> None:
    gaps = len(open_edges(surface.triangles))
    if gaps:
        raise _failure(f"The surface of the {part} is not closed: {gaps} edges have one triangle")
    crowded = len(crowded_edges(surface.triangles))
    if crowded:
        raise _failure(
            f"The surface of the {part} is not that of a solid: {crowded} edges have more than two "
            "triangles"
        )
    if surface.volume() <= 0.0:
        raise _failure(f"The surface of the {part} is inside out: it encloses a negative volume")


def _paper_height(pair: SurfacePair, tolerance: float) -> float:
    """Return the height of the horizontal plane on which body and base meet."""
    top, bottom = float(pair.base.points[:, 2].max()), float(pair.body.points[:, 2].min())
    if abs(top - bottom) > tolerance:
        raise _failure(
            "Body and base must meet in one horizontal paper plane: the base ends at "
            f"z = {top:.6g} mm and the body begins at z = {bottom:.6g} mm"
        )
    return top


def _merged(
    pair: SurfacePair, plane_z: float, tolerance: float
) -> tuple[FloatArray, IntArray, BoolArray]:
    """Return common points (on the plane exactly), all triangles and which are the base's."""
    points = np.vstack((pair.body.points, pair.base.points))
    near = np.abs(points[:, 2] - plane_z) <= 2.0 * tolerance
    points[near, 2] = plane_z
    shifted = pair.base.triangles + len(pair.body.points)
    merged = merge_points(points, np.vstack((pair.body.triangles, shifted)), tolerance)
    centres = merged.points[merged.triangles].mean(axis=1)[:, 2]
    normals_z = doubled_areas(merged.points, merged.triangles)[:, 2]
    flat = _on_plane(merged.points, merged.triangles, plane_z)
    return merged.points, merged.triangles, np.where(flat, normals_z > 0.0, centres < plane_z)


def _on_plane(points: FloatArray, triangles: IntArray, plane_z: float) -> BoolArray:
    return np.asarray((points[triangles][:, :, 2] == plane_z).all(axis=1))


def _check_areas(
    points: FloatArray, triangles: IntArray, flat: BoolArray, from_base: BoolArray
) -> None:
    areas = np.linalg.norm(doubled_areas(points, triangles), axis=1) / 2.0
    body, base = areas[flat & ~from_base].sum(), areas[flat & from_base].sum()
    if min(body, base) == 0.0 or abs(body - base) > _AREA_TOLERANCE * max(body, base):
        raise _failure(
            "Body and base must cover the same area of the paper plane, but the body covers "
            f"{body:.6g} mm² and the base {base:.6g} mm²"
        )


def _split_outline(
    points: FloatArray,
    triangles: IntArray,
    flat: BoolArray,
    from_base: BoolArray,
    vertices: IntArray,
    side: bool,
    tolerance: float,
) -> tuple[IntArray, BoolArray, BoolArray]:
    """Split the triangles of one side where `vertices` of the other side lie on its outline."""
    for a, b in open_edges(triangles[flat & (from_base == side)]):
        inside = _vertices_on_edge(points, vertices, int(a), int(b), tolerance)
        if len(inside) == 0:
            continue
        hit = ((triangles == a) | (triangles == b)).sum(axis=1) == 2
        for index in np.flatnonzero(hit & (from_base == side)):
            fan = _fan(triangles[index], {int(a), int(b)}, inside, points)
            triangles = np.vstack((triangles, fan[1:]))
            triangles[index] = fan[0]
            flat = np.append(flat, np.full(len(fan) - 1, flat[index]))
            from_base = np.append(from_base, np.full(len(fan) - 1, side))
    return triangles, flat, from_base


def _vertices_on_edge(
    points: FloatArray, vertices: IntArray, a: int, b: int, tolerance: float
) -> IntArray:
    """Return those of `vertices` that lie strictly inside the edge from a to b."""
    direction = points[b] - points[a]
    length = float(np.linalg.norm(direction))
    offset = points[vertices] - points[a]
    along = offset @ direction / length
    away = np.linalg.norm(offset - np.outer(along, direction / length), axis=1)
    inside = (along > tolerance) & (along < length - tolerance) & (away <= tolerance)
    return np.asarray(vertices[inside])


def _fan(triangle: IntArray, edge: set[int], inside: IntArray, points: FloatArray) -> IntArray:
    """Return the triangles that replace `triangle` when `inside` splits its `edge`."""
    corner = next(i for i in range(3) if int(triangle[i]) not in edge)
    apex, first, last = np.roll(triangle, -corner)
    distance = np.linalg.norm(points[inside] - points[first], axis=1)
    chain = np.concatenate(([first], inside[np.argsort(distance)], [last]))
    return np.column_stack((np.full(len(chain) - 1, apex), chain[:-1], chain[1:]))


def _check_outlines(triangles: IntArray, flat: BoolArray, from_base: BoolArray) -> None:
    body = np.sort(open_edges(triangles[flat & ~from_base]), axis=1)
    base = np.sort(open_edges(triangles[flat & from_base]), axis=1)
    if not np.array_equal(np.unique(body, axis=0), np.unique(base, axis=0)):
        raise _failure("Body and base do not have the same outline in the paper plane")


def _failure(reason: str) -> StageFailure:
    return StageFailure(Status.mesh_failed, reason + ".")
