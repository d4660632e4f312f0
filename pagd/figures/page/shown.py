"""The figures of a design that the page shows: headings, units and digits, in their order."""

from __future__ import annotations

from typing import Any, Final, NamedTuple

from pagd.figures.style import number

__all__ = ["FIGURES", "Shown"]


class Shown(NamedTuple):
    """A figure: heading, unit, key of the rows, digits behind the point; none where it is text."""

    heading: str
    unit: str
    key: str
    digits: int | None = None
    factor: float = 1.0

    def in_words(self, value: Any) -> str:
        """Return a value with its unit as people read it."""
        if self.digits is None:
            return str(value).replace("_", " ")
        unit = f"{'' if self.unit == '°' else ' '}{self.unit}" if self.unit else ""
        return number(self.factor * float(value), self.digits) + unit


#: Of all designs, in the explorer and on the cards.
FIGURES: Final = (
    Shown("design", "", "design_id"),
    Shown("status", "", "status"),
    Shown("analysis", "", "analysis"),
    Shown("origin", "", "origin"),
    Shown("drawn for", "", "mode"),
    Shown("measured mode", "", "measured_mode"),
    Shown("novelty", "", "novelty", 2),
    Shown("pressure", "kPa", "pressure_kPa", 0),
    Shown("bending", "°", "bending_deg", 1),
    Shown("twist", "°", "twist_deg", 1),
    Shown("blocked force", "N", "blocked_force_N", 3),
    Shown("tip held up to", "kPa", "blocked_force_pressure_kPa", 1),
    Shown("tip x", "mm", "tip_x_mm", 1),
    Shown("tip y", "mm", "tip_y_mm", 1),
    Shown("tip z", "mm", "tip_z_mm", 1),
    Shown("first contact", "kPa", "first_contact_pressure_kPa", 1),
    Shown("penetration", "mm", "deepest_penetration_mm", 3),
    Shown("work", "mJ", "work_mJ", 1),
    Shown("work density", "kJ/m³", "work_density_kJ_m3", 2),
    Shown("strain, 99th percentile", "", "strain_p99", 3),
    Shown("energy balance", "%", "energy_balance", 2, 100.0),
    Shown("mesh size", "mm", "size_mm", 1),
    Shown("tetrahedra", "", "tets", 0),
    Shown("iterations", "", "newton_iterations", 0),
    Shown("time", "s", "wall_s", 1),
    Shown("material", "", "material"),
    Shown("why", "", "reason"),
)
