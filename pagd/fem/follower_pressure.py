"""Pressure in a closed cavity: the potential −p V of the enclosed volume.

V is written as a surface integral over faces that point out of the solid, hence
into the cavity, so that its sign is turned::

    V = −∮ Σ_i w_i x_i n_i dA,   w_x + w_y + w_z = 1

With w = ⅓ each this is ⅓∮x·n. Where the surface is open at a plane that stays a
plane, its volume is still right if the plane goes through the origin (a
symmetry plane) or if the weight of its normal direction is zero. V is cubic in
the nodes' positions; its second derivative is symmetric term by term.

Faces are those of the elements: triangles of six nodes, quadrilaterals of nine. Two
triangles on the nodes of a quadrilateral have another volume when it bulges.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem import shapes
from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.quadrature import quadrilateral, triangle
from pagd.fem.term import NO_INTERNAL, ElementSystem, node_dofs

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

EQUAL_WEIGHTS = (1 / 3, 1 / 3, 1 / 3)


@compiled
def _tangents(
    positions: FloatArray,
    values: FloatArray,
    derivatives: FloatArray,
    place: FloatArray,
    along_r: FloatArray,
    along_s: FloatArray,
) -> None:
    """Position and the two tangent vectors of a face at one point."""
    for i in range(3):
        place[i], along_r[i], along_s[i] = 0.0, 0.0, 0.0
        for a in range(len(values)):
            place[i] += values[a] * positions[a, i]
            along_r[i] += derivatives[a, 0] * positions[a, i]
            along_s[i] += derivatives[a, 1] * positions[a, i]


@compiled
def _add_hessian(
    values: FloatArray,
    derivatives: FloatArray,
    axis_weights: FloatArray,
    place: FloatArray,
    along_r: FloatArray,
    along_s: FloatArray,
    factor: float,
    tangent: FloatArray,
) -> None:
    """Add factor · ∂²V to the packed upper triangle of an element.

    The entry (a, i; b, k) is ε_ikm times a vector that belongs to the pair (a, b).
    """
    count = len(values)
    size = 3 * count
    for a in range(count):
        for b in range(a, count):
            crossed = derivatives[a, 0] * derivatives[b, 1] - derivatives[b, 0] * derivatives[a, 1]
            for i in range(3):
                row = 3 * a + i
                start = row * size - row * (row - 1) // 2 - row
                for step in range(1, 3):
                    k = (i + step) % 3
                    if 3 * b + k < row:
                        continue
                    m = 3 - i - k
                    sign = factor if step == 1 else -factor
                    b_part = derivatives[b, 0] * along_s[m] - derivatives[b, 1] * along_r[m]
                    a_part = derivatives[a, 0] * along_s[m] - derivatives[a, 1] * along_r[m]
                    tangent[start + 3 * b + k] += sign * (
                        axis_weights[i] * values[a] * b_part
                        - axis_weights[k] * values[b] * a_part
                        + axis_weights[m] * place[m] * crossed
                    )


@compiled_parallel
def _volume(
    points: FloatArray,
    unknowns: FloatArray,
    faces: IntArray,
    kinds: IntArray,
    values: FloatArray,
    derivatives: FloatArray,
    weights: FloatArray,
    axis_weights: FloatArray,
    factor: float,
    residual: FloatArray,
    tangent: FloatArray,
) -> float:
    """Volume; fills factor · ∂V (E, 27) and factor · ∂²V (E, 378).

    Shapes: faces (E, 9), kinds (E,), and for each kind values (2, Q, 9), derivatives (2, Q, 9, 2)
    and weights (2, Q).
    """
    total, count = 0.0, faces.shape[1]
    for e in prange(len(faces)):
        positions, kind = np.empty((count, 3)), kinds[e]
        place, along_r, along_s = np.empty(3), np.empty(3), np.empty(3)
        residual[e, :] = 0.0
        tangent[e, :] = 0.0
        for a in range(count):
            for i in range(3):
                positions[a, i] = points[faces[e, a], i] + unknowns[3 * faces[e, a] + i]
        for q in range(weights.shape[1]):
            _tangents(positions, values[kind, q], derivatives[kind, q], place, along_r, along_s)
            # Minus: the faces point into the cavity.
            weight = -weights[kind, q]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                normal = along_r[j] * along_s[k] - along_r[k] * along_s[j]
                total += weight * axis_weights[i] * place[i] * normal
                for a in range(count):
                    r, s = derivatives[kind, q, a, 0], derivatives[kind, q, a, 1]
                    slope = axis_weights[i] * values[kind, q, a] * normal
                    slope += axis_weights[j] * place[j] * (along_r[k] * s - r * along_s[k])
                    slope += axis_weights[k] * place[k] * (r * along_s[j] - along_r[j] * s)
                    residual[e, 3 * a + i] += factor * weight * slope
            _add_hessian(
                values[kind, q],
                derivatives[kind, q],
                axis_weights,
                place,
                along_r,
                along_s,
                factor * weight,
                tangent[e],
            )
    return total


# Numbers of the two kinds of faces in the tables of :func:`_rules`.
_TRIANGLE, _QUADRILATERAL = 0, 1


def _rules() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Values (2, 9, 9), derivatives (2, 9, 9, 2), weights (2, 9) of both kinds of faces.

    A triangle has six nodes and points; the rest is zero.
    """
    values, derivatives, weights = np.zeros((2, 9, 9)), np.zeros((2, 9, 9, 2)), np.zeros((2, 9))
    three, four = triangle(4), quadrilateral()
    values[_TRIANGLE, :6, :6] = shapes.triangle_values(three.points)
    derivatives[_TRIANGLE, :6, :6] = shapes.triangle_derivatives(three.points)
    weights[_TRIANGLE, :6] = three.weights / 2  # the area of the reference triangle
    values[_QUADRILATERAL] = shapes.quadrilateral_values(four.points)
    derivatives[_QUADRILATERAL] = shapes.quadrilateral_derivatives(four.points)
    weights[_QUADRILATERAL] = four.weights
    return values, derivatives, weights


