"""Picture of a design's blocked force over pressure, and of its shape with and without support."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from pagd.figures.captions import SUPPORTS
from pagd.figures.deformed import VIEW, Shapes, add_strain_bar, draw_triad, strain_limit
from pagd.figures.load import (
    Steps,
    has_blocked_states,
    load_blocked_force,
    load_blocked_states,
    load_records,
    load_states,
)
from pagd.figures.scene import Box
from pagd.figures.style import BLOCKED, FREE, INK, kilopascals, new_figure, number, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Blocked", "Pair", "blocked_force_figure", "draw_blocked_force"]

# Inches: width of the curve's panel, of a shape's, and height of the picture.
_CURVE, _SHAPE, _HEIGHT = 4.2, 3.4, 4.6


@dataclass(frozen=True, eq=False, slots=True)
class Blocked:
    """The analysis with a held tip: its steps, what held it, how it ended, and why if early."""

    steps: Steps
    variant: str
    status: str
    reason: str | None

    @classmethod
    def of(cls, steps: Steps, figures: Mapping[str, Any]) -> Self:
        """Return it from its steps and the figures of the solve record."""
        told = figures.get("blocked_force") or {}
        return cls(
            steps,
            str(told.get("variant", "")),
            str(told.get("status", "ok")).replace("_", " "),
            told.get("reason"),
        )

    @property
    def held(self) -> str:
        """What holds the actuator, in words."""
        return SUPPORTS.get(self.variant, self.variant)


@dataclass(frozen=True, eq=False, slots=True)
class Pair:
    """Shapes of one design, free and with a held tip, as near in pressure as they were kept."""

    free: Shapes
    blocked: Shapes

    @property
    def state(self) -> int:
        """The free state whose pressure is nearest to the last one with a held tip."""
        return int(np.abs(self.free.pressure_kPa - self.blocked.pressure_kPa[-1]).argmin())

    @property
    def box(self) -> Box:
        """What both pictures show of the screen."""
        points = np.vstack(
            [self.free.points[self.state], self.blocked.points[[0, -1]].reshape(-1, 3)]
        )
        return VIEW.box(points).widened(0.02)


def draw_blocked_force(design_folder: Path, out: Path) -> None:
    """Draw the blocked force of a design to a PNG file; InputError if there is none."""
    record = load_records(design_folder).get("solve")
    analysis = Blocked.of(load_blocked_force(design_folder), record.figures if record else {})
    pair = None
    if has_blocked_states(design_folder):
        free, blocked = load_states(design_folder), load_blocked_states(design_folder)
        pair = Pair(Shapes.of(free), Shapes.of(blocked))
    save(blocked_force_figure(design_folder.name, analysis, pair), out)


def blocked_force_figure(title: str, analysis: Blocked, pair: Pair | None = None) -> Figure:
    """Return the picture: the force over pressure, and the shapes with and without support."""
    figure = new_figure(_CURVE + (2.0 * _SHAPE if pair else 0.0), _HEIGHT)
    if pair is None:
        _draw_curve(figure.add_subplot(), analysis)
    else:
        widths = [_CURVE, _SHAPE, _SHAPE]
        curve, *places = figure.subplots(1, 3, width_ratios=widths)
        _draw_curve(curve, analysis)
        _draw_pair(figure, places, pair)
    held = f", {analysis.held}" if analysis.held else ""
    figure.suptitle(f"{title}: blocked force{held}", fontweight="bold")
    return figure


def _draw_curve(axes: Axes, analysis: Blocked) -> None:
    pressure, force = analysis.steps.forces
    axes.axhline(0.0, color=INK, linewidth=0.9)
    axes.plot(pressure, force, ".-", color=BLOCKED, linewidth=1.4, markersize=3.0)
    pressures, forces = analysis.steps.recorded_forces
    axes.plot(pressures, forces, "o", color=BLOCKED, markersize=5.0)
    last = float(pressures[-1]), float(forces[-1])
    end = f"{number(last[1], 3)} N at {kilopascals(last[0])}"
    early = "" if analysis.status == "ok" else f"\nended there: {analysis.status}"
    axes.annotate(
        end + early,
        last,
        xytext=(0.04, 0.96),
        textcoords="axes fraction",
        va="top",
        color=BLOCKED,
    )
    axes.set_xlim(left=0.0)
    axes.set(title="force on the support", xlabel="pressure, kPa", ylabel="blocked force, N")
    low, high = float(force.min()), float(force.max())
    axes.set_ylim(low - 0.05 * (high - low), high + 0.25 * (high - low) or 1.0)


def _draw_pair(figure: Figure, places: list[Axes], pair: Pair) -> None:
    top = strain_limit([pair.free, pair.blocked])
    box = pair.box
    scale = 225.0 * min(_SHAPE / box.width, _HEIGHT / box.height)
    for axes, name, shapes, state in (
        (places[0], "free", pair.free, pair.state),
        (places[1], "held", pair.blocked, len(pair.blocked.points) - 1),
    ):
        axes.imshow(shapes.ghost(VIEW, box, scale))
        axes.imshow(shapes.picture(state, VIEW, box, scale, top))
        colour = FREE if name == "free" else BLOCKED
        axes.set_title(f"{name}, {kilopascals(shapes.pressure_kPa[state])}", color=colour)
        axes.set_axis_off()
    add_strain_bar(figure, places, top)
    draw_triad(figure, VIEW, left=_CURVE / (_CURVE + 2.0 * _SHAPE))
