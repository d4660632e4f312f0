"""What a card offers to take away: links to the files beside it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from pagd.figures.page.markup import escaped

__all__ = ["DESCRIPTIONS", "downloads"]

#: What the files are, in the order in which they are offered.
DESCRIPTIONS: Final = {
    "body.stl": "surface of the body above the paper, hollow, mm",
    "base.stl": "surface of the base below the paper, mm",
    "solids.step": "body and base as solids with plane faces, for CAD",
    "design.scad": "model with its parameters, for OpenSCAD",
    "mould_outside.stl": "mould around the chambers, to be filled upside down",
    "mould_core.stl": "core that leaves the air, to be pressed into it",
    "mould_base.stl": "tray for the base with the paper",
    "last_state.vtu": "mesh with displacement and strain at the last pressure, for ParaView",
    "trajectory.csv": "positions and angles of all sections at all pressures",
    "performance.csv": "bending, twist, force, work and strain at all pressures",
    "free_actuation.csv": "every step of the free actuation",
    "blocked_force.csv": "every step with the tip held",
}
_MB: Final = 1e6


def downloads(folder: Path) -> str:
    """Return links to those of the files that lie in a folder, seen from the card in it."""
    there = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
    found = [name for name in DESCRIPTIONS if name in there]
    items = "".join(
        f'<li><a href="{escaped(name)}" download>{escaped(name)}</a>'
        f" <small>{_size(folder / name)}</small> {escaped(DESCRIPTIONS[name])}</li>"
        for name in found
    )
    return f'<ul class="downloads">{items}</ul>' if items else ""


def _size(path: Path) -> str:
    size = path.stat().st_size
    return f"{size / _MB:.1f} MB" if size >= _MB / 10.0 else f"{max(size / 1e3, 0.1):.1f} kB"
