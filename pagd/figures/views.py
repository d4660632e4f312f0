"""Plan and side view of a design: where they are cut, and what they are called."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pyvista as pv

from pagd.families import Actuator, PneuNet
from pagd.figures.outline import draw_section

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw_plan", "draw_side"]

# A pneu-net is cut near the roof of its cavities, above the channel; others half-way up.
_OF_CAVITY: Final = 0.85
_OF_BODY: Final = 0.5


def draw_plan(
    axes: Axes, body: pv.PolyData, base: pv.PolyData, design: Actuator | None, told: str = ""
) -> None:
    """Draw the plan of a body and a base (mm), with its title.

    Parameters
    ----------
    axes
        Where to draw it.
    body, base
        Closed surfaces above and below the plane of the paper (mm).
    design
        The design that they are of; None of surfaces of one's own.
    told
        What the title says besides.
    """
    draw_section(axes, body, base, 2, _level(body, design))
    if isinstance(design, PneuNet):
        one = design.design
        slant = "" if one.is_straight else f", θ = {one.theta:g}°"
        title = f"plan, through the chambers{slant}"
    else:
        title = "plan, half-way up the body"
    axes.set_title(title + told)


def draw_side(
    axes: Axes, body: pv.PolyData, base: pv.PolyData, design: Actuator | None, told: str = ""
) -> None:
    """Draw the side view, cut in the middle; the parameters are those of :func:`draw_plan`."""
    draw_section(axes, body, base, 1, 0.0)
    where = "through the air channel" if isinstance(design, PneuNet) else "in the middle"
    axes.set_title(f"side view, {where}{told}")
    axes.set_xlabel("x, mm")


def _level(body: pv.PolyData, design: Actuator | None) -> float:
    """Return the height z (mm) at which the plan is cut."""
    if isinstance(design, PneuNet):
        return _OF_CAVITY * (design.design.H - design.design.t_h)
    return _OF_BODY * (body.bounds[4] + body.bounds[5])
