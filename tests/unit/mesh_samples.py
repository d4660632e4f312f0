"""Small surfaces to mesh, made without OpenSCAD."""

from __future__ import annotations

import numpy as np

from pagd.mesh.surfaces import Surface, SurfacePair, merge_points
from pagd.mesh.topology import boundary_faces
from pagd.mesh.types import FloatArray, IntArray

#: Smallest size the body of :func:`block_pair` is meshed with in most tests.
SIZE = 4.0


def box_surface(low: tuple[float, ...], high: tuple[float, ...], inwards: bool = False) -> Surface:
    """The twelve triangles of a box."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    points = np.array(low) + corners * (np.array(high) - np.array(low))
    return Surface(points, triangles[:, ::-1].copy() if inwards else triangles)


def together(*surfaces: Surface) -> Surface:
    """Several surfaces as one."""
    starts = np.cumsum([0] + [len(s.points) for s in surfaces[:-1]])
    return Surface(
        np.vstack([s.points for s in surfaces]),
        np.vstack([s.triangles + n for s, n in zip(surfaces, starts, strict=True)]),
    )


def block_pair() -> SurfacePair:
    """A 20 x 10 x 8 mm block with a void, on a base of 2 mm: solid volume 20*10*10 - 14*6*4."""
    body = together(box_surface((0, 0, 2), (20, 10, 10)), box_surface((3, 2, 4), (17, 8, 8), True))
    return SurfacePair(body, box_surface((0, 0, 0), (20, 10, 2)))


BLOCK_VOLUME = 20 * 10 * 10 - 14 * 6 * 4


def half_pair() -> SurfacePair:
    """The half y >= 0 of a block like that, its void cut open at y = 0."""
    points, tets = _cells((20, 5, 8), (10, 5, 4), ((2, 8), (0, 3), (1, 3)))
    body = merge_points(points + np.array([0.0, 0.0, 2.0]), boundary_faces(tets), 1e-9)
    return SurfacePair(body, box_surface((0, 0, 0), (20, 5, 2)), half=True)


HALF_VOLUME = 20 * 5 * 10 - 12 * 3 * 4


def ball_pair(divisions: int = 24) -> SurfacePair:
    """A block with a finely divided spherical void of radius 3."""
    ball = _sphere(divisions, np.array([8.0, 5.0, 6.0]), 3.0)
    inner = Surface(ball.points, ball.triangles[:, ::-1].copy())
    body = together(box_surface((0, 0, 2), (16, 10, 10)), inner)
    return SurfacePair(body, box_surface((0, 0, 0), (16, 10, 2)))


BALL_VOLUME = 16 * 10 * 10 - 4 / 3 * np.pi * 27


def _sphere(n: int, centre: FloatArray, radius: float) -> Surface:
    """A cube's surface, n cells a side, blown up to a sphere."""
    points, tets = _cells((2.0, 2.0, 2.0), (n, n, n), ((0, 0), (0, 0), (0, 0)))
    faces = boundary_faces(tets)
    cube = merge_points(points - 1.0, faces, 1e-9)
    directions = np.tan(cube.points * np.pi / 4)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return Surface(centre + radius * directions, cube.triangles)


def _cells(
    size: tuple[float, ...], cells: tuple[int, ...], void: tuple[tuple[int, int], ...]
) -> tuple[FloatArray, IntArray]:
    from pagd.mesh.primitives import grid

    solid = np.ones(cells, dtype=np.bool_)
    solid[tuple(slice(*bounds) for bounds in void)] = False
    return grid(size, solid)
