"""Element kernels of the quadratic tetrahedron: one pass per quadrature point.

Everything is written in the deformed configuration: with g_a = F⁻ᵀ ∇N_a, the
Kirchhoff stress τ and the spatial tangent c, an element's residual is
r_a = Σ w τ g_a and its tangent K_ab = Σ w (B_aᵀ c B_b + (g_a · τ g_b) I), where B
maps displacements to engineering strains (Holzapfel 2000, section 8.4). The
volumetric stress of a pressure p that multiplies J − 1 is J p I, with the
tangent J p (I ⊗ I − 2 𝕀).
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.hyperelastic import deviatoric_response

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: J below which an element counts as inverted.
SMALLEST_VOLUME_RATIO = 1e-3


@compiled
def deformation_gradient(
    unknowns: FloatArray, nodes: IntArray, gradients: FloatArray, gradient: FloatArray
) -> None:
    """Fill F (3, 3) at a point from the unknowns, ten nodes and the gradients (10, 3) there."""
    for i in range(3):
        for j in range(3):
            total = 1.0 if i == j else 0.0
            for a in range(10):
                total += unknowns[3 * nodes[a] + i] * gradients[a, j]
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
def _push_forward(gradients: FloatArray, inverted: FloatArray, spatial: FloatArray) -> None:
    """Spatial gradients g_a = F⁻ᵀ ∇N_a (10, 3)."""
    for a in range(10):
        for i in range(3):
            spatial[a, i] = (
                gradients[a, 0] * inverted[0, i]
                + gradients[a, 1] * inverted[1, i]
                + gradients[a, 2] * inverted[2, i]
            )


@compiled
def _add_volumetric(value: float, stress: FloatArray, tangent: FloatArray) -> None:
    """Add the stress and tangent of a pressure; ``value`` is J p."""
    for m in range(3):
        stress[m] += value
        for n in range(3):
            tangent[m, n] += value
        tangent[m, m] -= 2.0 * value
        tangent[m + 3, m + 3] -= value


@compiled
def _stress_times(stress: FloatArray, vector: FloatArray, result: FloatArray) -> None:
    result[0] = stress[0] * vector[0] + stress[3] * vector[1] + stress[5] * vector[2]
    result[1] = stress[3] * vector[0] + stress[1] * vector[1] + stress[4] * vector[2]
    result[2] = stress[5] * vector[0] + stress[4] * vector[1] + stress[2] * vector[2]


@compiled
def _fill_tangent_times_strain(
    tangent: FloatArray, spatial: FloatArray, weight: float, product: FloatArray
) -> None:
    """Fill w c B (6, 30); each column of B has three entries."""
    for m in range(6):
        xx, yy, zz = weight * tangent[m, 0], weight * tangent[m, 1], weight * tangent[m, 2]
        xy, yz, zx = weight * tangent[m, 3], weight * tangent[m, 4], weight * tangent[m, 5]
        for a in range(10):
            x, y, z = spatial[a, 0], spatial[a, 1], spatial[a, 2]
            product[m, 3 * a] = xx * x + xy * y + zx * z
            product[m, 3 * a + 1] = yy * y + xy * x + yz * z
            product[m, 3 * a + 2] = zz * z + yz * y + zx * x


@compiled
def _add_stiffness(
    spatial: FloatArray, stress: FloatArray, product: FloatArray, weight: float, matrix: FloatArray
) -> None:
    """Add Bᵀ (w c B) and the geometric part; only columns from the row's node on are filled."""
    pull = np.empty(3)
    for a in range(10):
        x, y, z = spatial[a, 0], spatial[a, 1], spatial[a, 2]
        row = 3 * a
        for j in range(row, 30):
            matrix[row, j] += x * product[0, j] + y * product[3, j] + z * product[5, j]
            matrix[row + 1, j] += y * product[1, j] + x * product[3, j] + z * product[4, j]
            matrix[row + 2, j] += z * product[2, j] + y * product[4, j] + x * product[5, j]
        _stress_times(stress, spatial[a], pull)
        for b in range(a, 10):
            geometric = weight * (
                pull[0] * spatial[b, 0] + pull[1] * spatial[b, 1] + pull[2] * spatial[b, 2]
            )
            for i in range(3):
                matrix[row + i, 3 * b + i] += geometric


@compiled
def _add_residual(
    spatial: FloatArray,
    stress: FloatArray,
    weight: float,
    volume_weight: float,
    residual: FloatArray,
    volume_slope: FloatArray,
) -> None:
    """Add w τ g_a to the residual and w J g_a to the derivative of the volume."""
    force = np.empty(3)
    for a in range(10):
        _stress_times(stress, spatial[a], force)
        for i in range(3):
            residual[3 * a + i] += weight * force[i]
            volume_slope[3 * a + i] = volume_weight * spatial[a, i]


@compiled
def _pack(matrix: FloatArray, size: int, packed: FloatArray) -> None:
    """Upper triangle of the leading block, row by row."""
    position = 0
    for i in range(size):
        for j in range(i, size):
            packed[position] = matrix[i, j]
            position += 1


