"""Fidelity and coverage of generated designs by balls of nearest neighbours."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from scipy.spatial.distance import cdist

__all__ = ["Fidelity", "fidelity"]

FloatArray = NDArray[np.float64]


class Fidelity(NamedTuple):
    """Density, coverage (Naeem et al. 2020), precision and recall (Kynkäänniemi et al. 2019)."""

    density: float
    coverage: float
    precision: float
    recall: float


def fidelity(real: FloatArray, generated: FloatArray, neighbours: int = 5) -> Fidelity:
    """Compare generated points with real ones through balls around them.

    The ball around a point reaches to its k-th nearest other of its own set. With the balls B_i
    around the n real points x_i, and the m generated points y_j (B'_j around them):

    - density = Σ_j Σ_i [y_j in B_i] / (k m): 1 for equal distributions, more where generated
      points crowd where the real ones are dense;
    - coverage = Σ_i [some y_j in B_i] / n: 1 − 2^(−k) for equal distributions and many points,
      0.97 for k = 5 (Naeem et al. 2020, "Reliable fidelity and diversity metrics for generative
      models", with k = 5);
    - precision = Σ_j [y_j in some B_i] / m, recall = Σ_i [x_i in some B'_j] / n (Kynkäänniemi
      et al. 2019).

    The balls are closed, so that a copy of a design counts even where the design has doubles; the
    authors' program leaves their surface out.

    Parameters
    ----------
    real, generated
        Shapes (n, d) and (m, d); the time grows with n m.
    neighbours
        k, smaller than n and m.

    Raises
    ------
    ValueError
        If there are no k other points in one of the sets.
    """
    distances = cdist(real, generated)
    in_real = distances <= _radii(real, neighbours)[:, None]
    in_generated = distances <= _radii(generated, neighbours)
    return Fidelity(
        density=float(in_real.sum() / (neighbours * len(generated))),
        coverage=float(in_real.any(axis=1).mean()),
        precision=float(in_real.any(axis=0).mean()),
        recall=float(in_generated.any(axis=1).mean()),
    )


def _radii(points: FloatArray, neighbours: int) -> FloatArray:
    if not 0 < neighbours < len(points):
        raise ValueError(f"{len(points)} points have no {neighbours} nearest others each")
    # The first is the point itself.
    return np.asarray(KDTree(points).query(points, k=[neighbours + 1])[0][:, 0], dtype=np.float64)
