"""Picture of the convex hulls of training and generated designs: Fig. 5 of the paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from pagd.diversity.novelty import unit_square
from pagd.figures.generative.labels import legend_below
from pagd.figures.generative.plane import draw_background, frame_axes
from pagd.figures.generative.projection import load_plane
from pagd.figures.generative.results import GenerativePaths, NothingToDraw, table_or_none
from pagd.figures.style import INK, new_figure, number, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_hull", "hull_figure"]

# Colour and marker of training and generated designs; no colours of modes.
_LOOKS: Final = {"training": (INK, "o"), "generated": ("#e69f00", "s")}


def draw_hull(paths: GenerativePaths, out: Path) -> None:
    """Draw the hulls of one draw, and the areas of all, to a PNG file.

    Raises
    ------
    NothingToDraw
        If the hulls were not compared, as in a space that is no plane.
    """
    areas = table_or_none(paths.diversity / "hull.parquet")
    points = table_or_none(paths.diversity / "hull_points.parquet")
    if areas is None or points is None:
        raise NothingToDraw("The hulls were not compared in a plane.")
    plane = load_plane(paths)
    training = plane.training[["z1", "z2"]].to_numpy()
    save(hull_figure(unit_square(training, training), points, areas, plane.method), out)


def hull_figure(
    training: NDArray[np.float64],
    points: pd.DataFrame,
    areas: pd.DataFrame,
    method: str | None = None,
) -> Figure:
    """Return the picture: two hulls of some random points each, and the areas of many draws.

    Parameters
    ----------
    training
        All training designs (n, 2) in the plane.
    points
        The designs of one draw: ``set`` (training or generated), ``z1``, ``z2``, and ``corner``,
        their place around the hull, null within it.
    areas
        A row a draw: the areas ``training`` and ``generated`` of the hulls.
    method
        Method of the embedding, which names the coordinates.
    """
    figure = new_figure(11.0, 5.4)
    plane, histogram = figure.subplots(1, 2, width_ratios=[1.25, 1.0])
    draw_background(plane, training, f"all training ({len(training):,})")
    for name in _LOOKS:
        _draw_hull(plane, name, points[points["set"] == name])
    counts = points["set"].value_counts()
    plane.set_title(f"convex hulls of {counts.max():,} random designs each")
    frame_axes(plane, method)
    legend_below(plane, 3)
    _draw_areas(histogram, areas)
    return figure


def _draw_hull(axes: Axes, name: str, points: pd.DataFrame) -> None:
    colour, marker = _LOOKS[name]
    axes.scatter(
        points["z1"],
        points["z2"],
        s=26,
        c=colour,
        marker=marker,
        edgecolors="white",
        linewidths=0.5,
        label=f"{name} ({len(points):,})",
        zorder=3,
    )
    around = points[points["corner"].notna()].sort_values("corner")
    corners = around[["z1", "z2"]].to_numpy(dtype=np.float64)
    axes.fill(*corners.T, facecolor=colour, alpha=0.12, zorder=1)
    outline = np.vstack([corners, corners[:1]])
    style = "-" if name == "training" else (0, (6, 2))
    axes.plot(*outline.T, color=colour, linewidth=1.6, linestyle=style, zorder=2)


def _draw_areas(axes: Axes, draws: pd.DataFrame) -> None:
    areas = draws[list(_LOOKS)].to_numpy(dtype=np.float64)
    limits = (0.98 * float(areas.min()), 1.02 * float(areas.max()) + 1e-12)
    for (name, (colour, _)), values in zip(_LOOKS.items(), areas.T, strict=True):
        median = float(np.median(values))
        label = f"{name}, median {_short(median)}"
        axes.hist(values, bins=25, range=limits, color=colour, alpha=0.45, label=label)
        axes.axvline(median, color=colour, linewidth=1.6, linestyle="--")
    axes.set(xlabel="area of the hull, unit square: 1", ylabel="draws")
    axes.set_title(f"areas of {len(draws):,} draws\n{_ratio(areas)}")
    axes.xaxis.set_major_locator(MaxNLocator(5))
    legend_below(axes, 2)


def _short(value: float) -> str:
    return number(value, 0) if abs(value) >= 10 else number(value, 2)


def _ratio(areas: NDArray[np.float64]) -> str:
    """Return the ratio of the areas, draw by draw: median and the middle 95 %."""
    some = areas[areas[:, 0] > 0.0]
    if len(some) == 0:
        return "the training hulls have no area"
    quantiles = np.quantile(some[:, 1] / some[:, 0], (0.025, 0.5, 0.975))
    low, middle, high = (number(float(value), 2) for value in quantiles)
    return f"generated / training: {middle} (95 %: {low} to {high})"
