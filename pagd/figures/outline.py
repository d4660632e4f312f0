"""Plane sections of closed surfaces as filled outlines, and their dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from matplotlib.path import Path as Outline
from numpy.typing import NDArray

from pagd.figures.style import BASE, ELASTOMER, INK, PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FloatArray = NDArray[np.float64]

__all__ = ["dimension", "draw_section", "fill", "section_loops"]


def section_loops(
    surface: pv.PolyData, axis: int, at: float, shear: float = 0.0
) -> list[FloatArray]:
    """Return the closed outlines (k, 2) of a surface cut at coordinate `at` of an axis (mm).

    The two columns are the other axes, in order. A cut across (axis 0) follows a chamber that is
    sheared in x by y times `shear`; seen along x, it shows the true widths.
    """
    normal, origin = np.eye(3)[axis], at * np.eye(3)[axis]
    normal[1] -= shear
    cut = surface.slice(normal=normal, origin=origin)
    assert isinstance(cut, pv.PolyData)
    lines = cut.merge_points(tolerance=1e-6).strip(join=True)
    others = [i for i in range(3) if i != axis]
    points = np.asarray(lines.points, dtype=np.float64)[:, others]
    loops, rest = [], np.asarray(lines.lines)
    while len(rest):
        loops.append(points[rest[1 : rest[0] + 1]])
        rest = rest[rest[0] + 1 :]
    return [loop for loop in loops if len(loop) > 3]


def fill(axes: Axes, loops: Sequence[FloatArray], colour: str) -> None:
    """Fill the area that an odd number of outlines surround."""
    from matplotlib.patches import PathPatch

    if not loops:
        return
    path = Outline.make_compound_path(*(Outline(_oriented(loop, loops)) for loop in loops))
    axes.add_patch(PathPatch(path, facecolor=colour, edgecolor=INK, linewidth=0.6))


def draw_section(
    axes: Axes,
    body: pv.PolyData,
    base: pv.PolyData,
    axis: int,
    at: float,
    shear: float = 0.0,
) -> None:
    """Fill what a plane cuts of body and base, and draw the paper between them.

    The plane is that of :func:`section_loops`; the paper is where the body begins.
    """
    fill(axes, section_loops(body, axis, at, shear), ELASTOMER)
    if axis != 2:
        fill(axes, section_loops(base, axis, at, shear), BASE)
        along = body.bounds[0:2] if axis == 1 else body.bounds[2:4]
        axes.plot(along, [body.bounds[4]] * 2, color=PAPER, linewidth=1.6, solid_capstyle="butt")
    axes.set_aspect("equal")
    axes.margins(0.02, 0.06)
    axes.autoscale_view()
    axes.grid(False)
    axes.set_ylabel("y, mm" if axis == 2 else "z, mm")


def dimension(
    axes: Axes, start: tuple[float, float], end: tuple[float, float], label: str, *, aside: float
) -> None:
    """Draw a dimension line between two points, with its label `aside` points off the line.

    The label stands right of an upright line if `aside` is positive, above a level one.
    """
    axes.annotate(
        "",
        start,
        end,
        arrowprops={
            "arrowstyle": "|-|,widthA=0.25,widthB=0.25",
            "color": INK,
            "linewidth": 0.7,
            "shrinkA": 0,
            "shrinkB": 0,
        },
        annotation_clip=False,
    )
    upright = abs(end[0] - start[0]) < abs(end[1] - start[1])
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    axes.annotate(
        label,
        middle,
        xytext=(aside, 0.0) if upright else (0.0, aside),
        textcoords="offset points",
        ha=("left" if aside > 0 else "right") if upright else "center",
        va="center" if upright else ("bottom" if aside > 0 else "top"),
        fontsize=8,
        annotation_clip=False,
    )


def _oriented(loop: FloatArray, loops: Sequence[FloatArray]) -> FloatArray:
    """Return the outline anticlockwise if it bounds matter from outside, clockwise if a void."""
    x, y = loop.T
    area = float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
    around = sum(Outline(other).contains_point(loop[0]) for other in loops if other is not loop)
    return loop if (area > 0) == (around % 2 == 0) else loop[::-1]
