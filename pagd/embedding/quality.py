"""How much of the designs an embedding keeps: trustworthiness, and the decoder's error."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from sklearn.manifold import trustworthiness

from pagd.dataset.frame import INDEPENDENT
from pagd.embedding.interface import Embedding, Interpolating
from pagd.encoding import Encoder

__all__ = ["Quality", "quality_of"]

FloatArray = NDArray[np.float64]
_NEIGHBOURS = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Quality:
    """What an embedding keeps of its designs.

    trustworthiness: 0…1, how far the nearest designs in the reduced space are near in the
        encoded space (Venna and Kaski 2001; `_NEIGHBOURS` neighbours).
    round_trip_error: root mean square over designs and independent parameters, in standard
        deviations, of decoded training designs against themselves.
    left_out_error: the same where each design is decoded from the others; None where decoding
        does not go by the others.
    spread_of_kind: the same between training designs of one mode drawn at random; the error of a
        decoder that knows nothing but the mode is 1/√2 of it.
    designs: number of designs that the trustworthiness is measured with.
    """

    trustworthiness: float
    round_trip_error: float
    left_out_error: float | None
    spread_of_kind: float
    designs: int

    def as_dict(self) -> dict[str, float | int | None]:
        """Return it for a record."""
        return asdict(self)


def quality_of(embedding: Embedding, sample: int = 5000, seed: int = 1) -> Quality:
    """Measure an embedding with a sample of its training designs.

    Parameters
    ----------
    embedding
        A fitted embedding.
    sample
        Number of designs drawn; the time of the trustworthiness grows with its square.
    seed
        Of the draw.
    """
    rng = np.random.default_rng(seed)
    count = len(embedding.designs)
    rows = np.sort(rng.choice(count, size=min(sample, count), replace=False))
    designs, points = embedding.designs.iloc[rows], embedding.points[rows]
    return Quality(
        trustworthiness=_trustworthiness(embedding.encoder.transform(designs), points),
        round_trip_error=_error(embedding.encoder, designs, embedding.decode(points).parameters),
        left_out_error=_left_out_error(embedding, rows),
        spread_of_kind=_spread_of_kind(embedding.encoder, designs, rng),
        designs=len(rows),
    )


def _trustworthiness(vectors: FloatArray, points: FloatArray) -> float:
    # The measure is defined for fewer neighbours than half of the designs.
    neighbours = max(1, min(_NEIGHBOURS, len(vectors) // 2 - 1))
    return float(trustworthiness(vectors, points, n_neighbors=neighbours))


def _left_out_error(embedding: Embedding, rows: NDArray[np.int64]) -> float | None:
    if not isinstance(embedding, Interpolating):
        return None
    decoded = embedding.decode_left_out(rows).parameters
    return _error(embedding.encoder, embedding.designs.iloc[rows], decoded)


def _spread_of_kind(encoder: Encoder, designs: pd.DataFrame, rng: np.random.Generator) -> float:
    errors = [
        _error(encoder, kind, kind.iloc[rng.permutation(len(kind))]) ** 2 * len(kind)
        for _, kind in designs.groupby("mode")
    ]
    return float(np.sqrt(sum(errors) / len(designs)))


def _error(encoder: Encoder, designs: pd.DataFrame, others: pd.DataFrame) -> float:
    columns = list(INDEPENDENT)
    gaps = designs[columns].to_numpy(np.float64) - others[columns].to_numpy(np.float64)
    return float(np.sqrt(np.mean(np.square(gaps / encoder.spreads.to_numpy()))))
