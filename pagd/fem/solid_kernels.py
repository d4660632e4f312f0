"""What the kernels of solids do at a quadrature point; see :mod:`pagd.fem.point_kernels` too.

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
from pagd.fem.symmetric import FIRST, SECOND, SIX

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

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
