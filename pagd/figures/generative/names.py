"""Spaces and measures of the comparison of generators, as pictures and page name them."""

from __future__ import annotations

from typing import Final

__all__ = ["SPACES", "metric_name", "space_name"]

#: Spaces by the names they have in comparison.parquet, from the fullest to the smallest.
SPACES: Final = {"encoded": "all parameters", "plane": "plane", "plane_sample": "small plane"}
_METRICS: Final = {
    "dpp": "DPP score",
    "mmd": "MMD², from training",
    "mode_part": "share of novelty by mode",
    "hull_size": "hull",
    "hull_ratio": "hull / training hull",
}


def space_name(space: str) -> str:
    """Return the name of a space.

    >>> space_name("plane_sample")
    'small plane'
    """
    return SPACES.get(space, space.replace("_", " "))


def metric_name(metric: str) -> str:
    """Return the name of a measure.

    >>> metric_name("dpp")
    'DPP score'
    """
    return _METRICS.get(metric, metric.replace("_", " "))
