"""Picture of blocked force against bending of the simulated designs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from pagd.figures.generative.results import GenerativePaths, NothingToDraw, load_performance
from pagd.figures.generative.simulated import figure_of_simulated, with_numbers
from pagd.figures.style import save

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw_force_bending", "force_bending_figure"]


def draw_force_bending(paths: GenerativePaths, out: Path) -> None:
    """Draw blocked force against bending to a PNG file.

    Raises
    ------
    NothingToDraw
        If no simulated design has both.
    """
    save(force_bending_figure(load_performance(paths)), out)


def force_bending_figure(performance: pd.DataFrame) -> Figure:
    """Return the picture: a point a design, each analysis at the last pressure it reached.

    Crossed where either analysis has ended early: its point is not that of the last pressure.

    Parameters
    ----------
    performance
        Simulated designs with the columns :data:`pagd.tables.PERFORMANCE`; nulls are left out.

    Raises
    ------
    NothingToDraw
        If no design has both.
    """
    found = with_numbers(performance, "bending_deg", "blocked_force_N")
    if found.empty:
        raise NothingToDraw("No simulated design has both a bending and a blocked force.")
    held_to_the_end = found["blocked_force_status"].isin(["ok"])
    found = found.assign(status=found["status"].where(held_to_the_end, "held tip ended early"))
    plural = "s" if len(found) != 1 else ""
    columns = ("bending_deg", "blocked_force_N")
    labels = ("bending of the free tip, degrees", "blocked force, N")
    title = f"blocked force and bending of {len(found):,} simulated design{plural}"
    return figure_of_simulated(found, columns, labels, title)
