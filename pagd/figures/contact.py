"""Picture of a design's contact: gap between walls over pressure, and where walls touch."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pagd.figures.deformed import VIEW, Shapes, draw_triad
from pagd.figures.load import (
    States,
    Steps,
    has_blocked_force,
    has_blocked_states,
    load_blocked_force,
    load_blocked_states,
    load_history,
    load_records,
    load_states,
)
from pagd.figures.scene import Image, Sheet, Wire, render
from pagd.figures.style import (
    BASE,
    BLOCKED,
    FAINT,
    FREE,
    INK,
    kilopascals,
    new_figure,
    number,
    save,
)
from pagd.figures.touching import deformed_faces, touching_mm, touching_triangles

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["contact_figure", "draw_contact", "picture_of_touching"]

_TOUCHING = "#c4303f"
# Colour and line of an analysis.
_LOOKS = {"free": (FREE, "o-"), "held": (BLOCKED, "s-")}
# Inches: width of the curve's panel, and of the shape's; height of the picture, at most.
_CURVE, _SHAPE, _HEIGHT = 4.6, 6.4, 4.6


def draw_contact(design_folder: Path, out: Path) -> None:
    """Draw the contact of a design to a PNG file; InputError if it was not solved."""
    steps = {"free": load_history(design_folder)}
    states = {"free": load_states(design_folder)}
    if has_blocked_force(design_folder):
        steps["held"] = load_blocked_force(design_folder)
    if has_blocked_states(design_folder):
        states["held"] = load_blocked_states(design_folder)
    metrics = load_records(design_folder).get("metrics")
    first = metrics.figures.get("first_contact_pressure_kPa") if metrics else None
    save(contact_figure(design_folder.name, steps, states, first), out)


def contact_figure(
    heading: str,
    analyses: Mapping[str, Steps],
    states: Mapping[str, States],
    first_contact_kPa: float | None,
) -> Figure:
    """Return the picture: the gap over pressure on the left, the last shapes on the right.

    Parameters
    ----------
    heading
        Name of the design.
    analyses
        Steps with their gaps, by the name of the analysis: free, held.
    states
        Their states, the same way.
    first_contact_kPa
        Pressure at which walls first touch in free actuation; None where none do.
    """
    figure = new_figure(_CURVE + _SHAPE, _HEIGHT)
    width = _SHAPE / len(states)
    curve, *places = figure.subplots(
        1, 1 + len(states), width_ratios=[_CURVE, *(width for _ in states)]
    )
    _draw_gaps(curve, analyses, first_contact_kPa)
    for place, (name, kept) in zip(places, states.items(), strict=True):
        touches = _touches(analyses[name])
        image, area = picture_of_touching(kept, (225.0 * width, 225.0 * _HEIGHT), touches=touches)
        place.imshow(image)
        place.set_axis_off()
        there = f"{_told(area)} in contact" if touches else "no contact"
        title = f"{name}, {kilopascals(kept.pressure_kPa[-1])}: {there}"
        place.set_title(title, color=_LOOKS[name][0])
    figure.suptitle(f"{heading}: contact between walls", fontweight="bold")
    draw_triad(figure, VIEW, left=(_CURVE + 0.3) / (_CURVE + _SHAPE))
    return figure


def picture_of_touching(
    states: States, pixels: tuple[float, float], *, touches: bool
) -> tuple[Image, float]:
    """Return the last state, transparent, with what touches in red, and its area in mm².

    Whether anything `touches` is what the analysis says of its own gaps. `pixels` are the largest
    width and height. Touching walls are two, and their areas are added.
    """
    shapes = Shapes.of(states)
    points = shapes.points[-1]
    box = VIEW.box(points).widened(0.02)
    parts: list[Sheet | Wire] = [
        Sheet(points=points, triangles=shapes.triangles, colour=BASE, opacity=0.18),
        Wire(points=points, edges=shapes.edges, colour=FAINT),
    ]
    corners = _touching(states) if touches else np.zeros((0, 3, 3))
    if len(corners):
        where, triangles = corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)
        parts.insert(0, Sheet(points=where, triangles=triangles, colour=_TOUCHING, smooth=False))
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = float(np.linalg.norm(across, axis=1).sum() / 2.0)
    scale = min(pixels[0] / box.width, pixels[1] / box.height)
    return render(parts, VIEW, box, scale), area


def _touching(states: States) -> NDArray[np.float64]:
    """Return what touches (t, 3, 3) in the last state, of the surface that contact acts on."""
    return touching_triangles(deformed_faces(states.mesh, states.displacement[-1], ("outer",)))


def _touches(steps: Steps) -> bool:
    """Tell whether walls touch in the last recorded state."""
    gaps = steps.smallest_gap_mm[steps.recorded]
    return bool(len(gaps) and gaps[-1] < touching_mm())


def _told(area_mm2: float) -> str:
    return f"{number(area_mm2, 0)} mm²" if area_mm2 >= 0.5 else "less than 1 mm²"


def _draw_gaps(axes: Axes, analyses: Mapping[str, Steps], first_contact_kPa: float | None) -> None:
    axes.axhline(0.0, color=INK, linewidth=0.9)
    label = f"walls touch below {number(touching_mm(), 2)} mm"
    axes.axhline(touching_mm(), color=_TOUCHING, linewidth=0.9, linestyle=":", label=label)
    for name, steps in analyses.items():
        colour, line = _LOOKS[name]
        axes.plot(
            steps.pressure_kPa,
            steps.smallest_gap_mm,
            line,
            color=colour,
            markersize=3,
            label=name,
        )
    if first_contact_kPa is not None:
        label = f"first contact, free: {kilopascals(first_contact_kPa)}"
        axes.axvline(first_contact_kPa, color=_TOUCHING, linestyle="--", label=label)
    gaps = np.concatenate([steps.smallest_gap_mm for steps in analyses.values()])
    if not np.isfinite(gaps).any():
        axes.text(0.5, 0.5, "no two walls come near", transform=axes.transAxes, ha="center")
    axes.set_xlim(left=0.0)
    axes.set(title="smallest gap between walls", xlabel="pressure, kPa", ylabel="gap, mm")
    low, high = axes.get_ylim()
    axes.set_ylim(bottom=min(low, -0.05 * high))
    axes.legend(loc="best")
