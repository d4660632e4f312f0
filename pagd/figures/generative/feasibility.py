"""Picture of what became of the simulated designs: status by mode and origin, mode as measured."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.colors import LinearSegmentedColormap
from numpy.typing import NDArray

from pagd.figures.generative.plane import modes_of
from pagd.figures.generative.results import GenerativePaths, load_performance
from pagd.figures.style import (
    ELASTOMER,
    FAINT,
    INK,
    MODE_LOOKS,
    STATUS_COLOURS,
    new_figure,
    origin_name,
    save,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["counts_of", "draw_feasibility", "feasibility_figure"]

_NOT_MEASURED = "not measured"
_MAP = LinearSegmentedColormap.from_list("counts", ["#ffffff", ELASTOMER])


def draw_feasibility(paths: GenerativePaths, out: Path) -> None:
    """Draw feasibility to a PNG file.

    Raises
    ------
    NothingToDraw
        If nothing was simulated.
    """
    save(feasibility_figure(load_performance(paths)), out)


def feasibility_figure(performance: pd.DataFrame) -> Figure:
    """Return the picture: status by the mode drawn and by origin, mode drawn against measured.

    Parameters
    ----------
    performance
        Simulated designs with the columns :data:`pagd.tables.PERFORMANCE`.
    """
    figure = new_figure(12.0, 4.4)
    by_mode, by_origin, modes = figure.subplots(1, 3, width_ratios=[1.15, 1.15, 1.0])
    statuses = _statuses(performance)
    drawn = counts_of(performance, "mode", "status").reindex(modes_of(performance))
    _stack(by_mode, drawn.reindex(columns=statuses, fill_value=0))
    by_mode.set_title("status, by mode drawn")
    origins = counts_of(performance, "origin", "status")
    origins = origins.rename(index=origin_name)
    _stack(by_origin, origins.reindex(columns=statuses, fill_value=0))
    by_origin.set_title("status, by origin")
    handles, labels = by_mode.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower left", ncols=min(len(labels), 6))
    _draw_matrix(modes, _measured(performance))
    return figure


def counts_of(frame: pd.DataFrame, rows: str, columns: str) -> pd.DataFrame:
    """Return how many designs there are of each pair of values of two columns."""
    return frame.groupby([rows, columns]).size().unstack(fill_value=0)


def _statuses(performance: pd.DataFrame) -> list[str]:
    there = set(performance["status"])
    return [s for s in STATUS_COLOURS if s in there] + sorted(there - set(STATUS_COLOURS))


def _stack(axes: Axes, counts: pd.DataFrame) -> None:
    """Draw a bar a row: the share of each status, with the counts written on it."""
    totals = counts.sum(axis="columns").to_numpy()
    ends = np.zeros(len(counts))
    for status in counts.columns:
        shares = counts[status].to_numpy() / totals
        colour = STATUS_COLOURS.get(str(status), FAINT)
        label = str(status).replace("_", " ")
        bars = axes.barh(_names(counts, totals), shares, left=ends, color=colour, label=label)
        texts = [
            str(count) if share > 0.03 else ""
            for count, share in zip(counts[status], shares, strict=True)
        ]
        axes.bar_label(bars, texts, label_type="center", color=_ink_on(colour), fontsize=8)
        ends += shares
    axes.set(xlim=(0.0, 1.0), xlabel="share of the designs")
    axes.xaxis.set_major_formatter("{x:.0%}")
    axes.invert_yaxis()
    axes.grid(visible=False)


def _names(counts: pd.DataFrame, totals: NDArray[np.int64]) -> list[str]:
    return [f"{name}\n({total:,})" for name, total in zip(counts.index, totals, strict=True)]


def _ink_on(colour: str) -> str:
    """Return white on dark colours and ink on light ones."""
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return INK if 0.299 * red + 0.587 * green + 0.114 * blue > 130 else "white"


def _measured(performance: pd.DataFrame) -> pd.DataFrame:
    """Return the counts of mode drawn (rows) by mode measured (columns)."""
    named = performance.assign(measured_mode=performance["measured_mode"].fillna(_NOT_MEASURED))
    counts = counts_of(named, "mode", "measured_mode")
    usual = [mode for mode in MODE_LOOKS if mode in counts.index or mode in counts.columns]
    others = sorted((set(counts.columns) | set(counts.index)) - set(usual))
    rows = [mode for mode in (*usual, *others) if mode in counts.index]
    return counts.reindex(index=rows, columns=[*usual, *others], fill_value=0)


def _draw_matrix(axes: Axes, counts: pd.DataFrame) -> None:
    values = counts.to_numpy()
    axes.imshow(values, cmap=_MAP, vmin=0, aspect="auto")
    for row, column in np.ndindex(values.shape):
        agrees = counts.index[row] == counts.columns[column]
        axes.text(
            column,
            row,
            str(values[row, column]),
            ha="center",
            va="center",
            fontsize=11,
            fontweight="bold" if agrees else "normal",
            color=INK if values[row, column] else FAINT,
        )
    axes.set_xticks(range(len(counts.columns)), [str(c).replace(" ", "\n") for c in counts.columns])
    axes.set_yticks(range(len(counts.index)), list(counts.index))
    axes.set(xlabel="mode measured", ylabel="mode drawn")
    axes.set_title("mode drawn, mode measured")
    axes.grid(visible=False)
    axes.tick_params(length=0)
