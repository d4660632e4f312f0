"""From a plane without an inverse back to designs: interpolation among the nearest designs.

t-SNE gives places to designs, not designs to places. A place is decoded from the k nearest
designs of either kind, the straight (N1 = 0) and the slanted (N1 > 0), each weighted by its
closeness, the inverse square of its distance (Shepard, Proc. 23rd ACM Nat. Conf., 1968). The
parameters are treated by what they mean:

- alpha is the share of helical chambers, and so the share of the slanted kind's closeness in all
  closeness: 0 or 1 within the island of one kind, in between between the islands;
- theta is a property of slanted chambers: the mean over the slanted designs alone;
- all others are the means over each kind, weighted by 1 - alpha and alpha.

At the place of a training design the decoder returns that design.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.spatial import KDTree

from pagd.dataset.frame import INDEPENDENT
from pagd.encoding import Decoded, Limiter

__all__ = ["NeighbourDecoder"]

FloatArray = NDArray[np.float64]
_THETA, _ALPHA, _N = (INDEPENDENT.index(symbol) for symbol in ("theta", "alpha", "N"))


class NeighbourDecoder:
    """Decoder of places in the reduced space of some designs.

    Parameters
    ----------
    designs
        The n training designs.
    points
        Their places (n, d).
    neighbours
        How many of either kind are interpolated.
    """

    def __init__(self, designs: pd.DataFrame, points: FloatArray, neighbours: int = 5) -> None:
        slanted = designs["N1"].to_numpy() > 0
        values = designs[list(INDEPENDENT)].to_numpy(np.float64)
        self._limiter = Limiter(designs)
        self._straight, self._slanted = (
            _Kind(np.flatnonzero(kind), KDTree(points[kind]), values, neighbours)
            if kind.any()
            else None
            for kind in (~slanted, slanted)
        )

    def decode(self, points: FloatArray) -> Decoded:
        """Return the designs at places (m, d)."""
        return self._limiter(self._interpolated(points, None))

    def decode_left_out(self, training: NDArray[np.int64], points: FloatArray) -> Decoded:
        """Decode the places (m, d) of training designs (m,) as if each were not among them."""
        return self._limiter(self._interpolated(points, training))

    def _interpolated(self, points: FloatArray, left_out: NDArray[np.int64] | None) -> pd.DataFrame:
        kinds = [kind for kind in (self._straight, self._slanted) if kind is not None]
        means, closeness = zip(*(kind.means(points, left_out) for kind in kinds), strict=True)
        if len(kinds) == 2:
            values = _blended(means[0], means[1], closeness[1] / (closeness[0] + closeness[1]))
        else:
            values = means[0]
        return pd.DataFrame(values, columns=list(INDEPENDENT))


@dataclass(frozen=True, eq=False)
class _Kind:
    """The training designs of one kind: their rows, the tree of their places, all values."""

    rows: NDArray[np.int64]
    tree: KDTree
    values: FloatArray
    neighbours: int

    def means(
        self, points: FloatArray, left_out: NDArray[np.int64] | None
    ) -> tuple[FloatArray, FloatArray]:
        """Weighted means (m, 11) of the neighbours' parameters, and their closeness (m,)."""
        count = min(self.neighbours + (left_out is not None), len(self.rows))
        distances, places = self.tree.query(points, k=np.arange(1, count + 1))
        # A design's own place would be infinitely close.
        weights = np.maximum(distances, 1e-12) ** -2
        nearest = self.rows[places]
        if left_out is not None:
            weights = _without(weights, nearest == left_out[:, None], self.neighbours)
        closeness = weights.sum(axis=1)
        means = np.einsum("mk,mkp->mp", weights, self.values[nearest]) / closeness[:, None]
        return means, closeness


def _without(weights: FloatArray, own: NDArray[np.bool_], neighbours: int) -> FloatArray:
    """Weights with a design's own set to zero, or the farthest where it is not among them."""
    kept = np.where(own, 0.0, weights)
    if weights.shape[1] > neighbours:
        kept[~own.any(axis=1), -1] = 0.0
    return kept


def _blended(straight: FloatArray, slanted: FloatArray, alpha: FloatArray) -> FloatArray:
    """Designs (m, 11) between the two kinds: one of them where no chamber is of the other."""
    chambers = np.floor((1 - alpha) * straight[:, _N] + alpha * slanted[:, _N] + 0.5)
    alpha = np.floor(alpha * chambers + 0.5) / chambers
    values = (1 - alpha)[:, None] * straight + alpha[:, None] * slanted
    values[:, _THETA], values[:, _ALPHA] = slanted[:, _THETA], alpha
    return values
