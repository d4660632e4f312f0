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
from pagd.fem.condensation_kernels import (
    fill_condensed,
    fill_residual,
    fill_volume_slopes,
    pack,
    pressures_at,
    volume_changes,
    wanted_pressures,
)
from pagd.fem.hyperelastic import responses, stresses
from pagd.fem.point_kernels import (
    Points,
    add_pressure_tangents,
    add_pressures,
    deform,
    integral,
    points_of,
    push_stresses,
)
from pagd.fem.solid_kernels import CHUNK, chunks
from pagd.fem.symmetric import SIX

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@compiled
def _push_forward(inverse: FloatArray, gradients: FloatArray, spatial: FloatArray) -> None:
    """Fill g (Q, 3, n) from F⁻¹ (Q, 3, 3) and the gradients (Q, 3, n)."""
    for q in range(gradients.shape[0]):
        for i in range(3):
            x, y, z = inverse[q, 0, i], inverse[q, 1, i], inverse[q, 2, i]
            for a in range(gradients.shape[2]):
                spatial[q, i, a] = (
                    x * gradients[q, 0, a] + y * gradients[q, 1, a] + z * gradients[q, 2, a]
                )


@compiled
def _fill_products(
    weights: FloatArray,
    stress: FloatArray,
    tangent: FloatArray,
    spatial: FloatArray,
    equal: FloatArray,
    unequal: FloatArray,
) -> None:
    """Fill A_ij · g (Q, 3, 3, n) for ij = xx, yy, zz; the same for xy, yz, zx.

    From weights (Q,), stresses (Q, 6), tangents (Q, 6, 6) and g (Q, 3, n).
    """
    points, _, count = spatial.shape
    for q in range(points):
        for row in range(3):
            for i in range(3):
                c, j = SIX[i, row], (i + 1) % 3
                x = weights[q] * (tangent[q, c, SIX[i, 0]] + stress[q, SIX[row, 0]])
                y = weights[q] * (tangent[q, c, SIX[i, 1]] + stress[q, SIX[row, 1]])
                z = weights[q] * (tangent[q, c, SIX[i, 2]] + stress[q, SIX[row, 2]])
                for a in range(count):
                    equal[q, row, i, a] = (
                        x * spatial[q, 0, a] + y * spatial[q, 1, a] + z * spatial[q, 2, a]
                    )
                x = weights[q] * tangent[q, c, SIX[j, 0]]
                y = weights[q] * tangent[q, c, SIX[j, 1]]
                z = weights[q] * tangent[q, c, SIX[j, 2]]
                for a in range(count):
                    unequal[q, row, i, a] = (
                        x * spatial[q, 0, a] + y * spatial[q, 1, a] + z * spatial[q, 2, a]
                    )


@compiled
def _fill_forces(weights: FloatArray, at: Points, forces: FloatArray) -> None:
    """Fill w F⁻¹ τ (Q, 3, 3), what the gradients are multiplied by."""
    inverse, stress = at.inverse, at.stress
    for q in range(len(weights)):
        for i in range(3):
            for j in range(3):
                force = inverse[q, i, 0] * stress[q, SIX[0, j]]
                force += inverse[q, i, 1] * stress[q, SIX[1, j]]
                force += inverse[q, i, 2] * stress[q, SIX[2, j]]
                forces[q, i, j] = weights[q] * force


@compiled
def _fill_volumes(
    weights: FloatArray, ratio: FloatArray, values: FloatArray, volumes: FloatArray
) -> None:
    """Fill w J φ (m, Q), what g is multiplied by in the slopes of the volume changes."""
    for q in range(len(weights)):
        for c in range(len(volumes)):
            volumes[c, q] = weights[q] * ratio[q] * values[q, c]


