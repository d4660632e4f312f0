"""Triangulated input of the meshers: the body above the paper plane and the base below it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from pagd.errors import InputError
from pagd.mesh.topology import components
from pagd.mesh.types import FloatArray, IntArray

#: Points nearer than this share of the bounding box's diagonal are one point. OpenSCAD writes
#: six significant digits, which is 5e-6 of the largest coordinate.
RELATIVE_TOLERANCE = 1e-5

_STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("colour", "<u2")])
_STL_VERTEX = re.compile(rb"vertex((?:\s+[-+.\deEnaif]+){3})", re.IGNORECASE)


@dataclass(frozen=True, eq=False, slots=True)
class Surface:
    """Triangles with shared vertices: points (n, 3) in mm, triangles (m, 3) outward."""

    points: FloatArray
    triangles: IntArray

    def volume(self) -> float:
        """Return the enclosed volume in mm³ (of a closed surface)."""
        a, b, c = (self.points[self.triangles[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->", np.cross(a, b), c) / 6.0)


@dataclass(frozen=True, eq=False, slots=True)
class SurfacePair:
    """Watertight surfaces that meet in the paper plane, which is horizontal.

    body: all of the solid above the paper plane, the cavity as a void inside it.
    base: the slab below the paper plane.
    half: the pair is the half y ≥ 0 of an actuator that is symmetric in y; the cavity is then
        open at y = 0.
    """

    body: Surface
    base: Surface
    half: bool = False

    @classmethod
    def from_stl(cls, body: Path, base: Path, half: bool = False) -> SurfacePair:
        """Read both surfaces from STL files; InputError if one cannot be used."""
        return cls(read_stl(body), read_stl(base), half)

    def tolerance(self) -> float:
        """Return the distance in mm below which two points of the pair are the same."""
        points = np.vstack((self.body.points, self.base.points))
        return RELATIVE_TOLERANCE * float(np.linalg.norm(np.ptp(points, axis=0)))

    def volume(self) -> float:
        """Return the volume of the solid in mm³."""
        return self.body.volume() + self.base.volume()


def read_stl(path: Path) -> Surface:
    """Read an STL file (text or binary); vertices are merged; InputError if it holds nothing."""
    if not path.is_file():
        raise InputError(f"The surface file {path} does not exist.")
    content = path.read_bytes()
    corners = _binary_corners(content)
    if corners is None:
        corners = _text_corners(content)
    if len(corners) == 0:
        raise InputError(f"The surface file {path} holds no triangles; expected an STL file.")
    if not np.isfinite(corners).all():
        raise InputError(f"The surface file {path} holds coordinates that are not finite.")
    extent = float(np.linalg.norm(np.ptp(corners, axis=0)))
    triangles = np.arange(len(corners), dtype=np.int64).reshape(-1, 3)
    return merge_points(corners, triangles, RELATIVE_TOLERANCE * extent)


def _binary_corners(content: bytes) -> FloatArray | None:
    """Corners (3m, 3) of a binary STL file; None if its length is not that of one.

    The first word cannot tell: some programs begin binary files with "solid" too.
    """
    count = int.from_bytes(content[80:84], "little")
    if len(content) != 84 + count * _STL_RECORD.itemsize:
        return None
    records = np.frombuffer(content, _STL_RECORD, count, offset=84)
    return records["corners"].astype(np.float64).reshape(-1, 3)


def _text_corners(content: bytes) -> FloatArray:
    """Corners (3m, 3) of a text STL file; empty if it is none."""
    found = [match.split() for match in _STL_VERTEX.findall(content)]
    whole = len(found) - len(found) % 3
    return np.array(found[:whole], dtype=np.float64).reshape(-1, 3)


def merge_points(points: FloatArray, triangles: IntArray, tolerance: float) -> Surface:
    """Merge points nearer than `tolerance`, drop triangles that collapse and unused points."""
    pairs = cKDTree(points).query_pairs(tolerance, output_type="ndarray")
    label = components(pairs, len(points))
    _, representative = np.unique(label, return_index=True)
    merged = label[triangles]
    a, b, c = merged.T
    kept = merged[(a != b) & (b != c) & (c != a)]
    used, numbers = np.unique(kept, return_inverse=True)
    return Surface(points[representative[used]], numbers.reshape(-1, 3).astype(np.int64))
