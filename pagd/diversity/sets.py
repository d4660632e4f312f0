"""Measures of small random sets: every generator is judged by equal counts, with an interval."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Interval", "interval", "over_sets", "random_set"]

FloatArray = NDArray[np.float64]


class Interval(NamedTuple):
    """A value and what it lies between."""

    value: float
    low: float
    high: float


def interval(values: FloatArray) -> Interval:
    """Return the median of values (n,) and the interval that holds the middle 95 % of them."""
    low, value, high = np.percentile(values, [2.5, 50.0, 97.5])
    return Interval(float(value), float(low), float(high))


def random_set(points: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
    """Return ``count`` of the points (n, d), drawn without replacement.

    Raises
    ------
    ValueError
        If there are fewer.
    """
    return points[rng.choice(len(points), size=count, replace=False)]


def over_sets(
    measure: Callable[[FloatArray], float],
    points: FloatArray,
    count: int,
    repeats: int,
    rng: np.random.Generator,
) -> FloatArray:
    """Return the measure of ``repeats`` random sets of ``count`` of the points, (repeats,)."""
    return np.array([measure(random_set(points, count, rng)) for _ in range(repeats)])
