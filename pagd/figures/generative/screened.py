"""Pictures of designs that were analysed by a chamber each: what they can do, and how new it is."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
from matplotlib.lines import Line2D

from pagd.figures.generative.plane import modes_of
from pagd.figures.generative.results import (
    GenerativePaths,
    NothingToDraw,
    load_generated,
    table_or_none,
)
from pagd.figures.style import FAINT, INK, mode_look, new_figure, number, save
from pagd.fronts import OBJECTIVES, known, not_dominated, reached, values_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "draw_screened",
    "draw_screened_beside_full",
    "draw_screened_novelty",
    "screened_beside_full_figure",
    "screened_figure",
    "screened_novelty_figure",
]

_UNITS: Final = {"bending_deg": "degrees", "twist_deg": "degrees", "blocked_force_N": "N"}
_GREY: Final = "#c9d0d7"


def draw_screened(paths: GenerativePaths, out: Path) -> None:
    """Draw what generated and training designs can do to a PNG file.

    Raises
    ------
    NothingToDraw
        If either were not screened.
    """
    save(screened_figure(_screened(paths.screened), _screened(paths.screened_training)), out)


def draw_screened_novelty(paths: GenerativePaths, out: Path) -> None:
    """Draw novelty against performance of the screened generated designs to a PNG file.

    Raises
    ------
    NothingToDraw
        If there are none.
    """
    novelty = load_generated(paths).set_index("design_id")["novelty"]
    screened = _screened(paths.screened)
    screened = screened.assign(novelty=screened["design_id"].map(novelty))
    save(screened_novelty_figure(screened, table_or_none(paths.full)), out)


def draw_screened_beside_full(paths: GenerativePaths, out: Path) -> None:
    """Draw what a chamber tells of designs against their full analyses to a PNG file.

    Raises
    ------
    NothingToDraw
        If no design has both.
    """
    save(screened_beside_full_figure(_screened(paths.screened), table_or_none(paths.full)), out)


def screened_figure(generated: pd.DataFrame, training: pd.DataFrame) -> Figure:
    """Return the maps: each two objectives against each other, with both Pareto fronts.

    Parameters
    ----------
    generated, training
        Screened designs with the columns :data:`pagd.tables.PERFORMANCE`.
    """
    figure = new_figure(13.0, 5.0)
    pairs = list(combinations(OBJECTIVES, 2))
    for axes, pair in zip(figure.subplots(1, len(pairs)), pairs, strict=True):
        old, new = values_of(training, pair), values_of(generated, pair)
        shown = old[known(training, pair)]
        axes.scatter(shown[:, 0], shown[:, 1], s=5, c=_GREY, marker="o", linewidths=0, zorder=1)
        some = known(generated, pair)
        _draw_modes(axes, generated[some], new[some])
        _draw_front(axes, shown, FAINT)
        _draw_front(axes, new[some], INK)
        axes.set(xlabel=_label(pair[0]), ylabel=_label(pair[1]), xlim=(0, None), ylim=(0, None))
        axes.set_title(f"{OBJECTIVES[pair[1]]} and {OBJECTIVES[pair[0]]}")
    handles = [
        *_mode_handles(generated),
        Line2D([], [], color=INK, label="front of the generated designs"),
        Line2D(
            [],
            [],
            color=_GREY,
            marker="o",
            linestyle="",
            markersize=4,
            label=f"training ({len(training):,})",
        ),
        Line2D([], [], color=FAINT, label="front of the training designs"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def screened_novelty_figure(screened: pd.DataFrame, full: pd.DataFrame | None) -> Figure:
    """Return the picture of novelty against each objective, full analyses joined to their cells.

    Parameters
    ----------
    screened
        Screened designs with a ``novelty``.
    full
        Designs that were simulated as a whole, if any were.
    """
    figure = new_figure(13.0, 5.0)
    for axes, name in zip(figure.subplots(1, len(OBJECTIVES)), OBJECTIVES, strict=True):
        # Beside its full analysis a doubted result is of interest too.
        both = _both(screened, full, name).assign(doubt=None)
        some = screened[known(screened, [name])]
        values = np.column_stack([some["novelty"], values_of(some, [name])])
        _draw_modes(axes, some, values)
        if len(both):
            whole = values_of(both.assign(**{name: both[f"{name}_full"]}), [name])[:, 0]
            cells = values_of(both, [name])[:, 0]
            novelty = both["novelty"].to_numpy(dtype=np.float64)
            axes.vlines(novelty, cells, whole, color=INK, linewidth=0.9, zorder=4)
            axes.scatter(novelty, whole, s=34, facecolor="white", edgecolor=INK, zorder=5)
        axes.set(xlabel="novelty: distance to the nearest training design", ylim=(0, None))
        axes.set(ylabel=_label(name), xlim=(0, None))
        axes.set_title(f"{OBJECTIVES[name]}{_correlation(values)}")
    handles = _mode_handles(screened)
    if full is not None:
        handles.append(
            Line2D(
                [],
                [],
                color=INK,
                marker="o",
                markerfacecolor="white",
                label="the same design, full analysis",
            )
        )
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return figure


def screened_beside_full_figure(screened: pd.DataFrame, full: pd.DataFrame | None) -> Figure:
    """Return the picture of each objective by a chamber against that of the full analysis.

    Raises
    ------
    NothingToDraw
        If no design has both.
    """
    pairs = {name: _both(screened, full, name) for name in OBJECTIVES}
    if all(both.empty for both in pairs.values()):
        raise NothingToDraw("No screened design was simulated as a whole.")
    figure = new_figure(13.0, 4.8)
    for axes, (name, both) in zip(figure.subplots(1, len(pairs)), pairs.items(), strict=True):
        values = both[[f"{name}_full", name]].to_numpy(dtype=np.float64)
        ends = np.array([min(values.min(initial=0.0), 0.0), max(values.max(initial=1e-9), 0.0)])
        ends += 0.05 * (ends[1] - ends[0]) * np.array([-1.0, 1.0])
        axes.plot(ends, ends, color=FAINT, linewidth=0.8, zorder=1)
        _draw_modes(axes, both, values, size=26.0)
        axes.set(xlabel=f"full analysis, {_UNITS[name]}", ylabel=f"cells, {_UNITS[name]}")
        axes.set(xlim=ends, ylim=ends, aspect="equal")
        axes.set_title(f"{OBJECTIVES[name]}{_median_error(values)}")
    shown = pairs[max(pairs, key=lambda name: len(pairs[name]))]
    figure.legend(
        handles=_mode_handles(shown), loc="outside lower center", ncols=len(modes_of(shown))
    )
    return figure


def _screened(folder: Path) -> pd.DataFrame:
    """The screened designs that came to an equilibrium at their end."""
    found = table_or_none(folder / "performance.parquet")
    if found is None:
        raise NothingToDraw("No designs were screened.")
    some = reached(found)
    if some.empty:
        raise NothingToDraw("No screened design came to its end.")
    return some


# Where each objective is known, by column.
_PRESSURES: Final = {"blocked_force_N": "blocked_force_pressure_kPa"}


def _both(screened: pd.DataFrame, full: pd.DataFrame | None, name: str) -> pd.DataFrame:
    """The screened designs whose objective is known of a full analysis at the same pressure too."""
    if full is None:
        return screened.head(0).assign(**{f"{name}_full": 0.0})
    pressure = _PRESSURES.get(name, "pressure_kPa")
    columns = [name, pressure]
    sides = [
        frame.assign(**{key: pd.to_numeric(frame[key], errors="coerce") for key in columns})
        for frame in (screened, reached(full))
    ]
    both = sides[0].merge(
        sides[1][["design_id", *columns]], "inner", "design_id", suffixes=("", "_full")
    )
    complete = both[columns + [f"{key}_full" for key in columns]].notna().all(axis=1)
    return both[complete & np.isclose(both[pressure], both[f"{pressure}_full"])]


def _draw_modes(axes: Axes, frame: pd.DataFrame, values: np.ndarray, size: float = 9.0) -> None:
    for mode in modes_of(frame):
        rows, look = (frame["mode"] == mode).to_numpy(), mode_look(mode)
        xs, ys = values[rows].T
        axes.scatter(xs, ys, s=size, c=look.colour, marker=look.marker, linewidths=0)


def _draw_front(axes: Axes, values: np.ndarray, colour: str) -> None:
    """A staircase: whatever is below it is not better than a design that is on it."""
    if not len(values):
        return
    front = values[not_dominated(values)]
    front = front[np.argsort(front[:, 0])]
    xs = np.concatenate([[0.0], front[:, 0], front[-1:, 0]])
    ys = np.concatenate([front[:1, 1], front[:, 1], [0.0]])
    axes.step(xs, ys, where="pre", color=colour, linewidth=1.2, zorder=3)


def _mode_handles(frame: pd.DataFrame) -> list[Line2D]:
    counts = frame["mode"].value_counts()
    return [
        Line2D(
            [],
            [],
            color=mode_look(mode).colour,
            marker=mode_look(mode).marker,
            linestyle="",
            label=f"{mode} ({counts[mode]:,})",
        )
        for mode in modes_of(frame)
    ]


def _label(name: str) -> str:
    size = f"|{OBJECTIVES[name]}|" if name == "twist_deg" else OBJECTIVES[name]
    return f"{size}, {_UNITS[name]}"


def _correlation(values: np.ndarray) -> str:
    """Spearman's rank correlation in words, where there is one."""
    ranks = pd.DataFrame(values).rank()
    if len(ranks) < 3 or (ranks.nunique() < 2).any():
        return ""
    value = float(np.corrcoef(ranks.to_numpy(dtype=np.float64).T)[0, 1])
    return f" (rank correlation {number(value, 2)})"


def _median_error(values: np.ndarray) -> str:
    """The median error in words, of what is not nearly nothing."""
    whole, cells = values.T
    some = np.abs(whole) > 0.05 * np.abs(whole).max(initial=0.0)
    if not some.any():
        return ""
    error = float(np.median(np.abs(cells[some] / whole[some] - 1.0)))
    return f" (median error {number(100 * error, 1)} %)"
