"""What every generator of designs can do: the seam behind which mixtures and baselines stand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.embedding.interface import Embedding

__all__ = ["Generator", "Proposal"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Proposal:
    """Designs that a generator proposes, not yet checked.

    parameters: the independent parameters of n designs.
    points: (n, d) places in the reduced space that they were decoded from; None where the
        generator does not draw there.
    components: (n,) index of the Gaussian that each was drawn from; None without a mixture.
    corrected: which parameters had to be brought into limits, as a table of true and false; None
        where none had.
    redrawn: (n,) how many draws of its own the generator has replaced before each; None: none.
    """

    parameters: pd.DataFrame
    points: FloatArray | None = None
    components: NDArray[np.int64] | None = None
    corrected: pd.DataFrame | None = None
    redrawn: NDArray[np.int64] | None = None


class Generator(Protocol):
    """A source of designs like those of a data set, or unlike them.

    copies_training: whether it gives training designs back by its nature.
    """

    name: str
    copies_training: bool

    def fit(self, embedding: Embedding, seed: int = 1) -> Generator:
        """Learn from the designs of a fitted embedding; returns itself."""
        ...

    def propose(self, count: int, rng: np.random.Generator) -> Proposal:
        """Return ``count`` designs; :func:`pagd.generators.generate` sorts out the unusable."""
        ...
