"""What the kernels of all solids do at a quadrature point; stretches and energies.

Everything is written in the deformed configuration: with g_a = F⁻ᵀ ∇N_a, the
Kirchhoff stress τ and the spatial tangent c, an element's residual is
r_a = Σ w τ g_a and its tangent K_ab = Σ w (B_aᵀ c B_b + (g_a · τ g_b) I), where B
maps displacements to engineering strains (Holzapfel 2000, section 8.4). The
volumetric stress of a pressure p that multiplies J − 1 is J p I, with the
tangent J p (I ⊗ I − 2 𝕀).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled
from pagd.fem.hyperelastic import deviatoric_response

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Where entry (i, j) of a symmetric tensor stands among its six, xx yy zz xy yz zx; and the other
#: way round.
SIX = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
FIRST = np.array([0, 1, 2, 0, 1, 2])
SECOND = np.array([0, 1, 2, 1, 2, 0])

#: Elements that one thread takes at once.
CHUNK = 32

#: J below which an element counts as inverted.
SMALLEST_VOLUME_RATIO = 1e-3


@compiled
def chunks(count: int) -> int:
    """How many chunks ``count`` elements make."""
    return (count + CHUNK - 1) // CHUNK


@compiled
def deformation_gradient(
    unknowns: FloatArray, nodes: IntArray, gradients: FloatArray, gradient: FloatArray
) -> None:
    """Fill F (3, 3) at a point from the unknowns, n nodes and the gradients (3, n) there."""
    for i in range(3):
        for j in range(3):
            total = 1.0 if i == j else 0.0
            for a in range(len(nodes)):
                total += unknowns[3 * nodes[a] + i] * gradients[j, a]
            gradient[i, j] = total


@compiled
def inverse(matrix: FloatArray, result: FloatArray) -> float:
    """Fill the inverse of a 3 × 3 matrix and return the determinant."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        for m in range(3):
            n, o = (m + 1) % 3, (m + 2) % 3
            result[m, i] = matrix[j, n] * matrix[k, o] - matrix[j, o] * matrix[k, n]
    determinant = (
        matrix[0, 0] * result[0, 0] + matrix[0, 1] * result[1, 0] + matrix[0, 2] * result[2, 0]
    )
    scale = 1.0 / determinant
    for i in range(3):
        for j in range(3):
            result[i, j] *= scale
    return float(determinant)


@compiled
def isochoric_left_stretch(gradient: FloatArray, volume_ratio: float, b: FloatArray) -> None:
    """Fill b̄ = J^(−2/3) F Fᵀ."""
    scale = volume_ratio ** (-2.0 / 3.0)
    for i in range(3):
        for j in range(3):
            b[i, j] = scale * (
                gradient[i, 0] * gradient[j, 0]
                + gradient[i, 1] * gradient[j, 1]
                + gradient[i, 2] * gradient[j, 2]
            )


@compiled
def add_volumetric(value: float, stress: FloatArray, tangent: FloatArray) -> None:
    """Add the stress and tangent of a pressure; ``value`` is J p."""
    for m in range(3):
        stress[m] += value
        for n in range(3):
            tangent[m, n] += value
        tangent[m, m] -= 2.0 * value
        tangent[m + 3, m + 3] -= value


@compiled
def push_stress(gradient: FloatArray, stress: FloatArray, result: FloatArray) -> None:
    """Fill F S Fᵀ (6,) of a symmetric tensor S (6,); with F⁻¹ it goes the way back."""
    for m in range(6):
        i, j = FIRST[m], SECOND[m]
        result[m] = 0.0
        for k in range(3):
            for n in range(3):
                result[m] += gradient[i, k] * stress[SIX[k, n]] * gradient[j, n]


@compiled
def _largest_eigenvalue(matrix: FloatArray) -> float:
    """Of a symmetric 3 × 3 matrix, in closed form (Smith, *Commun. ACM* 4 (1961) 168)."""
    mean = (matrix[0, 0] + matrix[1, 1] + matrix[2, 2]) / 3.0
    squared = 0.0
    for i in range(3):
        for j in range(3):
            rest = matrix[i, j] - (mean if i == j else 0.0)
            squared += rest * rest
    size = np.sqrt(squared / 6.0)
    if size <= 1e-15 * abs(mean):
        return float(mean)
    x, y, z = (
        (matrix[0, 0] - mean) / size,
        (matrix[1, 1] - mean) / size,
        (matrix[2, 2] - mean) / size,
    )
    xy, yz, zx = matrix[0, 1] / size, matrix[1, 2] / size, matrix[0, 2] / size
    half = 0.5 * (x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx))
    return float(mean + 2.0 * size * np.cos(np.arccos(min(max(half, -1.0), 1.0)) / 3.0))


@compiled
def largest_stretches(
    unknowns: FloatArray,
    nodes: IntArray,
    gradients: FloatArray,
    threshold: float,
    result: FloatArray,
) -> None:
    """Largest principal stretch (E, Q); 0 where it is certainly below ``threshold``.

    The sum of the squared stretches, tr FFᵀ, bounds the largest: axes are sought only where
    that does not settle it.
    """
    gradient = np.empty((3, 3))
    for e in range(len(nodes)):
        for q in range(gradients.shape[1]):
            deformation_gradient(unknowns, nodes[e], gradients[e, q], gradient)
            result[e, q] = 0.0
            if np.sum(gradient * gradient) >= threshold * threshold:
                result[e, q] = np.sqrt(_largest_eigenvalue(gradient @ gradient.T))


@compiled
def energies(
    unknowns: FloatArray,
    nodes: IntArray,
    gradients: FloatArray,
    weights: FloatArray,
    law: int,
    parameters: FloatArray,
    isochoric: FloatArray,
    volume_change: FloatArray,
) -> None:
    """Isochoric energy (E,) and J − 1 (E, Q) of each element; infinite where inverted."""
    gradient = np.empty((3, 3))
    inverted = np.empty((3, 3))
    b = np.empty((3, 3))
    stress = np.empty(6)
    tangent = np.empty((6, 6))
    for e in range(len(nodes)):
        isochoric[e] = 0.0
        for q in range(weights.shape[1]):
            deformation_gradient(unknowns, nodes[e], gradients[e, q], gradient)
            ratio = inverse(gradient, inverted)
            volume_change[e, q] = ratio - 1.0
            if not ratio > SMALLEST_VOLUME_RATIO:
                isochoric[e] = np.inf
                continue
            isochoric_left_stretch(gradient, ratio, b)
            isochoric[e] += weights[e, q] * deviatoric_response(law, parameters, b, stress, tangent)
