"""Gaussian mixtures with a bridge between the two categories of the data set.

In the reduced space the bending and the twisting designs are two separate islands. A mixture of
Gaussians fitted by expectation–maximisation (EM) covers what is there, so that a third Gaussian
splits one of the islands, and no sample lies between them. The mixed mode, which the data set does
not have, needs a Gaussian of its own: here the Wasserstein barycentre of the two categories'
Gaussians, half-way along the cheapest transport of the one to the other. With means m, covariances
S and the optimal transport map A from the first Gaussian to the second,

    m = (m_1 + m_2) / 2,    S = M S_1 M,    M = (I + A) / 2,
    A = S_1^{-1/2} (S_1^{1/2} S_2 S_1^{1/2})^{1/2} S_1^{-1/2}

(Agueh and Carlier, Barycenters in the Wasserstein space, SIAM J. Math. Anal. 43, 2011; the map:
Dowson and Landau, J. Multivariate Anal. 12, 1982).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.mixture import GaussianMixture

__all__ = ["Mixture", "barycentre", "bic_curve", "fit_mixture", "transport"]

FloatArray = NDArray[np.float64]

# EM finds the nearest optimum: the best of so many starts is kept.
_STARTS = 3


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Mixture:
    """K Gaussians in d dimensions.

    weights: (K,), their sum is 1. means: (K, d). covariances: (K, d, d).
    bridge: index of the Gaussian between the two categories; None if there is none.
    """

    weights: FloatArray
    means: FloatArray
    covariances: FloatArray
    bridge: int | None = None

    def sample(self, count: int, rng: np.random.Generator) -> tuple[FloatArray, NDArray[np.int64]]:
        """Return points (count, d) in random order, and the Gaussian of each (count,)."""
        components = rng.choice(len(self.weights), size=count, p=self.weights)
        points = np.empty((count, self.means.shape[1]))
        for k in range(len(self.weights)):
            members = components == k
            points[members] = self.sample_of(k, int(members.sum()), rng)
        return points, components

    def sample_of(self, component: int, count: int, rng: np.random.Generator) -> FloatArray:
        """Return points (count, d) of one of the Gaussians."""
        normal = rng.standard_normal((count, self.means.shape[1]))
        return np.asarray(self.means[component] + normal @ _root(self.covariances[component]))

    def as_dict(self) -> dict[str, Any]:
        """Return it as lists of numbers, for JSON."""
        return {
            "components": len(self.weights),
            "weights": self.weights.tolist(),
            "means": self.means.tolist(),
            "covariances": self.covariances.tolist(),
            "bridge": self.bridge,
        }


def fit_mixture(
    points: FloatArray,
    slanted: NDArray[np.bool_],
    components: int,
    bridge_share: float = 1 / 3,
    seed: int = 1,
) -> Mixture:
    """Fit Gaussians to points by EM, and put one of them between the two categories.

    Parameters
    ----------
    points
        (n, d) training designs in the reduced space.
    slanted
        (n,) which of them twist.
    components
        Number K of Gaussians in all.
    bridge_share
        Weight of the Gaussian between the categories, which is one of the K; with 0, or with
        designs of one category only, all K come from EM.
    seed
        Of the starts of EM.
    """
    if bridge_share == 0 or components < 2 or slanted.all() or not slanted.any():
        return _em(points, components, seed)
    islands = _em(points, components - 1, seed)
    floor = _floor(points)
    straight, helical = (_moments(points[kind], floor) for kind in (~slanted, slanted))
    mean, covariance = barycentre(straight, helical)
    return Mixture(
        weights=np.append((1 - bridge_share) * islands.weights, bridge_share),
        means=np.vstack([islands.means, mean]),
        covariances=np.concatenate([islands.covariances, covariance[None]]),
        bridge=components - 1,
    )


def barycentre(
    first: tuple[FloatArray, FloatArray], second: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return mean and covariance of the Wasserstein barycentre of two Gaussians, each (m, S)."""
    (mean_1, covariance_1), (mean_2, covariance_2) = first, second
    half = (np.eye(len(mean_1)) + transport(covariance_1, covariance_2)) / 2
    return (mean_1 + mean_2) / 2, half @ covariance_1 @ half


def transport(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the matrix A of the optimal transport of N(0, first) to N(0, second)."""
    root = _root(first)
    inverse = np.linalg.inv(root)
    return np.asarray(inverse @ _root(root @ second @ root) @ inverse)


def bic_curve(points: FloatArray, components: Iterable[int], seed: int = 1) -> dict[int, float]:
    """Return the Bayesian information criterion of EM with each number of Gaussians.

    Lower is better (Schwarz, Ann. Statist. 6, 1978).
    """
    return {k: float(_fitted(points, k, seed).bic(points)) for k in components}


def _em(points: FloatArray, components: int, seed: int) -> Mixture:
    fitted = _fitted(points, components, seed)
    return Mixture(
        weights=fitted.weights_ / fitted.weights_.sum(),
        means=fitted.means_,
        covariances=fitted.covariances_,
    )


def _fitted(points: FloatArray, components: int, seed: int) -> GaussianMixture:
    floor = _floor(points)
    method = GaussianMixture(components, n_init=_STARTS, reg_covar=floor, random_state=seed)
    return method.fit(points)


def _moments(points: FloatArray, floor: float) -> tuple[FloatArray, FloatArray]:
    covariance = np.atleast_2d(np.cov(points, rowvar=False, bias=True))
    return points.mean(axis=0), covariance + floor * np.eye(len(covariance))


def _floor(points: FloatArray) -> float:
    """Variance added in every direction: alpha, for one, has none within a category."""
    return 1e-6 * max(float(points.var(axis=0).mean()), 1e-12)


def _root(matrix: FloatArray) -> FloatArray:
    """Symmetric square root of a positive semi-definite matrix."""
    values, vectors = np.linalg.eigh((matrix + matrix.T) / 2)
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T)
