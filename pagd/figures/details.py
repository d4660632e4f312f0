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

# Distances (mm) of dimension lines from the outline, and of the picture's edge, with the label
# before it, from the dimension line.
_BESIDE, _OVER = 1.5, 1.2
_LABEL_BESIDE, _LABEL_OVER = 4.5, 2.0


def draw_details(
    figure: Figure, cell: SubplotSpec, body: pv.PolyData, base: pv.PolyData, design: Design
) -> None:
    """Draw up to two chambers from the side, one across, and the table of parameters (mm)."""
    columns = cell.subgridspec(1, 3, width_ratios=[1.9, 1.5, 0.9])
    side, across, table = (figure.add_subplot(columns[i]) for i in range(3))
    middle = float(design.chamber_starts()[-1]) + 0.5 * design.L
    draw_section(side, body, base, 1, 0.0)
    _dimension_side(side, design)
    side.set_title("first chambers, mm" if design.N > 1 else "the chamber, along, mm")
    draw_section(across, body, base, 0, middle, shear=float(design.chamber_skews()[-1]))
    _dimension_across(across, design)
    across.set_title("last chamber, across, mm" if design.N > 1 else "across, mm")
    table.set_axis_off()
    table.set_title("parameters, mm")
    table.text(0.0, 0.97, _parameters(design), va="top", linespacing=1.35, fontsize=8)
    table.text(0.45, 0.97, _values(design), va="top", ha="right", linespacing=1.35, fontsize=8)


def _dimension_side(axes: Axes, design: Design) -> None:
    """Dimension the first two chambers, or the only one."""
    end = float(design.chamber_starts()[:2][-1]) + design.L
    left, right = -_BESIDE, end + _BESIDE
    _dimension_chamber_and_gap(axes, design)
    _dimension_end_wall(axes, design, min(1, design.N - 1))
    dimension(axes, (left, 0.0), (left, design.H), f"$H$ {design.H:g}", aside=-3)
    dimension(axes, (left, -design.t_b), (left, 0.0), f"$t_b$ {design.t_b:g}", aside=-3)
    _dimension_roof(axes, design, right)
    # What follows the second chamber would lie behind the dimension line.
    axes.axvspan(end, right + _LABEL_BESIDE, color="white", zorder=2)
    _frame(axes, design, left - _LABEL_BESIDE, right + _LABEL_BESIDE)


def _dimension_chamber_and_gap(axes: Axes, design: Design) -> None:
    """Dimension the first chamber, and the gap to the second if there is one, from above."""
    d, level = design, design.H + _OVER
    start, *following = (float(x) for x in d.chamber_starts()[:2])
    end = start + d.L
    dimension(axes, (start, level), (end, level), f"$L$ {d.L:g}", aside=3)
    for second in following:
        gap = second - end
        # Where helical chambers give way to straight ones, it is wider in the middle than t_n.
        wider = gap > 1.001 * float(d.gaps()[0])
        label = f"{gap:.3g}" if wider else f"$t_n$ {d.gaps()[0]:g}"
        dimension(axes, (end, level), (second, level), label, aside=3)


def _dimension_end_wall(axes: Axes, design: Design, chamber: int) -> None:
    """Dimension the wall towards the fixed end of a chamber, from below."""
    d, level = design, -design.t_b - _OVER
    start = float(d.chamber_starts()[chamber])
    length = float(d.end_wall_lengths()[chamber])
    slanted = d.chamber_skews()[chamber] != 0.0
    label = f"$t_{{ab}}$ {d.t_ab:g}" + (f" / cos θ = {length:.3g}" if slanted else "")
    dimension(axes, (start, level), (start + length, level), label, aside=-3)
    for x in (start, start + length):
        _guide(axes, design, x)


def _dimension_across(axes: Axes, design: Design) -> None:
    d, half = design, design.W / 2
    above, below = d.H + _OVER, -d.t_b - _OVER
    dimension(axes, (-half, above), (half, above), f"$W$ {d.W:g}", aside=3)
    dimension(axes, (half - d.t, below), (half, below), f"$t$ {d.t:g}", aside=-3)
    _dimension_roof(axes, design, half + _BESIDE)
    _guide(axes, design, half - d.t)
    _frame(axes, design, -half - 1.0, half + _BESIDE + _LABEL_BESIDE)


def _dimension_roof(axes: Axes, design: Design, x: float) -> None:
    """Dimension the roof of the chambers on an upright line at `x`, with the label right of it."""
    top = design.H
    dimension(axes, (x, top - design.t_h), (x, top), f"$t_h$ {design.t_h:g}", aside=3)


def _guide(axes: Axes, design: Design, x: float) -> None:
    """Lead the face of a wall at `x` down to the dimension line below the base."""
    ends = [-design.t_b - _OVER, design.H - design.t_h]
    axes.plot([x, x], ends, color=FAINT, linewidth=0.6, linestyle=":")


def _frame(axes: Axes, design: Design, left: float, right: float) -> None:
    """Show what lies between `left` and `right`, with room for labels above and below."""
    room = _OVER + _LABEL_OVER
    axes.set_xlim(left, right)
    axes.set_ylim(-design.t_b - room, design.H + room)
    axes.set_axis_off()


def _parameters(design: Design) -> str:
    names = [*design.as_dict(), "L_T", "N_1", "N_2"]
    greek = {"theta": "θ, °", "alpha": "α"}
    return "\n".join(greek.get(n) or (f"${n[0]}_{{{n[2:]}}}$" if "_" in n else n) for n in names)


def _values(design: Design) -> str:
    values = [*design.as_dict().values(), round(design.L_T, 2), design.N1, design.N2]
    return "\n".join(f"{value:g}" for value in values)
