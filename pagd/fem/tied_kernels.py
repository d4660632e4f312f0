"""Element tangents in terms of what a screw motion leaves free: Tᵀ K T.

An element that sees tied nodes is given six unknowns more at its end, the rotation θ and the
displacement d of the motion; the unknowns of a tied node are those of its master.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem.compiled import compiled, compiled_parallel

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@compiled
def _unpack(packed: FloatArray, matrix: FloatArray) -> None:
    """Fill a symmetric matrix (n, at least n) from its upper triangle, packed row by row."""
    size, entry = len(matrix), 0
    for i in range(size):
        for j in range(i, size):
            matrix[i, j] = matrix[j, i] = packed[entry]
            entry += 1


@compiled
def _times_motion(
    matrix: FloatArray, arms: IntArray, all_arms: FloatArray, rotation: FloatArray
) -> None:
    """Make M (m, n + 6), whose last six columns are empty, M T, in place.

    ``arms`` (n,) number what the unknowns of tied nodes follow, three on end.
    """
    rows, size = len(matrix), len(arms)
    matrix[:, size:] = 0.0
    first = 0
    while first < size:
        if arms[first] < 0:
            first += 1
            continue
        y = all_arms[arms[first] // 3]
        for row in range(rows):
            a, b, c = matrix[row, first], matrix[row, first + 1], matrix[row, first + 2]
            # δθ × y, and δd
            matrix[row, size] += y[1] * c - y[2] * b
            matrix[row, size + 1] += y[2] * a - y[0] * c
            matrix[row, size + 2] += y[0] * b - y[1] * a
            matrix[row, size + 3] += a
            matrix[row, size + 4] += b
            matrix[row, size + 5] += c
            for k in range(3):
                turned = a * rotation[0, k] + b * rotation[1, k] + c * rotation[2, k]
                matrix[row, first + k] = turned
        first += 3


@compiled_parallel
def transformed(
    tangents: FloatArray,
    elements: IntArray,
    arms: IntArray,
    all_arms: FloatArray,
    rotation: FloatArray,
    result: FloatArray,
) -> None:
    """Fill Tᵀ K T, packed (k, (n + 6)(n + 7)/2), of the ``elements`` (k,) that see tied nodes.

    Parameters
    ----------
    tangents
        Packed upper triangles of all elements of a term.
    arms
        (k, n): 3 times the number of the tie and the component, for unknowns of tied nodes, whose
        three stand on end; −1 for all others.
    all_arms, rotation
        The arms y (ties, 3) and R of the motion.
    """
    size = arms.shape[1]
    whole = size + 6
    for e in prange(len(elements)):
        # Tᵀ K T = ((K T)ᵀ T)ᵀ, since K is symmetric.
        matrix, transposed = np.empty((size, whole)), np.empty((whole, whole))
        _unpack(tangents[elements[e]], matrix)
        _times_motion(matrix, arms[e], all_arms, rotation)
        for i in range(size):
            for j in range(whole):
                transposed[j, i] = matrix[i, j]
        _times_motion(transposed, arms[e], all_arms, rotation)
        entry = 0
        for i in range(whole):
            for j in range(i, whole):
                result[e, entry] = transposed[j, i]
                entry += 1
