"""Polyhedral surfaces as solids of a STEP file, which any CAD program reads: by OpenCASCADE.

Triangles in one plane become one planar face with straight edges, so that a CAD program finds the
walls of a pneu-net as somebody would have drawn them, and not their triangulation.
"""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from pagd.errors import StageFailure, Status
from pagd.files import replaced_file
from pagd.mesh.facets import Facets, facets_of
from pagd.mesh.gmsh_session import gmsh_session
from pagd.mesh.joining import Complex
from pagd.mesh.surfaces import RELATIVE_TOLERANCE, Surface
from pagd.mesh.topology import open_edges
from pagd.mesh.types import FloatArray, IntArray

__all__ = ["write_step"]

# OpenCASCADE takes corners for those of one plane that lie within 1e-7 mm of it. STL files keep
# 24 bits, some 4e-6 mm.
_FLAT_MM, _ROUNDS = 1e-9, 50
# When the file was written, which OpenCASCADE puts in its head, and how many it had written before.
_WRITTEN = re.compile(rb"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'")
_COUNTED = re.compile(rb"(STEP translator [\d.]+) \d+")
_OCCURRENCE = re.compile(rb"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'")
# Planes that meet at a smaller angle do not say where along them a corner lies.
_SMALLEST_ANGLE = 1e-6


def write_step(surfaces: Sequence[Surface], path: Path) -> list[float]:
    """Write closed surfaces as solids, voids inside them as such (mm).

    Parameters
    ----------
    surfaces
        One a solid, in the order of the file.
    path
        The file, NAME.step; it appears complete or not at all.

    Returns
    -------
    list of float
        Volume of each solid in mm³, as OpenCASCADE finds it.

    Raises
    ------
    StageFailure
        ``invalid_geometry`` if the faces do not close, or OpenCASCADE refuses them.
    """
    try:
        # Lengths in a STEP file are in mm unless another unit is asked for.
        with gmsh_session({"Geometry.OCCParallel": 0}) as gmsh:
            solids = [_add_solid(gmsh.model.occ, _facets(surface)) for surface in surfaces]
            gmsh.model.occ.synchronize()
            with replaced_file(path) as temporary:
                with _silenced():
                    gmsh.write(str(temporary))
                temporary.write_bytes(_repeatable(temporary.read_bytes()))
            return [float(gmsh.model.occ.getMass(3, solid)) for solid in solids]
    except StageFailure:
        raise
    except Exception as error:  # all that gmsh ever raises
        reason = f"OpenCASCADE could not make a solid of the surface: {error}."
        raise StageFailure(Status.invalid_geometry, reason) from error


def _repeatable(text: bytes) -> bytes:
    """Return a STEP file without time and counters: the same solids give the same file."""
    numbers = itertools.count(1)
    text = _COUNTED.sub(rb"\1 1", _WRITTEN.sub(b"''", text, count=1))
    return _OCCURRENCE.sub(lambda found: found[1] + b"'%d'" % next(numbers), text)


@contextmanager
def _silenced() -> Iterator[None]:
    """Keep what OpenCASCADE tells on the standard output, whatever it is asked to, from there."""
    kept = os.dup(1)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(nowhere)
        os.close(kept)


def _facets(surface: Surface) -> Facets:
    tolerance = RELATIVE_TOLERANCE * float(np.linalg.norm(np.ptp(surface.points, axis=0)))
    if len(open_edges(surface.triangles)):
        raise StageFailure(
            Status.invalid_geometry, "The surface is not closed, and bounds no solid."
        )
    one_patch = np.zeros(len(surface.triangles), dtype=np.int64)
    level = float(surface.points[:, 2].min())
    complex_ = Complex(surface.points, surface.triangles, one_patch, level, tolerance, half=False)
    return _flattened(facets_of(complex_))


def _flattened(facets: Facets) -> Facets:
    """Return the facets with corners that lie in their planes as exactly as doubles can tell.

    In turn, planes are fitted to the corners, and each corner goes the shortest way to where its
    planes meet; two or three rounds do.
    """
    points = facets.points.copy()
    corners = [np.unique(facets.edges[_edges_of(loops)]) for loops in facets.loops]
    planes: list[list[int]] = [[] for _ in points]
    for plane, members in enumerate(corners):
        for corner in members:
            planes[corner].append(plane)
    for _ in range(_ROUNDS):
        fitted = [_fitted(points[members]) for members in corners]
        if max(off for _, _, off in fitted) <= _FLAT_MM:
            break
        for corner in np.flatnonzero([bool(one) for one in planes]):
            normals = np.array([fitted[plane][0] for plane in planes[corner]])
            levels = np.array([fitted[plane][1] for plane in planes[corner]])
            away = levels - normals @ points[corner]
            points[corner] += np.linalg.lstsq(normals, away, rcond=_SMALLEST_ANGLE)[0]
    return replace(facets, points=points)


def _fitted(points: FloatArray) -> tuple[FloatArray, float, float]:
    """Return normal and level of the plane nearest to some points, and how far off they are."""
    centre = points.mean(axis=0)
    normal = np.linalg.svd(points - centre, full_matrices=False)[2][-1]
    away = float(np.abs((points - centre) @ normal).max())
    return normal, float(normal @ centre), away


def _edges_of(loops: Sequence[Sequence[int]]) -> list[int]:
    return [abs(edge) - 1 for loop in loops for edge in loop]


def _add_solid(occ: Any, facets: Facets) -> int:
    """Add the solid that the facets bound: the shell that is outermost, without the others."""
    corners = {int(p): occ.addPoint(*facets.points[p]) for p in np.unique(facets.edges)}
    lines = [occ.addLine(corners[int(a)], corners[int(b)]) for a, b in facets.edges]
    planes = np.array([_add_plane(occ, loops, lines) for loops in facets.loops])
    shells = _outermost_first(facets)
    loops = [occ.addSurfaceLoop(planes[facets.shells == shell].tolist()) for shell in shells]
    return int(occ.addVolume(loops))


def _add_plane(occ: Any, loops: Sequence[Sequence[int]], lines: Sequence[int]) -> int:
    curves = [[lines[e - 1] if e > 0 else -lines[-e - 1] for e in loop] for loop in loops]
    return int(occ.addPlaneSurface([occ.addCurveLoop(curve) for curve in curves]))


def _outermost_first(facets: Facets) -> IntArray:
    numbers = np.unique(facets.shells)
    sizes = [float(np.ptp(_corners(facets, shell), axis=0).sum()) for shell in numbers]
    return np.asarray(numbers[np.argsort(-np.array(sizes), kind="stable")])


def _corners(facets: Facets, shell: int) -> FloatArray:
    found = [_edges_of(facets.loops[index]) for index in np.flatnonzero(facets.shells == shell)]
    return facets.points[facets.edges[np.concatenate(found)].ravel()]
