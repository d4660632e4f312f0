"""Isotropic hyperelastic laws: energy, Kirchhoff stress and spatial tangent.

A law is a function W of the isochoric stretch alone; the volumetric part is an
unknown of its own (see :mod:`pagd.fem.solid`). With b̄ = J^(−2/3) F Fᵀ, the
fictitious stress τ̄ and tangent c̄ come from the law, and the deviatoric
projection is the same for all (Holzapfel, *Nonlinear Solid Mechanics*, 2000,
section 6.6, eqs 6.91–6.103 and 6.168, in their spatial form)::

    τ = P : τ̄
    c = P : c̄ : P + ⅔ tr(τ̄) P − ⅔ (I ⊗ τ + τ ⊗ I),    P = 𝕀 − ⅓ I ⊗ I

Symmetric tensors are stored as (xx, yy, zz, xy, yz, zx); the columns of a
tangent act on engineering strains.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled
from pagd.materials import GENT, OGDEN, POLYNOMIAL

FloatArray = NDArray[np.float64]

_FIRST = np.array([0, 1, 2, 0, 1, 2])
_SECOND = np.array([0, 1, 2, 1, 2, 0])


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
def _invariant_law(
    law: int, parameters: FloatArray, b: FloatArray, stress: FloatArray, tangent: FloatArray
) -> float:
    """Fictitious stress and tangent of a law W(Ī₁, Ī₂) that is linear in Ī₂."""
    trace = b[0, 0] + b[1, 1] + b[2, 2]
    squared = 0.0
    for i in range(3):
        for j in range(3):
            squared += b[i, j] * b[i, j]
    energy, w1, w11, w2 = _slopes(law, parameters, trace, 0.5 * (trace * trace - squared))
    for m in range(6):
        i, j = _FIRST[m], _SECOND[m]
        square = b[i, 0] * b[0, j] + b[i, 1] * b[1, j] + b[i, 2] * b[2, j]
        stress[m] = 2.0 * (w1 + trace * w2) * b[i, j] - 2.0 * w2 * square
        for n in range(6):
            k, r = _FIRST[n], _SECOND[n]
            crossed = 0.5 * (b[i, k] * b[j, r] + b[i, r] * b[j, k])
            tangent[m, n] = 4.0 * (w11 + w2) * b[i, j] * b[k, r] - 4.0 * w2 * crossed
    return energy


@compiled
def _ogden_axes(
    parameters: FloatArray, squares: FloatArray, beta: FloatArray, gamma: FloatArray
) -> float:
    """Principal stresses β = λ ∂W/∂λ and slopes γ = dβ/d(ln λ) of W = Σ 2µ/α² (Σ λ^α − 3)."""
    energy = 0.0
    for axis in range(3):
        beta[axis] = 0.0
        gamma[axis] = 0.0
        for term in range(parameters.size // 2):
            modulus, exponent = parameters[2 * term], parameters[2 * term + 1]
            power = squares[axis] ** (0.5 * exponent)
            energy += 2.0 * modulus / (exponent * exponent) * (power - 1.0)
            beta[axis] += 2.0 * modulus / exponent * power
            gamma[axis] += 2.0 * modulus * power
    return energy


@compiled
def _shear_slope(squares: FloatArray, beta: FloatArray, gamma: FloatArray, a: int, c: int) -> float:
    """(β_a λ_c² − β_c λ_a²) / (λ_a² − λ_c²), by its limit where the stretches meet."""
    difference = squares[a] - squares[c]
    if abs(difference) > 1e-6 * (squares[a] + squares[c]):
        return float((beta[a] * squares[c] - beta[c] * squares[a]) / difference)
    return float(0.25 * (gamma[a] + gamma[c]) - 0.5 * (beta[a] + beta[c]))


@compiled
def _principal_law(
    parameters: FloatArray, b: FloatArray, stress: FloatArray, tangent: FloatArray
) -> float:
    """Fictitious stress and tangent of the Ogden law from the principal axes of b̄."""
    squares, axes = np.linalg.eigh(b)
    beta = np.empty(3)
    gamma = np.empty(3)
    energy = _ogden_axes(parameters, squares, beta, gamma)
    stress[:] = 0.0
    tangent[:, :] = 0.0
    dyad = np.empty((3, 6))
    shear = np.empty(6)
    for a in range(3):
        for m in range(6):
            dyad[a, m] = axes[_FIRST[m], a] * axes[_SECOND[m], a]
        for m in range(6):
            stress[m] += beta[a] * dyad[a, m]
            for n in range(6):
                tangent[m, n] += (gamma[a] - 2.0 * beta[a]) * dyad[a, m] * dyad[a, n]
    for a in range(3):
        c = (a + 1) % 3
        slope = _shear_slope(squares, beta, gamma, a, c)
        for m in range(6):
            i, j = _FIRST[m], _SECOND[m]
            shear[m] = axes[i, a] * axes[j, c] + axes[j, a] * axes[i, c]
        for m in range(6):
            for n in range(6):
                tangent[m, n] += slope * shear[m] * shear[n]
    return energy


@compiled
def _project(stress: FloatArray, tangent: FloatArray) -> None:
    """Deviatoric stress and tangent from the fictitious ones, in place."""
    trace = stress[0] + stress[1] + stress[2]
    rows = np.empty(6)
    for m in range(6):
        rows[m] = (tangent[m, 0] + tangent[m, 1] + tangent[m, 2]) / 3.0
    total = (rows[0] + rows[1] + rows[2]) / 3.0
    for m in range(3):
        stress[m] -= trace / 3.0
    for m in range(6):
        unit_m = 1.0 if m < 3 else 0.0
        tangent[m, m] += trace / 3.0 * (1.0 + unit_m)
        for n in range(6):
            unit_n = 1.0 if n < 3 else 0.0
            tangent[m, n] += (
                (total - 2.0 / 9.0 * trace) * unit_m * unit_n
                - (rows[m] + 2.0 / 3.0 * stress[m]) * unit_n
                - (rows[n] + 2.0 / 3.0 * stress[n]) * unit_m
            )


@compiled
def deviatoric_response(
    law: int, parameters: FloatArray, b: FloatArray, stress: FloatArray, tangent: FloatArray
) -> float:
    """Energy density (MPa); fills Kirchhoff stress (6,) and tangent (6, 6) of b̄ (3, 3).

    The energy is infinite where the law has reached its limit of stretch.
    """
    if law == OGDEN:
        energy = _principal_law(parameters, b, stress, tangent)
    else:
        energy = _invariant_law(law, parameters, b, stress, tangent)
    _project(stress, tangent)
    return energy


__all__ = ["GENT", "OGDEN", "POLYNOMIAL", "deviatoric_response"]
