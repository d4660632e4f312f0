"""From linear to quadratic tetrahedra, and a node order that suits assembly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pagd.mesh.types import TET_EDGES, TRI_EDGES, FloatArray, IntArray, Mesh


def quadratic_mesh(
    points: FloatArray,
    tets: IntArray,
    surfaces: dict[str, IntArray],
    hexahedra: int = 0,
    wedges: int = 0,
) -> Mesh:
    """Return the ten-node mesh of linear tetrahedra (m, 4) and triangles (k, 3).

    New nodes lie exactly half-way, so every element map is affine. Nodes and elements are
    sorted along the longest axis, which keeps what is near in space near in memory; points that
    belong to no tetrahedron are dropped. Tetrahedra that come as ``hexahedra`` and ``wedges``
    stay in order.
    """
    points, tets, surfaces = compact(points, tets, surfaces)
    pairs = np.sort(tets[:, TET_EDGES].reshape(-1, 2), axis=1)
    keys, first, numbers = np.unique(
        _edge_keys(pairs, len(points)), return_index=True, return_inverse=True
    )
    offset = len(points)

    def upgraded(triangles: IntArray) -> IntArray:
        wanted = _edge_keys(np.sort(triangles[:, TRI_EDGES], axis=2), offset)
        return np.hstack((triangles, offset + np.searchsorted(keys, wanted)))

    return sort_along_axis(
        Mesh(
            points=np.vstack((points, points[pairs[first]].mean(axis=1))),
            tets=np.hstack((tets, offset + numbers.reshape(-1, 6))),
            surfaces={name: upgraded(faces) for name, faces in surfaces.items()},
            hexahedra=hexahedra,
            wedges=wedges,
        )
    )


def sort_along_axis(mesh: Mesh) -> Mesh:
    """Return the mesh with nodes, elements and faces sorted along the longest axis.

    Each face begins with the lowest of its corners, so that rows of the same chambers have the same
    faces. Elements that come as blocks stay in order.
    """
    axis = int(np.argmax(np.ptp(mesh.points, axis=0)))
    order = np.argsort(mesh.points[:, axis], kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    tets = rank[mesh.tets]
    if not (mesh.hexahedra or mesh.wedges):
        tets = tets[np.argsort(tets.min(axis=1), kind="stable")]
    return replace(
        mesh,
        points=mesh.points[order],
        tets=tets,
        surfaces={
            name: _from_lowest(rank[faces[np.argsort(rank[faces].min(axis=1), kind="stable")]])
            for name, faces in mesh.surfaces.items()
        },
    )


def _from_lowest(faces: IntArray) -> IntArray:
    """Faces (k, 6) turned until their lowest corner comes first."""
    turn = (np.arange(3) + faces[:, :3].argmin(axis=1)[:, None]) % 3
    return np.take_along_axis(faces, np.hstack([turn, 3 + turn]), axis=1)


def compact(
    points: FloatArray, tets: IntArray, surfaces: dict[str, IntArray]
) -> tuple[FloatArray, IntArray, dict[str, IntArray]]:
    """Drop points that belong to no tetrahedron; faces that use one get the number -1 there."""
    used = np.unique(tets)
    numbers = np.full(len(points), -1, dtype=np.int64)
    numbers[used] = np.arange(len(used))
    return points[used], numbers[tets], {name: numbers[f] for name, f in surfaces.items()}


def _edge_keys(edges: IntArray, size: int) -> IntArray:
    """Return one number per sorted edge (…, 2)."""
    return np.asarray(edges[..., 0] * size + edges[..., 1])
