"""One row a simulated design: what its records and the summary of the run know of it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pagd.figures.groups import Entry
from pagd.figures.load import contact_setting

__all__ = ["Row", "rows_of"]

Row = Mapping[str, Any]


def rows_of(entries: Iterable[Entry], performance: Sequence[Row]) -> list[dict[str, Any]]:
    """Return the figures of all simulated designs, in the order of the summary.

    Designs that the summary does not have come first; those without a folder here have no
    ``link``. Keys beyond the figures: ``design_id``, ``origin``, ``mode``, ``status``, ``link``,
    and ``contact``, whether it was on; None where no record tells.
    """
    found = {entry.name: _of(entry) for entry in entries}
    summary = {str(row["design_id"]): _without_nulls(row) for row in performance}
    unlisted = [name for name in found if name not in summary]
    return [
        {"design_id": name, "link": False, **found.get(name, {}), **summary.get(name, {})}
        for name in (*unlisted, *summary)
    ]


def _of(entry: Entry) -> dict[str, Any]:
    status = entry.record.status.value if entry.record else "not run"
    known = {"origin": entry.origin, "mode": entry.mode, "status": status, "link": True}
    return {**entry.figures, **known, "contact": contact_setting(entry.folder)}


def _without_nulls(row: Row) -> dict[str, Any]:
    return {key: value for key, value in row.items() if value is not None}
