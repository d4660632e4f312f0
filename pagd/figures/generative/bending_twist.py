"""Picture of bending against twist of the simulated designs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from pagd.figures.generative.results import GenerativePaths, NothingToDraw, load_performance
from pagd.figures.generative.simulated import figure_of_simulated, with_numbers
from pagd.figures.style import save

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["bending_twist_figure", "draw_bending_twist"]


def draw_bending_twist(paths: GenerativePaths, out: Path) -> None:
    """Draw bending against twist to a PNG file.

    Raises
    ------
    NothingToDraw
        If no simulated design has both.
    """
    save(bending_twist_figure(load_performance(paths)), out)


def bending_twist_figure(performance: pd.DataFrame) -> Figure:
    """Return the picture: a point a simulated design, at the last pressure it reached.

    Parameters
    ----------
    performance
        Simulated designs with the columns :data:`pagd.tables.PERFORMANCE`; nulls are left out.

    Raises
    ------
    NothingToDraw
        If no design has both.
    """
    found = with_numbers(performance, "bending_deg", "twist_deg")
    if found.empty:
        raise NothingToDraw("No simulated design came as far as a bending and a twist.")
    columns = ("bending_deg", "twist_deg")
    labels = ("bending of the tip, degrees", "twist of the tip, degrees")
    title = f"bending and twist of {_count(performance, found)}"
    return figure_of_simulated(found, columns, labels, title)


def _count(performance: pd.DataFrame, found: pd.DataFrame) -> str:
    lost = len(performance) - len(found)
    words = f"{len(found):,} simulated design{'s' if len(found) != 1 else ''}"
    return words + (f" ({lost:,} more gave no result)" if lost else "")
