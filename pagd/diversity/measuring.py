"""All metrics of one set of designs in one space, as rows of a table."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.diversity.coverage import fidelity
from pagd.diversity.hull import HullComparison, hull_comparison
from pagd.diversity.mmd import mmd_squared
from pagd.diversity.novelty import Nearest, nearest, nearest_other, share_in_columns
from pagd.diversity.sets import Interval, interval, over_sets, random_set
from pagd.diversity.spaces import Counts, Space
from pagd.diversity.spread import dpp_score, mean_pairwise_distance, unevenness

__all__ = ["Subject", "hulls_of", "known", "newcomer", "rows_of"]

FloatArray = NDArray[np.float64]
_Named = Iterator[tuple[str, Interval]]


@dataclass(frozen=True, eq=False, slots=True)
class Subject:
    """The designs of a generator, or the training designs, in a space.

    points: (n, d).
    modes: (n,).
    nearest: the nearest training designs, (n,).
    sample: (s, d) those that density, coverage and discrepancy are taken of.
    """

    points: FloatArray
    modes: NDArray[Any]
    nearest: Nearest
    sample: FloatArray


def known(space: Space, modes: NDArray[Any]) -> Subject:
    """Return the training designs as the yardstick: each against the others."""
    return Subject(space.training, modes, nearest_other(space.training), space.held_out)


def newcomer(
    space: Space, given: FloatArray, modes: NDArray[Any], sample: int, seed: int
) -> Subject:
    """Return designs of a generator, (n, d) before any scaling."""
    points = space.scaled(given)
    drawn = random_set(points, sample, np.random.default_rng(seed))
    return Subject(points, modes, nearest(points, space.training), drawn)


def hulls_of(space: Space, subject: Subject, counts: Counts, seed: int) -> HullComparison:
    """Compare the hulls of sets of the designs with those of training designs."""
    return hull_comparison(
        space.flat(space.training),
        space.flat(subject.points),
        counts.set_size,
        counts.sets,
        rng=np.random.default_rng(seed),
    )


def rows_of(
    space: Space,
    subject: Subject,
    hulls: HullComparison,
    counts: Counts,
    neighbours: int,
    seed: int,
) -> Iterator[dict[str, Any]]:
    """Yield a row for every metric: mode, metric, value, low, high and count of designs."""
    yield from _rows_by_mode(space, subject)
    for name, found in (
        ("hull_size", interval(hulls.generated_sizes)),
        ("hull_ratio", hulls.ratio),
        *_spreads(space, subject.points, counts, seed),
    ):
        yield _row("all", name, found, counts.set_size)
    for name, value in _likeness(space, subject.sample, neighbours):
        yield _row("all", name, Interval(value, math.nan, math.nan), counts.sample)


def _rows_by_mode(space: Space, subject: Subject) -> Iterator[dict[str, Any]]:
    chosen = {"all": np.ones(len(subject.modes), dtype=bool)}
    # The order of modes is that of the alphabet, whatever comes first.
    chosen |= {str(mode): subject.modes == mode for mode in np.unique(subject.modes.astype(str))}
    for mode, rows in chosen.items():
        for name, found in _novelties(space, subject, rows):
            yield _row(mode, name, found, int(rows.sum()))


def _novelties(space: Space, subject: Subject, rows: NDArray[np.bool_]) -> _Named:
    distances = subject.nearest.distances[rows]
    error = distances.std(ddof=1) / math.sqrt(len(distances)) if len(distances) > 1 else math.nan
    mean = float(distances.mean())
    yield "novelty", Interval(mean, mean - 1.96 * error, mean + 1.96 * error)
    if space.mode_places:
        others = space.training[subject.nearest.rows[rows]]
        share = share_in_columns(subject.points[rows], others, space.mode_places)
        yield "mode_part", Interval(share, math.nan, math.nan)


def _spreads(space: Space, points: FloatArray, counts: Counts, seed: int) -> _Named:
    measures = {
        "mean_pairwise_distance": mean_pairwise_distance,
        "dpp": lambda drawn: dpp_score(drawn, space.length),
        "unevenness": unevenness,
    }
    for name, measure in measures.items():
        rng = np.random.default_rng(seed)
        yield name, interval(over_sets(measure, points, counts.set_size, counts.sets, rng))


def _likeness(space: Space, sample: FloatArray, neighbours: int) -> Iterator[tuple[str, float]]:
    yield from fidelity(space.reference, sample, neighbours)._asdict().items()
    yield "mmd", mmd_squared(space.reference, sample, space.length)


def _row(mode: str, metric: str, found: Interval, count: int) -> dict[str, Any]:
    numbers = {
        key: float(value) if math.isfinite(value) else None
        for key, value in found._asdict().items()
    }
    return {"mode": mode, "metric": metric, **numbers, "count": count}
