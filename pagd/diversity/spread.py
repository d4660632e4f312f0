"""Spread of a set of designs among themselves."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import pdist

from pagd.diversity.kernel import rbf
from pagd.diversity.novelty import leave_one_out_distances

__all__ = ["JITTER", "dpp_score", "mean_pairwise_distance", "unevenness"]

FloatArray = NDArray[np.float64]

#: Added to the diagonal of the kernel matrix: what a design adds that is a double of another.
JITTER: Final = 1e-6


def mean_pairwise_distance(points: FloatArray) -> float:
    """Return the mean Euclidean distance over all pairs of points (n, d), n at least 2."""
    return float(pdist(points).mean())


def dpp_score(points: FloatArray, length: float, jitter: float = JITTER) -> float:
    """Return log det(K + ε I) / n for the RBF kernel matrix K of points (n, d).

    The log-probability, but for a constant, that a determinantal point process draws these points
    (Kulesza and Taskar 2012); as a measure of the diversity of generated designs: Chen and Ahmed
    2021 (PaDGAN), Regenwetter et al. 2023. 0 for points far from each other, log ε or so for
    doubles. Only scores of equal n, ℓ and ε can be compared; with many points in a plane most
    eigenvalues of K are under ε.

    Parameters
    ----------
    points
        Shape (n, d).
    length
        Length scale ℓ, for example the median distance of the training designs.
    jitter
        ε.
    """
    matrix = rbf(points, points, length) + jitter * np.eye(len(points))
    return float(np.linalg.slogdet(matrix).logabsdet / len(points))


def unevenness(points: FloatArray) -> float:
    """Return how unevenly points (n, d) are spaced: 0 for a lattice.

    The coefficient of variation of the distances γ_i to the nearest other point,
    λ = (Σ (γ_i − γ̄)² / n)^½ / γ̄: the COV measure of uniformity of Gunzburger and Burkardt (2004).
    Independent points spread evenly over a large square have (4/π − 1)^½ = 0.52. Not a number
    where all points have a double.
    """
    gaps = leave_one_out_distances(points)
    return float(gaps.std() / gaps.mean()) if gaps.any() else float("nan")
