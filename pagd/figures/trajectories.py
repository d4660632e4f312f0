"""Picture of the trajectories of several designs: where stations and tip go under pressure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from pagd.errors import InputError
from pagd.figures.groups import FEW, by_mode, read_entries
from pagd.figures.load import Path3D, has_trajectory, load_trajectory
from pagd.figures.paths_by_mode import members_of, trajectories_by_mode
from pagd.figures.style import (
    FAINT,
    INK,
    PRESSURE_MAP,
    design_colours,
    kilopascals,
    new_figure,
    save,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_trajectories", "load_all", "trajectories_figure"]

# Pressures whose shape is drawn, and designs side by side in the legend.
_MOST, _IN_A_ROW = 11, 5
# Shortest side of a panel, as a share of its longest.
_SHORTEST = 0.3


def draw_trajectories(design_folders: Sequence[Path], out: Path) -> None:
    """Draw the trajectories of the designs that have one to a PNG file, by mode if many.

    Raises
    ------
    InputError
        If none has.
    """
    paths = load_all(design_folders)
    if len(paths) <= FEW:
        save(trajectories_figure(paths), out)
    else:
        save(trajectories_by_mode(members_of(by_mode(read_entries(design_folders)), paths)), out)


def load_all(design_folders: Sequence[Path]) -> dict[str, Path3D]:
    """Return the trajectories there are by design; InputError if there is none."""
    found = {f.name: load_trajectory(f) for f in design_folders if has_trajectory(f)}
    if not found:
        raise InputError("None of the designs has a trajectory to draw.")
    return found


def trajectories_figure(paths: Mapping[str, Path3D]) -> Figure:
    """Return the picture: shapes from the side, a panel a design; below, all tips together."""
    colours = design_colours(list(paths))
    figure = new_figure(13.0, 8.2)
    both = figure.subfigures(2, 1, height_ratios=[1.0, 1.3], squeeze=False)
    upper, lower = both[0, 0], both[1, 0]
    panels = upper.subplots(1, len(paths), squeeze=False, sharex=True, sharey=True)[0]
    limit = max(float(path.pressure_kPa.max()) for path in paths.values())
    for axes, (name, path) in zip(panels, paths.items(), strict=True):
        _draw_side(axes, path, colours[name], limit)
        axes.set_title(f"{name}: centre line from the side", color=colours[name])
    panels[0].set_ylabel("z, mm")
    _widen(panels[0])
    _add_pressure_bar(upper, list(panels), limit)
    _draw_tips(lower, paths, colours, limit)
    return figure


def _draw_side(axes: Axes, path: Path3D, colour: str, limit: float) -> None:
    """Draw centre lines at rising pressure, and the lines that the stations follow."""
    from matplotlib import colormaps

    for station in range(1, path.positions.shape[1]):
        x, _, z = path.positions[:, station].T
        axes.plot(x, z, color="#d5dae0", linewidth=0.8, zorder=1)
    for i in _evenly(len(path.pressure_kPa)):
        x, _, z = path.positions[i].T
        shade = colormaps[PRESSURE_MAP](path.pressure_kPa[i] / limit)
        axes.plot(x, z, color=shade, linewidth=1.6, zorder=2)
    x, _, z = path.positions[:, -1].T
    axes.plot(x, z, "o-", color=colour, markersize=3.5, linewidth=1.4, zorder=3)
    axes.set_aspect("equal")
    axes.set_xlabel("x, mm")


def _draw_tips(
    figure: Any, paths: Mapping[str, Path3D], colours: Mapping[str, str], limit: float
) -> None:
    """Draw the tips of all designs in space and in two projections, one legend below.

    Pressure is the colour inside the markers, as in the panels above: labels at the points would
    cover each other where curves meet.
    """
    grid = figure.add_gridspec(1, 3, width_ratios=[1.5, 0.7, 1.35])
    side, front = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
    space = figure.add_subplot(grid[2], projection="3d")
    for name, path in paths.items():
        _draw_in_space(space, path, name, colours[name])
        _draw_projected(side, path, 0, colours[name], limit)
        _draw_projected(front, path, 1, colours[name], limit)
    for axes, axis in ((side, "x"), (front, "y")):
        axes.set_aspect("equal")
        axes.set(xlabel=f"{axis}, mm", ylabel="z, mm")
        _widen(axes)
    side.set_title("tips from the side, inner colour: pressure")
    front.set_title("tips from the front")
    legend = [f"{name}, to {kilopascals(path.pressure_kPa[-1])}" for name, path in paths.items()]
    figure.legend(side.lines, legend, loc="outside lower left", ncols=min(len(legend), _IN_A_ROW))
    space.set_title("tips (thick) and centre lines at the last pressure")
    _equal_box(space, paths)


def _draw_projected(axes: Axes, path: Path3D, across: int, colour: str, limit: float) -> None:
    """Draw the path of a tip in the plane of axis `across` and z."""
    tips = path.positions[:, -1]
    along, z = tips[:, across], tips[:, 2]
    axes.plot(along, z, color=colour)
    axes.scatter(
        along,
        z,
        c=path.pressure_kPa,
        cmap=PRESSURE_MAP,
        vmin=0.0,
        vmax=limit,
        edgecolors=colour,
        linewidths=1.2,
        s=22,
        zorder=3,
    )


def _draw_in_space(axes: Any, path: Path3D, name: str, colour: str) -> None:
    tips = path.positions[:, -1]
    axes.plot(*tips.T, "o-", color=colour, markersize=3, linewidth=1.8, label=name)
    axes.plot(*path.positions[0].T, color=FAINT, linewidth=0.8)
    axes.plot(*path.positions[-1].T, color=colour, linewidth=1.0, alpha=0.8)


def _widen(axes: Axes) -> None:
    """Show a strip around a path that hardly leaves a line: equal scales would leave no room."""
    limits = np.array([axes.get_xlim(), axes.get_ylim()])
    sizes = np.diff(limits, axis=1)
    missing = np.maximum(_SHORTEST * sizes.max() - sizes, 0.0)
    x, y = limits + missing * [-0.5, 0.5]
    axes.set(xlim=x, ylim=y)


def _equal_box(axes: Any, paths: Mapping[str, Path3D]) -> None:
    """Give the axes in space one scale, around everything drawn."""
    points = np.vstack([path.positions[[0, -1]].reshape(-1, 3) for path in paths.values()])
    points = np.vstack([points, *(path.positions[:, -1] for path in paths.values())])
    low, high = points.min(axis=0), points.max(axis=0)
    largest = float((high - low).max())
    # As in the flat panels, no side is so short that its ticks meet.
    missing = np.maximum(_SHORTEST * largest - (high - low), 0.0)
    low, high, margin = low - missing / 2, high + missing / 2, 0.04 * largest
    axes.set(
        **{f"{n}lim": (a - margin, b + margin) for n, a, b in zip("xyz", low, high, strict=True)}
    )
    axes.set_box_aspect(high - low + 2.0 * margin, zoom=0.87)
    axes.set(xlabel="x, mm", ylabel="y, mm", zlabel="z, mm")
    axes.yaxis.set_major_locator(MaxNLocator(3))
    axes.view_init(elev=22.0, azim=-58.0)


def _add_pressure_bar(figure: Any, axes: Sequence[Axes], limit: float) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    bar = figure.colorbar(
        ScalarMappable(Normalize(0.0, limit), PRESSURE_MAP),
        ax=list(axes),
        aspect=20,
        pad=0.01,
        shrink=0.8,
    )
    bar.set_label("pressure, kPa")
    bar.outline.set_edgecolor(INK)


def _evenly(count: int) -> list[int]:
    return sorted(set(np.linspace(0, count - 1, min(_MOST, count)).round().astype(int).tolist()))
