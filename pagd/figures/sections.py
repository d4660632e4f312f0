"""Sections of a design with dimensions, as a small vector picture: how a notebook shows a design.

Unlike :mod:`pagd.figures.geometry` there is no view in space, whose pixels take a second to render.
"""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING, Any, Final

import pyvista as pv
from matplotlib import rc_context

from pagd.design import Design
from pagd.figures.details import draw_details
from pagd.figures.outline import draw_section
from pagd.figures.style import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["sections_as_svg", "sections_figure"]

_WIDTH = 10.0
# Largest side view and plan, inches; height of the details, and of a title with its axis.
_HIGHEST, _DETAILS, _HEAD = 1.8, 3.0, 0.65
# The plan is cut near the roof of the cavities, above the channel.
_LEVEL = 0.85
# With a salt of its own matplotlib names equal things equally; by default it draws lots.
_SETTINGS: Final[dict[Any, Any]] = {"svg.hashsalt": "pagd", "svg.fonttype": "none"}


def sections_as_svg(body: pv.PolyData, base: pv.PolyData, design: Design) -> str:
    """Return :func:`sections_figure` as the text of an SVG picture; equal designs, equal texts."""
    # The look of our pictures is not to become that of others in the same process.
    with rc_context(_SETTINGS):
        target = io.StringIO()
        figure = sections_figure(body, base, design)
        figure.savefig(target, format="svg", metadata={"Date": None, "Creator": None})
    size = f'style="max-width: {_WIDTH:g}in" width="100%"'
    told = f'role="img" aria-label="sections of a {design.mode} design, {design.N} chambers"'
    # As wide as there is room, since notebooks are of all widths.
    fixed = re.compile(r'(<svg [^>]*?)width="\S+" height="\S+"')
    return fixed.sub(rf"\1{size} {told}", target.getvalue(), count=1)


def sections_figure(body: pv.PolyData, base: pv.PolyData, design: Design) -> Figure:
    """Return the picture: plan, side view, and details with dimensions and parameters.

    Parameters
    ----------
    body, base
        Closed surfaces above and below the plane of the paper (mm).
    design
        The design that they are of.
    """
    scale = min((_WIDTH - 1.0) / design.L_T, _HIGHEST / max(design.W, design.H + design.t_b))
    heights = [scale * side + _HEAD for side in (design.W, design.H + design.t_b)] + [_DETAILS]
    figure = new_figure(_WIDTH, sum(heights))
    rows = figure.add_gridspec(3, 1, height_ratios=heights)
    plan, side = (figure.add_subplot(rows[i]) for i in range(2))
    draw_section(plan, body, base, 2, _LEVEL * (design.H - design.t_h))
    slant = "" if design.is_straight else f", θ = {design.theta:g}°"
    plan.set_title(f"plan, through the chambers{slant}; {design.mode}, {design.N} chambers")
    draw_section(side, body, base, 1, 0.0)
    side.set_title("side view, through the air channel; paper between body and base")
    side.set_xlabel("x, mm")
    draw_details(figure, rows[2], body, base, design)
    return figure
