"""What a comparison of generators gives, as rows for tables, files and figures."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pagd.diversity.hull import HullComparison, hull_corners
from pagd.diversity.metrics import METRICS, SPACES

__all__ = ["TRAINING", "Comparison"]

#: Name of the yardstick among the generators: the training designs themselves.
TRAINING: Final = "training"


@dataclass(frozen=True, eq=False, slots=True)
class Comparison:
    """Every metric of every generator, in every space.

    rows: generator, space, mode (or ``all``), metric, value, low, high and count of designs. The
        metrics are those of `METRICS`, the spaces those of `SPACES`. low and high are None where a
        metric has no interval, value where it is not defined.
    hulls: generator to its hulls in the plane.
    facts: counts and scales of the comparison.
    """

    rows: list[dict[str, Any]]
    hulls: dict[str, HullComparison]
    facts: dict[str, Any]

    def as_dict(self) -> dict[str, Any]:
        """Return rows, facts, and what the names mean, for a JSON file."""
        metrics = {name: metric._asdict() for name, metric in METRICS.items()}
        return {"facts": self.facts, "metrics": metrics, "spaces": dict(SPACES), "rows": self.rows}

    def row(
        self, generator: str, metric: str, space: str = "encoded", mode: str = "all"
    ) -> dict[str, Any]:
        """Return one row.

        Raises
        ------
        KeyError
            If that has not been measured.
        """
        wanted = {"generator": generator, "metric": metric, "space": space, "mode": mode}
        for row in self.rows:
            if wanted.items() <= row.items():
                return row
        raise KeyError(f"{metric} of {generator}, {mode}, in {space}")

    def hull_points(self) -> list[dict[str, Any]]:
        """Return the designs of Fig. 5, the first sets drawn: a row each.

        generator; set (``training`` or ``generated``); z1, z2 in the unit square; corner: place
        around the hull from 0, counter-clockwise, None within it.
        """
        return [
            {"generator": name, "set": kind, **row}
            for name, hull in self.hulls.items()
            for kind, points in ((TRAINING, hull.training_set), ("generated", hull.generated_set))
            for row in _places(points)
        ]

    def hull_areas(self) -> list[dict[str, Any]]:
        """Return the areas of all pairs of sets: generator, repeat, training and generated."""
        return [
            {"generator": name, "repeat": repeat, "training": float(one), "generated": float(other)}
            for name, hull in self.hulls.items()
            for repeat, (one, other) in enumerate(
                zip(hull.training_sizes, hull.generated_sizes, strict=True)
            )
        ]


def _places(points: NDArray[np.float64]) -> Iterator[dict[str, Any]]:
    corners = {int(row): place for place, row in enumerate(hull_corners(points))}
    for row, (z1, z2) in enumerate(points):
        yield {"z1": float(z1), "z2": float(z2), "corner": corners.get(row)}
