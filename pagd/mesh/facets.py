"""Planar facets of a triangulated complex: the exact polygons a polyhedral design consists of.

A mesher that starts from the polygons is free to place its own triangles on them, without a
trace of the needle-shaped triangles of an STL file.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from pagd.errors import StageFailure, Status
from pagd.mesh.joining import Complex
from pagd.mesh.topology import (
    components,
    doubled_areas,
    edge_neighbours,
    occurrences,
    triangle_edges,
)
from pagd.mesh.types import FloatArray, IntArray

__all__ = ["SMOOTH_DEG", "Facets", "Loop", "coplanar_groups", "facets_of", "is_finely_curved"]

#: Facets that meet at a smaller angle are taken for pieces of one curved surface.
SMOOTH_DEG = 25.0
_TINY = float(np.finfo(np.float64).tiny)

Loop = list[int]


@dataclass(frozen=True, eq=False, slots=True)
class Facets:
    """A complex as planar polygons bounded by straight edges.

    points: (n, 3); edges: (e, 2) end points; loops: per facet its closed loops, the outer one
    first, each a list of edge numbers counted from 1 and negative where walked backwards;
    patches: (f,) values of Patch; shells: (f,) number of the closed or open piece of surface
    (connected within the patch) that the facet belongs to.
    """

    points: FloatArray
    edges: IntArray
    loops: list[list[Loop]]
    patches: IntArray
    shells: IntArray


def facets_of(complex_: Complex) -> Facets:
    """Group the triangles of ``complex_`` into planar facets and trace their outlines.

    Raises
    ------
    StageFailure
        ``mesh_failed`` if an outline does not close.
    """
    pairs = edge_neighbours(complex_.triangles, complex_.patches)
    groups = coplanar_groups(complex_, pairs)
    chains = _straight_chains(complex_, groups)
    starts = _chain_starts(chains)
    loops = [
        _facet_loops(complex_.points, complex_.triangles[groups == g], starts, chains, normal)
        for g, normal in enumerate(_group_normals(complex_, groups))
    ]
    first = np.unique(groups, return_index=True)[1]
    return Facets(
        points=complex_.points,
        edges=np.array([(chain[0], chain[-1]) for chain in chains], dtype=np.int64),
        loops=loops,
        patches=complex_.patches[first],
        shells=components(pairs, len(groups))[first],
    )


def is_finely_curved(complex_: Complex, size: float) -> bool:
    """Tell whether some surface is curved and divided more finely than meshing needs.

    That is so where two neighbours meet at a small angle, and a triangle there is narrower than
    half the mesh size. Needles prove nothing: their planes are known too badly.
    """
    corners = complex_.points[complex_.triangles]
    pairs = edge_neighbours(complex_.triangles, complex_.patches)
    areas = doubled_areas(complex_.points, complex_.triangles)
    longest = _longest_edge(corners)
    heights = np.linalg.norm(areas, axis=1) / longest
    normals = areas / np.maximum(np.linalg.norm(areas, axis=1, keepdims=True), _TINY)
    a, b = pairs.T
    cosines = np.einsum("ij,ij->i", normals[a], normals[b])
    away = np.abs(np.einsum("kij,kj->ki", corners[b] - corners[a][:, :1], normals[a])).max(axis=1)
    doubt = 2.0 * complex_.tolerance * (1.0 + longest[b] / np.maximum(heights[a], _TINY))
    smooth = (away > doubt) & (cosines > np.cos(np.radians(SMOOTH_DEG)))
    return bool((smooth & (np.minimum(heights[a], heights[b]) < size / 2.0)).any())


def coplanar_groups(complex_: Complex, pairs: IntArray) -> IntArray:
    """Return the number (m,) of the planar facet that each triangle belongs to.

    Facets grow from the largest triangle left over whose plane they keep: neighbours join while
    all their corners lie within the tolerance of it, so needles with a meaningless normal of
    their own join the facet they lie in.
    """
    corners = complex_.points[complex_.triangles]
    areas = doubled_areas(complex_.points, complex_.triangles)
    size = np.linalg.norm(areas, axis=1)
    needle = size <= 2.0 * complex_.tolerance * _longest_edge(corners)
    graph = _adjacency(pairs)
    groups = np.full(len(corners), -1, dtype=np.int64)
    for seed in np.argsort(-size, kind="stable").tolist():
        if groups[seed] >= 0:
            continue
        normal = areas[seed] / max(size[seed], _TINY)
        level = corners[seed, 0] @ normal

        def joins(other: int, normal: FloatArray = normal, level: float = level) -> bool:
            distance = np.abs(corners[other] @ normal - level).max()
            is_along = needle[other] or areas[other] @ normal > 0.0
            return bool(is_along and distance <= 2.0 * complex_.tolerance)

        _flood(seed, joins, graph, groups)
    return groups


def _longest_edge(corners: FloatArray) -> FloatArray:
    edges = corners - np.roll(corners, 1, axis=1)
    return np.asarray(np.linalg.norm(edges, axis=2).max(axis=1))


def _adjacency(pairs: IntArray) -> dict[int, list[int]]:
    graph: dict[int, list[int]] = defaultdict(list)
    for a, b in pairs.tolist():
        graph[a].append(b)
        graph[b].append(a)
    return graph


def _flood(
    seed: int, joins: Callable[[int], bool], graph: dict[int, list[int]], groups: IntArray
) -> None:
    """Give the next group number to the seed and all free triangles that join it."""
    number = int(groups.max()) + 1
    stack = [seed]
    groups[seed] = number
    while stack:
        for other in graph[stack.pop()]:
            if groups[other] < 0 and joins(other):
                groups[other] = number
                stack.append(other)


def _group_normals(complex_: Complex, groups: IntArray) -> FloatArray:
    sums = np.zeros((int(groups.max()) + 1, 3))
    np.add.at(sums, groups, doubled_areas(complex_.points, complex_.triangles))
    return np.asarray(sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), _TINY))


def _outlines(triangles: IntArray, groups: IntArray) -> IntArray:
    """Return the undirected edges (k, 2) on the outline of some group."""
    edges = np.sort(triangle_edges(triangles), axis=1)
    on_outline = occurrences(np.column_stack((edges, np.tile(groups, 3)))) == 1
    return np.unique(edges[on_outline], axis=0)


def _straight_chains(complex_: Complex, groups: IntArray) -> list[list[int]]:
    """Return the vertex chains that make up the straight edges between corners."""
    graph = _adjacency(_outlines(complex_.triangles, groups))
    inner = {v for v, ends in graph.items() if _is_straight(complex_, v, ends)}
    chains: list[list[int]] = []
    for corner in sorted(set(graph) - inner):
        for second in graph[corner]:
            chain = _walk(corner, second, graph, inner)
            if corner < chain[-1]:
                chains.append(chain)
    return chains


def _is_straight(complex_: Complex, vertex: int, ends: list[int]) -> bool:
    """Tell whether the outline passes straight through `vertex`, so that it is no corner."""
    if len(ends) != 2:
        return False
    p, a, b = complex_.points[[vertex, *ends]]
    span = float(np.linalg.norm(b - a))
    if span <= complex_.tolerance or (p - a) @ (b - p) <= 0.0:
        return False
    return float(np.linalg.norm(np.cross(p - a, b - a))) / span <= complex_.tolerance


def _walk(corner: int, second: int, graph: dict[int, list[int]], inner: set[int]) -> list[int]:
    chain = [corner, second]
    while chain[-1] in inner:
        a, b = graph[chain[-1]]
        chain.append(b if a == chain[-2] else a)
    return chain


def _chain_starts(chains: list[list[int]]) -> dict[tuple[int, int], int]:
    """Map the first step of a walk along a chain, in either direction, to its signed number."""
    starts = {}
    for number, chain in enumerate(chains, start=1):
        starts[chain[0], chain[1]] = number
        starts[chain[-1], chain[-2]] = -number
    return starts


def _facet_loops(
    points: FloatArray,
    triangles: IntArray,
    starts: dict[tuple[int, int], int],
    chains: list[list[int]],
    normal: FloatArray,
) -> list[Loop]:
    """Trace the loops of one facet; the one that encloses the largest area comes first."""
    edges = {e for t in triangles.tolist() for e in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))}
    outline = sorted(edge for edge in edges if edge[::-1] not in edges and edge in starts)
    leaving: dict[int, list[int]] = defaultdict(list)
    for edge in outline:
        leaving[edge[0]].append(starts[edge])
    loops = []
    while any(leaving.values()):
        loops.append(_trace(points, leaving, chains, normal))
    return sorted(loops, key=lambda loop: -_loop_area(points, loop, chains, normal))


def _trace(
    points: FloatArray, leaving: dict[int, list[int]], chains: list[list[int]], normal: FloatArray
) -> Loop:
    corner = next(c for c, numbers in sorted(leaving.items()) if numbers)
    loop = [leaving[corner].pop()]
    first = corner
    while (here := _ends(loop[-1], chains)[1]) != first:
        if not leaving[here]:
            raise StageFailure(
                Status.mesh_failed, "The outline of a planar face of the surface is not closed."
            )
        loop.append(_next_edge(points, loop[-1], leaving[here], chains, normal))
        leaving[here].remove(loop[-1])
    return loop


def _ends(number: int, chains: list[list[int]]) -> tuple[int, int]:
    chain = chains[abs(number) - 1]
    return (chain[0], chain[-1]) if number > 0 else (chain[-1], chain[0])


def _next_edge(
    points: FloatArray,
    arriving: int,
    candidates: list[int],
    chains: list[list[int]],
    normal: FloatArray,
) -> int:
    """Return the edge that bounds the same piece of the facet where it touches itself."""
    a, b = _ends(arriving, chains)
    back = points[a] - points[b]

    def clockwise_angle(number: int) -> float:
        direction = points[_ends(number, chains)[1]] - points[b]
        sine, cosine = float(np.cross(direction, back) @ normal), float(direction @ back)
        return float(np.arctan2(sine, cosine) % (2.0 * np.pi))

    return min(candidates, key=clockwise_angle)


def _loop_area(
    points: FloatArray, loop: Loop, chains: list[list[int]], normal: FloatArray
) -> float:
    corners = points[[_ends(number, chains)[0] for number in loop]]
    spokes = corners - corners[0]
    return abs(float(np.cross(spokes, np.roll(spokes, -1, axis=0)).sum(axis=0) @ normal))
