"""The table of all simulated designs: every column can be sorted by, all rows filtered."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final, NamedTuple

from pagd.figures.page.markup import badge, escaped
from pagd.figures.page.rows import Row
from pagd.figures.style import number

__all__ = ["results_table"]


class _Column(NamedTuple):
    heading: str
    unit: str
    key: str
    write: Callable[[Any], str]


def _number(digits: int, factor: float = 1.0) -> Callable[[Any], str]:
    return lambda value: number(factor * value, digits)


_COLUMNS: Final = (
    _Column("origin", "", "origin", str),
    _Column("drawn for", "", "mode", str),
    _Column("measured mode", "", "measured_mode", str),
    _Column("novelty", "", "novelty", _number(2)),
    _Column("pressure", "kPa", "pressure_kPa", _number(0)),
    _Column("bending", "°", "bending_deg", _number(1)),
    _Column("twist", "°", "twist_deg", _number(1)),
    _Column("blocked force", "N", "blocked_force_N", _number(3)),
    _Column("of the tip held to", "kPa", "blocked_force_pressure_kPa", _number(1)),
    _Column("tip x", "mm", "tip_x_mm", _number(1)),
    _Column("tip y", "mm", "tip_y_mm", _number(1)),
    _Column("tip z", "mm", "tip_z_mm", _number(1)),
    _Column("first contact", "kPa", "first_contact_pressure_kPa", _number(1)),
    _Column("penetration", "mm", "deepest_penetration_mm", _number(3)),
    _Column("work density", "kJ/m³", "work_density_kJ_m3", _number(2)),
    _Column("energy balance", "%", "energy_balance", _number(2, 100.0)),
    _Column("strain", "99 %", "strain_p99", _number(3)),
    _Column("mesh size", "mm", "size_mm", str),
    _Column("tetrahedra", "", "tets", _number(0)),
    _Column("iterations", "", "newton_iterations", _number(0)),
    _Column("time", "s", "wall_s", _number(1)),
    _Column("material", "", "material", str),
)

# What is not known of a design without contact; that it was off is told instead.
_OF_CONTACT: Final = ("first_contact_pressure_kPa", "deepest_penetration_mm")

# More rows than these scroll in a box of their own.
_MOST: Final = 20

_FILTER = """
<div class="filter">
  <label>
    Filter <input type="search" placeholder="mixed generated ok" data-filters="results">
  </label>
  <output data-count="results"></output>
</div>
"""


def results_table(rows: Sequence[Row]) -> str:
    """Return the table as markup; a column of which no design knows anything is left out."""
    columns = [c for c in _COLUMNS if any(row.get(c.key) is not None for row in rows)]
    head = "".join(_heading(c.heading, c.unit) for c in columns)
    head = f"{_heading('design', '')}{_heading('status', '')}{head}"
    body = "\n".join(_row(row, columns) for row in rows)
    box = "scroll tall" if len(rows) > _MOST else "scroll"
    return (
        f'{_FILTER}<div class="{box}"><table class="sortable" id="results"><thead><tr>{head}'
        f"</tr></thead><tbody>{body}</tbody></table></div>"
    )


def _heading(name: str, unit: str) -> str:
    small = f"<small>{escaped(unit)}</small>"
    return f'<th scope="col"><button type="button">{escaped(name)}<br>{small}</button></th>'


def _row(row: Row, columns: Iterable[_Column]) -> str:
    name, status = escaped(row["design_id"]), str(row["status"])
    first = f'<a href="#design-{name}">{name}</a>' if row["link"] else name
    word = badge(status.replace("_", " "), ok=status == "ok")
    cells = "".join(_cell(row, column) for column in columns)
    return f"<tr><th>{first}</th><td>{word}</td>{cells}</tr>"


def _cell(row: Row, column: _Column) -> str:
    value = row.get(column.key)
    if value is None:
        off = column.key in _OF_CONTACT and row.get("contact") is False
        return "<td>off</td>" if off else "<td>–</td>"
    order = f' data-order="{value:.6g}"' if isinstance(value, (int, float)) else ""
    return f"<td{order}>{escaped(column.write(value))}</td>"
