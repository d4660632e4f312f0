"""Picture of bending and twist: of the tip against pressure, and joint by joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.ticker import MaxNLocator

from pagd.figures.groups import FEW, by_mode, read_entries
from pagd.figures.load import Path3D
from pagd.figures.paths_by_mode import angles_by_mode, members_of
from pagd.figures.style import design_colours, new_figure, number, save
from pagd.figures.trajectories import load_all

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["angles_figure", "draw_angles"]


def draw_angles(design_folders: Sequence[Path], out: Path) -> None:
    """Draw the angles of the designs that have a trajectory to a PNG file, by mode if many.

    Raises
    ------
    InputError
        If none has.
    """
    paths = load_all(design_folders)
    if len(paths) <= FEW:
        save(angles_figure(paths), out)
    else:
        save(angles_by_mode(members_of(by_mode(read_entries(design_folders)), paths)), out)


def angles_figure(paths: Mapping[str, Path3D]) -> Figure:
    """Return the picture: bending and twist of the tip above, of the joints below."""
    colours = design_colours(list(paths))
    figure = new_figure(11.0, 7.0)
    panels = figure.subplots(2, 2)
    for column, (word, values) in enumerate(_angles(paths).items()):
        _draw_tips(panels[0, column], word, paths, values, colours)
        _draw_joints(panels[1, column], word, values, colours)
    panels[0, 0].legend(loc="best")
    panels[1, 0].sharey(panels[1, 1])
    return figure


def _angles(paths: Mapping[str, Path3D]) -> dict[str, dict[str, np.ndarray]]:
    return {
        "bending": {name: path.bending_deg for name, path in paths.items()},
        "twist": {name: path.twist_deg for name, path in paths.items()},
    }


def _draw_tips(
    axes: Axes,
    word: str,
    paths: Mapping[str, Path3D],
    values: Mapping[str, np.ndarray],
    colours: Mapping[str, str],
) -> None:
    for name, path in paths.items():
        tip = values[name][:, -1]
        axes.plot(path.pressure_kPa, tip, "o-", color=colours[name], markersize=4, label=name)
        axes.annotate(
            f"{number(tip[-1], 0)}°",
            (path.pressure_kPa[-1], tip[-1]),
            xytext=(6, 0),
            textcoords="offset points",
            va="center",
            color=colours[name],
            annotation_clip=False,
        )
    axes.set(title=f"{word} of the tip", xlabel="pressure, kPa", ylabel="degrees")


def _draw_joints(
    axes: Axes, word: str, values: Mapping[str, np.ndarray], colours: Mapping[str, str]
) -> None:
    for name, angles in values.items():
        joints = np.diff(angles[-1])
        axes.plot(np.arange(1, len(joints) + 1), joints, "o-", color=colours[name], markersize=4)
    axes.set(
        title=f"{word} of each chamber at the last pressure",
        xlabel="chamber, from the fixed end",
        ylabel="degrees",
    )
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
