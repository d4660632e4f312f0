"""Picture of all generators side by side: one dot plot a measure."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import pandas as pd

from pagd.figures.generative.results import GenerativePaths, NothingToDraw, table_or_none
from pagd.figures.style import FAINT, INK, new_figure, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["comparison_figure", "draw_comparison"]

_COLUMNS: Final = 4
_ARROWS: Final = {"higher": "more is better →", "lower": "← less is better"}
_OWN: Final = "#d55e00"


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


class _Measure(NamedTuple):
    title: str
    better: str


#: Measures that are known: what they are called, and which way they get better.
_MEASURES: Final = {
    "novelty": _Measure("novelty", ""),
    "hull_ratio": _Measure("hull, generated / training", "higher"),
    "hull": _Measure("hull, generated / training", "higher"),
    "coverage": _Measure("coverage", "higher"),
    "density": _Measure("density", "higher"),
    "mmd": _Measure("maximum mean discrepancy", "lower"),
    "dpp": _Measure("DPP score, log-determinant", "higher"),
    "mean_pairwise": _Measure("mean pairwise distance", "higher"),
    "uniformity": _Measure("uniformity", "higher"),
}


def comparison_figure(rows: pd.DataFrame) -> Figure:
    """Return the picture: a panel a measure and space, a line a generator.

    Parameters
    ----------
    rows
        ``generator``, ``space``, ``metric``, ``value`` and, where there is an interval, ``low``
        and ``high``; nulls are left out. A column ``better`` (higher, lower) overrides what is
        known of a measure.

    Raises
    ------
    NothingToDraw
        If there is no number among them.
    """
    found = rows[pd.to_numeric(rows["value"], errors="coerce").notna()]
    if found.empty:
        raise NothingToDraw("No generator has any measure.")
    generators = list(dict.fromkeys(rows["generator"]))
    panels = list(found.groupby(["metric", "space"], sort=False))
    columns = min(_COLUMNS, len(panels))
    lines = -(-len(panels) // columns)
    figure = new_figure(3.0 * columns + 0.8, (0.27 * len(generators) + 1.15) * lines + 0.3)
    axes = figure.subplots(lines, columns, sharey=True, squeeze=False).ravel()
    for panel, ((metric, space), part) in zip(axes, panels, strict=False):
        _draw_measure(panel, str(metric), str(space), part, generators)
    for panel in axes[len(panels) :]:
        panel.set_axis_off()
    return figure


def _draw_measure(
    axes: Axes, metric: str, space: str, part: pd.DataFrame, generators: list[str]
) -> None:
    measure = _MEASURES.get(metric, _Measure(metric.replace("_", " "), ""))
    heights = [generators.index(name) for name in part["generator"]]
    values = part["value"].to_numpy(dtype=np.float64)
    for bound in ("low", "high"):
        ends = pd.to_numeric(part[bound], errors="coerce") if bound in part else values
        axes.hlines(heights, values, np.where(np.isnan(ends), values, ends), color=FAINT)
    first = [_OWN if height == 0 else INK for height in heights]
    axes.scatter(values, heights, s=34, c=first, zorder=3)
    axes.set_yticks(range(len(generators)), generators)
    axes.set_ylim(len(generators) - 0.5, -0.5)
    axes.margins(x=0.15)
    axes.set_title(f"{measure.title}\n", fontsize=9)
    better = part["better"].iloc[0] if "better" in part else measure.better
    _write_above(axes, f"{space.replace('_', ' ')}{_arrow(better)}")


def _arrow(better: str | None) -> str:
    return f"   {_ARROWS[better]}" if better in _ARROWS else ""


def _write_above(axes: Axes, text: str) -> None:
    axes.annotate(
        text,
        (0.0, 1.0),
        xytext=(0, 4),
        xycoords="axes fraction",
        textcoords="offset points",
        color=FAINT,
        fontsize=8,
    )
