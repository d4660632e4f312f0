"""Names beside points, placed so that they hide neither each other nor the points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from matplotlib.collections import PathCollection
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from pagd.figures.style import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["label_points", "legend_below"]

_SIZE: Final = 7.5  # points
_WIDTH, _HEIGHT = 0.58 * _SIZE, 1.25 * _SIZE  # of a letter, of a line
_LEGEND_SIZE: Final = 30.0  # points²
_ANGLES: Final = np.radians([0, 45, -45, 180, 135, -135, 90, -90, 20, -20, 160, -160, 70, -70])
_DISTANCES: Final = (8.0, 16.0, 26.0, 40.0, 56.0)


class _Box(NamedTuple):
    left: float
    low: float
    right: float
    high: float


def label_points(
    axes: Axes, points: NDArray[np.float64], names: Sequence[str], others: NDArray[np.float64]
) -> None:
    """Write a name beside each of the points.

    Parameters
    ----------
    axes
        Where the points are drawn already: the limits must be final.
    points
        What is named (n, 2), in data coordinates.
    names
        n names.
    others
        Points (m, 2) that no name should hide, the named ones included.
    """
    figure = axes.get_figure(root=True)
    if figure is None or len(points) == 0:
        return
    figure.draw_without_rendering()  # only now the layout, and thus the scale, is known
    scale = 72.0 / figure.dpi
    at = axes.transData.transform(points) * scale
    hidden = axes.transData.transform(others) * scale
    frame = axes.get_window_extent()
    inside = _Box(*(float(value) * scale for value in frame.extents))
    taken: list[_Box] = []
    for i in np.lexsort((at[:, 0], -at[:, 1])):
        offset, box = _best(at[i], names[i], hidden, taken, inside)
        taken.append(box)
        _write(axes, names[i], points[i], offset)


def legend_below(axes: Axes, columns: int) -> None:
    """Put the legend of some axes under them, where it covers no data; small points get larger."""
    legend = axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        borderaxespad=3.0 if len(axes.get_xticks()) == 0 else 4.6,
        ncols=columns,
        columnspacing=1.2,
        handletextpad=0.4,
    )
    for handle in legend.legend_handles:
        if isinstance(handle, PathCollection):
            handle.set_sizes(np.maximum(handle.get_sizes(), _LEGEND_SIZE))
            handle.set_alpha(1.0)


def _write(axes: Axes, name: str, point: NDArray[np.float64], offset: NDArray[np.float64]) -> None:
    far = float(np.hypot(*offset)) > _DISTANCES[0] + 4.0
    axes.annotate(
        name,
        (float(point[0]), float(point[1])),
        xytext=(float(offset[0]), float(offset[1])),
        textcoords="offset points",
        ha=_side(offset),
        va="center",
        fontsize=_SIZE,
        color=INK,
        zorder=6,
        path_effects=[withStroke(linewidth=2.5, foreground="white")],
        arrowprops={"arrowstyle": "-", "color": INK, "linewidth": 0.5} if far else None,
    )


def _best(
    at: NDArray[np.float64],
    name: str,
    hidden: NDArray[np.float64],
    taken: Sequence[_Box],
    inside: _Box,
) -> tuple[NDArray[np.float64], _Box]:
    """Return the offset (points) and the box of the place that costs least; near ones first."""
    places = [d * np.array([np.cos(a), np.sin(a)]) for d in _DISTANCES for a in _ANGLES]
    boxes = [_box(at + place, place, name) for place in places]
    costs = [
        _cost(box, hidden, taken, inside) + 0.02 * float(np.hypot(*place))
        for box, place in zip(boxes, places, strict=True)
    ]
    best = int(np.argmin(costs))
    return places[best], boxes[best]


def _cost(box: _Box, hidden: NDArray[np.float64], taken: Sequence[_Box], inside: _Box) -> float:
    covers = (
        (hidden[:, 0] > box.left - 2.0)
        & (hidden[:, 0] < box.right + 2.0)
        & (hidden[:, 1] > box.low - 2.0)
        & (hidden[:, 1] < box.high + 2.0)
    )
    outside = (
        box.left < inside.left
        or box.right > inside.right
        or box.low < inside.low
        or box.high > inside.high
    )
    overlaps = sum(_overlap(box, other) for other in taken)
    return float(covers.sum()) + 10.0 * overlaps + 20.0 * outside


def _overlap(a: _Box, b: _Box) -> bool:
    return a.left < b.right and b.left < a.right and a.low < b.high and b.low < a.high


def _side(offset: NDArray[np.float64]) -> str:
    if abs(offset[0]) < 0.2 * abs(offset[1]):
        return "center"
    return "left" if offset[0] > 0 else "right"


def _box(at: NDArray[np.float64], offset: NDArray[np.float64], name: str) -> _Box:
    width = _WIDTH * len(name)
    share = {"left": 0.0, "center": 0.5, "right": 1.0}[_side(offset)]
    left, middle = float(at[0]) - share * width, float(at[1])
    return _Box(left, middle - _HEIGHT / 2, left + width, middle + _HEIGHT / 2)
