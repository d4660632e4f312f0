"""The Gaussian (RBF) kernel and its length scale."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist, pdist

__all__ = ["median_distance", "rbf"]

FloatArray = NDArray[np.float64]


def rbf(first: FloatArray, second: FloatArray, length: float) -> FloatArray:
    """Return the kernel exp(−‖x − y‖² / (2 ℓ²)) of points (n, d) and (m, d), shape (n, m).

    Raises
    ------
    ValueError
        If the length scale ℓ is not positive.
    """
    if not length > 0:
        raise ValueError(f"the length scale of a kernel must be positive, and is {length:g}")
    squares: FloatArray = cdist(first, second, "sqeuclidean")
    return np.exp(squares / (-2.0 * length**2))


def median_distance(points: FloatArray) -> float:
    """Return the median distance between two of the points (n, d): the usual length scale.

    The median heuristic (Gretton et al. 2012, section 8).
    """
    return float(np.median(pdist(points)))
