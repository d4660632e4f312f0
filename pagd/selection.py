"""Choice of a few designs of many: as many of each mode, as different as there are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from pagd.design import MODES

__all__ = ["choose", "farthest_points"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def choose(
    frame: pd.DataFrame,
    encoded: FloatArray,
    count: int,
    seed: int = 1,
    modes: Sequence[str] = MODES,
) -> IntArray:
    """Choose designs, spread by farthest-point choice within each mode.

    Every mode gets an equal share. What does not divide evenly goes to the first modes, and what a
    mode has too few designs for to the others. Within a mode the choice is that of
    `farthest_points`, from a design drawn with the seed.

    Parameters
    ----------
    frame
        n designs, with a column ``mode``.
    encoded
        Their vectors, shape (n, d).
    count
        How many.
    seed
        Of the first design of each mode.
    modes
        The modes to choose from, in order of precedence: bending, twisting and mixed.

    Returns
    -------
    rows
        Places in the table, mode by mode and in the order of choice; all places in order where
        ``count`` is at least n. Fewer than ``count`` where the given modes have fewer.

    Raises
    ------
    ValueError
        If ``count`` is negative, or the vectors are not those of the table.
    """
    if count < 0:
        raise ValueError(f"cannot choose {count} designs")
    if len(frame) != len(encoded):
        raise ValueError(f"{len(encoded)} vectors for {len(frame)} designs")
    if count >= len(frame):
        return np.arange(len(frame))
    of_mode = {mode: np.flatnonzero(frame["mode"].to_numpy() == mode) for mode in modes}
    shares = _shares(count, {mode: len(rows) for mode, rows in of_mode.items()})
    rng = np.random.default_rng(seed)
    chosen = [
        rows[farthest_points(encoded[rows], shares[mode], rng)] for mode, rows in of_mode.items()
    ]
    return np.concatenate([np.zeros(0, dtype=np.int64), *chosen])


def farthest_points(points: FloatArray, count: int, rng: np.random.Generator) -> IntArray:
    """Choose ``count`` points that cover all: each is the one farthest from those chosen before.

    Greedy k-centre choice (Gonzalez 1985): no point is more than twice as far from the chosen
    ones as with the best choice, whichever the first. That one is drawn at random, so that
    another seed gives another selection.

    Parameters
    ----------
    points
        Shape (n, d).
    count
        At most n; a smaller choice with an equal generator is the beginning of a larger one.
    rng
        Draws the first point. Of equally far points the first in order is taken.

    Returns
    -------
    rows
        Shape (count,), in the order of choice, all different.
    """
    if count > len(points):
        raise ValueError(f"cannot choose {count} of {len(points)} points")
    if count == 0:
        return np.zeros(0, dtype=np.int64)
    chosen = [int(rng.integers(len(points)))]
    gaps = np.full(len(points), np.inf)
    while len(chosen) < count:
        gaps = np.minimum(gaps, cdist(points, points[chosen[-1:]])[:, 0])
        # Doubles of a chosen point are as near as the point itself, which must not come twice.
        gaps[chosen[-1]] = -1.0
        chosen.append(int(np.argmax(gaps)))
    return np.array(chosen, dtype=np.int64)


def _shares(count: int, available: Mapping[str, int]) -> dict[str, int]:
    """Deal ``count`` designs to the modes in turn, as long as they have any."""
    shares = dict.fromkeys(available, 0)
    left = min(count, sum(available.values()))
    while left:
        for mode in [m for m in available if shares[m] < available[m]][:left]:
            shares[mode] += 1
            left -= 1
    return shares
