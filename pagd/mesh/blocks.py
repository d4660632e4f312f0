"""Hexahedra and wedges behind tetrahedra: blocks of six and of three that share their nodes.

A mesh of blocks is also one of tetrahedra, cut along the diagonals from the lowest to the highest
corner of each block (Kuhn 1960); all its nodes are nodes of the ten-node tetrahedra. So surfaces,
files and every tool that knows tetrahedra go on working, and a solver may take the blocks.
"""

from __future__ import annotations

from itertools import permutations

import numpy as np

from pagd.errors import InputError
from pagd.mesh.types import TET_EDGES, FloatArray, IntArray, Mesh

__all__ = ["HEXAHEDRON_TETS", "WEDGE_TETS", "block_faces", "check_blocks", "hexahedra", "wedges"]


def _ten_nodes(corners: FloatArray, places: FloatArray) -> IntArray:
    """Where the ten nodes of tetrahedra (k, 4, 3) are among ``places`` (n, 3): (k, 10)."""
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1])
    corners = np.where((volumes > 0)[:, None, None], corners, corners[:, [0, 2, 1, 3]])
    nodes = np.concatenate([corners, corners[:, TET_EDGES].mean(axis=2)], axis=1)
    distances = np.linalg.norm(nodes[:, :, None] - places, axis=3)
    return np.asarray(distances.argmin(axis=2), dtype=np.int64)


def _hexahedron_tets() -> IntArray:
    """The six paths along the edges of the unit cube, from (0, 0, 0) to (1, 1, 1)."""
    layers = np.array([0.0, 0.5, 1.0])
    places = np.stack(np.meshgrid(layers, layers, layers, indexing="ij"), axis=-1).reshape(-1, 3)
    steps = np.eye(3)[np.array(list(permutations(range(3))))]
    paths = np.concatenate([np.zeros((6, 1, 3)), np.cumsum(steps, axis=1)], axis=1)
    return _ten_nodes(paths, places)


def _wedge_tets(order: tuple[int, int, int]) -> IntArray:
    """The three paths up a wedge whose edges ascend in ``order`` of its triangle's corners."""
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    edges = [(0, 1), (1, 2), (2, 0)]
    flat = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in edges]])
    places = np.vstack([np.column_stack([flat, np.full(6, z)]) for z in (0.0, 0.5, 1.0)])
    first, second, third = (corners[k] for k in order)
    paths = [
        [(*first, 0), (*second, 0), (*third, 0), (*third, 1)],
        [(*first, 0), (*second, 0), (*second, 1), (*third, 1)],
        [(*first, 0), (*first, 1), (*second, 1), (*third, 1)],
    ]
    return _ten_nodes(np.array(paths, dtype=np.float64), places)


#: Nodes (6, 10) of a block's tetrahedra among its 27: node 9 i + 3 j + k at (i/2, j/2, k/2).
HEXAHEDRON_TETS: IntArray = _hexahedron_tets()
#: Nodes (3, 10) of the tetrahedra of a wedge among its 18, six nodes of a triangle at each of
#: three heights; by whether its edges ascend with the numbers of its corners or as 0, 2, 1.
WEDGE_TETS: tuple[IntArray, IntArray] = (_wedge_tets((0, 1, 2)), _wedge_tets((0, 2, 1)))


# Outward faces of the blocks, nodes by rows.
_LATTICE = np.arange(27).reshape(3, 3, 3)
_HEXAHEDRON_FACES: IntArray = np.array(
    [
        face.ravel()
        for face in (
            _LATTICE[0].T,
            _LATTICE[2],
            _LATTICE[:, 0],
            _LATTICE[:, 2].T,
            _LATTICE[:, :, 0].T,
            _LATTICE[:, :, 2],
        )
    ]
)
_WEDGE_FACES: IntArray = np.array(
    [
        [node + 6 * layer for node in edge for layer in range(3)]
        for edge in ((0, 3, 1), (1, 4, 2), (2, 5, 0))
    ]
)


def hexahedra(mesh: Mesh) -> IntArray:
    """Nodes (k, 27) of the hexahedra of a mesh, its first 6 k tetrahedra."""
    tets = mesh.tets[: 6 * mesh.hexahedra].reshape(-1, 6, 10)
    return _gathered(tets, HEXAHEDRON_TETS, 27)


def wedges(mesh: Mesh) -> IntArray:
    """Nodes (m, 18) of the wedges of a mesh, the 3 m tetrahedra behind those of the hexahedra."""
    tets = mesh.tets[6 * mesh.hexahedra :].reshape(-1, 3, 10)[: mesh.wedges]
    first, second = (_gathered(tets, table, 18) for table in WEDGE_TETS)
    fits = (first[:, WEDGE_TETS[0]] == tets).all(axis=(1, 2))
    return np.where(fits[:, None], first, second)


def block_faces(mesh: Mesh, name: str) -> tuple[IntArray, IntArray]:
    """Faces of blocks on surface ``name``: with nine nodes (k, 9) and with six (m, 6).

    Where two of the surface's triangles are a face of a block, its nine nodes; the triangles that
    are left. Nine nodes come row by row, node 3 i + j at (i/2, j/2) of the face; all point to the
    side that the surface does. InputError if there is no such surface.
    """
    mesh.nodes_of(name)  # says which surfaces there are where it is missing
    triangles = mesh.surfaces[name]
    on = np.zeros(len(mesh.points), dtype=np.bool_)
    on[triangles[:, 3:]] = True
    cells = ((hexahedra(mesh), _HEXAHEDRON_FACES), (wedges(mesh), _WEDGE_FACES))
    faces = np.vstack([nodes[:, table].reshape(-1, 9) for nodes, table in cells])
    # The node in the middle of a block's face is on no other face.
    faces = faces[on[faces[:, 4]]]
    middles = np.zeros(len(mesh.points), dtype=np.bool_)
    middles[faces[:, 4]] = True
    return faces, triangles[~middles[triangles[:, 3:]].any(axis=1)]


def check_blocks(mesh: Mesh) -> None:
    """Raise InputError unless the tetrahedra of the blocks make up hexahedra and wedges."""
    if not (mesh.hexahedra or mesh.wedges):
        return
    if 6 * mesh.hexahedra + 3 * mesh.wedges != len(mesh.tets):
        raise InputError(
            f"A mesh of {mesh.hexahedra} hexahedra and {mesh.wedges} wedges has 6 and 3 "
            f"tetrahedra for each, not {len(mesh.tets)}."
        )
    six = mesh.tets[: 6 * mesh.hexahedra].reshape(-1, 6, 10)
    three = mesh.tets[6 * mesh.hexahedra :].reshape(-1, 3, 10)
    broken = (hexahedra(mesh)[:, HEXAHEDRON_TETS] != six).any(axis=(1, 2)).sum()
    nodes = wedges(mesh)
    fits = [(nodes[:, table] == three).all(axis=(1, 2)) for table in WEDGE_TETS]
    broken += (~(fits[0] | fits[1])).sum()
    if broken:
        raise InputError(f"{broken} blocks of the mesh are not made up of their tetrahedra.")


def _gathered(tets: IntArray, table: IntArray, count: int) -> IntArray:
    """The nodes (k, count) that ``table`` (T, 10) finds in tetrahedra (k, T, 10)."""
    places = [np.flatnonzero(table.ravel() == node)[0] for node in range(count)]
    return np.asarray(tets.reshape(len(tets), table.size)[:, places])
