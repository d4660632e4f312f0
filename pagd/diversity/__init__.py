"""Novelty and diversity of generated designs, as functions of arrays of points (n, d)."""

from pagd.diversity.compare import Candidate, Settings, compare, places_of_mode
from pagd.diversity.comparison import TRAINING, Comparison
from pagd.diversity.coverage import Fidelity, fidelity
from pagd.diversity.hull import HullComparison, hull_comparison, hull_corners, hull_size
from pagd.diversity.kernel import median_distance, rbf
from pagd.diversity.metrics import METRICS, SPACES, Metric
from pagd.diversity.mmd import mmd_squared
from pagd.diversity.novelty import (
    leave_one_out_distances,
    nearest_distances,
    novelty,
    share_in_columns,
    unit_square,
)
from pagd.diversity.seeds import PlaneNovelty, plane_novelty_over_seeds
from pagd.diversity.spread import dpp_score, mean_pairwise_distance, unevenness

__all__ = [
    "METRICS",
    "SPACES",
    "TRAINING",
    "Candidate",
    "Comparison",
    "Fidelity",
    "HullComparison",
    "Metric",
    "PlaneNovelty",
    "Settings",
    "compare",
    "dpp_score",
    "fidelity",
    "hull_comparison",
    "hull_corners",
    "hull_size",
    "leave_one_out_distances",
    "mean_pairwise_distance",
    "median_distance",
    "mmd_squared",
    "nearest_distances",
    "novelty",
    "places_of_mode",
    "plane_novelty_over_seeds",
    "rbf",
    "share_in_columns",
    "unevenness",
    "unit_square",
]
