"""Maximum mean discrepancy: one number for how much two distributions differ."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.diversity.kernel import median_distance, rbf

__all__ = ["mmd_squared"]

FloatArray = NDArray[np.float64]


def mmd_squared(first: FloatArray, second: FloatArray, length: float | None = None) -> float:
    """Return the unbiased estimate of the squared maximum mean discrepancy, with an RBF kernel.

    Σ_{i≠j} k(x_i, x_j) / (m (m − 1)) + Σ_{i≠j} k(y_i, y_j) / (n (n − 1)) − 2 Σ k(x_i, y_j) / (m n)
    (Gretton et al. 2012, "A kernel two-sample test", equation 3). Its mean is 0 for equal
    distributions, so that it may fall below 0.

    Parameters
    ----------
    first, second
        Samples, shapes (m, d) and (n, d), each of at least 2.
    length
        Length scale of the kernel; None: the median distance over both samples together.
    """
    if length is None:
        length = median_distance(np.vstack([first, second]))
    across = rbf(first, second, length).mean()
    return float(_mean_of_pairs(first, length) + _mean_of_pairs(second, length) - 2 * across)


def _mean_of_pairs(points: FloatArray, length: float) -> float:
    count = len(points)
    if count < 2:
        raise ValueError("the discrepancy takes at least two points of each sample")
    # k(x, x) = 1 is left out.
    return float((rbf(points, points, length).sum() - count) / (count * (count - 1)))
