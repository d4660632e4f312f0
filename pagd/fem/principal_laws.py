"""The hyperelastic law of Ogden: of the principal stretches, in the principal axes of b̄.

Symmetric tensors as in :mod:`pagd.fem.hyperelastic`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled
from pagd.fem.symmetric import FIRST, SECOND

FloatArray = NDArray[np.float64]

# Jacobi's method ends where what is left off the diagonal is below rounding; by far before this.
_SWEEPS = 12


@compiled
def _rotate(matrix: FloatArray, axes: FloatArray, i: int, j: int) -> None:
    """Turn the axes (columns) in their plane ij so that entry ij of the matrix (3, 3) is zero."""
    if matrix[i, j] == 0.0:
        return
    ratio = (matrix[j, j] - matrix[i, i]) / (2.0 * matrix[i, j])
    tangent = 1.0 / (abs(ratio) + np.sqrt(1.0 + ratio * ratio))
    if ratio < 0.0:
        tangent = -tangent
    cosine = 1.0 / np.sqrt(1.0 + tangent * tangent)
    sine, k = tangent * cosine, 3 - i - j
    matrix[i, i] -= tangent * matrix[i, j]
    matrix[j, j] += tangent * matrix[i, j]
    matrix[i, j] = matrix[j, i] = 0.0
    x, y = matrix[k, i], matrix[k, j]
    matrix[k, i] = matrix[i, k] = cosine * x - sine * y
    matrix[k, j] = matrix[j, k] = sine * x + cosine * y
    for m in range(3):
        x, y = axes[m, i], axes[m, j]
        axes[m, i], axes[m, j] = cosine * x - sine * y, sine * x + cosine * y


@compiled
def _principal_axes(b: FloatArray, squares: FloatArray, axes: FloatArray) -> None:
    """Fill the squared stretches (3,) of b̄ and their axes (3, 3), in columns, by Jacobi's method.

    Golub and Van Loan, *Matrix Computations*, 2013, section 8.5.
    """
    matrix = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            matrix[i, j] = b[i, j]
            axes[i, j] = 1.0 if i == j else 0.0
    trace = matrix[0, 0] + matrix[1, 1] + matrix[2, 2]
    for _ in range(_SWEEPS):
        if abs(matrix[0, 1]) + abs(matrix[1, 2]) + abs(matrix[2, 0]) <= 1e-17 * trace:
            break
        _rotate(matrix, axes, 0, 1)
        _rotate(matrix, axes, 1, 2)
        _rotate(matrix, axes, 0, 2)
    for i in range(3):
        squares[i] = matrix[i, i]


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
def _fill_sum(factors: FloatArray, axes: FloatArray, six: FloatArray) -> None:
    """Fill Σ f_a n_a ⊗ n_a (6,)."""
    for m in range(6):
        i, j = FIRST[m], SECOND[m]
        six[m] = 0.0
        for a in range(3):
            six[m] += factors[a] * axes[i, a] * axes[j, a]


@compiled
def _add_square(
    factor: float, axes: FloatArray, a: int, c: int, six: FloatArray, tangent: FloatArray
) -> None:
    """Add f s ⊗ s to a tangent (6, 6), s = (n_a ⊗ n_c + n_c ⊗ n_a)/2; ``six`` is scratch."""
    for m in range(6):
        i, j = FIRST[m], SECOND[m]
        six[m] = 0.5 * (axes[i, a] * axes[j, c] + axes[j, a] * axes[i, c])
    for m in range(6):
        for n in range(6):
            tangent[m, n] += factor * six[m] * six[n]


@compiled
def principal_stress(parameters: FloatArray, b: FloatArray, stress: FloatArray) -> float:
    """Fill the deviatoric stress (6,) of b̄ (3, 3); the energy."""
    squares, axes = np.empty(3), np.empty((3, 3))
    beta, gamma = np.empty(3), np.empty(3)
    _principal_axes(b, squares, axes)
    energy = _ogden_axes(parameters, squares, beta, gamma)
    _fill_sum(beta - beta.mean(), axes, stress)
    return energy


@compiled
def principal_law(
    parameters: FloatArray, b: FloatArray, stress: FloatArray, tangent: FloatArray
) -> float:
    """Fill the deviatoric stress (6,) and its tangent (6, 6) of b̄ (3, 3); the energy."""
    squares, axes, six = np.empty(3), np.empty((3, 3)), np.empty(6)
    beta, gamma = np.empty(3), np.empty(3)
    _principal_axes(b, squares, axes)
    energy = _ogden_axes(parameters, squares, beta, gamma)
    mean = beta.mean()
    tangent[:, :] = 0.0
    for a in range(3):
        c = (a + 1) % 3
        _add_square(gamma[a] - 2.0 * beta[a], axes, a, a, six, tangent)
        _add_square(4.0 * _shear_slope(squares, beta, gamma, a, c), axes, a, c, six, tangent)
    # What the projection P takes from it and adds to it.
    _fill_sum((gamma - 2.0 * mean) / 3.0, axes, six)
    for m in range(3):
        tangent[m, m] += 2.0 * mean
        tangent[m + 3, m + 3] += mean
        for n in range(6):
            tangent[m, n] -= six[n]
            tangent[n, m] -= six[n]
        for n in range(3):
            tangent[m, n] += gamma.mean() / 3.0 - 4.0 / 3.0 * mean
    _fill_sum(beta - mean, axes, stress)
    return energy
