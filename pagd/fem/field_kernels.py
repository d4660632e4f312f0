"""What is asked of a solved state: the largest stretches and the energies of a solid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled
from pagd.fem.hyperelastic import stresses
from pagd.fem.point_kernels import deform, fill_gradients, integral, points_of

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


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
    at, squares = points_of(nodes.shape[1], result.shape[1]), np.empty((3, 3))
    gradient = at.gradient
    for e in range(len(nodes)):
        fill_gradients(unknowns, nodes[e], gradients[e], at)
        for q in range(result.shape[1]):
            for i in range(3):
                for j in range(3):
                    squares[i, j] = gradient[q, i, 0] * gradient[q, j, 0]
                    squares[i, j] += gradient[q, i, 1] * gradient[q, j, 1]
                    squares[i, j] += gradient[q, i, 2] * gradient[q, j, 2]
            result[e, q] = 0.0
            if squares[0, 0] + squares[1, 1] + squares[2, 2] >= threshold * threshold:
                result[e, q] = np.sqrt(_largest_eigenvalue(squares))


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
    at = points_of(nodes.shape[1], weights.shape[1])
    ratio = at.ratio
    for e in range(len(nodes)):
        isochoric[e] = np.inf
        if deform(unknowns, nodes[e], gradients[e], at):
            stresses(law, parameters, at.left, at.energy, at.stress)
            isochoric[e] = integral(weights[e], at.energy)
        for q in range(weights.shape[1]):
            volume_change[e, q] = ratio[q] - 1.0
