"""What is measured of generated designs, and where: names, equations and sources."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final, Literal, NamedTuple

__all__ = ["METRICS", "SPACES", "Metric"]


class Metric(NamedTuple):
    """One metric of a set of designs.

    symbol: as in a figure.
    description: for a caption, with the equation in words.
    source: where it comes from.
    better: where more novelty or diversity, or more likeness to the training designs, lies.
    interval: what its low and high are.
    """

    symbol: str
    description: str
    source: str
    better: Literal["higher", "lower", "neither"]
    interval: str


_OF_MEAN = "95 % confidence interval of the mean, ± 1.96 standard errors"
_OF_SETS = "the value is the median over random sets of equal counts; 95 % of the sets"
_NONE = "none"

METRICS: Final = MappingProxyType(
    {
        "novelty": Metric(
            "d_new",
            "mean distance to the nearest training design (of training designs: to the nearest"
            " other)",
            "the paper",
            "higher",
            _OF_MEAN,
        ),
        "mode_part": Metric(
            "s_mode",
            "share of the squared distance to the nearest training design that is due to what"
            " tells the mode: alpha, N1, N2 and the one-hot mode",
            "ours",
            "neither",
            _NONE,
        ),
        "hull_size": Metric(
            "A",
            "area of the convex hull of a set (in the encoded space: volume in the first principal"
            " components of the training designs)",
            "the paper, Fig. 5; Regenwetter et al. 2023",
            "higher",
            _OF_SETS,
        ),
        "hull_ratio": Metric(
            "A / A_train",
            "size of the convex hull of a set by that of as many training designs",
            "the paper, Fig. 5; Regenwetter et al. 2023",
            "higher",
            _OF_SETS,
        ),
        "mean_pairwise_distance": Metric(
            "d_mean",
            "mean distance between two designs of a set",
            "Regenwetter et al. 2023",
            "higher",
            _OF_SETS,
        ),
        "dpp": Metric(
            "log det K / n",
            "logarithm of the determinant of the RBF kernel matrix of a set, per design; length"
            " scale: median distance of the training designs; 1e-6 is added to the diagonal",
            "Kulesza and Taskar 2012; Chen and Ahmed 2021; Regenwetter et al. 2023",
            "higher",
            _OF_SETS,
        ),
        "unevenness": Metric(
            "λ",
            "coefficient of variation of the distances to the nearest other design of a set; 0 for"
            " a lattice",
            "Gunzburger and Burkardt 2004",
            "lower",
            _OF_SETS,
        ),
        "density": Metric(
            "density",
            "mean number of training designs whose ball, reaching to the k-th nearest other"
            " training design, holds a design, by k. Resampled designs may be among the very"
            " training designs that they are compared with, which raises theirs",
            "Naeem et al. 2020",
            "neither",
            _NONE,
        ),
        "coverage": Metric(
            "coverage",
            "share of training designs whose ball, reaching to the k-th nearest other training"
            " design, holds some design. Resampled designs may be among the very training designs"
            " that they are compared with, which raises theirs",
            "Naeem et al. 2020",
            "higher",
            _NONE,
        ),
        "precision": Metric(
            "precision",
            "share of designs within the ball of some training design",
            "Kynkäänniemi et al. 2019",
            "higher",
            _NONE,
        ),
        "recall": Metric(
            "recall",
            "share of training designs within the ball of some design",
            "Kynkäänniemi et al. 2019",
            "higher",
            _NONE,
        ),
        "mmd": Metric(
            "MMD²",
            "squared maximum mean discrepancy from the training designs, unbiased, RBF kernel;"
            " length scale: median distance of the training designs",
            "Gretton et al. 2012",
            "lower",
            _NONE,
        ),
    }
)
"""Every metric by its name in the results."""

SPACES: Final = MappingProxyType(
    {
        "plane_sample": "plane of a few training designs, made anew for every seed, scaled to the"
        " unit square; the value is the mean over seeds, ± one standard deviation",
        "plane": "plane of all training designs, scaled to the unit square",
        "encoded": "standardised numbers and one-hot categories of all training designs",
    }
)
"""The spaces that distances are measured in."""
