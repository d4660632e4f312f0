"""From the products of an element's matrices to its residual and its packed tangent.

The pressures p of an element are condensed: with the volume changes v = ∫ φ (J − 1) dV and their
slopes b = ∂v/∂u the residual takes up K M⁻¹ v − p by b, the tangent b K M⁻¹ bᵀ.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled

FloatArray = NDArray[np.float64]


@compiled
def pressures_at(values: FloatArray, pressures: FloatArray, result: FloatArray) -> None:
    """Fill the pressures Σ φ_c p_c (Q,) of an element from values (Q, m) and pressures (m,)."""
    for q in range(len(values)):
        result[q] = 0.0
        for c in range(len(pressures)):
            result[q] += values[q, c] * pressures[c]


@compiled
def volume_changes(
    weights: FloatArray, values: FloatArray, ratios: FloatArray, changes: FloatArray
) -> None:
    """Fill v = ∫ φ (J − 1) dV (m,) from weights (Q,), values (Q, m) and ratios J (Q,)."""
    changes[:] = 0.0
    for q in range(len(weights)):
        change = weights[q] * (ratios[q] - 1.0)
        for c in range(len(changes)):
            changes[c] += change * values[q, c]


@compiled
def wanted_pressures(stiffness: FloatArray, changes: FloatArray, wanted: FloatArray) -> float:
    """Fill the pressures K M⁻¹ v (m,) of the volume changes v (m,); their energy."""
    energy = 0.0
    for c in range(len(changes)):
        wanted[c] = 0.0
        for d in range(len(changes)):
            wanted[c] += stiffness[c, d] * changes[d]
        energy += 0.5 * wanted[c] * changes[c]
    return energy


@compiled
def fill_volume_slopes(products: FloatArray, slopes: FloatArray) -> None:
    """Sort what belongs to direction i and node a, (m, 3, n), into the slopes b (m, 3n)."""
    for c in range(products.shape[0]):
        for i in range(3):
            for a in range(products.shape[2]):
                slopes[c, 3 * a + i] = products[c, i, a]


@compiled
def fill_residual(
    forces: FloatArray,
    wanted: FloatArray,
    pressures: FloatArray,
    slopes: FloatArray,
    residual: FloatArray,
) -> None:
    """Fill the residual (3n,): the forces (n, 3), and what the pressures lack by the slopes b."""
    for a in range(len(forces)):
        for i in range(3):
            residual[3 * a + i] = forces[a, i]
    for c in range(len(wanted)):
        lacking = wanted[c] - pressures[c]
        for i in range(len(residual)):
            residual[i] += lacking * slopes[c, i]


@compiled
def fill_condensed(
    stiffness: FloatArray, slopes: FloatArray, products: FloatArray, condensed: FloatArray
) -> None:
    """Fill b K M⁻¹ bᵀ (3n, 3n) of slopes (m, 3n); ``products`` (m, 3n) is scratch."""
    for c in range(len(slopes)):
        products[c, :] = 0.0
        for d in range(len(slopes)):
            factor = stiffness[c, d]
            for i in range(slopes.shape[1]):
                products[c, i] += factor * slopes[d, i]
    np.dot(slopes.T, products, condensed)


@compiled
def pack(equal: FloatArray, unequal: FloatArray, condensed: FloatArray, packed: FloatArray) -> None:
    """Fill the packed upper triangle: stiffness of the displacements, and what is condensed.

    equal, unequal (n, 3n): blocks ij = xx, yy, zz and xy, yz, zx. condensed (3n, 3n).
    """
    count, size, start = len(equal), len(condensed), 0
    for a in range(count):
        for i in range(3):
            row, after, before = 3 * a + i, (i + 1) % 3, (i + 2) % 3
            # Entry (row, column) stands at start + column.
            start -= row
            for column in range(row, 3 * a + 3):
                packed[start + column] = condensed[row, column]
            packed[start + row] += equal[a, i * count + a]
            if after > i:
                packed[start + 3 * a + after] += unequal[a, i * count + a]
            if before > i:
                packed[start + 3 * a + before] += unequal[a, before * count + a]
            for b in range(a + 1, count):
                first = 3 * b
                x = condensed[row, first + i] + equal[a, i * count + b]
                y = condensed[row, first + after] + unequal[a, i * count + b]
                z = condensed[row, first + before] + unequal[b, before * count + a]
                packed[start + first + i] = x
                packed[start + first + after] = y
                packed[start + first + before] = z
            start += size
