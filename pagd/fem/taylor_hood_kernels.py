"""The kernel of the quadratic tetrahedron with a continuous linear pressure (P2–P1)."""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.hyperelastic import deviatoric_response
from pagd.fem.solid_kernels import (
    CHUNK,
    SMALLEST_VOLUME_RATIO,
    add_volumetric,
    chunks,
    deformation_gradient,
    inverse,
    isochoric_left_stretch,
    push_stress,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@compiled
def _push_forward(gradients: FloatArray, inverted: FloatArray, spatial: FloatArray) -> None:
    """Spatial gradients g_a = F⁻ᵀ ∇N_a (10, 3)."""
    for a in range(10):
        for i in range(3):
            spatial[a, i] = (
                gradients[0, a] * inverted[0, i]
                + gradients[1, a] * inverted[1, i]
                + gradients[2, a] * inverted[2, i]
            )


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
    iterated: FloatArray,
    iterates_stresses: bool,
    law: int,
    parameters: FloatArray,
    work: tuple[FloatArray, ...],
    residual: FloatArray,
    volume_slope: FloatArray,
    matrix: FloatArray,
) -> tuple[float, float]:
    """Add one quadrature point; its energy (weighted) and volume ratio J."""
    gradient, inverted, b, stress, tangent, spatial, product, turning = work
    deformation_gradient(unknowns, nodes, gradients, gradient)
    ratio = inverse(gradient, inverted)
    if not ratio > SMALLEST_VOLUME_RATIO:
        return np.inf, ratio
    _push_forward(gradients, inverted, spatial)
    isochoric_left_stretch(gradient, ratio, b)
    energy = weight * deviatoric_response(law, parameters, b, stress, tangent)
    add_volumetric(ratio * pressure, stress, tangent)
    _fill_tangent_times_strain(tangent, spatial, weight, product)
    _add_residual(spatial, stress, weight, weight * ratio, residual, volume_slope)
    if iterates_stresses:
        push_stress(gradient, iterated, turning)
        for i in range(3):
            turning[i] += ratio * pressure
    else:
        turning[:] = stress
    _add_stiffness(spatial, turning, product, weight, matrix)
    return energy, ratio


@compiled
def _workspace() -> tuple[FloatArray, ...]:
    """F, F⁻¹, b̄, τ, c, spatial gradients, c B and F S* Fᵀ of one quadrature point."""
    return (
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty(6),
        np.empty((6, 6)),
        np.empty((10, 3)),
        np.empty((6, 30)),
        np.empty(6),
    )


@compiled_parallel
def taylor_hood(
    unknowns: FloatArray,
    nodes: IntArray,
    stresses: FloatArray,
    iterates_stresses: bool,
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

    Shapes: nodes (E, 10), stresses S* of the geometric part if they are iterated (E, Q, 6; see
    :mod:`pagd.fem.stress_kernels`), pressure_dofs (E, 4), gradients (E, Q, 3, 10), weights (E, Q)
    in mm³, corner_values (Q, 4), residual (E, 34), tangent (E, 595).
    """
    total = 0.0
    for chunk in prange(chunks(len(nodes))):
        work = _workspace()
        matrix = np.empty((34, 34))
        slope = np.empty(30)
        for e in range(chunk * CHUNK, min((chunk + 1) * CHUNK, len(nodes))):
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
                    stresses[e, q],
                    iterates_stresses,
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
