"""Picture of many designs in rows, each deformed at the last pressure it reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from pagd.errors import InputError
from pagd.figures.deformed import VIEW, Shapes, draw_triad, strain_limit
from pagd.figures.groups import FEW, Entry, by_mode, read_entries
from pagd.figures.load import has_states, has_trajectory, load_states, load_trajectory
from pagd.figures.scene import Box
from pagd.figures.style import (
    INK,
    STRAIN_LABEL,
    STRAIN_MAP,
    kilopascals,
    mode_look,
    new_figure,
    number,
    save,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["Tile", "caption", "draw_gallery", "gallery_figure", "rows_of"]

# Inches: width of the picture, least width of a tile, margin, height of a line of its
# caption, of a heading, and of the foot with the colour bar.
_WIDTH, _TILE, _MARGIN, _LINE, _HEADING, _FOOT = 13.0, 2.1, 0.1, 0.17, 0.3, 1.0
_FAILED = "#b3362c"
# Letters of a name that a tile has room for.
_LONGEST = 26
# Designs in a row, and inches on paper for a millimetre of a design, at most.
_IN_A_ROW, _LARGEST = 6, 0.06
# Of many designs a few may strain beyond the colour bar, or all others would look unstrained.
_SHARE_ON_BAR = 90.0
_PIXELS_PER_INCH = 225.0


@dataclass(frozen=True, eq=False, slots=True)
class Tile:
    """One design of the gallery: its shapes and the lines above it; status only of a failure."""

    shapes: Shapes
    title: str
    caption: str
    status: str = ""

    @property
    def box(self) -> Box:
        """What the tile shows of the screen: the shape before and after."""
        return VIEW.box(self.shapes.points[[0, -1]]).widened(0.02)


def draw_gallery(design_folders: Sequence[Path], out: Path) -> None:
    """Draw the designs that have deformed states to a PNG file, in rows by mode if many.

    Raises
    ------
    InputError
        If none has.
    """
    solved = [entry for entry in read_entries(design_folders) if has_states(entry.folder)]
    if not solved:
        raise InputError("None of the designs has deformed states to draw.")
    save(gallery_figure(rows_of(solved)), out)


def rows_of(entries: Sequence[Entry]) -> list[tuple[str, list[Tile]]]:
    """Return the rows: heading and tiles. A few designs share one row without a heading."""
    if len(entries) <= FEW:
        return [("", [_tile(entry) for entry in entries])]
    rows = []
    for mode, group in by_mode(entries).items():
        tiles = [_tile(entry) for entry in group]
        parts = np.array_split(np.arange(len(tiles)), -(-len(tiles) // _IN_A_ROW))
        for i, part in enumerate(parts):
            rows.append((mode if i == 0 else "", [tiles[k] for k in part]))
    return rows


def gallery_figure(rows: Sequence[tuple[str, Sequence[Tile]]]) -> Figure:
    """Return the picture of the rows, all designs on one scale and one colour bar."""
    scale = _scale([[tile.box.width for tile in tiles] for _, tiles in rows])
    heights = [_row_height(heading, tiles, scale) for heading, tiles in rows]
    figure = new_figure(_WIDTH, sum(heights) + _FOOT)
    figure.set_layout_engine("none")
    top = _strain_top([tile.shapes for _, tiles in rows for tile in tiles])
    upper = float(figure.get_figheight())
    for (heading, tiles), height in zip(rows, heights, strict=True):
        _draw_row(figure, heading, tiles, upper, scale, top)
        upper -= height
    _add_bar(figure, top)
    draw_triad(figure, VIEW, height=min(0.8 / sum(heights), 0.1))
    return figure


def caption(folder: Path) -> str:
    """Return bending and twist of the tip at the last pressure, or nothing."""
    if not has_trajectory(folder):
        return ""
    path = load_trajectory(folder)
    bending, twist = (number(a[-1, -1], 0) for a in (path.bending_deg, path.twist_deg))
    return f"bends {bending}°, twists {twist}°"


def _tile(entry: Entry) -> Tile:
    shapes = Shapes.of(load_states(entry.folder))
    turned = caption(entry.folder)
    reached = ": ".join(filter(None, (kilopascals(shapes.pressure_kPa[-1]), turned)))
    name = entry.name if len(entry.name) <= _LONGEST else f"{entry.name[: _LONGEST - 1]}…"
    return Tile(shapes, name, reached, "" if entry.is_ok else entry.status)


def _scale(widths: Sequence[Sequence[float]]) -> float:
    """Return the inches a millimetre of a design gets, so that the fullest row fits.

    A tile is as wide as its design, or as its caption.
    """

    def fits(scale: float) -> bool:
        return all(sum(_tile_width(w, scale) for w in row) <= _WIDTH + 1e-9 for row in widths)

    low, high = 0.0, _LARGEST
    if fits(high):
        return high
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def _tile_width(width_mm: float, scale: float) -> float:
    return max(_TILE, scale * width_mm)


def _row_height(heading: str, tiles: Sequence[Tile], scale: float) -> float:
    tallest = max(tile.box.height for tile in tiles)
    return scale * tallest + _caption_height(tiles) + (_HEADING if heading else 0.0)


def _caption_height(tiles: Sequence[Tile]) -> float:
    lines = 3 if any(tile.status for tile in tiles) else 2
    return lines * _LINE + 2 * _MARGIN


def _draw_row(
    figure: Figure,
    heading: str,
    tiles: Sequence[Tile],
    upper: float,
    scale: float,
    top: float,
) -> None:
    """Draw one row; `upper` is its upper edge in inches from the foot of the picture."""
    height = float(figure.get_figheight())
    if heading:
        place = (0.01, (upper - 0.1) / height)
        colour = mode_look(heading).colour
        figure.text(*place, heading, color=colour, fontsize=13, fontweight="bold", va="top")
        upper -= _HEADING
    left, below = 0.0, upper - _caption_height(tiles)
    for tile in tiles:
        _write_caption(figure, tile, left, upper)
        _draw_tile(figure, tile, left, below, scale, top)
        left += _tile_width(tile.box.width, scale)


def _draw_tile(
    figure: Figure, tile: Tile, left: float, upper: float, scale: float, top: float
) -> None:
    """Draw one design; `left` and `upper` are its corner in inches."""
    height, pixels = float(figure.get_figheight()), scale * _PIXELS_PER_INCH
    size = scale * tile.box.width, scale * tile.box.height
    corner = left / _WIDTH, (upper - size[1]) / height
    axes = figure.add_axes((*corner, size[0] / _WIDTH, size[1] / height))
    last = len(tile.shapes.points) - 1
    axes.imshow(tile.shapes.ghost(VIEW, tile.box, pixels), aspect="auto")
    axes.imshow(tile.shapes.picture(last, VIEW, tile.box, pixels, top), aspect="auto")
    axes.set_axis_off()


def _write_caption(figure: Figure, tile: Tile, left: float, upper: float) -> None:
    looks: tuple[dict[str, Any], ...] = (
        {"fontweight": "bold"},
        {"fontsize": 8.5},
        {"fontsize": 8.5, "color": _FAILED},
    )
    texts = (tile.title, tile.caption, tile.status)
    for i, (text, look) in enumerate(zip(texts, looks, strict=True)):
        line = upper - _MARGIN - _LINE * i
        place = (left + _MARGIN) / _WIDTH, line / float(figure.get_figheight())
        if text:
            figure.text(*place, text, va="top", **look)


def _strain_top(designs: Sequence[Shapes]) -> float:
    """Return the top of the colour bar, which one design in ten may pass if there are many."""
    if len(designs) <= FEW:
        return strain_limit(designs)
    return float(np.percentile([strain_limit([shapes]) for shapes in designs], _SHARE_ON_BAR))


def _add_bar(figure: Figure, top: float) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    height = float(figure.get_figheight())
    axes = figure.add_axes((0.3, 0.55 / height, 0.4, 0.14 / height))
    paint = ScalarMappable(Normalize(0.0, top), STRAIN_MAP)
    bar = figure.colorbar(paint, cax=axes, orientation="horizontal", extend="max")
    bar.set_label(STRAIN_LABEL)
    bar.outline.set_edgecolor(INK)
