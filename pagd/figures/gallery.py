"""Picture of several designs side by side, each deformed at its highest pressure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from pagd.errors import InputError
from pagd.figures.deformed import VIEW, Shapes, add_strain_bar, draw_triad, strain_limit
from pagd.figures.load import has_states, has_trajectory, load_states, load_trajectory
from pagd.figures.scene import Box
from pagd.figures.style import new_figure, number, save

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["caption", "draw_gallery", "gallery_figure"]


def draw_gallery(design_folders: Sequence[Path], out: Path) -> None:
    """Draw the designs that were solved side by side to a PNG file.

    Raises
    ------
    InputError
        If none was.
    """
    solved = [folder for folder in design_folders if has_states(folder)]
    if not solved:
        raise InputError("None of the designs has deformed states to draw.")
    shapes = {folder.name: Shapes.of(load_states(folder)) for folder in solved}
    save(gallery_figure(shapes, {f.name: caption(f) for f in solved}), out)


def gallery_figure(shapes: Mapping[str, Shapes], captions: Mapping[str, str]) -> Figure:
    """Return the picture of designs by name, all on one scale and one colour bar."""
    boxes = [VIEW.box(shape.points[[0, -1]]).widened(0.02) for shape in shapes.values()]
    height = max(box.height for box in boxes)
    boxes = [Box(box.left, box.right, box.high - height, box.high) for box in boxes]
    width = sum(box.width for box in boxes)
    figure = new_figure(13.0, 13.0 * height / width + 1.2)
    panels = figure.subplots(
        1, len(boxes), squeeze=False, width_ratios=[box.width for box in boxes]
    )[0]
    top, scale = strain_limit(list(shapes.values())), 225.0 * 13.0 / width
    for axes, box, (name, shape) in zip(panels, boxes, shapes.items(), strict=True):
        axes.imshow(shape.ghost(VIEW, box, scale))
        axes.imshow(shape.picture(len(shape.points) - 1, VIEW, box, scale, top))
        axes.set_axis_off()
        axes.set_title(f"{name}, {shape.pressure_kPa[-1]:g} kPa", pad=18)
        axes.text(0.0, 1.02, captions[name], transform=axes.transAxes, va="bottom")
    add_strain_bar(figure, list(panels), top)
    draw_triad(figure, VIEW)
    return figure


def caption(folder: Path) -> str:
    """Return bending and twist of the tip at the highest pressure, or nothing."""
    if not has_trajectory(folder):
        return ""
    path = load_trajectory(folder)
    bending, twist = (number(a[-1, -1], 0) for a in (path.bending_deg, path.twist_deg))
    return f"bends {bending}°, twists {twist}°"
