"""Hyperelastic laws of the invariants of b̄: polynomials (Yeoh, Mooney–Rivlin) and Gent.

Stresses and tangents of a point q are written to its row of arrays for many points: lefts b̄
(Q, 3, 3), stresses (Q, 6), tangents (Q, 6, 6), as :mod:`pagd.fem.hyperelastic` has them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled
from pagd.fem.symmetric import FIRST, SECOND
from pagd.materials import GENT

FloatArray = NDArray[np.float64]


@compiled
def _slopes(
    law: int, parameters: FloatArray, invariant_1: float, invariant_2: float
) -> tuple[float, float, float, float]:
    """Energy and its derivatives W, ∂W/∂Ī₁, ∂²W/∂Ī₁², ∂W/∂Ī₂; infinite where the law locks."""
    x = invariant_1 - 3.0
    if law == GENT:
        modulus, limit = parameters[0], parameters[1]
        room = 1.0 - x / limit
        if room <= 1e-6:
            return np.inf, 0.0, 0.0, 0.0
        slope = 0.5 * modulus / room
        return -0.5 * modulus * limit * np.log(room), slope, slope / (limit * room), 0.0
    c10, c20, c30, c01 = parameters[0], parameters[1], parameters[2], parameters[3]
    energy = x * (c10 + x * (c20 + x * c30)) + c01 * (invariant_2 - 3.0)
    return energy, c10 + x * (2 * c20 + 3 * c30 * x), 2 * c20 + 6 * c30 * x, c01


@compiled
def _common(
    law: int, parameters: FloatArray, b: FloatArray, q: int
) -> tuple[float, float, float, float]:
    """Energy of point q, 2 (∂W/∂Ī₁ + Ī₁ ∂W/∂Ī₂), 4 (∂²W/∂Ī₁² + ∂W/∂Ī₂), and tr b̄ / 3."""
    trace = b[q, 0, 0] + b[q, 1, 1] + b[q, 2, 2]
    second = 0.5 * (trace * trace - _trace_of_square(b, q))
    energy, w1, w11, w2 = _slopes(law, parameters, trace, second)
    return energy, 2.0 * (w1 + trace * w2), 4.0 * (w11 + w2), trace / 3.0


@compiled
def _trace_of_square(b: FloatArray, q: int) -> float:
    xx, yy, zz = b[q, 0, 0], b[q, 1, 1], b[q, 2, 2]
    xy, yz, zx = b[q, 0, 1], b[q, 1, 2], b[q, 2, 0]
    return float(xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx))


@compiled
def invariant_stress(
    law: int, parameters: FloatArray, b: FloatArray, q: int, stress: FloatArray
) -> float:
    """Fill the deviatoric stress of point q but for that of :func:`second_factor`; its energy."""
    energy, factor, _, third = _common(law, parameters, b, q)
    for m in range(3):
        stress[q, m] = factor * (b[q, m, m] - third)
        stress[q, m + 3] = factor * b[q, m, (m + 1) % 3]
    return energy


@compiled
def invariant_law(
    law: int, parameters: FloatArray, b: FloatArray, q: int, stress: FloatArray, tangent: FloatArray
) -> float:
    """The same with the tangent; what the projection P makes of b̄ ⊗ b̄ is known beforehand."""
    energy, factor, steep, third = _common(law, parameters, b, q)
    stretches = (b[q, 0, 0] - third, b[q, 1, 1] - third, b[q, 2, 2] - third)
    shears = (b[q, 0, 1], b[q, 1, 2], b[q, 2, 0])
    mean, turned = factor * third, 2.0 / 3.0 * factor
    for m in range(3):
        stretch, shear = stretches[m], shears[m]
        stress[q, m], stress[q, m + 3] = factor * stretch, factor * shear
        for n in range(3):
            other_stretch, other_shear = stretches[n], shears[n]
            spread = turned * (third + stretch + other_stretch)
            tangent[q, m, n] = steep * stretch * other_stretch - spread
            tangent[q, m, n + 3] = (steep * stretch - turned) * other_shear
            tangent[q, m + 3, n] = (steep * other_stretch - turned) * shear
            tangent[q, m + 3, n + 3] = steep * shear * other_shear
        tangent[q, m, m] += 2.0 * mean
        tangent[q, m + 3, m + 3] += mean
    return energy


@compiled
def second_factor(law: int, parameters: FloatArray) -> float:
    """The factor −2 ∂W/∂Ī₂ of dev b̄² in the stress: the same at all points."""
    return 0.0 if law == GENT else float(-2.0 * parameters[3])


@compiled
def _square(b: FloatArray, q: int, m: int) -> float:
    """Entry m of the six of b̄² at point q."""
    i, j = FIRST[m], SECOND[m]
    return float(b[q, i, 0] * b[q, 0, j] + b[q, i, 1] * b[q, 1, j] + b[q, i, 2] * b[q, 2, j])


@compiled
def add_second_stress(factor: float, b: FloatArray, q: int, stress: FloatArray) -> None:
    """Add ``factor`` dev b̄² to the stress."""
    third = _trace_of_square(b, q) / 3.0
    for m in range(6):
        stress[q, m] += factor * (_square(b, q, m) - (third if m < 3 else 0.0))


@compiled
def add_second_tangent(factor: float, b: FloatArray, q: int, tangent: FloatArray) -> None:
    """Add to the tangent what belongs to it."""
    mean = factor * _trace_of_square(b, q) / 3.0
    for m in range(6):
        i, j = FIRST[m], SECOND[m]
        both = 4.0 / 3.0 * factor * _square(b, q, m)
        for n in range(6):
            k, r = FIRST[n], SECOND[n]
            crossed = b[q, i, k] * b[q, j, r] + b[q, i, r] * b[q, j, k]
            tangent[q, m, n] += factor * crossed
        for n in range(3):
            tangent[q, m, n] -= both
            tangent[q, n, m] -= both
    for m in range(3):
        tangent[q, m, m] += 2.0 * mean
        tangent[q, m + 3, m + 3] += mean
        for n in range(3):
            tangent[q, m, n] += 4.0 / 3.0 * mean
