"""Overall dimensions of a design of any family, from its surfaces, and its parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from pagd.families import Actuator
from pagd.figures.outline import dimension, draw_section

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

__all__ = ["draw_overall", "symbol_text"]

# Distance (mm) of dimension lines from the outline, and room (mm) for labels beyond them, as
# shares of the height.
_OFF, _ROOM = 0.12, 0.3
# Parts of the body this near (share of its height) to its top are its top.
_TOP = 0.05
_GREEK = {"theta": "θ", "alpha": "α"}


def draw_overall(
    figure: Figure, cell: SubplotSpec, body: pv.PolyData, base: pv.PolyData, design: Actuator
) -> None:
    """Draw a design from the side and across with its overall size (mm), and its parameters."""
    columns = cell.subgridspec(1, 3, width_ratios=[1.9, 1.2, 0.9])
    side, across, table = (figure.add_subplot(columns[i]) for i in range(3))
    draw_section(side, body, base, 1, 0.0)
    _dimension(side, body, base, 0)
    side.set_title("in the middle, mm")
    highest = _highest(body)
    draw_section(across, body, base, 0, highest)
    _dimension(across, body, base, 1)
    across.set_title(f"across, at x = {highest:.3g} mm")
    table.set_axis_off()
    table.set_title("parameters, mm")
    names, values = zip(*_rows(design), strict=True)
    table.text(0.0, 0.97, "\n".join(names), va="top", linespacing=1.35, fontsize=8)
    table.text(0.6, 0.97, "\n".join(values), va="top", ha="right", linespacing=1.35, fontsize=8)


def symbol_text(symbol: str, unit: str = "mm") -> str:
    """Return a symbol as pictures have it, with its unit unless that is mm or none."""
    letter, _, index = symbol.partition("_")
    shown = _GREEK.get(symbol) or (f"${letter}_{{{index}}}$" if index else symbol)
    return shown + {"mm": "", "1": "", "": "", "degrees": ", °"}.get(unit, f", {unit}")


def _rows(design: Actuator) -> list[tuple[str, str]]:
    parameters = design.parameters()
    given = [(s, value, parameters[s].unit) for s, value in design.as_dict().items()]
    more = [(row.symbol, row.value, row.unit) for row in design.derived()]
    return [
        (symbol_text(symbol, unit), value if isinstance(value, str) else f"{value:.5g}")
        for symbol, value, unit in (*given, *more)
    ]


def _highest(body: pv.PolyData) -> float:
    """Return where (mm) along x the body is highest, as near to its middle as there is."""
    x, _, z = np.asarray(body.cell_centers().points, dtype=np.float64).T
    x = x[z > z.max() - _TOP * np.ptp(z)]
    return float(x[np.argmin(np.abs(x - body.center[0]))])


def _dimension(axes: Axes, body: pv.PolyData, base: pv.PolyData, axis: int) -> None:
    """Dimension extent along an axis, from below, and height, from the right."""
    start, end = body.bounds[2 * axis : 2 * axis + 2]
    low, high = base.bounds[4], body.bounds[5]
    off, room = _OFF * (high - low), _ROOM * (high - low)
    dimension(axes, (start, low - off), (end, low - off), f"{end - start:.4g}", aside=-3)
    dimension(axes, (end + off, low), (end + off, high), f"{high - low:.4g}", aside=3)
    axes.set_xlim(start - off, end + off + room)
    axes.set_ylim(low - off - room, high + off)
    axes.set_axis_off()
