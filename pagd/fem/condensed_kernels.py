"""The kernel of elements that condense pressures of their own; for any number of nodes.

With g_a = F⁻ᵀ ∇N_a, the Kirchhoff stress τ and the spatial tangent c, the stiffness between the
displacements i of node a and j of node b is the sum over the quadrature points of
g_a · A_ij · g_b, A_ij = w (c_i·j· + δ_ij τ). All points of an element make one product of two
dense matrices of it: the work of an element of 27 nodes and 27 points is left to BLAS.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.hyperelastic import deviatoric_response
from pagd.fem.solid_kernels import (
    CHUNK,
    SIX,
    SMALLEST_VOLUME_RATIO,
    add_volumetric,
    chunks,
    inverse,
    isochoric_left_stretch,
    push_stress,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_Work = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]


@compiled
def _workspace() -> _Work:
    """F, F⁻¹, b̄, τ and c of one quadrature point."""
    return (
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty(6),
        np.empty((6, 6)),
    )


@compiled
def _gather(unknowns: FloatArray, nodes: IntArray, displacements: FloatArray) -> None:
    """Fill the displacements (3, n) of an element."""
    for a in range(len(nodes)):
        for i in range(3):
            displacements[i, a] = unknowns[3 * nodes[a] + i]


@compiled
def _combined(values: FloatArray, pressures: FloatArray) -> float:
    """The pressure Σ φ_c p_c at a point."""
    total = 0.0
    for c in range(len(values)):
        total += values[c] * pressures[c]
    return total


@compiled
def _gradient(displacements: FloatArray, gradients: FloatArray, result: FloatArray) -> None:
    """Fill F (3, 3) from displacements (3, n) and the gradients (3, n) of a point."""
    for i in range(3):
        for j in range(3):
            total = 1.0 if i == j else 0.0
            for a in range(gradients.shape[1]):
                total += displacements[i, a] * gradients[j, a]
            result[i, j] = total


@compiled
def _combine(
    x: float, y: float, z: float, gradients: FloatArray, result: FloatArray, first: int
) -> None:
    """Fill x g_x + y g_y + z g_z of all nodes into ``result``, from ``first`` on."""
    for a in range(gradients.shape[1]):
        result[first + a] = x * gradients[0, a] + y * gradients[1, a] + z * gradients[2, a]


@compiled
def _fill_products(
    weight: float,
    stress: FloatArray,
    tangent: FloatArray,
    spatial: FloatArray,
    equal: FloatArray,
    unequal: FloatArray,
) -> None:
    """Fill A_ij · g (3, 3n) of a point: ij = xx, yy, zz side by side; xy, yz, zx likewise."""
    count = spatial.shape[1]
    for row in range(3):
        x = weight * stress[SIX[row, 0]]
        y = weight * stress[SIX[row, 1]]
        z = weight * stress[SIX[row, 2]]
        for i in range(3):
            c = weight * tangent[SIX[i, row]]
            _combine(
                c[SIX[i, 0]] + x,
                c[SIX[i, 1]] + y,
                c[SIX[i, 2]] + z,
                spatial,
                equal[row],
                i * count,
            )
            j = (i + 1) % 3
            _combine(c[SIX[j, 0]], c[SIX[j, 1]], c[SIX[j, 2]], spatial, unequal[row], i * count)


@compiled
def _fill_forces(
    weight: float,
    ratio: float,
    stress: FloatArray,
    values: FloatArray,
    forces: FloatArray,
) -> None:
    """Fill what the gradients of a point are multiplied by (3, 3 + 3m): w τ, and w J φ I each."""
    forces[:, :] = 0.0
    for i in range(3):
        for j in range(3):
            forces[i, j] = weight * stress[SIX[i, j]]
        for c in range(len(values)):
            forces[i, 3 + 3 * c + i] = weight * ratio * values[c]


@compiled
def _state(
    displacements: FloatArray,
    gradients: FloatArray,
    pressure: float,
    law: int,
    parameters: FloatArray,
    work: _Work,
    spatial: FloatArray,
) -> tuple[float, float]:
    """Energy density and J of a point; fills stress and tangent of ``work``, and g (3, n)."""
    gradient, inverted, b, stress, tangent = work
    _gradient(displacements, gradients, gradient)
    ratio = inverse(gradient, inverted)
    if not ratio > SMALLEST_VOLUME_RATIO:
        return np.inf, ratio
    for i in range(3):
        _combine(inverted[0, i], inverted[1, i], inverted[2, i], gradients, spatial[i], 0)
    isochoric_left_stretch(gradient, ratio, b)
    energy = deviatoric_response(law, parameters, b, stress, tangent)
    add_volumetric(ratio * pressure, stress, tangent)
    return energy, ratio


@compiled
def _pack(
    equal: FloatArray,
    unequal: FloatArray,
    slopes: FloatArray,
    products: FloatArray,
    packed: FloatArray,
) -> None:
    """Fill the packed upper triangle: stiffness of the displacements, and what is condensed.

    equal, unequal (n, 3n): blocks ij = xx, yy, zz and xy, yz, zx. slopes, products (m, 3n): b
    and K M⁻¹ b.
    """
    count, size = len(equal), slopes.shape[1]
    position = 0
    for a in range(count):
        for i in range(3):
            row = 3 * a + i
            start = position - row
            after, before = (i + 1) % 3, (i + 2) % 3
            for b in range(a, count):
                packed[start + 3 * b + i] = equal[a, i * count + b]
                if b > a or after > i:
                    packed[start + 3 * b + after] = unequal[a, i * count + b]
                if b > a or before > i:
                    packed[start + 3 * b + before] = unequal[b, before * count + a]
            for c in range(len(slopes)):
                slope = slopes[c, row]
                for column in range(row, size):
                    packed[start + column] += slope * products[c, column]
            position += size - row


@compiled
def _wanted(stiffness: FloatArray, changes: FloatArray, wanted: FloatArray) -> float:
    """Fill the pressures K M⁻¹ v (m,) of the volume changes v (m,); their energy."""
    energy = 0.0
    for c in range(len(changes)):
        wanted[c] = 0.0
        for d in range(len(changes)):
            wanted[c] += stiffness[c, d] * changes[d]
        energy += 0.5 * wanted[c] * changes[c]
    return energy


@compiled
def _condense(
    stiffness: FloatArray,
    slopes: FloatArray,
    products: FloatArray,
) -> None:
    """Fill K M⁻¹ b (m, 3n)."""
    count, size = slopes.shape
    for c in range(count):
        products[c, :] = 0.0
        for d in range(count):
            for i in range(size):
                products[c, i] += stiffness[c, d] * slopes[d, i]


@compiled
def _add_lacking(
    wanted: FloatArray, pressures: FloatArray, slopes: FloatArray, residual: FloatArray
) -> None:
    """Add what the pressures lack, by the slopes b (m, 3n), to the residual (3n,)."""
    for c in range(len(wanted)):
        for i in range(len(residual)):
            residual[i] += (wanted[c] - pressures[c]) * slopes[c, i]


@compiled
def _spread(forces: FloatArray, residual: FloatArray, slopes: FloatArray) -> None:
    """Sort the products (n, 3 + 3m) into the residual (3n,) and the slopes (m, 3n)."""
    for a in range(len(forces)):
        for i in range(3):
            residual[3 * a + i] = forces[a, i]
            for c in range(len(slopes)):
                slopes[c, 3 * a + i] = forces[a, 3 + 3 * c + i]


@compiled_parallel
def condensed_pressures(
    unknowns: FloatArray,
    nodes: IntArray,
    pressures: FloatArray,
    stresses: FloatArray,
    iterates_stresses: bool,
    gradients: FloatArray,
    weights: FloatArray,
    values: FloatArray,
    stiffnesses: FloatArray,
    law: int,
    parameters: FloatArray,
    residual: FloatArray,
    tangent: FloatArray,
    volume_slopes: FloatArray,
    volume_changes: FloatArray,
) -> float:
    """Elements with pressures p = Σ φ_c p_c of their own, condensed: the term b K M⁻¹ bᵀ remains.

    Shapes, with n nodes and m pressures an element: nodes (E, n), pressures (E, m), stresses S*
    of the geometric part if they are iterated (E, Q, 6; see :mod:`pagd.fem.stress_kernels`),
    gradients (E, Q, 3, n),
    weights (E, Q) in mm³, values (E, Q, m) of φ, stiffnesses K M⁻¹ (E, m, m) with
    M = ∫ φ φᵀ dV, residual (E, 3n), tangent (E, 3n (3n + 1)/2). Also fills b = ∂(∫ φ J dV)/∂u
    (E, m, 3n) and ∫ φ (J − 1) dV (E, m). Returns the energy, infinite where inverted.
    """
    total = 0.0
    count, points, functions = nodes.shape[1], weights.shape[1], pressures.shape[1]
    for chunk in prange(chunks(len(nodes))):
        work, turning = _workspace(), np.empty(6)
        displacements = np.empty((3, count))
        spatial = np.empty((3 * points, count))
        # Two products rather than one: OpenBLAS spreads larger ones over threads of its own.
        equal, unequal = np.empty((3 * points, 3 * count)), np.empty((3 * points, 3 * count))
        forces = np.empty((3 * points, 3 + 3 * functions))
        equal_sum, unequal_sum = np.empty((count, 3 * count)), np.empty((count, 3 * count))
        forces_sum = np.empty((count, 3 + 3 * functions))
        products, wanted = np.empty((functions, 3 * count)), np.empty(functions)
        for e in range(chunk * CHUNK, min((chunk + 1) * CHUNK, len(nodes))):
            _gather(unknowns, nodes[e], displacements)
            volume_changes[e, :] = 0.0
            for q in range(points):
                weight, first = weights[e, q], 3 * q
                pressure = _combined(values[e, q], pressures[e])
                here = spatial[first : first + 3]
                energy, ratio = _state(
                    displacements, gradients[e, q], pressure, law, parameters, work, here
                )
                total += weight * energy
                stress, moduli = work[3], work[4]
                if iterates_stresses:
                    push_stress(work[0], stresses[e, q], turning)
                    for i in range(3):
                        turning[i] += ratio * pressure
                else:
                    turning[:] = stress
                _fill_products(
                    weight,
                    turning,
                    moduli,
                    here,
                    equal[first : first + 3],
                    unequal[first : first + 3],
                )
                _fill_forces(weight, ratio, stress, values[e, q], forces[first : first + 3])
                for c in range(functions):
                    volume_changes[e, c] += weight * values[e, q, c] * (ratio - 1.0)
            np.dot(spatial.T, equal, equal_sum)
            np.dot(spatial.T, unequal, unequal_sum)
            np.dot(spatial.T, forces, forces_sum)
            _spread(forces_sum, residual[e], volume_slopes[e])
            total += _wanted(stiffnesses[e], volume_changes[e], wanted)
            _add_lacking(wanted, pressures[e], volume_slopes[e], residual[e])
            _condense(stiffnesses[e], volume_slopes[e], products)
            _pack(equal_sum, unequal_sum, volume_slopes[e], products, tangent[e])
    return total


@compiled_parallel
def residuals_near(
    unknowns: FloatArray,
    nodes: IntArray,
    pressures: FloatArray,
    gradients: FloatArray,
    weights: FloatArray,
    values: FloatArray,
    stiffnesses: FloatArray,
    law: int,
    parameters: FloatArray,
    residual: FloatArray,
    volume_slopes: FloatArray,
    volume_changes: FloatArray,
) -> float:
    """The residual alone, with slopes b that are known from a state near by.

    Shapes as in :func:`condensed_pressures`; fills residual and volume changes.
    """
    total = 0.0
    count, points, functions = nodes.shape[1], weights.shape[1], pressures.shape[1]
    for chunk in prange(chunks(len(nodes))):
        work, displacements = _workspace(), np.empty((3, count))
        spatial, wanted = np.empty((3 * points, count)), np.empty(functions)
        forces, forces_sum = np.zeros((3 * points, 3)), np.empty((count, 3))
        for e in range(chunk * CHUNK, min((chunk + 1) * CHUNK, len(nodes))):
            _gather(unknowns, nodes[e], displacements)
            volume_changes[e, :] = 0.0
            for q in range(points):
                weight, first = weights[e, q], 3 * q
                pressure = _combined(values[e, q], pressures[e])
                here = spatial[first : first + 3]
                energy, ratio = _state(
                    displacements, gradients[e, q], pressure, law, parameters, work, here
                )
                total += weight * energy
                _fill_forces(weight, ratio, work[3], values[e, q, :0], forces[first : first + 3])
                for c in range(functions):
                    volume_changes[e, c] += weight * values[e, q, c] * (ratio - 1.0)
            np.dot(spatial.T, forces, forces_sum)
            _spread(forces_sum, residual[e], volume_slopes[e, :0])
            total += _wanted(stiffnesses[e], volume_changes[e], wanted)
            _add_lacking(wanted, pressures[e], volume_slopes[e], residual[e])
    return total
