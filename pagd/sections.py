"""Sections of the paper plane: where they go and how they turn.

A section is the strip of the paper plane around a station. It is sampled on a regular grid of
material points, and their displacement comes from the six-node faces of the mesh by the shape
functions of the elements themselves. The grid is centred on the station and the same for every
mesh. A plain set of the nodes near the station is neither, and matters: where the actuator curls
by 2° per mm, a set whose centre is off by 0.5 mm turns the frame by 1°.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.design import Design
from pagd.errors import InputError
from pagd.fem.compiled import compiled
from pagd.fem.shapes import triangle_values
from pagd.rotations import kabsch, rotation_matrix, rotation_vector

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

__all__ = ["Sections", "Stations", "even_stations", "place_sections", "stations_of"]

# Length of a strip as a share of the distance to the nearest station: long enough to even out the
# slopes, which jump between elements, and short enough to stay within a gap or an end wall.
STRIP_LENGTH = 0.125
# Sample points along a strip and across it.
ALONG, ACROSS = 3, 12
# A point counts as inside a face up to this barycentric coordinate beyond it: STL files keep six
# digits, so that the edges of the paper lie within some 1e-4 mm of where they should.
TOLERANCE = 0.02


@dataclass(frozen=True, eq=False, slots=True)
class Stations:
    """Stations along the undeformed actuator.

    x: (s,) coordinates in mm, rising from the fixed end (first) to the tip (last).
    names: what people read, one a station.
    """

    x: FloatArray
    names: tuple[str, ...]

    def __post_init__(self) -> None:
        if len(self.x) != len(self.names) or len(self.x) < 2 or not np.all(np.diff(self.x) > 0.0):
            raise InputError("Stations need at least two rising x, and a name for each.")


def stations_of(design: Design) -> Stations:
    """Return the stations of a row of chambers: fixed end, every chamber boundary, tip.

    The boundary of two chambers is the middle of the gap between them on the centre line y = 0:
    N chambers have N + 1 stations, and chamber i lies between stations i − 1 and i.
    """
    starts = np.asarray(design.chamber_starts(), dtype=np.float64)
    middles = 0.5 * (starts[:-1] + design.L + starts[1:])
    names = ("fixed end", *(f"chamber {i}|{i + 1}" for i in range(1, len(starts))), "tip")
    return Stations(np.array([0.0, *middles, design.L_T]), names)


def even_stations(length: float, count: int, start: float = 0.0) -> Stations:
    """Return `count` ≥ 2 evenly spaced stations from `start` to `start + length` (mm)."""
    names = ("fixed end", *(f"section {i}" for i in range(1, count - 1)), "tip")
    return Stations(np.linspace(start, start + length, count), names)


@dataclass(frozen=True, eq=False, slots=True)
class Points:
    """Material points of the paper plane, found in its faces; any leading shape (…).

    reference: (…, 3) undeformed coordinates in mm.
    nodes, values: (…, 6) nodes of the face around each point, and their shape functions there.
    sign: (…) −1 for a point of the half that the mesh leaves out by symmetry, else 1.
    inside: (…) whether there is such a face.
    """

    reference: FloatArray
    nodes: IntArray
    values: FloatArray
    sign: FloatArray
    inside: BoolArray

    def moved(self, displacement: FloatArray) -> FloatArray:
        """Return the deformed coordinates (…, 3) for nodal displacements (n, 3), in mm."""
        u = np.einsum("...a,...ai->...i", self.values, displacement[self.nodes])
        u[..., 1] *= self.sign
        return np.asarray(self.reference + u)


@dataclass(frozen=True, eq=False, slots=True)
class Sections:
    """The sections of s stations, placed in a mesh.

    stations: where they lie.
    centres: the s station points, on the centre line of the paper plane.
    strips: (s, 2, k) sample points of the two strips of each section.
    share: (s,) how far the station lies from the first strip's centre towards the second's:
        ½ between two stations; −½ and 3⁄2 at the ends, where both strips lie on the same side.
    """

    stations: Stations
    centres: Points
    strips: Points
    share: FloatArray

    def positions(self, displacement: FloatArray) -> FloatArray:
        """Return the deformed station points (s, 3) in mm for nodal displacements (n, 3)."""
        return self.centres.moved(displacement)

    def frames(self, displacement: FloatArray) -> FloatArray:
        """Return the rotations (s, 3, 3) of the sections for nodal displacements (n, 3).

        A and B are the best rigid rotations (Kabsch) of the two strips. The section's frame is
        R = A exp(c log(Aᵀ B)) with c = `share`, exact where curvature and twist are constant.
        """
        weights = self.strips.inside.astype(np.float64)
        a, b = np.moveaxis(
            kabsch(self.strips.reference, self.strips.moved(displacement), weights), 1, 0
        )
        step = rotation_vector(np.swapaxes(a, -1, -2) @ b)
        return np.asarray(a @ rotation_matrix(self.share[:, None] * step))


def place_sections(
    points: FloatArray, paper: IntArray, stations: Stations, *, mirrored: bool
) -> Sections:
    """Place the sections of `stations` in a mesh.

    Parameters
    ----------
    points
        (n, 3) undeformed node coordinates in mm.
    paper
        (f, 6) six-node faces of the paper plane: flat, normal to z, with straight edges.
    stations
        Where the sections lie, from one end of the paper to the other at most.
    mirrored
        The mesh is the half y ≥ 0 of a body that is symmetric about y = 0.

    Raises
    ------
    InputError
        If a station point lies off the paper, or the sample points of a section that lie on it
        do not span a plane.
    """
    used = points[np.unique(paper)]
    low, high = (0.0 if mirrored else float(used[:, 1].min())), float(used[:, 1].max())
    low, level = (-high if mirrored else low), float(used[:, 2].mean())
    grid, share = _sample_grid(stations.x, low, high)
    middle = np.column_stack([stations.x, np.full_like(stations.x, 0.5 * (low + high))])
    centres = _find(middle, level, points, paper, mirrored)
    strips = _find(grid, level, points, paper, mirrored)
    _refuse(np.logical_not(centres.inside), stations, "its centre point lies off the paper")
    _refuse(np.any(_is_thin(strips), axis=1), stations, "too little of it lies on the paper")
    return Sections(stations, centres, strips, share)


def _sample_grid(x: FloatArray, low: float, high: float) -> tuple[FloatArray, FloatArray]:
    """Return the sample points (s, 2, k, 2) of every section, and the stations' share (s,)."""
    gaps = np.diff(x)
    length = STRIP_LENGTH * np.minimum(np.append(gaps, np.inf), np.insert(gaps, 0, np.inf))
    # First strip's start, counted in strips from the station: one before it, one after it …
    first = np.full(len(x), -1.0)
    first[0], first[-1] = 0.0, -2.0
    # Midpoints of equal cells: no sample lies on an edge of the paper.
    along = (np.arange(ALONG) + 0.5) / ALONG
    across = low + (high - low) * (np.arange(ACROSS) + 0.5) / ACROSS
    offset = first[:, None, None] + np.arange(2.0)[:, None] + along
    xs = x[:, None, None] + length[:, None, None] * offset
    shape = (*xs.shape, ACROSS)
    grid = np.stack([np.broadcast_to(xs[..., None], shape), np.broadcast_to(across, shape)], -1)
    return grid.reshape(len(x), 2, ALONG * ACROSS, 2), -first - 0.5


