"""Dimensioned details of a design: the first chambers, one chamber across, the parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyvista as pv

from pagd.design import Design
from pagd.figures.outline import dimension, draw_section
from pagd.figures.style import FAINT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

__all__ = ["draw_details"]


def draw_details(
    figure: Figure, cell: SubplotSpec, body: pv.PolyData, base: pv.PolyData, design: Design
) -> None:
    """Draw two chambers from the side, one across, and the table of parameters (mm)."""
    columns = cell.subgridspec(1, 3, width_ratios=[1.9, 1.5, 0.9])
    side, across, table = (figure.add_subplot(columns[i]) for i in range(3))
    middle = float(design.chamber_starts()[-1]) + 0.5 * design.L
    draw_section(side, body, base, 1, 0.0)
    _dimension_side(side, design)
    side.set_title("first chambers, mm")
    draw_section(across, body, base, 0, middle, shear=float(design.chamber_skews()[-1]))
    _dimension_across(across, design)
    across.set_title("last chamber, across, mm")
    table.set_axis_off()
    table.set_title("parameters, mm")
    table.text(0.0, 0.97, _parameters(design), va="top", linespacing=1.35, fontsize=8)
    table.text(0.45, 0.97, _values(design), va="top", ha="right", linespacing=1.35, fontsize=8)


def _dimension_side(axes: Axes, design: Design) -> None:
    d, starts = design, design.chamber_starts()
    first, second = float(starts[0]), float(starts[1])
    wall, end = float(d.end_wall_lengths()[1]), second + d.L
    slanted = d.N1 > 1
    above, below, left, right = d.H + 1.2, -d.t_b - 1.2, -1.5, end + 1.5
    dimension(axes, (first, above), (first + d.L, above), f"$L$ {d.L:g}", aside=3)
    dimension(axes, (first + d.L, above), (second, above), f"$t_n$ {d.gaps()[0]:g}", aside=3)
    label = f"$t_{{ab}}$ {d.t_ab:g}" + (f" / cos θ = {wall:.3g}" if slanted else "")
    dimension(axes, (second, below), (second + wall, below), label, aside=-3)
    dimension(axes, (right, d.H - d.t_h), (right, d.H), f"$t_h$ {d.t_h:g}", aside=3)
    dimension(axes, (left, 0.0), (left, d.H), f"$H$ {d.H:g}", aside=-3)
    dimension(axes, (left, -d.t_b), (left, 0.0), f"$t_b$ {d.t_b:g}", aside=-3)
    for x in (second, second + wall):
        axes.plot([x, x], [below, d.H - d.t_h], color=FAINT, linewidth=0.6, linestyle=":")
    axes.set_xlim(left - 4.5, right + 4.5)
    axes.set_ylim(below - 2.0, above + 2.0)
    # What follows the second chamber would lie behind the dimension line.
    axes.axvspan(end, right + 4.5, color="white", zorder=2)
    axes.set_axis_off()


def _dimension_across(axes: Axes, design: Design) -> None:
    d, half = design, design.W / 2
    above, below, right = d.H + 1.2, -d.t_b - 1.2, design.W / 2 + 1.5
    dimension(axes, (-half, above), (half, above), f"$W$ {d.W:g}", aside=3)
    dimension(axes, (half - d.t, below), (half, below), f"$t$ {d.t:g}", aside=-3)
    dimension(axes, (right, d.H - d.t_h), (right, d.H), f"$t_h$ {d.t_h:g}", aside=3)
    axes.plot([half - d.t] * 2, [below, d.H - d.t_h], color=FAINT, linewidth=0.6, linestyle=":")
    axes.set_xlim(-half - 1.0, right + 4.5)
    axes.set_ylim(below - 2.0, above + 2.0)
    axes.set_axis_off()


def _parameters(design: Design) -> str:
    names = [*design.as_dict(), "L_T", "N_1", "N_2"]
    greek = {"theta": "θ, °", "alpha": "α"}
    return "\n".join(greek.get(n) or (f"${n[0]}_{{{n[2:]}}}$" if "_" in n else n) for n in names)


def _values(design: Design) -> str:
    values = [*design.as_dict().values(), round(design.L_T, 2), design.N1, design.N2]
    return "\n".join(f"{value:g}" for value in values)
