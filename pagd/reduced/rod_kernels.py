"""The chain of compliant joints, joint by joint; see :mod:`pagd.reduced.rod`."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled

FloatArray = NDArray[np.float64]

# Angles (rad) below which sin(a)/a and (1 − cos a)/a² are their limits to the last digit.
_SMALL = 1e-8


@compiled
def _product(first: FloatArray, second: FloatArray, result: FloatArray) -> None:
    """Fill the product (3, 3) of two matrices (3, 3)."""
    for a in range(3):
        for b in range(3):
            result[a, b] = (
                first[a, 0] * second[0, b] + first[a, 1] * second[1, b] + first[a, 2] * second[2, b]
            )


@compiled
def _rotation(vector: FloatArray, result: FloatArray) -> None:
    """Fill exp([ω]×) (3, 3) for a rotation vector ω (3,) in radians (Rodrigues)."""
    x, y, z = vector
    angle = math.sqrt(x * x + y * y + z * z)
    first, second = 1.0, 0.5
    if angle > _SMALL:
        first = math.sin(angle) / angle
        second = 0.5 * (math.sin(0.5 * angle) / (0.5 * angle)) ** 2
    for a in range(3):
        for b in range(3):
            result[a, b] = second * vector[a] * vector[b]
        result[a, a] += 1.0 - second * angle * angle
    result[0, 1] -= first * z
    result[1, 0] += first * z
    result[0, 2] += first * y
    result[2, 0] -= first * y
    result[1, 2] -= first * x
    result[2, 1] += first * x


@compiled
def _answer(
    without: FloatArray, change: FloatArray, share: FloatArray, moment: FloatArray, row: int
) -> float:
    """What a moment (3,) makes of one row of a compliance that is linear in it."""
    part = 0.5 * (share[0] * moment[0] + share[1] * moment[1] + share[2] * moment[2])
    result = 0.0
    for b in range(3):
        result += (without[row, b] + part * change[row, b]) * moment[b]
    return result


@compiled
def shape(
    base: FloatArray,
    rotations: FloatArray,
    displacements: FloatArray,
    centres: FloatArray,
    without: FloatArray,
    change: FloatArray,
    share: FloatArray,
    edge: FloatArray,
    moments: FloatArray,
    turned: FloatArray,
    cells: FloatArray,
    cuts: FloatArray,
    ends: FloatArray,
) -> None:
    """Fill where the chain is under moments: ``turned``, ``cells``, ``cuts`` and ``ends``.

    Parameters
    ----------
    base
        Rotation and displacement (3, 4) of the first cell.
    rotations, displacements, centres
        (j, 3, 3) and (j, 3), (j, 3): the joints at rest.
    without, change
        (j, 6, 3): the compliance without a moment, and what it is more with that of ``share``.
    share
        (j, 3): m* / (m* · m*).
    edge
        (2, 3) in coordinates of the last cell.
    moments
        (j, 3) at the joints, in coordinates of the cell before.
    turned
        (j, 3) rotation vectors of the joints by their moments, filled.
    cells, cuts, ends
        Rotations (j, 3, 3) of the cells, centres (j, 3) of the cuts and the edge (2, 3), filled.
    """
    rotation, place = base[:, :3].copy(), base[:, 3].copy()
    further, joint = np.empty((3, 3)), np.empty((3, 3))
    next_rotation, behind = np.empty((3, 3)), np.empty(3)
    for k in range(len(rotations)):
        cells[k] = rotation
        for a in range(3):
            turned[k, a] = _answer(without[k], change[k], share[k], moments[k], a)
            cuts[k, a] = place[a]
            for b in range(3):
                cuts[k, a] += rotation[a, b] * centres[k, b]
        _rotation(turned[k], further)
        _product(further, rotations[k], joint)
        for a in range(3):
            aside = _answer(without[k], change[k], share[k], moments[k], 3 + a)
            behind[a] = centres[k, a] + aside
            for b in range(3):
                behind[a] += further[a, b] * (displacements[k, b] - centres[k, b])
        for a in range(3):
            for b in range(3):
                place[a] += rotation[a, b] * behind[b]
        _product(rotation, joint, next_rotation)
        rotation[:] = next_rotation
    for end in range(len(edge)):
        for a in range(3):
            ends[end, a] = place[a]
            for b in range(3):
                ends[end, a] += rotation[a, b] * edge[end, b]


@compiled
def unbalanced(
    cells: FloatArray,
    cuts: FloatArray,
    ends: FloatArray,
    forces: FloatArray,
    moments: FloatArray,
    result: FloatArray,
) -> None:
    """Fill what the moments (j, 3) exceed those of upward forces (2,) at the edge by."""
    for k in range(len(cuts)):
        x = y = 0.0
        for end in range(len(forces)):
            # r × (0, 0, f)
            x += (ends[end, 1] - cuts[k, 1]) * forces[end]
            y -= (ends[end, 0] - cuts[k, 0]) * forces[end]
        for a in range(3):
            result[k, a] = moments[k, a] - cells[k, 0, a] * x - cells[k, 1, a] * y
