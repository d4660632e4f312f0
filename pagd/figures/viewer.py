"""Deformed shapes and trajectories as compact JSON, for the page to draw in the browser."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pagd.figures.load import Path3D, States
from pagd.figures.surface import OUTSIDE, sharp_edges, skin_of

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = ["path_data", "tip_data", "viewer_data"]

# Coordinates are kept in steps of 0.01 mm, which 16 bits hold up to 0.3 m.
_STEP_MM, _LARGEST = 0.01, 32000
# Skins of more triangles than this are drawn by the corners of the faces only.
_MANY = 40_000


def viewer_data(states: States) -> dict[str, Any]:
    """Return the skin of a design in all states.

    Keys: pressure_kPa; vertices (their number v); triangles (t, 3) and edges (e, 2), vertex
    numbers; rest (3, v) and change (p − 1, 3, v), in steps of step_mm: positions without
    pressure, and what `_changes` leaves of their displacements; strain (p, v) from 0 to 255 for 0
    to top. Arrays are little-endian integers, deflated, in base64; triangles and edges of
    index_bits.
    """
    skin = skin_of(states.mesh)
    if len(skin.triangles) > _MANY:
        skin = skin_of(states.mesh, OUTSIDE, corners_only=True)
    rest = skin.vectors(states.mesh.points)
    edges = sharp_edges(rest, skin.triangles)
    source, triangles = _split_along(edges, skin.triangles)
    points = np.stack([rest + skin.vectors(u) for u in states.displacement])[:, source]
    strain = np.stack([skin.scalars(e) for e in states.strain])[:, source]
    step = max(_STEP_MM, float(np.abs(points).max()) / _LARGEST)
    top = max(float(np.percentile(strain[-1], 99.0)), 1e-3)
    steps = np.rint(np.moveaxis(points, 2, 1) / step)
    # The edges go by any of the copies of their vertices.
    copy = np.zeros(len(skin.nodes), dtype=np.int64)
    copy[source] = np.arange(len(source))
    bits = 16 if len(source) < 2**16 else 32
    return {
        "pressure_kPa": states.pressure_kPa.round(6).tolist(),
        "vertices": len(source),
        "index_bits": bits,
        "triangles": _packed(triangles, f"<u{bits // 8}"),
        "edges": _packed(copy[edges], f"<u{bits // 8}"),
        "step_mm": step,
        "rest": _packed(steps[0], "<i2"),
        "change": _packed(_changes(steps[1:] - steps[0]), "<i2"),
        "top": top,
        "strain": _packed(np.rint(np.clip(strain / top, 0.0, 1.0) * 255.0), "<u1"),
    }


def path_data(path: Path3D) -> dict[str, Any]:
    """Return the trajectory of a design: pressures, tip, centre lines (x, z) and angles."""
    return {
        "pressure_kPa": path.pressure_kPa.round(6).tolist(),
        "lines": _rounded(np.moveaxis(path.positions, 2, 1)),
        "bending_deg": _rounded(path.bending_deg[:, -1]),
        "twist_deg": _rounded(path.twist_deg[:, -1]),
    }


def tip_data(path: Path3D) -> dict[str, Any]:
    """Return what plots of many designs show of one: the tip's path and angles, the last line."""
    return {
        "pressure_kPa": path.pressure_kPa.round(6).tolist(),
        "tip": _rounded(path.positions[:, -1].T),
        "last": _rounded(path.positions[-1].T),
        "bending_deg": _rounded(path.bending_deg[:, -1]),
        "twist_deg": _rounded(path.twist_deg[:, -1]),
    }


def _rounded(values: FloatArray) -> list[Any]:
    # Adding zero takes the sign off a negative one.
    rounded: list[Any] = (values.round(2) + 0.0).tolist()
    return rounded


def _packed(values: NDArray[Any], kind: str) -> str:
    raw = np.ascontiguousarray(values, dtype=kind).tobytes()
    return base64.b64encode(zlib.compress(raw, 9)).decode("ascii")


def _changes(displacement: FloatArray) -> FloatArray:
    """Return how much each displacement (p, 3, v) departs from the course of the two before it.

    The numbers are small, and deflate to half. Two running sums over the states undo it.
    """
    return np.asarray(
        np.diff(displacement, n=2, axis=0, prepend=np.zeros((2, *displacement.shape[1:])))
    )


def _split_along(edges: IntArray, triangles: IntArray) -> tuple[IntArray, IntArray]:
    """Give every smooth patch its own vertices, so that shading stays crisp at sharp edges.

    Returns
    -------
    source, triangles
        (w,) old number of every new vertex, and (t, 3) new vertex numbers.
    """
    patch = _patches(edges, triangles)
    pairs = np.stack([triangles.ravel(), np.repeat(patch, 3)], axis=1)
    unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
    return unique[:, 0], inverse.reshape(-1, 3)


def _patches(edges: IntArray, triangles: IntArray) -> IntArray:
    """Return the patch (t,) of every triangle: those joined by edges that are not sharp."""
    base = int(triangles.max()) + 1
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    keys, owner = sides @ [base, 1], np.repeat(np.arange(len(triangles)), 3)
    smooth = ~np.isin(keys, edges @ [base, 1])
    keys, owner = keys[smooth], owner[smooth]
    order = np.argsort(keys, kind="stable")
    # Every smooth edge has exactly two triangles: neighbours in the sorted list.
    first, second = owner[order].reshape(-1, 2).T
    shape = (len(triangles), len(triangles))
    graph = coo_array((np.ones(len(first)), (first, second)), shape=shape)
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)
