"""Designs as vectors: standardised numbers and one-hot categories, and the way back.

The paper's preprocessing: zero mean and unit variance for the 14 numbers, one-hot for the two
categories. Back from a vector, only the eleven independent parameters are read; the dependent ones
and the categories are computed from them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.preprocessing import OneHotEncoder, StandardScaler

from pagd.dataset.frame import CATEGORICAL, DEPENDENT, INDEPENDENT
from pagd.design import DECIMALS

__all__ = ["Decoded", "Encoder", "Limiter"]

FloatArray = NDArray[np.float64]

_ALPHA_DECIMALS = 4
_NUMBERS = [*INDEPENDENT, *DEPENDENT]


class Encoder(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """Table of designs to vectors and back, as a scikit-learn transformer.

    A vector has the 14 standardised numbers, then a one for the category of each of mode and
    cross-section. A category that the training designs do not have, such as the mode of a mixed
    design, is none of theirs: its places are all zero.
    """

    def fit(self, designs: pd.DataFrame, y: Any = None) -> Encoder:
        """Learn mean and spread of the numbers, and the categories there are."""
        self.numbers_ = StandardScaler().fit(designs[_NUMBERS].to_numpy(np.float64))
        self.categories_ = OneHotEncoder(handle_unknown="ignore", sparse_output=False)
        self.categories_.fit(designs[list(CATEGORICAL)].to_numpy(object))
        return self

    def transform(self, designs: pd.DataFrame) -> FloatArray:
        """Return the vectors, shape (n, 17) for a training set of two modes."""
        numbers = self.numbers_.transform(designs[_NUMBERS].to_numpy(np.float64))
        categories = self.categories_.transform(designs[list(CATEGORICAL)].to_numpy(object))
        return np.hstack([numbers, categories])

    def inverse_transform(self, vectors: FloatArray) -> pd.DataFrame:
        """Return the independent parameters of vectors (n, 17), as they come: see `Limiter`."""
        numbers = self.numbers_.inverse_transform(np.asarray(vectors)[:, : len(_NUMBERS)])
        return pd.DataFrame(numbers[:, : len(INDEPENDENT)], columns=list(INDEPENDENT))

    def get_feature_names_out(self, input_features: Any = None) -> NDArray[np.object_]:
        """Return the names of the places of a vector, as ``mode_bending``."""
        categories = self.categories_.get_feature_names_out(list(CATEGORICAL))
        return np.array([*_NUMBERS, *categories], dtype=object)

    @property
    def spreads(self) -> pd.Series:
        """Standard deviation of each independent parameter over the training designs."""
        return pd.Series(self.numbers_.scale_[: len(INDEPENDENT)], index=list(INDEPENDENT))


@dataclass(frozen=True, eq=False, slots=True)
class Decoded:
    """Independent parameters that can be drawn, and which of them had to be corrected.

    parameters: n rows, one column a symbol. corrected: the same, true or false.
    """

    parameters: pd.DataFrame
    corrected: pd.DataFrame

    @property
    def corrections(self) -> dict[str, int]:
        """How many designs were corrected, by symbol; without those that never were."""
        return {str(key): int(n) for key, n in self.corrected.sum().items() if n}


class Limiter:
    """Makes parameters that can be drawn of numbers that come out of a decoder.

    N becomes a whole number and alpha the share of whole chambers, theta is 0 where none is
    helical. Everything is kept within the range of the training designs (theta within that of
    the slanted ones); a value counts as corrected where that took more than rounding.
    """

    def __init__(self, training: pd.DataFrame) -> None:
        ranges = training[list(INDEPENDENT)].agg(["min", "max"])
        slanted = training.loc[training["N1"] > 0, "theta"]
        if len(slanted):
            ranges["theta"] = [slanted.min(), slanted.max()]
        self._ranges = ranges

    def __call__(self, raw: pd.DataFrame) -> Decoded:
        """Return the parameters (n rows) and the corrections, by symbol."""
        found = raw[list(INDEPENDENT)].reset_index(drop=True).astype(np.float64)
        low, high = self._ranges.to_numpy(np.float64)
        # The slant of no chamber needs no correction.
        helical = found["alpha"] * found["N"] >= 0.5
        found["theta"] = found["theta"].where(helical, low[INDEPENDENT.index("theta")])
        limited = pd.DataFrame(np.clip(found.to_numpy(), low, high), columns=found.columns)
        beyond = (limited - found).abs() > 0.5 * 10.0**-DECIMALS
        return Decoded(_rounded(limited), beyond)


def _rounded(parameters: pd.DataFrame) -> pd.DataFrame:
    found = parameters.round(DECIMALS)
    found["N"] = np.floor(parameters["N"] + 0.5).astype(np.int64)
    helical = np.floor(parameters["alpha"] * found["N"] + 0.5)
    found["alpha"] = (helical / found["N"]).round(_ALPHA_DECIMALS)
    found["theta"] = found["theta"].where(helical > 0, 0.0)
    return found