@compiled_parallel
def condensed_pressures(
    unknowns: FloatArray,
    nodes: IntArray,
    pressures: FloatArray,
    stressed: FloatArray,
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
    changes: FloatArray,
) -> float:
    """Elements with pressures p = Σ φ_c p_c of their own, condensed: the term b K M⁻¹ bᵀ remains.

    Shapes, with n nodes and m pressures an element: nodes (E, n), pressures (E, m), stresses S*
    of the geometric part if they are iterated (``stressed``, (E, Q, 6); see
    :mod:`pagd.fem.stress_kernels`),
    gradients (E, Q, 3, n),
    weights (E, Q) in mm³, values (E, Q, m) of φ, stiffnesses K M⁻¹ (E, m, m) with
    M = ∫ φ φᵀ dV, residual (E, 3n), tangent (E, 3n (3n + 1)/2). Also fills b = ∂(∫ φ J dV)/∂u
    (E, m, 3n) and ∫ φ (J − 1) dV (E, m). Returns the energy, infinite where inverted.
    """
    energies = np.full(len(nodes), np.inf)
    count, points, functions = nodes.shape[1], weights.shape[1], pressures.shape[1]
    for chunk in prange(chunks(len(nodes))):
        at, turning, here = points_of(count, points), np.empty((points, 6)), np.empty(points)
        spatial = np.empty((points, 3, count))
        # Two products rather than one: OpenBLAS spreads larger ones over threads of its own.
        equal, unequal = np.empty((points, 3, 3, count)), np.empty((points, 3, 3, count))
        equal_sum, unequal_sum = np.empty((count, 3 * count)), np.empty((count, 3 * count))
        forces, volumes = np.empty((points, 3, 3)), np.empty((functions, points))
        forces_sum, volumes_sum = np.empty((count, 3)), np.empty((functions, 3 * count))
        wanted, condensed = np.empty(functions), np.empty((3 * count, 3 * count))
        rows, left = 3 * points, spatial.reshape(3 * points, count).T
        for e in range(chunk * CHUNK, min((chunk + 1) * CHUNK, len(nodes))):
            if not deform(unknowns, nodes[e], gradients[e], at):
                continue
            pressures_at(values[e], pressures[e], here)
            responses(law, parameters, at.left, at.energy, at.stress, at.tangent)
            add_pressures(here, at.ratio, at.stress)
            add_pressure_tangents(here, at.ratio, at.tangent)
            if iterates_stresses:
                push_stresses(at.gradient, stressed[e], turning)
                add_pressures(here, at.ratio, turning)
            else:
                turning[:] = at.stress
            _push_forward(at.inverse, gradients[e], spatial)
            _fill_products(weights[e], turning, at.tangent, spatial, equal, unequal)
            _fill_forces(weights[e], at, forces)
            _fill_volumes(weights[e], at.ratio, values[e], volumes)
            np.dot(left, equal.reshape(rows, 3 * count), equal_sum)
            np.dot(left, unequal.reshape(rows, 3 * count), unequal_sum)
            np.dot(gradients[e].reshape(rows, count).T, forces.reshape(rows, 3), forces_sum)
            np.dot(volumes, spatial.reshape(points, 3 * count), volumes_sum)
            fill_volume_slopes(volumes_sum.reshape(functions, 3, count), volume_slopes[e])
            volume_changes(weights[e], values[e], at.ratio, changes[e])
            energies[e] = wanted_pressures(stiffnesses[e], changes[e], wanted)
            energies[e] += integral(weights[e], at.energy)
            fill_residual(forces_sum, wanted, pressures[e], volume_slopes[e], residual[e])
            fill_condensed(stiffnesses[e], volume_slopes[e], volumes_sum, condensed)
            pack(equal_sum, unequal_sum, condensed, tangent[e])
    return float(energies.sum())


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
    changes: FloatArray,
) -> float:
    """The residual alone, with slopes b that are known from a state near by.

    Shapes as in :func:`condensed_pressures`; fills residual and volume changes.
    """
    energies = np.full(len(nodes), np.inf)
    count, points, functions = nodes.shape[1], weights.shape[1], pressures.shape[1]
    for chunk in prange(chunks(len(nodes))):
        at, here, wanted = points_of(count, points), np.empty(points), np.empty(functions)
        forces, forces_sum = np.empty((points, 3, 3)), np.empty((count, 3))
        rows = 3 * points
        for e in range(chunk * CHUNK, min((chunk + 1) * CHUNK, len(nodes))):
            if not deform(unknowns, nodes[e], gradients[e], at):
                continue
            pressures_at(values[e], pressures[e], here)
            stresses(law, parameters, at.left, at.energy, at.stress)
            add_pressures(here, at.ratio, at.stress)
            _fill_forces(weights[e], at, forces)
            np.dot(gradients[e].reshape(rows, count).T, forces.reshape(rows, 3), forces_sum)
            volume_changes(weights[e], values[e], at.ratio, changes[e])
            energies[e] = wanted_pressures(stiffnesses[e], changes[e], wanted)
            energies[e] += integral(weights[e], at.energy)
            fill_residual(forces_sum, wanted, pressures[e], volume_slopes[e], residual[e])
    return float(energies.sum())
