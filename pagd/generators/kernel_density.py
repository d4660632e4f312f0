"""Kernel density in the reduced space: every training design under a Gaussian of its own."""

from __future__ import annotations

import numpy as np
from sklearn.neighbors import KernelDensity

from pagd.embedding.interface import Embedding
from pagd.generators.interface import Proposal

__all__ = ["KernelDensityGenerator"]


class KernelDensityGenerator:
    """Samples of a kernel density estimate, decoded by the embedding.

    Parameters
    ----------
    bandwidth
        Standard deviation of the kernel in units of the reduced space. None takes Scott's rule
        (Multivariate Density Estimation, 1992), σ n^(−1/(d + 4)), with the spread σ within the
        categories: over both islands it would be the distance between them.
    """

    name = "kde"
    copies_training = False

    def __init__(self, bandwidth: float | None = None) -> None:
        self.bandwidth = bandwidth

    def fit(self, embedding: Embedding, seed: int = 1) -> KernelDensityGenerator:
        """Put a kernel on each training design; the seed changes nothing."""
        self._embedding = embedding
        width = self.bandwidth or _scott(embedding)
        self._density = KernelDensity(bandwidth=width).fit(embedding.points)
        return self

    def propose(self, count: int, rng: np.random.Generator) -> Proposal:
        """Sample the density and decode."""
        points = self._density.sample(count, random_state=int(rng.integers(2**31)))
        decoded = self._embedding.decode(points)
        return Proposal(parameters=decoded.parameters, points=points, corrected=decoded.corrected)


def _scott(embedding: Embedding) -> float:
    n, d = embedding.points.shape
    modes = embedding.designs["mode"].to_numpy()
    within = [
        embedding.points[modes == mode].var(axis=0) * np.mean(modes == mode)
        for mode in np.unique(modes)
    ]
    return float(np.sqrt(np.sum(within) / d) * n ** (-1 / (d + 4)))
