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
from pagd.families import Actuator, PneuNet, actuator_of
from pagd.figures.details import draw_details
from pagd.figures.overall import draw_overall
from pagd.figures.style import new_figure
from pagd.figures.views import draw_plan, draw_side

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["sections_as_svg", "sections_figure"]

_WIDTH = 10.0
# Largest side view and plan, inches; height of the details, and of a title with its axis.
_HIGHEST, _DETAILS, _HEAD = 1.8, 3.0, 0.65
# With a salt of its own matplotlib names equal things equally; by default it draws lots.
_SETTINGS: Final[dict[Any, Any]] = {"svg.hashsalt": "pagd", "svg.fonttype": "none"}


def sections_as_svg(body: pv.PolyData, base: pv.PolyData, of: Design | Actuator) -> str:
    """Return :func:`sections_figure` as the text of an SVG picture; equal designs, equal texts."""
    # The look of our pictures is not to become that of others in the same process.
    with rc_context(_SETTINGS):
        target = io.StringIO()
        figure = sections_figure(body, base, of)
        figure.savefig(target, format="svg", metadata={"Date": None, "Creator": None})
    size = f'style="max-width: {_WIDTH:g}in" width="100%"'
    told = f'role="img" aria-label="sections of a {_in_words(actuator_of(of))}"'
    # As wide as there is room, since notebooks are of all widths.
    fixed = re.compile(r'(<svg [^>]*?)width="\S+" height="\S+"')
    return fixed.sub(rf"\1{size} {told}", target.getvalue(), count=1)


def sections_figure(body: pv.PolyData, base: pv.PolyData, of: Design | Actuator) -> Figure:
    """Return the picture: plan, side view, and details with dimensions and parameters.

    Parameters
    ----------
    body, base
        Closed surfaces above and below the plane of the paper (mm).
    of
        The design that they are of.
    """
    design = actuator_of(of)
    width, height = body.bounds[3] - body.bounds[2], body.bounds[5] - base.bounds[4]
    scale = min((_WIDTH - 1.0) / design.L_T, _HIGHEST / max(width, height))
    heights = [scale * side + _HEAD for side in (width, height)] + [_DETAILS]
    figure = new_figure(_WIDTH, sum(heights))
    rows = figure.add_gridspec(3, 1, height_ratios=heights)
    plan, side = (figure.add_subplot(rows[i]) for i in range(2))
    draw_plan(plan, body, base, design, f"; {_in_words(design)}")
    draw_side(side, body, base, design, "; paper between body and base")
    if isinstance(design, PneuNet):
        draw_details(figure, rows[2], body, base, design.design)
    else:
        draw_overall(figure, rows[2], body, base, design)
    return figure


def _in_words(design: Actuator) -> str:
    if isinstance(design, PneuNet):
        return f"{design.mode} design, {design.design.N} chambers"
    return f"{design.mode} design, {design.family}"
