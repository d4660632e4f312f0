"""What a generator is to be compared with: random designs, and the training designs themselves."""

from __future__ import annotations

import numpy as np

from pagd.dataset.frame import INDEPENDENT, frame_of
from pagd.dataset.sampling import sample_designs
from pagd.design import GeometryRules
from pagd.embedding.interface import Embedding
from pagd.generators.interface import Proposal

__all__ = ["RandomSampling", "Resampling"]


class RandomSampling:
    """Fresh random designs of the sampling box, bending and twisting as in the training set."""

    name = "random"
    copies_training = False

    def __init__(self, rules: GeometryRules | None = None) -> None:
        self._rules = rules or GeometryRules()

    def fit(self, embedding: Embedding, seed: int = 1) -> RandomSampling:
        """Take over the share of twisting designs, and nothing else."""
        self._twisting_share = float(np.mean(embedding.designs["N1"] > 0))
        return self

    def propose(self, count: int, rng: np.random.Generator) -> Proposal:
        """Draw designs, all valid by the rules, in random order."""
        twisting = int(rng.binomial(count, self._twisting_share))
        designs = [
            *sample_designs(count - twisting, "bending", self._rules, rng).designs,
            *sample_designs(twisting, "twisting", self._rules, rng).designs,
        ]
        drawn = frame_of([designs[i] for i in rng.permutation(count)], map(str, range(count)), "")
        return Proposal(parameters=drawn[list(INDEPENDENT)])


class Resampling:
    """Training designs drawn at random, none twice in one proposal: the yardstick for copies."""

    name = "resample"
    copies_training = True

    def fit(self, embedding: Embedding, seed: int = 1) -> Resampling:
        """Keep the training designs and their places."""
        self._designs, self._points = embedding.designs, embedding.points
        return self

    def propose(self, count: int, rng: np.random.Generator) -> Proposal:
        """Draw training designs; fewer than ``count`` where there are no more."""
        rows = rng.permutation(len(self._designs))[:count]
        parameters = self._designs.iloc[rows][list(INDEPENDENT)].reset_index(drop=True)
        return Proposal(parameters=parameters, points=self._points[rows])
