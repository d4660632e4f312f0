"""All quadrature points of one element at once: deformation, stresses, strains of a correction.

What is done at every point runs in loops over the points: a call for each would cost more than
what it does.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled
from pagd.fem.solid_kernels import SMALLEST_VOLUME_RATIO
from pagd.fem.symmetric import FIRST, SECOND, SIX

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Points(NamedTuple):
    """Room for what is known at the Q points of an element of n nodes.

    Displacements (n, 3) of its nodes and their slopes ∂u_i/∂X_j (3Q, 3), i across, j of point q in
    row 3q + j. At each point F, F⁻¹ and b̄ (Q, 3, 3), J and the energy density (Q,), stress
    (Q, 6) and tangent (Q, 6, 6).
    """

    displacements: FloatArray
    slopes: FloatArray
    gradient: FloatArray
    inverse: FloatArray
    left: FloatArray
    ratio: FloatArray
    energy: FloatArray
    stress: FloatArray
    tangent: FloatArray


@compiled
def points_of(nodes: int, points: int) -> Points:
    """Room for an element."""
    return Points(
        np.empty((nodes, 3)),
        np.empty((3 * points, 3)),
        np.empty((points, 3, 3)),
        np.empty((points, 3, 3)),
        np.empty((points, 3, 3)),
        np.empty(points),
        np.empty(points),
        np.empty((points, 6)),
        np.empty((points, 6, 6)),
    )


@compiled
def fill_slopes(unknowns: FloatArray, nodes: IntArray, gradients: FloatArray, at: Points) -> None:
    """Fill displacements and slopes from the unknowns, nodes (n,) and gradients (Q, 3, n)."""
    displacements, slopes = at.displacements, at.slopes
    for a in range(len(nodes)):
        for i in range(3):
            displacements[a, i] = unknowns[3 * nodes[a] + i]
    np.dot(gradients.reshape(-1, len(nodes)), displacements, slopes)


@compiled
def fill_gradients(
    unknowns: FloatArray, nodes: IntArray, gradients: FloatArray, at: Points
) -> None:
    """Fill the deformation gradients."""
    fill_slopes(unknowns, nodes, gradients, at)
    slopes, gradient = at.slopes, at.gradient
    for q in range(len(gradient)):
        for i in range(3):
            for j in range(3):
                gradient[q, i, j] = slopes[3 * q + j, i]
            gradient[q, i, i] += 1.0


@compiled
def _invert(gradient: FloatArray, inverse: FloatArray, ratio: FloatArray) -> None:
    """Fill the inverses (Q, 3, 3) and the determinants (Q,)."""
    for q in range(len(gradient)):
        a, b, c = gradient[q, 0, 0], gradient[q, 0, 1], gradient[q, 0, 2]
        d, e, f = gradient[q, 1, 0], gradient[q, 1, 1], gradient[q, 1, 2]
        g, h, i = gradient[q, 2, 0], gradient[q, 2, 1], gradient[q, 2, 2]
        first, second, third = e * i - f * h, f * g - d * i, d * h - e * g
        determinant = a * first + b * second + c * third
        scale = 1.0 / determinant
        ratio[q] = determinant
        inverse[q, 0, 0], inverse[q, 1, 0] = scale * first, scale * second
        inverse[q, 2, 0], inverse[q, 0, 1] = scale * third, scale * (c * h - b * i)
        inverse[q, 1, 1], inverse[q, 2, 1] = scale * (a * i - c * g), scale * (b * g - a * h)
        inverse[q, 0, 2], inverse[q, 1, 2] = scale * (b * f - c * e), scale * (c * d - a * f)
        inverse[q, 2, 2] = scale * (a * e - b * d)


@compiled
def deform(unknowns: FloatArray, nodes: IntArray, gradients: FloatArray, at: Points) -> bool:
    """Fill F, F⁻¹, J and b̄ = J^(−2/3) F Fᵀ; whether no point of the element is inverted."""
    fill_gradients(unknowns, nodes, gradients, at)
    gradient, left, ratio = at.gradient, at.left, at.ratio
    _invert(gradient, at.inverse, ratio)
    for q in range(len(ratio)):
        if not ratio[q] > SMALLEST_VOLUME_RATIO:
            return False
        scale = ratio[q] ** (-2.0 / 3.0)
        for i in range(3):
            for j in range(i, 3):
                product = gradient[q, i, 0] * gradient[q, j, 0]
                product += gradient[q, i, 1] * gradient[q, j, 1]
                product += gradient[q, i, 2] * gradient[q, j, 2]
                left[q, i, j] = left[q, j, i] = scale * product
    return True


@compiled
def integral(weights: FloatArray, density: FloatArray) -> float:
    """Σ w ψ of a density ψ (Q,)."""
    total = 0.0
    for q in range(len(weights)):
        total += weights[q] * density[q]
    return total


@compiled
def add_pressures(pressures: FloatArray, ratio: FloatArray, stress: FloatArray) -> None:
    """Add the stresses J p of pressures (Q,) to stresses (Q, 6)."""
    for q in range(len(pressures)):
        for m in range(3):
            stress[q, m] += ratio[q] * pressures[q]


@compiled
def add_pressure_tangents(pressures: FloatArray, ratio: FloatArray, tangent: FloatArray) -> None:
    """Add J p (I ⊗ I − 2 𝕀) of pressures (Q,) to tangents (Q, 6, 6)."""
    for q in range(len(pressures)):
        value = ratio[q] * pressures[q]
        for m in range(3):
            for n in range(3):
                tangent[q, m, n] += value
            tangent[q, m, m] -= 2.0 * value
            tangent[q, m + 3, m + 3] -= value


@compiled
def push_stresses(gradient: FloatArray, stress: FloatArray, result: FloatArray) -> None:
    """Fill F S Fᵀ (Q, 6) of symmetric S (Q, 6) and F (Q, 3, 3); with F⁻¹ it goes the way back."""
    half = np.empty((3, 3))
    for q in range(len(stress)):
        for i in range(3):
            for j in range(3):
                half[i, j] = gradient[q, i, 0] * stress[q, SIX[0, j]]
                half[i, j] += gradient[q, i, 1] * stress[q, SIX[1, j]]
                half[i, j] += gradient[q, i, 2] * stress[q, SIX[2, j]]
        for m in range(6):
            i, j = FIRST[m], SECOND[m]
            result[q, m] = half[i, 0] * gradient[q, j, 0]
            result[q, m] += half[i, 1] * gradient[q, j, 1]
            result[q, m] += half[i, 2] * gradient[q, j, 2]


@compiled
def add_linearised(at: Points, strain: FloatArray) -> None:
    """Add to the stresses c : ε of the slopes, those of a correction; ``strain`` (6,) is scratch.

    ε is the engineering strain of the correction on the deformed body.
    """
    slopes, inverse, stress, tangent = at.slopes, at.inverse, at.stress, at.tangent
    for q in range(len(stress)):
        for m in range(6):
            i, j = FIRST[m], SECOND[m]
            strain[m] = 0.0
            for k in range(3):
                strain[m] += slopes[3 * q + k, i] * inverse[q, k, j]
                if m >= 3:
                    strain[m] += slopes[3 * q + k, j] * inverse[q, k, i]
        for m in range(6):
            for n in range(6):
                stress[q, m] += tangent[q, m, n] * strain[n]
