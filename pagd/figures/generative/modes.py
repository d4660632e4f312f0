"""A small vector picture of the three modes in the plane, for the documentation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pandas as pd
from matplotlib import rc_context

from pagd.figures.generative.labels import legend_below
from pagd.figures.generative.mixture import draw_plane, name_gaussians
from pagd.figures.generative.plane import Gaussian, frame_axes
from pagd.figures.generative.projection import load_gaussians, load_generated_plane, load_plane
from pagd.figures.generative.results import GenerativePaths
from pagd.figures.style import new_figure
from pagd.files import replaced_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_modes", "modes_figure"]

# Points of each kind: as many as a file for git and a small picture bear.
_POINTS: Final = 300
# With a salt of its own matplotlib names equal things equally; by default it draws lots.
_SALT: Final[dict[Any, Any]] = {"svg.hashsalt": "pagd", "svg.fonttype": "none"}


def draw_modes(paths: GenerativePaths, out: Path) -> None:
    """Write the picture as SVG; equal results give equal bytes.

    Raises
    ------
    NothingToDraw
        If nothing was generated, or not in a plane.
    """
    plane = load_plane(paths)
    generated = load_generated_plane(paths, plane)
    figure = modes_figure(plane.training, generated, load_gaussians(paths, plane), plane.method)
    with rc_context(_SALT), replaced_file(out) as temporary:
        figure.savefig(temporary, format="svg", metadata={"Date": None, "Creator": None})


def modes_figure(
    training: pd.DataFrame,
    generated: pd.DataFrame,
    gaussians: list[Gaussian],
    method: str | None = None,
) -> Figure:
    """Return the picture: some training designs, some generated ones by mode, the ellipses."""
    figure = new_figure(6.4, 5.0)
    axes = figure.add_subplot()
    some, others = _every(training), _every(generated)
    draw_plane(axes, some, others, gaussians, counted=False)
    axes.set_title(
        "two modes in the data set, three among the generated designs\n"
        f"(drawn: {len(some):,} of {len(training):,} training designs,"
        f" {len(others):,} of {len(generated):,} generated)"
    )
    frame_axes(axes, method)
    legend_below(axes, 4)
    name_gaussians(axes, gaussians)
    return figure


def _every(frame: pd.DataFrame) -> pd.DataFrame:
    """Return rows evenly through the table, so that no draw is needed."""
    rows = np.unique(np.linspace(0, len(frame) - 1, min(_POINTS, len(frame))).astype(int))
    return frame.iloc[rows]
