"""Pictures of the trajectories and angles of many designs: a column a mode."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import ScaledTranslation
from numpy.typing import NDArray

from pagd.figures.groups import Entry, Line, line_looks
from pagd.figures.load import Path3D
from pagd.figures.style import FAINT, mode_look, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FloatArray = NDArray[np.float64]

__all__ = ["Member", "angles_by_mode", "members_of", "trajectories_by_mode"]

# Inches: width of a column, by how many there are, and what labels and legend take of it.
_COLUMN, _LABELS = {1: 8.0, 2: 5.6}, 1.5
_WIDE = 4.4
# Names of a legend side by side; inches: their height, and how far below its axis a legend is.
_NAMES, _NAME, _BELOW = 3, 0.2, 0.45
# Inches: height of a label, and of a panel of angles.
_LABEL, _ROW = 0.17, 2.3


class Member(NamedTuple):
    """A design of a mode: its path, its line, and whether it carries its name."""

    name: str
    path: Path3D
    line: Line
    labelled: bool


class _End(NamedTuple):
    x: float
    y: float
    name: str
    colour: str


Groups = Mapping[str, Sequence[Member]]
Angle = Callable[[Path3D], FloatArray]


def members_of(groups: Mapping[str, Sequence[Entry]], paths: Mapping[str, Path3D]) -> Groups:
    """Return the designs that have a path, by mode; published ones and Table 2 carry names."""
    found = {}
    for mode, entries in groups.items():
        there = [e for e in entries if e.name in paths]
        lines = line_looks([e.name for e in there])
        if there:
            found[mode] = [Member(e.name, paths[e.name], lines[e.name], e.is_known) for e in there]
    return found


def trajectories_by_mode(groups: Groups) -> Figure:
    """Return the picture: tips and last centre lines from the side, and below from above."""
    (low, high) = _box(groups)
    width, (x, y, z) = _column(groups), high - low
    per_mm = (width - _LABELS) / x
    heights = [z * per_mm, max(y * per_mm, 0.8)]
    figure = new_figure(width * len(groups), sum(heights) + 1.2 + _legend_height(groups))
    panels = figure.subplots(2, len(groups), squeeze=False, height_ratios=heights)
    for column, members in enumerate(groups.values()):
        for row, axis in enumerate((2, 1)):
            axes = panels[row, column]
            for member in members:
                _draw_path(axes, member, axis)
            axes.set(xlim=(low[0], high[0]), ylim=(low[axis], high[axis]), aspect="equal")
            axes.label_outer()
        tips = [_tip(m) for m in members if m.labelled]
        _label_ends(panels[0, column], tips, _LABEL / heights[0])
        panels[1, column].set_xlabel("x, mm")
        _add_legend(panels[1, column], members)
    _head(panels[0], groups, "from the side")
    _name_rows(panels, ("z, mm", "y, mm (from above)"))
    return figure


def angles_by_mode(groups: Groups) -> Figure:
    """Return the picture: angles of the tip against pressure, and those of the chambers."""
    names = ("bending of the tip, °", "twist of the tip, °")
    joints = ("bending of a chamber, °", "twist of a chamber, °")
    figure = new_figure(_column(groups) * len(groups), 4 * _ROW + 1.8 + _legend_height(groups))
    panels = figure.subplots(4, len(groups), squeeze=False, sharey="row")
    for column, members in enumerate(groups.values()):
        for row, angle in enumerate((_bending, _twist)):
            _draw_tip_angles(panels[row, column], members, angle)
            _draw_joint_angles(panels[row + 2, column], members, angle)
        panels[1, column].set_xlabel("pressure, kPa")
        panels[3, column].set_xlabel("chamber, from the fixed end")
        _add_legend(panels[3, column], members)
    _head(panels[0], groups, "")
    _name_rows(panels, (*names, *joints))
    _label_angles(panels, groups)
    return figure


def _bending(path: Path3D) -> FloatArray:
    return path.bending_deg


def _twist(path: Path3D) -> FloatArray:
    return path.twist_deg


def _draw_path(axes: Axes, member: Member, axis: int) -> None:
    """Draw the way of the tip and the centre line at the last pressure."""
    colour, dash, _ = member.line
    positions = member.path.positions
    x, y = positions[-1, :, 0], positions[-1, :, axis]
    axes.plot(x, y, color=colour, linewidth=0.7, alpha=0.4)
    x, y = positions[:, -1, 0], positions[:, -1, axis]
    width = 1.8 if member.labelled else 1.1
    axes.plot(x, y, color=colour, linestyle=dash, linewidth=width, label=member.name)
    axes.plot(x[-1:], y[-1:], "o", color=colour, markersize=4.5 if member.labelled else 3.0)


def _draw_tip_angles(axes: Axes, members: Sequence[Member], angle: Angle) -> None:
    for name, path, (colour, dash, _), labelled in members:
        width = 1.8 if labelled else 1.1
        values = angle(path)[:, -1]
        axes.plot(
            path.pressure_kPa, values, color=colour, linestyle=dash, linewidth=width, label=name
        )
        axes.plot(path.pressure_kPa[-1:], values[-1:], "o", color=colour, markersize=3.0)


def _draw_joint_angles(axes: Axes, members: Sequence[Member], angle: Angle) -> None:
    for name, path, (colour, dash, _), labelled in members:
        joints = np.diff(angle(path)[-1])
        number = np.arange(1, len(joints) + 1)
        width = 1.8 if labelled else 1.1
        axes.plot(number, joints, color=colour, linestyle=dash, linewidth=width, label=name)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))


def _tip(member: Member) -> _End:
    x, _, z = member.path.positions[-1, -1]
    return _End(float(x), float(z), member.name, member.line.colour)


def _last_angle(member: Member, angle: Angle) -> _End:
    pressure, value = member.path.pressure_kPa[-1], angle(member.path)[-1, -1]
    return _End(float(pressure), float(value), member.name, member.line.colour)


def _label_angles(panels: NDArray[Any], groups: Groups) -> None:
    """Name the lines of the upper rows, whose limits all columns have had their share in."""
    for column, members in enumerate(groups.values()):
        for row, angle in enumerate((_bending, _twist)):
            ends = [_last_angle(m, angle) for m in members if m.labelled]
            axes = panels[row, column]
            axes.set_ylim(axes.get_ylim())
            _label_ends(axes, ends, _LABEL / _ROW)


def _label_ends(axes: Axes, ends: Sequence[_End], gap: float) -> None:
    """Write names right of a panel, each with a thin line to its end.

    They keep at least the gap, a share of the panel's height.
    """
    low, high = axes.get_ylim()
    ordered = sorted(ends, key=lambda end: end.y)
    places = _spread([(end.y - low) / (high - low) for end in ordered], gap)
    for end, place in zip(ordered, places, strict=True):
        axes.annotate(
            end.name,
            (end.x, end.y),
            xytext=(1.03, place),
            textcoords="axes fraction",
            va="center",
            color=end.colour,
            fontsize=8,
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": FAINT, "linewidth": 0.6, "shrinkB": 3},
        )


def _spread(wanted: Sequence[float], gap: float) -> list[float]:
    """Return places near the wanted rising ones, no two nearer than the gap."""
    if not wanted:
        return []
    steps = gap * np.arange(len(wanted))
    # Rising values minus rising steps: the best places never fall below a former one.
    pushed = np.maximum.accumulate(np.asarray(wanted) - steps)
    pulled = np.minimum.accumulate((np.asarray(wanted) - steps)[::-1])[::-1]
    return [float(place) for place in (pushed + pulled) / 2 + steps]


def _add_legend(axes: Axes, members: Sequence[Member]) -> None:
    """Put the names below the panel, under the label of its axis."""
    below = ScaledTranslation(0.0, -_BELOW, axes.figure.dpi_scale_trans)
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=axes.transAxes + below,
        ncols=_NAMES,
        fontsize=7.5,
        handlelength=2.8,
        columnspacing=1.0,
    )


def _head(panels: Sequence[Axes], groups: Groups, view: str) -> None:
    for axes, (mode, members) in zip(panels, groups.items(), strict=True):
        words = ", ".join(filter(None, (f"{mode} ({len(members)})", view)))
        axes.set_title(words, color=mode_look(mode).colour)


def _name_rows(panels: NDArray[Any], names: Sequence[str]) -> None:
    for axes, name in zip(panels[:, 0], names, strict=True):
        axes.set_ylabel(name)


def _column(groups: Groups) -> float:
    return _COLUMN.get(len(groups), _WIDE)


def _legend_height(groups: Groups) -> float:
    return _NAME * -(-max(len(members) for members in groups.values()) // _NAMES)


def _box(groups: Groups) -> tuple[FloatArray, FloatArray]:
    """Return the corners (3,) of the box around all tips and last centre lines, with a margin."""
    paths = [member.path.positions for members in groups.values() for member in members]
    points = np.vstack([np.vstack([p[-1], p[:, -1]]) for p in paths])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.04 * float((high - low).max())
    return low - margin, high + margin
