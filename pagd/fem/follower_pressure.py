"""Pressure in a closed cavity: the potential −p V of the enclosed volume.

V is written as a surface integral over six-node faces that point out of the
solid, hence into the cavity, so that its sign is turned::

    V = −∮ Σ_i w_i x_i n_i dA,   w_x + w_y + w_z = 1

With w = ⅓ each this is ⅓∮x·n. Where the surface is open at a plane that stays a
plane, its volume is still right if the plane goes through the origin (a
symmetry plane) or if the weight of its normal direction is zero. V is cubic in
the nodes' positions; its second derivative is symmetric term by term.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem import shapes
from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.quadrature import triangle
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
        for a in range(6):
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
    """Add factor · ∂²V to the packed upper triangle (171,).

    The entry (a, i; b, k) is ε_ikm times a vector that belongs to the pair (a, b).
    """
    for a in range(6):
        for b in range(a, 6):
            crossed = derivatives[a, 0] * derivatives[b, 1] - derivatives[b, 0] * derivatives[a, 1]
            for i in range(3):
                row = 3 * a + i
                start = row * 18 - row * (row - 1) // 2 - row
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
    values: FloatArray,
    derivatives: FloatArray,
    weights: FloatArray,
    axis_weights: FloatArray,
    factor: float,
    residual: FloatArray,
    tangent: FloatArray,
) -> float:
    """Volume; adds factor · ∂V and factor · ∂²V to zeroed arrays (E, 18) and (E, 171)."""
    total = 0.0
    for e in prange(len(faces)):
        positions = np.empty((6, 3))
        place, along_r, along_s = np.empty(3), np.empty(3), np.empty(3)
        residual[e, :] = 0.0
        tangent[e, :] = 0.0
        for a in range(6):
            for i in range(3):
                positions[a, i] = points[faces[e, a], i] + unknowns[3 * faces[e, a] + i]
        for q in range(len(weights)):
            _tangents(positions, values[q], derivatives[q], place, along_r, along_s)
            # Half the weight: the reference triangle has area ½. Minus: the faces
            # point into the cavity.
            weight = -0.5 * weights[q]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                normal = along_r[j] * along_s[k] - along_r[k] * along_s[j]
                total += weight * axis_weights[i] * place[i] * normal
                for a in range(6):
                    r, s = derivatives[q, a, 0], derivatives[q, a, 1]
                    slope = axis_weights[i] * values[q, a] * normal
                    slope += axis_weights[j] * place[j] * (along_r[k] * s - r * along_s[k])
                    slope += axis_weights[k] * place[k] * (r * along_s[j] - along_r[j] * s)
                    residual[e, 3 * a + i] += factor * weight * slope
            _add_hessian(
                values[q],
                derivatives[q],
                axis_weights,
                place,
                along_r,
                along_s,
                factor * weight,
                tangent[e],
            )
    return total


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
    """

    name = "pressure"

    def __init__(
        self,
        points: FloatArray,
        faces: IntArray,
        axis_weights: tuple[float, float, float] = EQUAL_WEIGHTS,
    ) -> None:
        rule = triangle(4)
        self._points = points
        self._faces = faces
        self._axis_weights = np.array(axis_weights)
        self._rule = (
            shapes.triangle_values(rule.points),
            shapes.triangle_derivatives(rule.points),
            rule.weights,
        )
        self.dofs = node_dofs(faces)
        self._scratch = ElementSystem.of(self.dofs)

    def internal_at_rest(self) -> FloatArray:
        """There are none."""
        return NO_INTERNAL

    def _fill(self, unknowns: FloatArray, factor: float, system: ElementSystem) -> float:
        return _volume(
            self._points,
            unknowns,
            self._faces,
            *self._rule,
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
