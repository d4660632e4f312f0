"""What every reduced space of designs can do: the seam behind which t-SNE, PCA and none stand."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.encoding import Decoded, Encoder

__all__ = ["Embedding", "Interpolating"]

FloatArray = NDArray[np.float64]


class Embedding(Protocol):
    """A reduced space, fitted to the n designs of a data set.

    designs: the n training designs, as a table (:mod:`pagd.dataset.frame`).
    points: (n, d) their places in the reduced space.
    encoder: the encoding it is made of.
    """

    name: str
    designs: pd.DataFrame
    points: FloatArray
    encoder: Encoder

    def fit(self, designs: pd.DataFrame, seed: int = 1) -> Embedding:
        """Make the reduced space of these designs; returns itself."""
        ...

    def restore(self, designs: pd.DataFrame, points: FloatArray) -> Embedding:
        """Take up the points that an earlier fit to the same designs has left; returns itself."""
        ...

    def transform(self, designs: pd.DataFrame) -> FloatArray:
        """Return the places (m, d) of designs, known or new."""
        ...

    def decode(self, points: FloatArray) -> Decoded:
        """Return the designs at places (m, d) as independent parameters, in limits."""
        ...


@runtime_checkable
class Interpolating(Protocol):
    """An embedding that decodes from the training designs near by."""

    def decode_left_out(self, training: NDArray[np.int64]) -> Decoded:
        """Decode the places of training designs (m,) as if each were not among them."""
        ...