@compiled
def _point(
    unknowns: FloatArray,
    nodes: IntArray,
    gradients: FloatArray,
    weight: float,
    pressure: float,
    law: int,
    parameters: FloatArray,
    work: tuple[FloatArray, ...],
    residual: FloatArray,
    volume_slope: FloatArray,
    matrix: FloatArray,
) -> tuple[float, float]:
    """Add one quadrature point; its energy (weighted) and volume ratio J."""
    gradient, inverted, b, stress, tangent, spatial, product = work
    deformation_gradient(unknowns, nodes, gradients, gradient)
    ratio = inverse(gradient, inverted)
    if not ratio > SMALLEST_VOLUME_RATIO:
        return np.inf, ratio
    _push_forward(gradients, inverted, spatial)
    isochoric_left_stretch(gradient, ratio, b)
    energy = weight * deviatoric_response(law, parameters, b, stress, tangent)
    _add_volumetric(ratio * pressure, stress, tangent)
    _fill_tangent_times_strain(tangent, spatial, weight, product)
    _add_residual(spatial, stress, weight, weight * ratio, residual, volume_slope)
    _add_stiffness(spatial, stress, product, weight, matrix)
    return energy, ratio


@compiled
def _workspace() -> tuple[FloatArray, ...]:
    """F, F⁻¹, b̄, τ, c, spatial gradients and c B of one quadrature point."""
    return (
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty(6),
        np.empty((6, 6)),
        np.empty((10, 3)),
        np.empty((6, 30)),
    )


@compiled_parallel
def taylor_hood(
    unknowns: FloatArray,
    nodes: IntArray,
    pressure_dofs: IntArray,
    gradients: FloatArray,
    weights: FloatArray,
    corner_values: FloatArray,
    law: int,
    parameters: FloatArray,
    bulk_modulus: float,
    residual: FloatArray,
    tangent: FloatArray,
) -> float:
    """Elements with a continuous linear pressure: W(F̄) + p (J − 1) − p²/2K.

    Shapes: nodes (E, 10), pressure_dofs (E, 4), gradients (E, Q, 10, 3), weights (E, Q)
    in mm³, corner_values (Q, 4), residual (E, 34), tangent (E, 595).
    """
    total = 0.0
    for chunk in prange(_chunks(len(nodes))):
        work = _workspace()
        matrix = np.empty((34, 34))
        slope = np.empty(30)
        for e in range(chunk * _CHUNK, min((chunk + 1) * _CHUNK, len(nodes))):
            matrix[:, :] = 0.0
            residual[e, :] = 0.0
            for q in range(weights.shape[1]):
                weight = weights[e, q]
                pressure = 0.0
                for c in range(4):
                    pressure += corner_values[q, c] * unknowns[pressure_dofs[e, c]]
                energy, ratio = _point(
                    unknowns,
                    nodes[e],
                    gradients[e, q],
                    weight,
                    pressure,
                    law,
                    parameters,
                    work,
                    residual[e],
                    slope,
                    matrix,
                )
                total += energy + weight * pressure * (ratio - 1.0 - 0.5 * pressure / bulk_modulus)
                for c in range(4):
                    value = corner_values[q, c]
                    residual[e, 30 + c] += weight * value * (ratio - 1.0 - pressure / bulk_modulus)
                    for i in range(30):
                        matrix[i, 30 + c] += value * slope[i]
                    for d in range(c, 4):
                        matrix[30 + c, 30 + d] -= (
                            weight * value * corner_values[q, d] / bulk_modulus
                        )
            _pack(matrix, 34, tangent[e])
    return total


@compiled_parallel
def element_pressure(
    unknowns: FloatArray,
    nodes: IntArray,
    pressures: FloatArray,
    gradients: FloatArray,
    weights: FloatArray,
    law: int,
    parameters: FloatArray,
    bulk_modulus: float,
    residual: FloatArray,
    tangent: FloatArray,
    volume_slopes: FloatArray,
    volume_changes: FloatArray,
) -> float:
    """Elements with one pressure each, condensed: the rank-one term K/V bbᵀ remains.

    Shapes as in :func:`taylor_hood`, residual (E, 30), tangent (E, 465); also fills
    b = ∂(∫J dV)/∂u (E, 30) and ∫(J − 1) dV (E,).
    """
    total = 0.0
    for chunk in prange(_chunks(len(nodes))):
        work = _workspace()
        matrix = np.empty((30, 30))
        slope = np.empty(30)
        for e in range(chunk * _CHUNK, min((chunk + 1) * _CHUNK, len(nodes))):
            matrix[:, :] = 0.0
            residual[e, :] = 0.0
            volume_slopes[e, :] = 0.0
            change, volume = 0.0, 0.0
            for q in range(weights.shape[1]):
                weight = weights[e, q]
                energy, ratio = _point(
                    unknowns,
                    nodes[e],
                    gradients[e, q],
                    weight,
                    pressures[e],
                    law,
                    parameters,
                    work,
                    residual[e],
                    slope,
                    matrix,
                )
                total += energy
                change += weight * (ratio - 1.0)
                volume += weight
                for i in range(30):
                    volume_slopes[e, i] += slope[i]
            volume_changes[e] = change
            stiffness = bulk_modulus / volume
            excess = stiffness * change - pressures[e]
            total += 0.5 * stiffness * change * change
            for i in range(30):
                residual[e, i] += excess * volume_slopes[e, i]
                for j in range(i, 30):
                    matrix[i, j] += stiffness * volume_slopes[e, i] * volume_slopes[e, j]
            _pack(matrix, 30, tangent[e])
    return total


_CHUNK = 32


@compiled
def _chunks(count: int) -> int:
    return (count + _CHUNK - 1) // _CHUNK


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
                result[e, q] = np.sqrt(np.linalg.eigvalsh(gradient @ gradient.T)[2])


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
