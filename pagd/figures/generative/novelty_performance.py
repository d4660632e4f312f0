"""Picture of novelty against performance: what the paper's tables leave apart."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd

from pagd.figures.generative.results import GenerativePaths, NothingToDraw, load_performance
from pagd.figures.generative.simulated import (
    draw_simulated,
    legend_of_simulated,
    name_known,
    with_numbers,
)
from pagd.figures.style import new_figure, number, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_novelty_performance", "novelty_performance_figure"]

# Column of the vertical axis, its title, its unit.
_PANELS: Final = (
    ("bending_deg", "bending", "degrees"),
    ("twist_size_deg", "|twist|", "degrees"),
    ("work_density_kJ_m3", "work density", "kJ/m³"),
)


def draw_novelty_performance(paths: GenerativePaths, out: Path) -> None:
    """Draw novelty against performance to a PNG file.

    Raises
    ------
    NothingToDraw
        If no simulated design has both.
    """
    save(novelty_performance_figure(load_performance(paths)), out)


def novelty_performance_figure(performance: pd.DataFrame) -> Figure:
    """Return the picture: bending, |twist| and work density against novelty, by mode.

    Parameters
    ----------
    performance
        Simulated designs with the columns :data:`pagd.tables.PERFORMANCE`; nulls are left out.

    Raises
    ------
    NothingToDraw
        If no design has a novelty and a performance.
    """
    measured = performance.assign(twist_size_deg=np.abs(_numbers(performance, "twist_deg")))
    if with_numbers(measured, "novelty", "bending_deg").empty:
        raise NothingToDraw("No simulated design has both a novelty and a performance.")
    figure = new_figure(12.0, 4.9)
    panels = figure.subplots(1, len(_PANELS))
    for axes, (column, title, unit) in zip(panels, _PANELS, strict=True):
        _draw_panel(axes, measured, column, title, unit)
    legend_of_simulated(figure, with_numbers(measured, "novelty", "bending_deg"))
    for axes, (column, _, _) in zip(panels, _PANELS, strict=True):
        name_known(axes, measured, "novelty", column)
    return figure


def _draw_panel(axes: Axes, measured: pd.DataFrame, column: str, title: str, unit: str) -> None:
    found = with_numbers(measured, "novelty", column)
    draw_simulated(axes, found, "novelty", column)
    axes.set(xlabel="novelty: distance to the nearest training design", ylabel=unit)
    axes.set_title(f"{title}{_correlation(found, column)}")
    axes.set_xlim(left=min(0.0, axes.get_xlim()[0]))


def _correlation(found: pd.DataFrame, column: str) -> str:
    """Return Spearman's rank correlation of the designs that went well, where there is one."""
    good = found[found["status"] == "ok"][["novelty", column]].rank()
    if len(good) < 3 or (good.nunique() < 2).any():
        return ""
    value = float(np.corrcoef(good.to_numpy(dtype=np.float64).T)[0, 1])
    return f" (rank correlation {number(value, 2)})"


def _numbers(frame: pd.DataFrame, column: str) -> pd.Series[float]:
    return pd.to_numeric(frame[column], errors="coerce")
