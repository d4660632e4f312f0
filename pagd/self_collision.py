"""Detects an actuator that touches itself, as on a full curl.

Contact is solved between walls that face each other across a gap; this here is for places that
are far apart along the undeformed actuator: its tip against its base, one turn of a helix against
the next. They collide where the outside of the deformed body crosses itself. Crossing surfaces are
found however deep one has gone into the other, so that a step may jump past the first touch.

x runs along the actuator.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError, Status
from pagd.fem.compiled import compiled
from pagd.mesh.types import Mesh

__all__ = ["Collision", "SelfCollision", "self_collision_stop"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Surfaces that are not the outside of an actuator.
_INSIDE = ("cavity", "paper", "symmetry")
#: Places nearer than this share of the length along the undeformed actuator are neighbours.
_FAR_SHARE = 1 / 3
#: The outside is cut into so many slices along the actuator, compared before their faces are.
_SLICES = 32
#: The four flat triangles of a six-node face.
_FLAT: IntArray = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)])
#: An edge that passes another's triangle by less than this, in barycentric coordinates, meets it.
_BESIDE = 1e-9


@compiled
def _cross(a: FloatArray, b: FloatArray, result: FloatArray) -> None:
    result[0] = a[1] * b[2] - a[2] * b[1]
    result[1] = a[2] * b[0] - a[0] * b[2]
    result[2] = a[0] * b[1] - a[1] * b[0]


@compiled
def _dot(a: FloatArray, b: FloatArray) -> float:
    product: float = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


@compiled
def _pierces(
    start: FloatArray,
    end: FloatArray,
    a: FloatArray,
    b: FloatArray,
    c: FloatArray,
    work: FloatArray,
) -> bool:
    """Whether the segment from ``start`` to ``end`` passes through the triangle a, b, c."""
    ab, ac, normal, to, product = work[0], work[1], work[2], work[3], work[4]
    before, behind = 0.0, 0.0
    for i in range(3):
        ab[i], ac[i] = b[i] - a[i], c[i] - a[i]
    _cross(ab, ac, normal)
    for i in range(3):
        before += normal[i] * (start[i] - a[i])
        behind += normal[i] * (end[i] - a[i])
    if before * behind > 0.0 or before == behind:
        return False
    share = before / (before - behind)
    for i in range(3):
        to[i] = start[i] + share * (end[i] - start[i]) - a[i]
    square = _dot(normal, normal)
    _cross(to, ac, product)
    u = _dot(product, normal) / square
    _cross(ab, to, product)
    v = _dot(product, normal) / square
    return bool(u >= -_BESIDE and v >= -_BESIDE and u + v <= 1 + _BESIDE)


@compiled
def _cross_each_other(first: FloatArray, second: FloatArray, work: FloatArray) -> bool:
    """Whether two six-node faces (6, 3), each as four flat triangles, cross each other."""
    for s in _FLAT:
        for t in _FLAT:
            for i in range(3):
                j = (i + 1) % 3
                edge, other = (first[s[i]], first[s[j]]), (second[t[i]], second[t[j]])
                if _pierces(edge[0], edge[1], second[t[0]], second[t[1]], second[t[2]], work):
                    return True
                if _pierces(other[0], other[1], first[s[0]], first[s[1]], first[s[2]], work):
                    return True
    return False


@compiled
def _apart(low: FloatArray, high: FloatArray, others: FloatArray, ends: FloatArray) -> bool:
    """Whether two boxes have nothing in common."""
    apart = False
    for k in range(3):
        apart |= high[k] < others[k] or ends[k] < low[k]
    return apart


@compiled
def _first_crossing(
    faces: FloatArray,
    low: FloatArray,
    high: FloatArray,
    starts: FloatArray,
    ends: FloatArray,
    far: float,
    first: IntArray,
    second: IntArray,
) -> tuple[int, int]:
    """Two faces that cross, more than ``far`` between them; (−1, −1) if there are none.

    ``faces`` (F, 6, 3) with their boxes, and where they start and end along the undeformed
    actuator; those numbered from first[0] to first[1] are compared with those from second[0] to
    second[1].
    """
    work = np.empty((5, 3))
    for i in range(first[0], first[1]):
        for j in range(second[0], second[1]):
            if starts[j] - ends[i] <= far or _apart(low[i], high[i], low[j], high[j]):
                continue
            if _cross_each_other(faces[i], faces[j], work):
                return i, j
    return -1, -1


@dataclass(frozen=True, eq=False, slots=True)
class Collision:
    """Where an actuator has met itself.

    Attributes
    ----------
    places
        Where the two places (2, 3) lie in the undeformed actuator, the one nearer to the fixed
        end first, in mm: the middles of the two faces that cross.
    point
        Where they meet (3,), in mm.
    """

    places: FloatArray
    point: FloatArray


class SelfCollision:
    """Looks for places of the outside that meet, a third of the length or more apart along x.

    In the half of a symmetric actuator, what crosses the symmetry plane is not looked at.

    Parameters
    ----------
    mesh
        The actuator; all of its surfaces but ``cavity``, ``paper`` and ``symmetry`` are outside.

    Raises
    ------
    InputError
        Where the mesh has no other surface.
    """

    def __init__(self, mesh: Mesh) -> None:
        outside = [faces for name, faces in mesh.surfaces.items() if name not in _INSIDE]
        if not outside:
            raise InputError(
                "The mesh has no surface that is outside, such as 'outer'; it has: "
                f"{', '.join(sorted(mesh.surfaces)) or 'none'}."
            )
        faces = np.vstack(outside)
        # Two faces are as far apart as their nearest nodes: faces of one node never count.
        self._faces = faces[np.argsort(mesh.points[faces, 0].mean(axis=1), kind="stable")]
        self._points = mesh.points
        along = mesh.points[self._faces, 0]
        self._begins, self._ends = along.min(axis=1), along.max(axis=1)
        self._far = _FAR_SHARE * float(np.ptp(mesh.points[:, 0]))
        self._starts = np.unique(np.linspace(0, len(faces), _SLICES + 1).astype(np.int64))
        self._slices = self._far_slices()

    def find(self, displacement: FloatArray) -> Collision | None:
        """Return a place where the body, displaced by (n, 3) mm, meets itself, or None."""
        faces = (self._points + displacement)[self._faces]
        low, high = faces.min(axis=1), faces.max(axis=1)
        for first, second in self._near_slices(low, high):
            i, j = _first_crossing(
                faces,
                low,
                high,
                self._begins,
                self._ends,
                self._far,
                self._starts[first : first + 2],
                self._starts[second : second + 2],
            )
            if i >= 0:
                return self._collision(faces, i, j)
        return None

    def _far_slices(self) -> IntArray:
        """Pairs (p, 2) of slices that hold faces far enough apart, the lower one first."""
        nearest = np.minimum.reduceat(self._ends, self._starts[:-1])
        farthest = np.maximum.reduceat(self._begins, self._starts[:-1])
        return np.argwhere(farthest[None, :] - nearest[:, None] > self._far)

    def _near_slices(self, low: FloatArray, high: FloatArray) -> IntArray:
        """Those of the pairs of slices whose boxes meet."""
        lows = np.minimum.reduceat(low, self._starts[:-1])
        highs = np.maximum.reduceat(high, self._starts[:-1])
        first, second = self._slices.T
        meet = (lows[first] <= highs[second]) & (lows[second] <= highs[first])
        return np.asarray(self._slices[meet.all(axis=1)])

    def _collision(self, faces: FloatArray, i: int, j: int) -> Collision:
        places = self._points[self._faces[[i, j]]].mean(axis=1)
        return Collision(places, faces[[i, j]].mean(axis=(0, 1)))


def self_collision_stop(
    mesh: Mesh,
) -> Callable[[float, FloatArray], tuple[Status, str] | None]:
    """Return what ends an analysis where the actuator touches itself.

    It takes a pressure in kPa and a displacement (n, 3) in mm.
    """
    collision = SelfCollision(mesh)

    def stop(pressure_kPa: float, displacement: FloatArray) -> tuple[Status, str] | None:
        found = collision.find(displacement)
        if found is None:
            return None
        near, far = found.places[:, 0]
        return Status.self_collision, (
            f"At {pressure_kPa:.4g} kPa the actuator touches itself: x = {near:.1f} mm and "
            f"x = {far:.1f} mm of the undeformed shape."
        )

    return stop
