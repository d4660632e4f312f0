"""How the pictures look: colours, type, and the one way they are saved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from matplotlib import style
from matplotlib.colors import LinearSegmentedColormap

from pagd.files import replaced_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "BASE",
    "BLOCKED",
    "CAVITY",
    "CUT",
    "ELASTOMER",
    "FAINT",
    "FREE",
    "INK",
    "MODE_LOOKS",
    "ORIGIN_COLOURS",
    "PAPER",
    "PRESSURE_MAP",
    "STATUS_COLOURS",
    "STRAIN_COLOURS",
    "STRAIN_LABEL",
    "STRAIN_MAP",
    "Look",
    "design_colours",
    "kilopascals",
    "mode_look",
    "new_figure",
    "number",
    "origin_colour",
    "origin_name",
    "save",
    "set_resolution",
]

INK = "#1d2733"
FAINT = "#8a94a0"
ELASTOMER = "#a9cbe0"
BASE = "#7fa6c4"
CUT = "#5f8db3"
CAVITY = "#f6e3c5"
PAPER = "#f0b429"
# From cream, like the unstrained elastomer, to dark: lightness falls steadily, so that the map
# also reads in grey, and shading stays visible on its light half.
STRAIN_COLOURS = ("#f3ecdc", "#f7cf86", "#f0863f", "#c4303f", "#64123f")
STRAIN_MAP = LinearSegmentedColormap.from_list("strain", STRAIN_COLOURS)
PRESSURE_MAP = "viridis"
# The two analyses of a design: free actuation, and with a held tip.
FREE, BLOCKED = "#0072b2", "#d55e00"
STRAIN_LABEL = "largest principal logarithmic strain"

# Okabe and Ito's colours, which also readers with a colour deficiency tell apart.
_CYCLE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")


class Look(NamedTuple):
    """How the points of one group look; groups differ in shape as well as in colour."""

    colour: str
    marker: str


# Of Okabe and Ito's colours the three that lie farthest apart for every kind of sight, each with a
# shape of its own.
MODE_LOOKS: Final = {
    "bending": Look("#0072b2", "o"),
    "twisting": Look("#d55e00", "^"),
    "mixed": Look("#cc79a7", "D"),
}
_OTHER_MODE = Look("#8a94a0", "X")

ORIGIN_COLOURS: Final = {
    "random": "#b9c2cb",
    "jitter": "#e69f00",
    "interpolation": "#0072b2",
    "published": "#1d2733",
    "table2": "#d55e00",
    "generated": "#56b4e9",
}
_OTHER_ORIGIN = "#cc79a7"

# What went well stays quiet; every way to fail has its colour, from early stages (dark) to late.
STATUS_COLOURS: Final = {
    "ok": "#cfd8e0",
    "no_actuation": "#f0e442",
    "bending_limit": "#56b4e9",
    "self_collision": "#e69f00",
    "overstretched": "#d55e00",
    "buckled": "#cc79a7",
    "not_converged": "#8c6d31",
    "timed_out": "#b5912f",
    "out_of_memory": "#7f2a3c",
    "crashed": "#e0218a",
    "mesh_failed": "#6b4c9a",
    "invalid_geometry": "#1d2733",
}

_LOOK: dict[str, Any] = {
    # The second is for vector pictures, where DejaVu is not installed.
    "font.family": ["DejaVu Sans", "sans-serif"],
    "font.size": 9.0,
    "text.color": INK,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e3e7eb",
    "grid.linewidth": 0.7,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "figure.facecolor": "white",
    "savefig.dpi": 150,
}


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of `width` × `height` inches, without any display behind it."""
    from matplotlib.figure import Figure

    style.use(_LOOK)
    return Figure(figsize=(width, height), layout="constrained")


def set_resolution(dots_per_inch: int) -> None:
    """Set the resolution of the pictures that are made from now on."""
    _LOOK["savefig.dpi"] = dots_per_inch


def save(figure: Figure, out: Path) -> None:
    """Write a figure as PNG; the file appears complete or not at all.

    Neither date nor program name goes in, so that equal pictures are equal files.
    """
    with replaced_file(out) as temporary:
        figure.savefig(temporary, format="png", metadata={"Software": None})


def design_colours(names: Sequence[str]) -> dict[str, str]:
    """Return a colour a design, in their order."""
    return {name: _CYCLE[i % len(_CYCLE)] for i, name in enumerate(names)}


def mode_look(mode: str) -> Look:
    """Return colour and marker of a mode; a mode without any of its own gets a grey cross."""
    return MODE_LOOKS.get(mode, _OTHER_MODE)


def origin_colour(origin: str) -> str:
    """Return the colour of an origin; one that has none of its own gets green."""
    return ORIGIN_COLOURS.get(origin, _OTHER_ORIGIN)


def origin_name(origin: str) -> str:
    """Return an origin as people read it."""
    return {"table2": "Table 2"}.get(origin, origin)


def kilopascals(pressure_kPa: float) -> str:
    """Return a pressure with its unit, to four significant digits.

    >>> kilopascals(45.9116)
    '45.91 kPa'
    """
    return f"{float(f'{pressure_kPa:.4g}'):g} kPa"


def number(value: float, digits: int) -> str:
    """Return a number as people read it: rounded, grouped by thousands, zero without a sign."""
    return f"{round(value, digits) + 0.0:,.{digits}f}".replace("-", "−")
