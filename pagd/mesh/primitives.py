"""Structured meshes of simple bodies, on which results are known in closed form."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import permutations

import numpy as np

from pagd.errors import InputError
from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.tagging import name_surfaces
from pagd.mesh.topology import BoolArray, boundary_faces, interface_faces
from pagd.mesh.types import FloatArray, IntArray, Mesh

__all__ = ["box", "cylinder_quarter", "grid", "hollow_block", "sphere_octant"]

Range = tuple[int, int]

# Of the six tetrahedra of a cell, those of its two wedges: x grows before y in the first.
_WEDGES = [[0, 1, 4], [2, 3, 5]]


def box(
    size: Sequence[float],
    cells: tuple[int, int, int],
    paper_layer: int | None = None,
    blocks: str | None = None,
) -> Mesh:
    """Mesh the box [0, size] with six tetrahedra per cell.

    Parameters
    ----------
    size
        Edge lengths (3) in mm.
    cells
        Number of cells along x, y, z.
    paper_layer
        If given, the plane above that many layers of cells becomes the surface ``paper``.
    blocks
        What the tetrahedra make up (:mod:`pagd.mesh.blocks`): ``hexahedra``, one a cell;
        ``wedges``, two; ``both``, in turn; nothing unless given.

    Returns
    -------
    Mesh
        With the sides ``x0``, ``x1``, ``y0``, … ``z1`` as surfaces.

    Raises
    ------
    InputError
        If there are no such blocks.
    """
    points, tets = grid(size, np.ones(cells, dtype=np.bool_))
    faces = boundary_faces(tets)
    surfaces = {
        f"{name}{end}": faces[_all_at(points[:, axis], faces, end * size[axis])]
        for axis, name in enumerate("xyz")
        for end in (0, 1)
    }
    if paper_layer is not None:
        height = size[2] * paper_layer / cells[2]
        surfaces["paper"] = interface_faces(tets, points[tets].mean(axis=1)[:, 2] > height)
    return quadratic_mesh(points, *_in_blocks(tets, surfaces, blocks))


def hollow_block(
    size: Sequence[float],
    cells: tuple[int, int, int],
    void: tuple[Range, Range, Range],
    paper_layer: int,
    half: bool = False,
    blocks: str | None = None,
) -> Mesh:
    """Mesh a block with a closed void: the smallest thing that has all surfaces of an actuator.

    Parameters
    ----------
    size, cells, blocks
        As for :func:`box`.
    void
        Ranges (first, behind last) of the cells along x, y, z that are left out.
    paper_layer
        Number of layers of cells below the paper.
    half
        The block is the half y >= 0 of a symmetric one; the void may then start at y = 0.
    """
    solid = np.ones(cells, dtype=np.bool_)
    solid[tuple(slice(*bounds) for bounds in void)] = False
    points, tets = grid(size, solid)
    height = size[2] * paper_layer / cells[2]
    tolerance = 1e-9 * max(size)
    surfaces = name_surfaces(points, tets, height, half, tolerance)
    return quadratic_mesh(points, *_in_blocks(tets, surfaces, blocks))


def cylinder_quarter(
    inner: float,
    outer: float,
    height: float,
    cells: tuple[int, int, int],
    blocks: str | None = None,
) -> Mesh:
    """Mesh a quarter of a thick cylinder around z with curved elements.

    Parameters
    ----------
    inner, outer, height
        Radii and length in mm.
    cells
        Number of cells along radius, angle and z.
    blocks
        As for :func:`box`; their nodes lie on the cylinders too.

    Returns
    -------
    Mesh
        With ``cavity`` (inner radius), ``outer``, and the planes ``x0``, ``y0``, ``z0``, ``z1``.
    """
    flat = box((outer - inner, np.pi / 2.0, height), cells, blocks=blocks)

    def bend(points: FloatArray) -> FloatArray:
        radius, angle, z = points.T + np.array([[inner], [0.0], [0.0]])
        return np.column_stack((radius * np.cos(angle), radius * np.sin(angle), z))

    names = {"x0": "cavity", "x1": "outer", "y0": "y0", "y1": "x0", "z0": "z0", "z1": "z1"}
    return _mapped(flat, bend, names)


def sphere_octant(
    inner: float, outer: float, cells: tuple[int, int], blocks: str | None = None
) -> Mesh:
    """Mesh an octant (x, y, z >= 0) of a thick sphere with curved elements.

    Parameters
    ----------
    inner, outer
        Radii in mm.
    cells
        Number of cells along the radius and along each side of the spherical triangle.
    blocks
        ``wedges`` or nothing; their nodes lie on the spheres too.

    Returns
    -------
    Mesh
        With ``cavity`` (inner radius), ``outer``, and the planes ``x0``, ``y0``, ``z0``.

    Raises
    ------
    InputError
        If there are no such blocks.
    """
    if blocks not in (None, "wedges"):
        raise InputError(f"blocks = {blocks!r}, but those of a sphere must be wedges.")
    flat = _prism(inner, outer, cells, blocks)

    def inflate(points: FloatArray) -> FloatArray:
        u, v, radius = points.T
        directions = np.column_stack((1.0 - u - v, u, v))
        return np.asarray(
            directions * (radius / np.linalg.norm(directions, axis=1))[:, None], dtype=np.float64
        )

    return _mapped(flat, inflate, {name: name for name in flat.surfaces})


def grid(size: Sequence[float], solid: BoolArray) -> tuple[FloatArray, IntArray]:
    """Points (n, 3) and tetrahedra (m, 4) of the cells that are ``solid`` in a regular grid.

    Parameters
    ----------
    size
        Edge lengths (3) in mm of the whole grid.
    solid
        (nx, ny, nz) which cells to fill; six tetrahedra go into each.
    """
    axes = [np.linspace(0.0, size[i], n + 1) for i, n in enumerate(solid.shape)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    numbers = np.arange(len(points)).reshape([len(axis) for axis in axes])
    corner = np.argwhere(solid)
    return points, np.vstack([_kuhn(corner, numbers, order) for order in permutations(range(3))])


def _mapped(
    mesh: Mesh, function: Callable[[FloatArray], FloatArray], names: dict[str, str]
) -> Mesh:
    """Move all nodes, edge nodes too, by ``function`` and rename the surfaces."""
    surfaces = {new: mesh.surfaces[old] for old, new in names.items()}
    return replace(mesh, points=function(mesh.points), surfaces=surfaces)


def _in_blocks(
    tets: IntArray, surfaces: dict[str, IntArray], blocks: str | None
) -> tuple[IntArray, dict[str, IntArray], int, int]:
    """Tetrahedra of :func:`grid` in the order of blocks, the surfaces, the numbers of blocks."""
    if blocks is None:
        return tets, surfaces, 0, 0
    cells = tets.reshape(6, -1, 4).swapaxes(0, 1)
    period = {"hexahedra": 1, "both": 2, "wedges": len(cells) + 1}.get(blocks)
    if period is None:
        raise InputError(f"blocks = {blocks!r} must be hexahedra, wedges or both.")
    is_whole = np.arange(1, len(cells) + 1) % period == 0
    six, three = cells[is_whole], cells[~is_whole][:, _WEDGES]
    ordered = np.vstack([six.reshape(-1, 4), three.reshape(-1, 4)])
    return ordered, surfaces, len(six), 2 * len(three)


def _all_at(coordinates: FloatArray, faces: IntArray, value: float) -> BoolArray:
    return np.asarray(np.isclose(coordinates[faces], value, rtol=1e-9, atol=1e-12).all(axis=1))


def _kuhn(corner: IntArray, numbers: IntArray, order: tuple[int, ...]) -> IntArray:
    """Return the tetrahedra along the edge path that walks each cell's axes in ``order``.

    The six paths from one end of a cell's diagonal to the other divide it (Kuhn 1960), and
    neighbouring cells agree on the diagonals of their common faces.
    """
    steps = np.vstack((np.zeros(3), np.cumsum(np.eye(3)[list(order)], axis=0))).astype(np.int64)
    nodes = corner[:, None, :] + steps
    tets = numbers[nodes[..., 0], nodes[..., 1], nodes[..., 2]]
    is_odd = np.linalg.det(np.eye(3)[list(order)]) < 0.0
    return np.asarray(tets[:, [0, 2, 1, 3]] if is_odd else tets)


def _prism(inner: float, outer: float, cells: tuple[int, int], blocks: str | None) -> Mesh:
    """Mesh the prism u, v >= 0, u + v <= 1, inner <= r <= outer, named as its image."""
    layers, n = cells
    points, tets = grid((1.0, 1.0, outer - inner), np.ones((n, n, layers), dtype=np.bool_))
    tets = _in_blocks(tets, {}, blocks)[0]
    # The diagonals of the cells run along x = y: keep one side of it, then mirror it.
    x, y, _ = points[tets].mean(axis=1).T
    tets = tets[y < x][:, [0, 2, 1, 3]]
    points = points * np.array([-1.0, 1.0, 1.0]) + np.array([1.0, 0.0, inner])
    faces = boundary_faces(tets)
    u, v, radius = points.T
    surfaces = {
        "cavity": faces[_all_at(radius, faces, inner)],
        "outer": faces[_all_at(radius, faces, outer)],
        "x0": faces[_all_at(u + v, faces, 1.0)],
        "y0": faces[_all_at(u, faces, 0.0)],
        "z0": faces[_all_at(v, faces, 0.0)],
    }
    return quadratic_mesh(points, tets, surfaces, wedges=len(tets) // 3 if blocks else 0)
