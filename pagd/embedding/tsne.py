"""t-SNE by openTSNE, with a decoder that interpolates among neighbours.

openTSNE, unlike scikit-learn, can place new designs in a finished plane, gives the same plane
whatever the number of threads, and needs less than half the time (``docs/method.md``).
"""

from __future__ import annotations

import functools
from itertools import count
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.embedding.decoder import NeighbourDecoder
from pagd.encoding import Decoded, Encoder
from pagd.errors import InputError
from pagd.long_work import is_shown, long_work

__all__ = ["TSNE"]

FloatArray = NDArray[np.float64]

# The library's own choice for new points in a finished plane.
_PERPLEXITY_OF_NEW, _NEAREST_OF_NEW = 5, 25
# Approximate neighbours would hang on the version of the library that finds them.
_NEIGHBOURS = "exact"
# Rounds between two looks at how far it is, which change nothing of the plane.
_TELL = 10


class TSNE:
    """Plane of designs by t-distributed stochastic neighbour embedding.

    Parameters
    ----------
    perplexity
        Effective number of neighbours of a design; the paper takes 30.
    neighbours
        How many designs of either kind the decoder interpolates.
    threads
        Threads; −1 takes all cores. The plane does not depend on it.
    """

    name = "tsne"
    designs: pd.DataFrame
    points: FloatArray
    encoder: Encoder

    def __init__(self, perplexity: float = 30.0, neighbours: int = 5, threads: int = -1) -> None:
        if neighbours < 1:
            raise InputError(f"embedding.neighbours = {neighbours} must be at least 1.")
        self.perplexity, self.neighbours, self.threads = perplexity, neighbours, threads

    def fit(self, designs: pd.DataFrame, seed: int = 1) -> TSNE:
        """Place the designs, starting from their principal components."""
        import openTSNE

        if not 0 < self.perplexity <= len(designs) / 3:
            raise InputError(
                f"embedding.perplexity = {self.perplexity:g} must be greater than 0 and at most a "
                f"third of the number of designs, {len(designs) / 3:.4g}."
            )
        vectors = Encoder().fit(designs).transform(designs)
        method = openTSNE.TSNE(
            perplexity=self.perplexity,
            neighbors=_NEIGHBOURS,
            n_jobs=self.threads,
            random_state=seed,
        )
        with long_work("t-SNE", method.early_exaggeration_iter + method.n_iter, "rounds") as shown:
            if is_shown():
                # The rounds are counted anew behind those of the early exaggeration.
                done = count(_TELL, _TELL)
                method.callbacks = [lambda *_: shown.reach(next(done))]
                method.callbacks_every_iters = _TELL
            plane = method.fit(vectors)
        return self.restore(designs, np.asarray(plane, dtype=np.float64))

    def restore(self, designs: pd.DataFrame, points: FloatArray) -> TSNE:
        """Take up the points of an earlier fit."""
        self.designs, self.points = designs, points
        self.encoder = Encoder().fit(designs)
        self._decoder = NeighbourDecoder(designs, points, self.neighbours)
        self.__dict__.pop("_plane", None)
        return self

    def transform(self, designs: pd.DataFrame) -> FloatArray:
        """Return the places (m, 2) of designs, each moved until it suits its neighbours."""
        vectors = self.encoder.transform(designs)
        nearest = min(_NEAREST_OF_NEW, len(self.designs) - 1)
        placed = self._plane.transform(vectors, perplexity=_PERPLEXITY_OF_NEW, k=nearest)
        return np.asarray(placed, dtype=np.float64)

    def decode(self, points: FloatArray) -> Decoded:
        """Return the designs at places (m, 2)."""
        return self._decoder.decode(points)

    def decode_left_out(self, training: NDArray[np.int64]) -> Decoded:
        """Decode the places of training designs (m,) as if each were not among them."""
        return self._decoder.decode_left_out(training, self.points[training])

    @functools.cached_property
    def _plane(self) -> Any:
        """The plane as openTSNE's own object, which knows how to place others."""
        from openTSNE import TSNEEmbedding
        from openTSNE.affinity import PerplexityBasedNN

        vectors = self.encoder.transform(self.designs)
        affinities = PerplexityBasedNN(
            vectors, perplexity=self.perplexity, method=_NEIGHBOURS, n_jobs=self.threads
        )
        return TSNEEmbedding(self.points, affinities, n_jobs=self.threads, random_state=1)
