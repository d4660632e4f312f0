"""One design as a notebook shows it: a picture, and the figures that people ask for first."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib import rc_context

from pagd.figures.deformed import Shapes, deformed_figure
from pagd.figures.geometry import read_geometry_figure
from pagd.figures.load import has_states, load_states, stl_paths
from pagd.figures.style import kilopascals, number
from pagd.record import Record

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["picture_of", "short_table"]

# Enough for a screen; notebooks keep the pictures that they show.
_DPI = 100


def picture_of(folder: Path) -> bytes | None:
    """Return a picture of a design's folder as PNG; None where there is nothing to draw.

    Its deformed shapes, or the geometry of one that was not solved; as the stage figures has drawn
    them, or drawn now.
    """
    for name in ("deformed", "geometry"):
        path = folder / "figures" / f"{name}.png"
        if path.is_file():
            return path.read_bytes()
    # The look of our pictures is not to become that of others in the same process.
    with rc_context():
        if has_states(folder):
            return _as_png(deformed_figure(folder.name, Shapes.of(load_states(folder))))
        if stl_paths(folder):
            return _as_png(read_geometry_figure(folder))
    return None


def _as_png(figure: Figure) -> bytes:
    target = io.BytesIO()
    figure.savefig(target, format="png", dpi=_DPI, metadata={"Software": None})
    return target.getvalue()


def short_table(record: Record) -> dict[str, str]:
    """Return the figures of a design that people ask for first, as text by their names.

    Parameters
    ----------
    record
        That of the stage metrics. What it does not have is left out.
    """
    figures = record.figures
    rows: dict[str, str | None] = {
        "design": record.design_id,
        "status": record.status.value,
        "reason": record.reason,
        "material": figures.get("material"),
        "pressure": _pressure(figures.get("pressure_kPa")),
        "bending": _with_unit(figures.get("bending_deg"), 1, "°"),
        "twist": _with_unit(figures.get("twist_deg"), 1, "°"),
        "tip x, y, z": _tip(figures),
        "blocked force": _force(figures),
        "first contact": _pressure(figures.get("first_contact_pressure_kPa")),
        "work": _with_unit(figures.get("work_mJ"), 2, " mJ"),
        "strain, 99 % of the nodes below": _with_unit(figures.get("strain_p99"), 3, ""),
        "energy balance": _percent(figures.get("energy_balance")),
        "time": _with_unit(figures.get("wall_s"), 1, " s"),
    }
    return {label: value for label, value in rows.items() if value is not None}


def _with_unit(value: float | None, digits: int, unit: str) -> str | None:
    return None if value is None else f"{number(value, digits)}{unit}"


def _percent(share: float | None) -> str | None:
    return None if share is None else _with_unit(100.0 * share, 2, " %")


def _pressure(value: float | None) -> str | None:
    return None if value is None else kilopascals(value)


def _tip(figures: dict[str, Any]) -> str | None:
    places = [figures.get(f"tip_{axis}_mm") for axis in "xyz"]
    known = [number(place, 1) for place in places if place is not None]
    return f"{', '.join(known)} mm" if len(known) == len(places) else None


def _force(figures: dict[str, Any]) -> str | None:
    """Return the blocked force, with the pressure that it is of and what ended its analysis."""
    force = _with_unit(figures.get("blocked_force_N"), 3, " N")
    if force is None:
        return None
    at, status = figures.get("blocked_force_pressure_kPa"), figures.get("blocked_force_status")
    told = force if at is None else f"{force} at {kilopascals(at)}"
    return told if status in (None, "ok") else f"{told} ({status})"