class FollowerPressure:
    """The term −p V; the load factor is the pressure p in MPa.

    Parameters
    ----------
    points
        Reference coordinates (n, 3) in mm.
    faces
        Six-node faces (E, 6) of the cavity, pointing out of the solid.
    axis_weights
        The weights (w_x, w_y, w_z) of the volume formula; see the module.
    quadrilaterals
        Nine-node faces (F, 9) of the cavity beside them, node 3 i + j at (i/2, j/2).
    """

    name = "pressure"

    def __init__(
        self,
        points: FloatArray,
        faces: IntArray,
        axis_weights: tuple[float, float, float] = EQUAL_WEIGHTS,
        quadrilaterals: IntArray | None = None,
    ) -> None:
        self._points = points
        quads = np.zeros((0, 9), np.int64) if quadrilaterals is None else quadrilaterals
        # Triangles are given three nodes more, of their own, that nothing depends on.
        self._faces = np.vstack([np.hstack([faces, faces[:, :3]]), quads])
        self._kinds = np.repeat([_TRIANGLE, _QUADRILATERAL], [len(faces), len(quads)])
        self._rules = _rules()
        self._axis_weights = np.array(axis_weights)
        self.dofs = node_dofs(self._faces)
        self._scratch = ElementSystem.of(self.dofs)

    def internal_at_rest(self) -> FloatArray:
        """There are none."""
        return NO_INTERNAL

    def _fill(self, unknowns: FloatArray, factor: float, system: ElementSystem) -> float:
        return _volume(
            self._points,
            unknowns,
            self._faces,
            self._kinds,
            *self._rules,
            self._axis_weights,
            factor,
            system.residual,
            system.tangent,
        )

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        return -load * self._fill(unknowns, -load, system)

    def advance(self, correction: FloatArray) -> FloatArray:
        """Nothing to advance."""
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """The potential −p V, in mJ."""
        return -load * self.volume(unknowns)

    def conjugate(self, unknowns: FloatArray) -> tuple[float, FloatArray]:
        """The volume V in mm³, conjugate to the pressure, and its gradient (size,)."""
        volume = self._fill(unknowns, 1.0, self._scratch)
        flat = self.dofs.ravel()
        slopes = np.bincount(flat, self._scratch.residual.ravel(), minlength=len(unknowns))
        return volume, np.asarray(slopes, dtype=np.float64)

    def volume(self, unknowns: FloatArray) -> float:
        """The enclosed volume V, in mm³."""
        return self._fill(unknowns, 0.0, self._scratch)
