"""The sparsity pattern of the tangent, computed once per mesh.

The matrix is symmetric; only its upper triangle is stored, by rows (CSR), for
the free unknowns alone. For each term the pattern keeps where in the matrix
each entry of each element's packed triangle goes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Int32Array = NDArray[np.int32]


@dataclass(frozen=True)
class Pattern:
    """Upper triangle by rows: starts (m + 1,), columns (z,), and a map per term.

    A map (elements, size (size + 1)/2) holds positions in the matrix data; entries
    that involve a fixed unknown point to one position past the end, z.
    """

    starts: Int32Array
    columns: Int32Array
    maps: tuple[Int32Array, ...]

    @property
    def entries(self) -> int:
        """Number of stored entries z."""
        return len(self.columns)


@compiled
def _count_rows(dofs: IntArray, numbering: IntArray, counts: IntArray) -> None:
    """How many elements each free unknown belongs to."""
    for e in range(dofs.shape[0]):
        for i in range(dofs.shape[1]):
            row = numbering[dofs[e, i]]
            if row >= 0:
                counts[row] += 1


@compiled
def _list_elements(
    dofs: IntArray, numbering: IntArray, offset: int, position: IntArray, elements: Int32Array
) -> None:
    """Write the numbers of a term's elements, counted from ``offset``, to their rows."""
    for e in range(dofs.shape[0]):
        for i in range(dofs.shape[1]):
            row = numbering[dofs[e, i]]
            if row >= 0:
                elements[position[row]] = offset + e
                position[row] += 1


@compiled
def _row_columns(
    flat: IntArray,
    first: IntArray,
    numbering: IntArray,
    row_starts: IntArray,
    elements: Int32Array,
    starts: Int32Array,
    columns: Int32Array,
    fill: bool,
) -> None:
    """Find the columns ≥ row of each row; first only count them, then fill them in, sorted."""
    size = len(row_starts) - 1
    seen = np.full(size, -1, np.int32)
    for row in range(size):
        count = 0
        for k in range(row_starts[row], row_starts[row + 1]):
            for m in range(first[elements[k]], first[elements[k] + 1]):
                column = numbering[flat[m]]
                if column >= row and seen[column] != row:
                    seen[column] = row
                    if fill:
                        columns[starts[row] + count] = column
                    count += 1
        if fill:
            columns[starts[row] : starts[row + 1]].sort()
        else:
            starts[row + 1] = starts[row] + count


@compiled
def _locate(
    dofs: IntArray,
    numbering: IntArray,
    starts: Int32Array,
    columns: Int32Array,
    positions: Int32Array,
) -> None:
    """Position of each packed entry in the matrix data, by bisection within its row."""
    size = dofs.shape[1]
    for e in range(dofs.shape[0]):
        entry = 0
        for i in range(size):
            for j in range(i, size):
                a, b = numbering[dofs[e, i]], numbering[dofs[e, j]]
                if a < 0 or b < 0:
                    positions[e, entry] = len(columns)
                else:
                    row, column = min(a, b), max(a, b)
                    low, high = starts[row], starts[row + 1]
                    while high - low > 1:
                        middle = (low + high) // 2
                        if columns[middle] <= column:
                            low = middle
                        else:
                            high = middle
                    positions[e, entry] = low
                entry += 1


def build_pattern(dofs: Sequence[IntArray], numbering: IntArray) -> Pattern:
    """The pattern of terms whose elements see unknowns ``dofs``, each (elements, size).

    ``numbering`` (unknowns,) gives the row of each unknown, −1 where it is fixed.
    """
    free = int(numbering.max()) + 1
    flat = np.concatenate([d.ravel() for d in dofs])
    sizes = np.concatenate([np.full(len(d), d.shape[1]) for d in dofs])
    first = np.concatenate([[0], np.cumsum(sizes)])
    counts = np.zeros(free, np.int64)
    for d in dofs:
        _count_rows(d, numbering, counts)
    row_starts = np.concatenate([[0], np.cumsum(counts)])
    elements = np.empty(row_starts[-1], np.int32)
    position = row_starts[:-1].copy()
    offset = 0
    for d in dofs:
        _list_elements(d, numbering, offset, position, elements)
        offset += len(d)
    starts = np.zeros(free + 1, np.int32)
    _row_columns(flat, first, numbering, row_starts, elements, starts, elements, False)
    columns = np.empty(starts[-1], np.int32)
    _row_columns(flat, first, numbering, row_starts, elements, starts, columns, True)
    maps = []
    for d in dofs:
        size = d.shape[1]
        positions = np.empty((len(d), size * (size + 1) // 2), np.int32)
        _locate(d, numbering, starts, columns, positions)
        maps.append(positions)
    return Pattern(starts, columns, tuple(maps))
