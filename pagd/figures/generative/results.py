"""What the pictures of the generative half read: tables and records below a folder of results."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import pandas as pd

from pagd.errors import InputError, PagdError
from pagd.record import read_record
from pagd.tables import read_table

__all__ = [
    "GenerativePaths",
    "NothingToDraw",
    "figures_of",
    "load_generated",
    "load_mixture",
    "load_performance",
    "load_training",
    "settings_of",
    "table_or_none",
]


class NothingToDraw(PagdError):
    """A picture has no data: no fault, the run just has none; the message says what is missing."""


@dataclass(frozen=True, slots=True)
class GenerativePaths:
    """Where the results lie; any of them may be missing."""

    dataset: Path
    embedding: Path
    generated: Path
    diversity: Path
    performance: Path
    # Designs analysed by a chamber each, and those simulated as a whole to set beside them.
    screened: Path
    screened_training: Path
    full: Path

    @classmethod
    def under(cls, results: Path) -> Self:
        """Return the places below a folder of results, under their usual names."""
        return cls(
            dataset=results / "dataset",
            embedding=results / "embedding",
            generated=results / "generated",
            diversity=results / "diversity",
            performance=results / "summary" / "performance.parquet",
            screened=results / "screening" / "generated",
            screened_training=results / "screening" / "training",
            full=results / "summary" / "performance.parquet",
        )


def table_or_none(path: Path) -> pd.DataFrame | None:
    """Return a Parquet table with at least one row, or None."""
    if not path.is_file():
        return None
    frame = pd.DataFrame(read_table(path))
    return None if frame.empty else frame


def load_training(paths: GenerativePaths) -> pd.DataFrame:
    """Return the training designs, with their coordinates ``z1``, ``z2``… where they have any.

    Raises
    ------
    NothingToDraw
        If there is no data set.
    """
    designs = table_or_none(paths.dataset / "designs.parquet")
    if designs is None:
        raise NothingToDraw("There is no data set.")
    points = table_or_none(paths.embedding / "points.parquet")
    return designs if points is None else designs.merge(points, on="design_id", how="left")


def load_generated(paths: GenerativePaths) -> pd.DataFrame:
    """Return the generated designs, with ``z1`` and ``z2`` where they were drawn in a plane.

    Raises
    ------
    NothingToDraw
        If there are none.
    """
    designs = table_or_none(paths.generated / "designs.parquet")
    if designs is None:
        raise NothingToDraw("There are no generated designs.")
    return designs


def load_performance(paths: GenerativePaths) -> pd.DataFrame:
    """Return the simulated designs, one row each, whatever became of them.

    Raises
    ------
    NothingToDraw
        If there are none.
    """
    designs = table_or_none(paths.performance)
    if designs is None:
        raise NothingToDraw("There are no simulated designs.")
    return designs


def load_mixture(paths: GenerativePaths) -> dict[str, Any]:
    """Return the content of mixture.json; empty for a generator that leaves none."""
    try:
        content = json.loads((paths.generated / "mixture.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def figures_of(folder: Path) -> dict[str, Any]:
    """Return the figures in the record of a stage; empty where there is no record."""
    try:
        return read_record(folder).figures
    except InputError:
        return {}


def settings_of(folder: Path) -> dict[str, Any]:
    """Return the configuration in the record of a stage; empty where there is no record."""
    try:
        return read_record(folder).configuration
    except InputError:
        return {}