def _find(
    xy: FloatArray, level: float, points: FloatArray, faces: IntArray, mirrored: bool
) -> Points:
    """Find the faces around points (…, 2) of the plane z = `level`."""
    folded = np.stack([xy[..., 0], np.abs(xy[..., 1]) if mirrored else xy[..., 1]], axis=-1)
    flat = folded.reshape(-1, 2)
    # Points that no face is found for count as outside.
    face, barycentric = np.zeros(len(flat), np.int64), np.full((len(flat), 3), -1.0)
    _locate(flat, points[faces[:, :3], :2], face, barycentric)
    shape = xy.shape[:-1]
    return Points(
        reference=np.concatenate([xy, np.full((*shape, 1), level)], axis=-1),
        nodes=faces[face].reshape(*shape, 6),
        values=triangle_values(barycentric).reshape(*shape, 6),
        sign=np.where((xy[..., 1] < 0.0) & mirrored, -1.0, 1.0),
        inside=(barycentric.min(axis=1) >= -TOLERANCE).reshape(shape),
    )


@compiled
def _locate(xy: FloatArray, corners: FloatArray, face: IntArray, barycentric: FloatArray) -> None:
    """Fill face (m,) and barycentric coordinates (m, 3) of points (m, 2) in triangles (f, 3, 2).

    Of all the faces, the first one whose least coordinate is largest.
    """
    best = np.full(len(xy), -np.inf)
    for f in range(len(corners)):
        x, y = corners[f, 0]
        ax, ay = corners[f, 1, 0] - x, corners[f, 1, 1] - y
        bx, by = corners[f, 2, 0] - x, corners[f, 2, 1] - y
        area = ax * by - bx * ay
        for m in range(len(xy)):
            dx, dy = xy[m, 0] - x, xy[m, 1] - y
            second, third = (dx * by - bx * dy) / area, (ax * dy - dx * ay) / area
            least = min(1.0 - second - third, second, third)
            if least > best[m]:
                best[m], face[m] = least, f
                barycentric[m, 0] = 1.0 - second - third
                barycentric[m, 1], barycentric[m, 2] = second, third


def _is_thin(strips: Points) -> BoolArray:
    """Tell which strips (s, 2) have no samples on the paper, or all of them on one line."""
    weight = strips.inside[..., None].astype(np.float64)
    xy = strips.reference[..., :2]
    centred = weight * (xy - (weight * xy).sum(-2, keepdims=True) / weight.sum(-2, keepdims=True))
    spread = np.swapaxes(centred, -1, -2) @ centred
    return np.asarray(~(np.linalg.det(spread) > 1e-6 * np.trace(spread, axis1=-2, axis2=-1) ** 2))


def _refuse(fault: BoolArray, stations: Stations, reason: str) -> None:
    if fault.any():
        i = int(np.argmax(fault))
        raise InputError(
            f"The section at '{stations.names[i]}', x = {stations.x[i]:.6g} mm, "
            f"cannot be measured: {reason}."
        )
