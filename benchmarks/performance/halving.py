"""Meshes with every edge halved: they differ from what they are made of by their size alone."""

from __future__ import annotations

import importlib
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from pagd.inventory import inventory
from pagd.mesh.blocks import HEXAHEDRON_TETS, WEDGE_TETS, hexahedra, wedges
from pagd.mesh.msh import read_msh, write_msh
from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.types import IntArray, Mesh
from pagd.record import RECORD_NAME, read_record, write_record

__all__ = ["halve", "halved"]

#: Corners of a block among its nodes.
_CORNERS_OF_HEXAHEDRON = np.array([0, 2, 6, 8, 18, 20, 24, 26])
_CORNERS_OF_WEDGE = np.array([0, 1, 2, 12, 13, 14])

#: Parts of a six-node triangle, all turning as it does.
_PARTS = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])

#: The four parts of a wedge's triangle and their own way of ascending, by the wedge's way. Edges
#: of the parts ascend as the edges that they are parallel to.
_PARTS_OF_WEDGE = (
    (((0, 3, 5), 0), ((3, 1, 4), 0), ((5, 4, 2), 0), ((3, 4, 5), 1)),
    (((0, 3, 5), 1), ((3, 1, 4), 1), ((5, 4, 2), 1), ((5, 3, 4), 0)),
)


def halve(file: Path) -> None:
    """Replace a mesh in a file by that with every edge halved, and note it in its record."""
    write_msh(halved(read_msh(file)), file)
    folder = file.parent
    if (folder / RECORD_NAME).is_file():
        write_record(replace(read_record(folder), files=inventory(folder)), folder)


def halved(mesh: Mesh) -> Mesh:
    """Return the mesh with every edge halved: eight times as many elements.

    Blocks stay blocks; tetrahedra without blocks are halved as the verification does.
    """
    if mesh.hexahedra or mesh.wedges:
        return _halved_blocks(mesh)
    sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "verification"))
    refined = importlib.import_module("refinement").halved(mesh)
    if not isinstance(refined, Mesh):
        raise TypeError("the verification's refinement returns a mesh")
    return refined


def _halved_blocks(mesh: Mesh) -> Mesh:
    six, three = _parts_of_hexahedra(mesh), _parts_of_wedges(mesh)
    surfaces = {
        name: np.vstack([faces[:, part] for part in _PARTS])
        for name, faces in mesh.surfaces.items()
    }
    tets = np.vstack([six.reshape(-1, 4), three.reshape(-1, 4)])
    return quadratic_mesh(mesh.points, tets, surfaces, hexahedra=len(six), wedges=len(three))


def _parts_of_hexahedra(mesh: Mesh) -> IntArray:
    """Corner tetrahedra (8 k, 6, 4) of the eighths of the hexahedra."""
    nodes, lattice = hexahedra(mesh), np.arange(27).reshape(3, 3, 3)
    eighths = [
        nodes[:, lattice[i : i + 2, j : j + 2, k : k + 2].ravel()]
        for i, j, k in np.ndindex(2, 2, 2)
    ]
    return _cut(np.vstack(eighths), HEXAHEDRON_TETS, _CORNERS_OF_HEXAHEDRON)


def _parts_of_wedges(mesh: Mesh) -> IntArray:
    """Corner tetrahedra (8 m, 3, 4) of the eighths of the wedges."""
    nodes = wedges(mesh)
    three = mesh.tets[6 * mesh.hexahedra :].reshape(-1, 3, 10)
    ascends = (nodes[:, WEDGE_TETS[0]] == three).all(axis=(1, 2))
    found = [np.zeros((0, 3, 4), np.int64)]
    for way, chosen in enumerate((nodes[ascends], nodes[~ascends])):
        for triangle, own in _PARTS_OF_WEDGE[way]:
            for below in (0, 6):
                corners = [height + node for height in (below, below + 6) for node in triangle]
                found.append(_cut(chosen[:, corners], WEDGE_TETS[own], _CORNERS_OF_WEDGE))
    return np.concatenate(found)


def _cut(corners: IntArray, table: IntArray, corner_numbers: IntArray) -> IntArray:
    """Linear tetrahedra (k, T, 4) of blocks with ``corners`` (k, c) by a table (T, 10)."""
    return np.asarray(corners[:, np.searchsorted(corner_numbers, table[:, :4])])
