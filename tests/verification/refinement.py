"""Nested refinement: every edge halved, so that the meshes differ by their size alone.

Meshes drawn anew for another size differ by chance too, in where the elements lie; halves of one
mesh do not.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree
from solving import BoolArray, FloatArray, Solved, equilibrium

from pagd.actuation import Body
from pagd.fem.shapes import tetrahedron_values
from pagd.fem.solid import TaylorHoodSolid
from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.types import TET_EDGES, IntArray, Mesh

#: Order of the error of a mean or an energy: near inward edges of 90° the displacement goes with
#: the distance to the power 0.5445 (Williams 1952), and such results gain twice that.
ORDER = 2 * 0.5445

#: Parts at the corners of a ten-node tetrahedron, in its node numbers.
_CORNERS = np.array([(0, 4, 6, 7), (4, 1, 5, 9), (6, 5, 2, 8), (7, 9, 8, 3)])
#: The octahedron between them: for each of its diagonals, its ends and the ring around it, such
#: that (start, end, ring[i], ring[i + 1]) has a positive volume.
_DIAGONALS = (
    ((4, 8), (6, 7, 9, 5)),
    ((5, 7), (6, 4, 9, 8)),
    ((6, 9), (4, 5, 8, 7)),
)
#: Parts of a six-node triangle.
_FACES = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])


def halved(mesh: Mesh) -> Mesh:
    """The mesh with every edge halved: eight times as many tetrahedra; its edges are straight.

    The octahedron that is left of a tetrahedron without its corners is cut along its shortest
    diagonal, which keeps the shapes as good as they can be (Bey 1995). Blocks stay blocks.
    """
    if mesh.hexahedra or mesh.wedges:
        return _halved_blocks(mesh)
    parts = [mesh.tets[:, corner] for corner in _CORNERS] + _cut_octahedra(mesh)
    surfaces = {
        name: np.vstack([faces[:, part] for part in _FACES])
        for name, faces in mesh.surfaces.items()
    }
    return quadratic_mesh(mesh.points, np.vstack(parts), surfaces)


def _halved_blocks(mesh: Mesh) -> Mesh:
    """By the benchmarks, which halve meshes of blocks too."""
    benchmarks = str(Path(__file__).parents[2] / "benchmarks")
    if benchmarks not in sys.path:
        sys.path.append(benchmarks)
    refined = importlib.import_module("performance.halving").halved(mesh)
    assert isinstance(refined, Mesh)
    return refined


def _cut_octahedra(mesh: Mesh) -> list[IntArray]:
    shortest = np.argmin([_lengths(mesh, ends) for ends, _ in _DIAGONALS], axis=0)
    parts = []
    for k, ((start, end), ring) in enumerate(_DIAGONALS):
        tets = mesh.tets[shortest == k]
        parts += [tets[:, [start, end, ring[i], ring[(i + 1) % 4]]] for i in range(4)]
    return parts


def _lengths(mesh: Mesh, ends: tuple[int, int]) -> FloatArray:
    first, second = (mesh.points[mesh.tets[:, end]] for end in ends)
    return np.linalg.norm(second - first, axis=1)


def limit_of(coarse: float, fine: float) -> float:
    """Richardson's limit of a value on a mesh and on its halves, by the order of inward edges."""
    return fine + (fine - coarse) / (2**ORDER - 1)


def observed_order(coarse: float, fine: float, finest: float) -> float:
    """The order that a value shows on a mesh, its halves and theirs; no number if it has none."""
    ratio = (fine - coarse) / (finest - fine)
    return float(np.log2(ratio)) if ratio > 0 else float("nan")


#: Barycentric coordinates (35, 4) of the nodes that the parts of a tetrahedron have together.
_LATTICE = (
    np.array(
        [(a, b, c, 4 - a - b - c) for a in range(5) for b in range(5 - a) for c in range(5 - a - b)]
    )
    / 4
)


def solve_again(coarse: Body, fine: Body, found: Solved, fixed: BoolArray, load: float) -> Solved:
    """The equilibrium of a refined body, from that of the body it is refined of.

    The first guess is the very shape of the coarse body, which its halves can take on, and the
    pressures of its corners, so that a few iterations at the full load do.

    Parameters
    ----------
    coarse, fine
        P2–P1 bodies on a mesh and on the mesh :func:`halved`.
    found
        The equilibrium of the coarse one at the load.
    fixed
        Which displacements (n, 3) of the fine one are held at zero.
    """
    values = carried_over(coarse, fine, _nodal(coarse, found.unknowns))
    unknowns = np.concatenate([values[:, :3].ravel(), values[_corners(fine), 3]])
    held = np.zeros(len(unknowns), np.bool_)
    held[: fixed.size] = fixed.ravel()
    return equilibrium(fine.terms, held, load, unknowns, tolerance=1e-3)


def _corners(body: Body) -> IntArray:
    if not isinstance(body.solids[0], TaylorHoodSolid):
        raise TypeError("refinement carries over the pressures of P2–P1 elements")
    return body.solids[0].corners


def _nodal(body: Body, unknowns: FloatArray) -> FloatArray:
    """Displacement and pressure (n, 4) of all nodes; edge nodes have the mean of their ends."""
    result = np.zeros((body.nodes, 4))
    result[:, :3] = body.displacement(unknowns)
    result[_corners(body), 3] = unknowns[3 * body.nodes :]
    tets = body.mesh.tets
    for k, (a, b) in enumerate(TET_EDGES):
        result[tets[:, 4 + k], 3] = result[tets[:, [a, b]], 3].mean(axis=1)
    return result


def carried_over(coarse: Body, fine: Body, values: FloatArray) -> FloatArray:
    """Values (n, k) of the nodes of the fine mesh, those of the coarse one interpolated."""
    shapes = tetrahedron_values(_LATTICE)
    tets = coarse.mesh.tets
    places = np.einsum("qa,eai->eqi", shapes, coarse.mesh.points[tets]).reshape(-1, 3)
    known = np.einsum("qa,eak->eqk", shapes, values[tets]).reshape(len(places), -1)
    distances, nearest = KDTree(places).query(fine.mesh.points)
    assert distances.max() < 1e-9 * np.ptp(places), "the fine mesh is the coarse one, halved"
    return np.asarray(known[nearest])
