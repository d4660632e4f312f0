"""The deformed designs side by side as a small SVG: shaded triangles, back to front.

A picture that is text can be kept under version control; the README shows this one.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from matplotlib.colors import to_hex
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.figures.deformed import VIEW
from pagd.figures.groups import read_entries
from pagd.figures.load import States, has_states, load_states
from pagd.figures.style import FAINT, STRAIN_MAP, kilopascals
from pagd.figures.surface import skin_of
from pagd.files import write_text

FloatArray = NDArray[np.float64]

__all__ = ["draw_side_by_side"]


_LIGHT = np.array([-0.3, -0.6, 0.75])
_MARGIN, _CAPTION = 6.0, 9.0


def draw_side_by_side(design_folders: Sequence[Path], out: Path) -> None:
    """Draw solved designs at their last pressure to one SVG file, on one scale.

    Those of Table 2 if there are any, or all. Colours are the strain, as in the other pictures.
    Raises ``InputError`` if no design was solved.
    """
    entries = [entry for entry in read_entries(design_folders) if has_states(entry.folder)]
    if not entries:
        raise InputError("None of the designs has deformed states to draw.")
    examples = [entry for entry in entries if entry.origin == "table2"] or entries
    solved = {entry.name: load_states(entry.folder) for entry in examples}
    top = max(float(np.percentile(states.strain[-1], 99.0)) for states in solved.values())
    panels = [_triangles(states, top) for states in solved.values()]
    captions = [
        f"{name}, {kilopascals(states.pressure_kPa[-1])}" for name, states in solved.items()
    ]
    write_text(out, _svg(panels, captions))


def _triangles(states: States, top: float) -> tuple[FloatArray, list[str]]:
    """Images (t, 3, 2) of the triangles that face the eye, back to front, and their colours."""
    skin = skin_of(states.mesh, corners_only=True)
    points = skin.vectors(states.mesh.points) + skin.vectors(states.displacement[-1])
    corners = points[skin.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    strain = skin.scalars(states.strain[-1])[skin.triangles].mean(axis=1)
    seen = np.flatnonzero(normals @ VIEW.eye > 0)
    order = seen[np.argsort(corners[seen].mean(axis=1) @ VIEW.eye)]
    brightness = 0.62 + 0.38 * np.clip(normals[order] @ (_LIGHT / np.linalg.norm(_LIGHT)), 0, 1)
    colours = STRAIN_MAP(np.clip(strain[order] / top, 0, 1))[:, :3] * brightness[:, None]
    images = VIEW.project(corners[order]) * [1, -1]
    return images, [to_hex(c) for c in colours]


def _svg(panels: Sequence[tuple[FloatArray, list[str]]], captions: Sequence[str]) -> str:
    lows = [images.min(axis=(0, 1)) for images, _ in panels]
    highs = [images.max(axis=(0, 1)) for images, _ in panels]
    height = max(float((high - low)[1]) for low, high in zip(lows, highs, strict=True))
    parts, left = [], _MARGIN
    for (images, colours), low, high, caption in zip(panels, lows, highs, captions, strict=True):
        shift = np.array([left, _MARGIN]) - low
        parts.append(_group(images + shift, colours))
        width = float((high - low)[0])
        parts.append(
            f'<text x="{left + width / 2:.1f}" y="{height + _MARGIN + _CAPTION:.1f}">'
            f"{escape(caption)}</text>\n"
        )
        left += width + 2 * _MARGIN
    size = f"{left - _MARGIN:.0f} {height + 2 * _MARGIN + _CAPTION:.0f}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" font-size="6" '
        f'font-family="sans-serif" text-anchor="middle" fill="{FAINT}">\n{"".join(parts)}</svg>\n'
    )


def _group(images: FloatArray, colours: Sequence[str]) -> str:
    """The triangles of one design; a thin line of their own colour closes the seams."""
    corners = (" ".join(f"{x:.1f},{y:.1f}" for x, y in triangle) for triangle in images)
    rows = (
        f'<polygon color="{colour}" points="{points}"/>'
        for colour, points in zip(colours, corners, strict=True)
    )
    return (
        '<g fill="currentColor" stroke="currentColor" stroke-width=".2" stroke-linejoin="round">\n'
        + "\n".join(rows)
        + "\n</g>\n"
    )
