"""Reduced spaces with an exact way back: principal components, and the encoded space itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from sklearn.decomposition import PCA
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import FunctionTransformer

from pagd.encoding import Decoded, Encoder, Limiter

__all__ = ["FullSpace", "PrincipalComponents"]

FloatArray = NDArray[np.float64]


class FullSpace:
    """The encoded space as it is: no reduction."""

    name = "none"
    designs: pd.DataFrame
    points: FloatArray
    encoder: Encoder

    def fit(self, designs: pd.DataFrame, seed: int = 1) -> FullSpace:
        """Encode the designs; the seed changes nothing."""
        self._pipeline = make_pipeline(Encoder(), self._reduction(len(designs)))
        self.points = np.asarray(self._pipeline.fit_transform(designs), dtype=np.float64)
        self.designs, self.encoder = designs, self._pipeline[0]
        self._limiter = Limiter(designs)
        return self

    def restore(self, designs: pd.DataFrame, points: FloatArray) -> FullSpace:
        """Fit anew, which takes no time; the points are those of the fit."""
        return self.fit(designs)

    def transform(self, designs: pd.DataFrame) -> FloatArray:
        """Return the places (m, d) of designs."""
        return np.asarray(self._pipeline.transform(designs), dtype=np.float64)

    def decode(self, points: FloatArray) -> Decoded:
        """Return the designs at places (m, d)."""
        return self._limiter(_inverse(self._pipeline, points))

    def _reduction(self, count: int) -> Any:
        return FunctionTransformer()


class PrincipalComponents(FullSpace):
    """Principal components of the encoded space.

    Parameters
    ----------
    dimensions
        Number of components; None keeps all of them, and with them the exact way back.
    """

    name = "pca"

    def __init__(self, dimensions: int | None = None) -> None:
        self.dimensions = dimensions

    def _reduction(self, count: int) -> PCA:
        # The full decomposition is the one whose result does not hang on a random start.
        return PCA(self.dimensions, svd_solver="full")


def _inverse(pipeline: Pipeline, points: FloatArray) -> pd.DataFrame:
    parameters: pd.DataFrame = pipeline.inverse_transform(points)
    return parameters
