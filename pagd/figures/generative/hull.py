"""Picture of the convex hulls of training and generated designs: Fig. 5 of the paper."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from pagd.diversity.hull import hull_corners
from pagd.figures.generative.labels import legend_below
from pagd.figures.generative.plane import draw_background, frame_axes, in_plane
from pagd.figures.generative.results import (
    GenerativePaths,
    NothingToDraw,
    load_generated,
    load_training,
    settings_of,
    table_or_none,
)
from pagd.figures.style import new_figure, number, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_hull", "hull_figure"]

# Colour and marker of training and generated designs: two of Okabe and Ito's.
_LOOKS: Final = {"training": ("#0072b2", "o"), "generated": ("#d55e00", "^")}


def draw_hull(paths: GenerativePaths, out: Path) -> None:
    """Draw the hulls of one draw, and the areas of all, to a PNG file.

    Raises
    ------
    NothingToDraw
        If nothing was generated, not in a plane, or the hulls were not compared.
    """
    draws = table_or_none(paths.diversity / "hull.parquet")
    if draws is None:
        raise NothingToDraw("The hulls were not compared.")
    training, generated = in_plane(load_training(paths)), in_plane(load_generated(paths))
    settings = settings_of(paths.diversity).get("diversity", {})
    count, seed = settings.get("hull_designs", 50), settings.get("seed", 1)
    method = settings_of(paths.embedding).get("embedding", {}).get("method")
    places = [frame[["z1", "z2"]].to_numpy() for frame in (training, generated)]
    save(hull_figure(places[0], places[1], draws, count, seed, method), out)


def hull_figure(
    training: NDArray[np.float64],
    generated: NDArray[np.float64],
    draws: pd.DataFrame,
    count: int = 50,
    seed: int = 1,
    method: str | None = None,
) -> Figure:
    """Return the picture: two hulls of some random points each, and the areas of many draws.

    Parameters
    ----------
    training, generated
        Points (n, 2) and (m, 2) in the plane.
    draws
        A row a draw: the areas ``training`` and ``generated``.
    count
        Points of each hull.
    seed
        Of the choice of the points that are shown.
    method
        Method of the embedding, which names the coordinates.
    """
    figure = new_figure(11.0, 5.6)
    plane, areas = figure.subplots(1, 2, width_ratios=[1.25, 1.0])
    rng = np.random.default_rng(seed)
    draw_background(plane, training, f"all training ({len(training):,})")
    for name, points in (("training", training), ("generated", generated)):
        _draw_hull(plane, name, _some(points, count, rng))
    plane.set_title(f"convex hulls of {count} random designs each")
    frame_axes(plane, method)
    legend_below(plane, 3)
    _draw_areas(areas, draws)
    return figure


def _some(points: NDArray[np.float64], count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    chosen = rng.choice(len(points), min(count, len(points)), replace=False)
    return points[np.sort(chosen)]


def _draw_hull(axes: Axes, name: str, points: NDArray[np.float64]) -> None:
    colour, marker = _LOOKS[name]
    axes.scatter(
        points[:, 0],
        points[:, 1],
        s=26,
        c=colour,
        marker=marker,
        edgecolors="white",
        linewidths=0.5,
        label=f"{name} ({len(points):,})",
        zorder=3,
    )
    corners = points[hull_corners(points)]
    axes.fill(*corners.T, facecolor=colour, alpha=0.12, zorder=1)
    outline = np.vstack([corners, corners[:1]])
    style = "-" if name == "training" else (0, (6, 2))
    axes.plot(*outline.T, color=colour, linewidth=1.6, linestyle=style, zorder=2)


def _draw_areas(axes: Axes, draws: pd.DataFrame) -> None:
    areas = draws[list(_LOOKS)].to_numpy(dtype=np.float64)
    limits = (0.98 * float(areas.min()), 1.02 * float(areas.max()) + 1e-12)
    for (name, (colour, _)), values in zip(_LOOKS.items(), areas.T, strict=True):
        median = float(np.median(values))
        axes.hist(
            values,
            bins=25,
            range=limits,
            color=colour,
            alpha=0.45,
            label=f"{name}, median {_short(median)}",
        )
        axes.axvline(median, color=colour, linewidth=1.6, linestyle="--")
    axes.set(xlabel="area of the hull", ylabel="draws")
    axes.set_title(f"areas of {len(draws):,} draws\n{_ratio(areas)}")
    axes.xaxis.set_major_locator(MaxNLocator(5))
    legend_below(axes, 2)


def _short(value: float) -> str:
    return number(value, 0) if abs(value) >= 10 else number(value, 3)


def _ratio(areas: NDArray[np.float64]) -> str:
    """Return the sentence on the ratio of the areas, draw by draw."""
    flat = areas[:, 0] > 0.0
    if not flat.any():
        return "the training hull has no area"
    ratios = areas[flat, 1] / areas[flat, 0]
    low, middle, high = (number(float(q), 2) for q in np.quantile(ratios, (0.025, 0.5, 0.975)))
    return f"generated / training: {middle} (95 %: {low} to {high})"
