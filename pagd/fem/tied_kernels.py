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
    """Fill a symmetric matrix (n, n) from its upper triangle, packed row by row."""
    size, entry = len(matrix), 0
    for i in range(size):
        for j in range(i, size):
            matrix[i, j] = matrix[j, i] = packed[entry]
            entry += 1


@compiled
def _fill_motion(
    arms: IntArray, all_arms: FloatArray, rotation: FloatArray, motion: FloatArray
) -> None:
    """Fill T (n, n + 6) of an element: ``arms`` (n,) number what its tied unknowns follow."""
    size = len(arms)
    motion[:, :] = 0.0
    for row in range(size):
        if arms[row] < 0:
            motion[row, row] = 1.0
            continue
        node, i = arms[row] // 3, arms[row] % 3
        y, first = all_arms[node], row - i
        j, k = (i + 1) % 3, (i + 2) % 3
        for column in range(3):
            motion[row, first + column] = rotation[i, column]
        # δθ × y
        motion[row, size + j] = y[k]
        motion[row, size + k] = -y[j]
        motion[row, size + 3 + i] = 1.0


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
    for e in prange(len(elements)):
        matrix, motion = np.empty((size, size)), np.empty((size, size + 6))
        _unpack(tangents[elements[e]], matrix)
        _fill_motion(arms[e], all_arms, rotation, motion)
        reduced = np.dot(motion.T, np.dot(matrix, motion))
        entry = 0
        for i in range(size + 6):
            for j in range(i, size + 6):
                result[e, entry] = reduced[i, j]
                entry += 1
