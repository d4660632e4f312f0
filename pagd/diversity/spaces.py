"""The spaces in which designs are compared, with what is known of the training designs there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from sklearn.decomposition import PCA

from pagd.diversity.kernel import median_distance
from pagd.diversity.novelty import unit_square
from pagd.diversity.sets import random_set

__all__ = ["Counts", "Space", "encoded_space", "plane_space"]

FloatArray = NDArray[np.float64]


class Counts(NamedTuple):
    """Equal counts for all: designs of a sample; designs of a set, and number of the sets."""

    sample: int
    set_size: int
    sets: int


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Space:
    """One space.

    training: (m, d) all training designs.
    reference, held_out: (sample, d) two halves of a random draw of them.
    length: length scale of the kernels, the median distance within the reference.
    scaled: takes points to this space; flat: takes points of it to where hulls are taken.
    mode_places: which of the d tell the mode, as far as known.
    facts: for a record.
    """

    name: str
    training: FloatArray
    reference: FloatArray
    held_out: FloatArray
    length: float
    scaled: Callable[[FloatArray], FloatArray]
    flat: Callable[[FloatArray], FloatArray]
    mode_places: Sequence[int]
    facts: dict[str, Any]


def encoded_space(
    training: FloatArray,
    components: int,
    counts: Counts,
    seed: int,
    mode_places: Sequence[int] = (),
) -> Space:
    """Return the space of vectors (m, d) as they are.

    Hulls are taken in its first principal components, since a hull in all 17 dimensions would need
    more corners than there are designs.
    """
    # The full decomposition does not hang on a random start.
    reduction = PCA(min(components, *training.shape), svd_solver="full").fit(training)
    return _space(
        "encoded",
        training,
        counts,
        seed,
        scaled=_same,
        flat=reduction.transform,
        mode_places=mode_places,
        facts={
            "hull_components": int(reduction.n_components_),
            "hull_variance": float(reduction.explained_variance_ratio_.sum()),
        },
    )


def plane_space(places: FloatArray, counts: Counts, seed: int) -> Space:
    """Return the plane with the training designs at places (m, 2), scaled to the unit square."""
    return _space(
        "plane",
        unit_square(places, places),
        counts,
        seed,
        scaled=lambda points: unit_square(points, places),
        flat=_same,
        mode_places=(),
        facts={},
    )


def _space(
    name: str, training: FloatArray, counts: Counts, seed: int, facts: dict[str, Any], **parts: Any
) -> Space:
    drawn = random_set(training, 2 * counts.sample, np.random.default_rng(seed))
    reference, held_out = np.split(drawn, 2)
    length = median_distance(reference)
    return Space(
        name=name,
        training=training,
        reference=reference,
        held_out=held_out,
        length=length,
        facts={"dimensions": training.shape[1], "kernel_length": length, **facts},
        **parts,
    )


def _same(points: FloatArray) -> FloatArray:
    return points
