"""Picture of the blocked force of several designs against pressure, by mode if they are many."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pagd.errors import InputError
from pagd.figures.groups import FEW, Entry, Line, by_mode, line_looks, read_entries
from pagd.figures.load import Steps, has_blocked_force, load_blocked_force
from pagd.figures.style import INK, mode_look, new_figure, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_forces", "forces_figure"]

# Inches: width of a panel, by how many there are; height of the picture without its legends, and
# of a line of names, so many of them side by side.
_PANEL, _WIDE = {1: 8.0, 2: 5.6}, 4.4
_HEIGHT, _NAME, _NAMES = 3.8, 0.2, 3


def draw_forces(design_folders: Sequence[Path], out: Path) -> None:
    """Draw the blocked forces of the designs that have one to a PNG file.

    Raises
    ------
    InputError
        If none has.
    """
    entries = [e for e in read_entries(design_folders) if has_blocked_force(e.folder)]
    if not entries:
        raise InputError("None of the designs has a blocked force to draw.")
    steps = {entry.name: load_blocked_force(entry.folder) for entry in entries}
    save(forces_figure({"": entries} if len(entries) <= FEW else by_mode(entries), steps), out)


def forces_figure(groups: Mapping[str, Sequence[Entry]], steps: Mapping[str, Steps]) -> Figure:
    """Return the picture: a panel a group of designs, all on one scale; "" heads no group."""
    names = -(-max(len(group) for group in groups.values()) // _NAMES)
    width = _PANEL.get(len(groups), _WIDE)
    figure = new_figure(width * len(groups), _HEIGHT + _NAME * names)
    panels = figure.subplots(1, len(groups), squeeze=False, sharex=True, sharey=True)[0]
    for axes, (mode, group) in zip(panels, groups.items(), strict=True):
        lines = line_looks([entry.name for entry in group])
        axes.axhline(0.0, color=INK, linewidth=0.9)
        for entry in group:
            _draw(axes, entry, steps[entry.name], lines[entry.name])
        title = f"{mode} ({len(group)})" if mode else "blocked force"
        axes.set_title(title, color=mode_look(mode).colour if mode else INK)
        axes.set_xlabel("pressure, kPa")
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=_NAMES, fontsize=7.5)
    panels[0].set_ylabel("blocked force, N")
    return figure


def _draw(axes: Axes, entry: Entry, steps: Steps, line: Line) -> None:
    pressure, force = steps.forces
    width = 1.8 if entry.is_known else 1.1
    axes.plot(
        pressure, force, color=line.colour, linestyle=line.dash, linewidth=width, label=entry.name
    )
    axes.plot(pressure[-1:], force[-1:], "o", color=line.colour, markersize=3.0)
