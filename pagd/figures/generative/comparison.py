"""Picture of all generators side by side: one dot plot a measure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from pagd.diversity.comparison import TRAINING
from pagd.figures.generative.names import SPACES, metric_name, space_name
from pagd.figures.generative.results import GenerativePaths, NothingToDraw, table_or_none
from pagd.figures.style import FAINT, INK, new_figure, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["comparison_figure", "draw_comparison"]

_COLUMNS: Final = 4
_ARROWS: Final = {"higher": "  more is better →", "lower": "  ← less is better"}
_OWN: Final = "#e69f00"
# Of the plane only what the paper measures there, and what is told by few numbers.
_SHOWN: Final = {
    "plane": ("novelty", "hull_ratio", "coverage", "density"),
    "plane_sample": ("novelty",),
}
# Their ratio to the training designs says the same.
_HIDDEN: Final = ("hull_size",)


def draw_comparison(paths: GenerativePaths, out: Path) -> None:
    """Draw the measures of all generators to a PNG file.

    Raises
    ------
    NothingToDraw
        If the generators were not compared.
    """
    rows = table_or_none(paths.diversity / "comparison.parquet")
    if rows is None:
        raise NothingToDraw("The generators were not compared.")
    save(comparison_figure(rows), out)


def comparison_figure(rows: pd.DataFrame) -> Figure:
    """Return the picture: a panel a measure and space, a line a generator.

    Parameters
    ----------
    rows
        ``generator``, ``space``, ``mode``, ``metric``, ``better`` (higher, lower, neither),
        ``value`` and its interval ``low`` to ``high``, null where there is none; what the stage
        diversity leaves in comparison.parquet. The first generator is the one configured; the
        training designs are drawn as a line for comparison.

    Raises
    ------
    NothingToDraw
        If there is no number among them.
    """
    found = _shown(rows)
    generators = [name for name in dict.fromkeys(found["generator"]) if name != TRAINING]
    if not generators:
        raise NothingToDraw("No generator has any measure.")
    panels = list(found.groupby(["space", "metric"], sort=False))
    columns = min(_COLUMNS, len(panels))
    lines = -(-len(panels) // columns)
    figure = new_figure(2.9 * columns + 0.8, (0.22 * len(generators) + 1.0) * lines + 0.3)
    axes = figure.subplots(lines, columns, sharey=True, squeeze=False).ravel()
    for panel, ((space, metric), part) in zip(axes, panels, strict=False):
        _draw_measure(panel, part, generators)
        _head(panel, str(metric), str(space), str(part["better"].iloc[0]))
    for panel in axes[len(panels) :]:
        panel.set_axis_off()
    _explain(figure, generators[0], TRAINING in set(found["generator"]))
    return figure


def _shown(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of all modes together that get a panel and have a value."""
    numbers = rows.assign(
        **{
            name: pd.to_numeric(rows[name], errors="coerce").astype(float)
            for name in ("value", "low", "high")
        }
    )
    wanted = [
        metric not in _HIDDEN and metric in _SHOWN.get(space, (metric,))
        for space, metric in zip(rows["space"], rows["metric"], strict=True)
    ]
    has_value = np.isfinite(numbers["value"].to_numpy()) & (rows["mode"] == "all").to_numpy()
    found: pd.DataFrame = numbers.loc[has_value & wanted]
    return found.sort_values("space", key=_order, kind="stable")


def _order(spaces: pd.Series[str]) -> pd.Series[int]:
    return spaces.map({space: i for i, space in enumerate(reversed(SPACES))}).fillna(len(SPACES))


def _draw_measure(axes: Axes, part: pd.DataFrame, generators: Sequence[str]) -> None:
    yardstick = part[part["generator"] == TRAINING]
    for value in yardstick["value"]:
        axes.axvline(value, color=FAINT, linestyle="--", linewidth=1.2, zorder=1)
    own = part[part["generator"] != TRAINING]
    heights = [generators.index(name) for name in own["generator"]]
    values = own["value"].to_numpy()
    colours = [INK if height else _OWN for height in heights]
    low, high = (own[name].fillna(own["value"]).to_numpy() for name in ("low", "high"))
    axes.hlines(heights, low, high, color=colours, linewidth=1.6, alpha=0.6)
    axes.scatter(values, heights, s=34, c=colours, zorder=3)
    axes.set_yticks(range(len(generators)), generators)
    axes.set_ylim(len(generators) - 0.5, -0.5)
    axes.margins(x=0.12)
    axes.xaxis.set_major_locator(MaxNLocator(4))


def _explain(figure: Figure, own: str, with_training: bool) -> None:
    """Say under the panels what orange and dashed mean."""
    entries = [Line2D([], [], color=_OWN, marker="o", linestyle="", label=f"{own}: the one used")]
    if with_training:
        entries.append(Line2D([], [], color=FAINT, linestyle="--", label="training designs"))
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))


def _head(axes: Axes, metric: str, space: str, better: str) -> None:
    """Write what is measured above the panel, and below that where, and which way is better."""
    axes.set_title(f"{metric_name(metric)}\n", fontsize=9)
    axes.annotate(
        f"{space_name(space)}{_ARROWS.get(better, '')}",
        (0.0, 1.0),
        xytext=(0, 4),
        xycoords="axes fraction",
        textcoords="offset points",
        color=FAINT,
        fontsize=8,
    )
