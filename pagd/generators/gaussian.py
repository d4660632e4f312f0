"""The paper's generator: a Gaussian mixture over the designs' places in a reduced space.

The bridge (:mod:`pagd.generators.mixture`) is as wide as the islands it lies between, so that many
of its samples fall on them. The islands have Gaussians of their own: what the bridge draws there,
a design of one category, is drawn again.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pagd.dataset.frame import designs_of
from pagd.embedding.interface import Embedding
from pagd.embedding.linear import FullSpace
from pagd.errors import InputError
from pagd.generators.interface import Proposal
from pagd.generators.mixture import Mixture, bic_curve, fit_mixture

__all__ = ["FullSpaceMixture", "PlainMixture", "ReducedSpaceMixture"]


FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# So many draws of a point that is to lie between the islands and never does are enough.
_TRIES = 300


class ReducedSpaceMixture:
    """Gaussian mixture in the reduced space, decoded by the embedding.

    Parameters
    ----------
    components
        Number of Gaussians, the bridge among them; the paper has 3. "bic" takes the number that
        the Bayesian information criterion prefers, and the bridge on top.
    largest_components
        The criterion is evaluated for 1 … so many Gaussians without a bridge.
    bridge_share
        Share of the designs drawn from the bridge; 0 is plain EM.
    """

    name = "gmm"
    copies_training = False
    shows_bic = True
    mixture: Mixture

    def __init__(
        self,
        components: int | Literal["bic"] = 3,
        largest_components: int = 10,
        bridge_share: float = 1 / 3,
    ) -> None:
        if components != "bic" and components < 1:
            raise InputError(f"generator.components = {components} must be at least 1, or bic.")
        if not 0 <= bridge_share < 1:
            raise InputError(
                f"generator.bridge_share = {bridge_share} must be at least 0 and less than 1."
            )
        self.components, self.largest_components = components, largest_components
        self.bridge_share = bridge_share
        #: Criterion by number of Gaussians, lower is better: of the plane, and where it decides.
        self.bic: dict[int, float] = {}

    def fit(self, embedding: Embedding, seed: int = 1) -> ReducedSpaceMixture:
        """Fit the mixture to the training designs' places."""
        self._embedding = self._space(embedding)
        points = self._embedding.points
        self._check_count(len(points))
        slanted = self._embedding.designs["N1"].to_numpy() > 0
        if self.components == "bic" or self.shows_bic:
            self.bic = bic_curve(points, range(1, self.largest_components + 1), seed)
        self.mixture = fit_mixture(points, slanted, self._count(), self.bridge_share, seed)
        return self

    def propose(self, count: int, rng: np.random.Generator) -> Proposal:
        """Sample the mixture and decode."""
        points, components = self.mixture.sample(count, rng)
        redrawn = self._leave_the_islands(points, components, rng)
        decoded = self._embedding.decode(points)
        return Proposal(
            parameters=decoded.parameters,
            points=points,
            components=components,
            corrected=decoded.corrected,
            redrawn=redrawn,
        )

    def _leave_the_islands(
        self, points: FloatArray, components: IntArray, rng: np.random.Generator
    ) -> IntArray:
        """Draw the bridge's points again until each decodes to a mixed design; how often (n,)."""
        redrawn, bridge = np.zeros(len(points), np.int64), self.mixture.bridge
        if bridge is None:
            return redrawn
        wrong = np.flatnonzero(components == bridge)
        for _ in range(_TRIES):
            wrong = wrong[~self._is_mixed(points[wrong])]
            if len(wrong) == 0:
                return redrawn
            points[wrong] = self.mixture.sample_of(bridge, len(wrong), rng)
            redrawn[wrong] += 1
        raise InputError(
            f"generator.bridge_share = {self.bridge_share:g} must be 0 for these designs: between "
            f"their two categories hardly any point decodes to a mixed design."
        )

    def _is_mixed(self, points: FloatArray) -> NDArray[np.bool_]:
        designs = designs_of(self._embedding.decode(points).parameters)
        return np.array([design.mode == "mixed" for design in designs], dtype=np.bool_)

    def _space(self, embedding: Embedding) -> Embedding:
        return embedding

    def _check_count(self, designs: int) -> None:
        asked = {"components": self.components, "largest_components": self.largest_components}
        for key, value in asked.items():
            if value != "bic" and value > designs:
                raise InputError(
                    f"generator.{key} = {value} must be at most the number of training designs, "
                    f"{designs}."
                )

    def _count(self) -> int:
        if self.components == "bic":
            return min(self.bic, key=lambda k: self.bic[k]) + (self.bridge_share > 0)
        return self.components


class PlainMixture(ReducedSpaceMixture):
    """The mixture as EM gives it, without a bridge: what the bridge is to be compared with."""

    name = "gmm_plain"
    shows_bic = False

    def __init__(self, components: int | Literal["bic"] = 3, largest_components: int = 10) -> None:
        super().__init__(components, largest_components, bridge_share=0.0)


class FullSpaceMixture(ReducedSpaceMixture):
    """The same mixture in the encoded space itself: what the reduction is to be compared with."""

    name = "gmm_full"
    # In 17 dimensions the curve takes eight times as long as all else.
    shows_bic = False

    def propose(self, count: int, rng: np.random.Generator) -> Proposal:
        """Sample the mixture and decode; there is no place in the reduced space."""
        proposal = super().propose(count, rng)
        return Proposal(
            parameters=proposal.parameters,
            components=proposal.components,
            corrected=proposal.corrected,
            redrawn=proposal.redrawn,
        )

    def _space(self, embedding: Embedding) -> Embedding:
        return FullSpace().fit(embedding.designs)
