"""How simulated designs are shown: mode by colour and shape, known ones open, failed ones crossed.

A design that failed is shown where it stood at the last pressure that converged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from pagd.figures.generative.labels import label_points
from pagd.figures.generative.plane import modes_of
from pagd.figures.style import FAINT, INK, mode_look, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "draw_simulated",
    "figure_of_simulated",
    "legend_of_simulated",
    "name_known",
    "with_numbers",
]

_KNOWN: Final = ("table2", "published")
_MOST_NAMES: Final = 30
# Areas of the points, points²; of more than a few designs they are smaller.
_SIZE, _SIZE_KNOWN, _FEW = 36.0, 58.0, 150


def with_numbers(frame: pd.DataFrame, x: str, y: str) -> pd.DataFrame:
    """Return the rows in which both columns are finite numbers."""
    numbers = {name: pd.to_numeric(frame[name], errors="coerce").astype(float) for name in (x, y)}
    finite = np.logical_and.reduce([np.isfinite(values) for values in numbers.values()])
    return frame.assign(**numbers).loc[finite]


def draw_simulated(axes: Axes, frame: pd.DataFrame, x: str, y: str) -> None:
    """Draw the rows as points; see the module for what the shapes mean."""
    size = _SIZE if len(frame) <= _FEW else _SIZE / 2
    for mode in modes_of(frame):
        rows = frame[frame["mode"] == mode]
        known, failed = rows["origin"].isin(_KNOWN), rows["status"] != "ok"
        _points(axes, rows[~known & ~failed], x, y, mode, size)
        _points(axes, rows[known & ~failed], x, y, mode, _SIZE_KNOWN, known=True)
        crossed = rows[failed]
        axes.scatter(
            crossed[x], crossed[y], s=size, c=mode_look(mode).colour, marker="x", zorder=2.5
        )


def name_known(axes: Axes, frame: pd.DataFrame, x: str, y: str) -> None:
    """Write the names of the published actuators and of Table 2 beside their points."""
    found = with_numbers(frame, x, y)
    known = found[found["origin"].isin(_KNOWN)].head(_MOST_NAMES)
    points = found[[x, y]].to_numpy(dtype=np.float64)
    names = [_name(row) for _, row in known.iterrows()]
    label_points(axes, known[[x, y]].to_numpy(dtype=np.float64), names, points)


def legend_of_simulated(figure: Figure, frame: pd.DataFrame) -> None:
    """Put one legend under all panels: modes with their counts, and what open and crossed mean."""
    counts = frame["mode"].value_counts()
    entries = [_entry(mode, f"{mode} ({counts[mode]:,})") for mode in modes_of(frame)]
    if frame["origin"].isin(_KNOWN).any():
        entries.append(_handle("o", "Table 2 or published", filled=False))
    if (frame["status"] != "ok").any():
        entries.append(_handle("x", "failed: as far as it came", filled=True))
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))


def _points(
    axes: Axes, rows: pd.DataFrame, x: str, y: str, mode: str, size: float, *, known: bool = False
) -> None:
    look = mode_look(mode)
    axes.scatter(
        rows[x],
        rows[y],
        s=size,
        c="white" if known else look.colour,
        marker=look.marker,
        edgecolors=look.colour if known else "white",
        linewidths=1.7 if known else 0.5,
        zorder=4 if known else 3,
    )


def _name(row: pd.Series[str]) -> str:
    return f"Table 2: {row['name']}" if row["origin"] == "table2" else str(row["name"])


def _entry(mode: str, label: str) -> Line2D:
    look = mode_look(mode)
    return Line2D([], [], color=look.colour, marker=look.marker, linestyle="", label=label)


def _handle(marker: str, label: str, *, filled: bool) -> Line2D:
    face = FAINT if filled else "white"
    return Line2D(
        [],
        [],
        color=INK,
        marker=marker,
        markerfacecolor=face,
        markeredgewidth=1.5,
        linestyle="",
        label=label,
    )


def figure_of_simulated(
    found: pd.DataFrame, columns: tuple[str, str], labels: tuple[str, str], title: str
) -> Figure:
    """Return the picture of one column over another: a point a design, by mode, known ones named.

    Parameters
    ----------
    found
        Simulated designs that have numbers in both ``columns``, across and upwards.
    columns, labels
        What is drawn, and the labels of the axes.
    title
        Title of the picture.
    """
    figure = new_figure(8.6, 6.4)
    axes = figure.add_subplot()
    for line in (axes.axhline, axes.axvline):
        line(0.0, color=FAINT, linewidth=0.8, zorder=1)
    draw_simulated(axes, found, *columns)
    axes.margins(0.08)
    axes.set(xlabel=labels[0], ylabel=labels[1])
    axes.set_title(title)
    legend_of_simulated(figure, found)
    name_known(axes, found, *columns)
    return figure
