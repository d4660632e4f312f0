"""d_new in the plane of a few training designs, over seeds: the paper's own figure, 0.014."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.diversity.novelty import leave_one_out_distances, novelty, unit_square
from pagd.long_work import counted

__all__ = ["PlaneNovelty", "plane_novelty_over_seeds"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class PlaneNovelty:
    """Mean nearest distance in the unit square: generator (or ``training``) to one a seed."""

    seeds: tuple[int, ...]
    values: Mapping[str, FloatArray]

    def mean(self, generator: str) -> float:
        """Return the mean over the seeds."""
        return float(self.values[generator].mean())

    def spread(self, generator: str) -> float:
        """Return the standard deviation over the seeds (n − 1); not a number for one seed."""
        values = self.values[generator]
        return float(values.std(ddof=1)) if len(values) > 1 else float("nan")

    def rows(self) -> list[dict[str, Any]]:
        """Return rows as those of a comparison: mean ± standard deviation; count of seeds."""
        shared = {"space": "plane_sample", "mode": "all", "metric": "novelty"}
        return [
            {"generator": name, **shared, **self._interval(name), "count": len(self.seeds)}
            for name in self.values
        ]

    def _interval(self, name: str) -> dict[str, float | None]:
        mean, spread = self.mean(name), self.spread(name)
        known = math.isfinite(spread)
        return {
            "value": mean,
            "low": mean - spread if known else None,
            "high": mean + spread if known else None,
        }


def plane_novelty_over_seeds(
    fit_and_sample: Callable[[int], tuple[FloatArray, Mapping[str, FloatArray]]],
    seeds: Iterable[int],
) -> PlaneNovelty:
    """Measure d_new in the unit square of a plane that is made anew for every seed.

    Parameters
    ----------
    fit_and_sample
        For a seed: the places (m, 2) of the training designs, and those (n, 2) of the designs of
        each generator, by its name. Places are scaled here.
    seeds
        At least one.

    Returns
    -------
    novelty
        Beside the generators, ``training``: each training design to the nearest other.
    """
    chosen = tuple(seeds)
    found = [
        _novelties(*fit_and_sample(seed))
        for seed in counted(chosen, "planes of a few designs", len(chosen), "seeds")
    ]
    return PlaneNovelty(chosen, {name: np.array([f[name] for f in found]) for name in found[0]})


def _novelties(training: FloatArray, generated: Mapping[str, FloatArray]) -> dict[str, float]:
    known = unit_square(training, training)
    own = {"training": float(leave_one_out_distances(known).mean())}
    return own | {
        name: novelty(unit_square(points, training), known) for name, points in generated.items()
    }
