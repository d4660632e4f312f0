"""Picture of the embedding by category: Fig. 4a of the paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from pagd.figures.generative.labels import legend_below
from pagd.figures.generative.plane import frame_axes, scatter_modes
from pagd.figures.generative.projection import load_plane
from pagd.figures.generative.results import GenerativePaths, settings_of
from pagd.figures.style import new_figure, origin_colour, origin_name, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["SHOWN", "draw_embedding", "embedding_figure"]

#: Points of the left panel, as many as the paper plots.
SHOWN = 1000
# Rows of these origins are somebody's actuators, and are marked.
_KNOWN = ("published", "table2")


def draw_embedding(paths: GenerativePaths, out: Path) -> None:
    """Draw the training designs in the plane to a PNG file.

    Raises
    ------
    NothingToDraw
        If there is no data set, or it has no plane.
    """
    plane = load_plane(paths)
    seed = settings_of(paths.embedding).get("embedding", {}).get("seed", 1)
    save(embedding_figure(plane.training, plane.method, seed), out)


def embedding_figure(training: pd.DataFrame, method: str | None = None, seed: int = 1) -> Figure:
    """Return the picture: some designs by category, and all of them by origin.

    Parameters
    ----------
    training
        Training designs with ``z1`` and ``z2``.
    method
        Method of the embedding, which names the coordinates.
    seed
        Of the choice of the points of the left panel.
    """
    figure = new_figure(11.0, 5.4)
    left, right = figure.subplots(1, 2)
    some = _some(training, seed)
    scatter_modes(left, some, "z1", "z2", size=11, alpha=0.8)
    left.set_title(f"{len(some):,} training designs, by category")
    _scatter_origins(right, training)
    right.set_title(f"all {len(training):,}, by origin")
    for axes in (left, right):
        axes.update_datalim(training[["z1", "z2"]].to_numpy())  # one scale for both
        axes.autoscale_view()
        frame_axes(axes, method)
        legend_below(axes, 3)
    return figure


def _some(training: pd.DataFrame, seed: int) -> pd.DataFrame:
    if len(training) <= SHOWN:
        return training
    chosen = np.random.default_rng(seed).choice(len(training), SHOWN, replace=False)
    return training.iloc[np.sort(chosen)]


def _scatter_origins(axes: Axes, training: pd.DataFrame) -> None:
    """Draw the most frequent origin first, so that the rare ones lie on top."""
    for origin, count in training["origin"].value_counts().items():
        rows = training[training["origin"] == origin]
        known = origin in _KNOWN
        axes.scatter(
            rows["z1"],
            rows["z2"],
            s=90 if known else 5,
            c=origin_colour(str(origin)),
            marker="*" if known else ".",
            edgecolors="white" if known else "none",
            linewidths=0.6,
            zorder=5 if known else 2,
            label=f"{origin_name(str(origin))} ({count:,})",
        )
