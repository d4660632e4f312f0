"""All designs together: one row a design, whatever became of it, and what was measured of all."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pagd.files import write_text
from pagd.record import Record, read_record
from pagd.tables import (
    CHAMBERS,
    MEASURES,
    PERFORMANCE,
    TRAJECTORY,
    Column,
    concatenate,
    write_rows,
)

__all__ = ["FOR_PEOPLE", "GATHERED", "performance_row", "write_gathered", "write_summary"]

#: Tables of all designs, the rows of which every design has in a table of its own: file of the
#: summary, file in a folder of the stage metrics, columns.
GATHERED: tuple[tuple[str, str, tuple[Column, ...]], ...] = (
    ("by_pressure.parquet", "performance.parquet", MEASURES),
    ("trajectories.parquet", "trajectory.parquet", TRAJECTORY),
    ("chambers.parquet", "chambers.parquet", CHAMBERS),
)

#: Columns of the table for people: heading, key of the figures, format ('z': no minus zero).
FOR_PEOPLE = (
    ("origin", "origin", ""),
    ("mode drawn", "mode", ""),
    ("mode measured", "measured_mode", ""),
    ("material", "material", ""),
    ("mesh size, mm", "size_mm", "g"),
    ("tetrahedra", "tets", ""),
    ("pressure, kPa", "pressure_kPa", "g"),
    ("bending, °", "bending_deg", "z.1f"),
    ("twist, °", "twist_deg", "z.1f"),
    ("tip x, mm", "tip_x_mm", "z.1f"),
    ("tip y, mm", "tip_y_mm", "z.1f"),
    ("tip z, mm", "tip_z_mm", "z.1f"),
    ("blocked force, N", "blocked_force_N", "z.3f"),
    ("blocked force at, kPa", "blocked_force_pressure_kPa", ".4g"),
    ("blocked force ended", "blocked_force_status", ""),
    ("first contact, kPa", "first_contact_pressure_kPa", ".1f"),
    ("energy balance", "energy_balance", "z.5f"),
    ("novelty", "novelty", ".3f"),
    ("time, s", "wall_s", ".1f"),
)


def write_summary(
    metrics: Sequence[Path],
    performance: Path,
    table: Path,
    novelty: Mapping[str, float] | None = None,
) -> None:
    """Gather the records of the stage metrics.

    Parameters
    ----------
    metrics
        Folders of the stage metrics, one a design, in the order of the rows.
    performance
        Parquet file to write, with the columns ``PERFORMANCE``.
    table
        CSV file to write, for people.
    novelty
        Distance to the nearest training design by design_id; null for what is not in it.
    """
    known = novelty or {}
    records = [read_record(folder) for folder in metrics]
    rows = [performance_row(r) | {"novelty": known.get(r.design_id)} for r in records]
    write_rows(performance, PERFORMANCE, rows)
    write_text(table, _for_people(records, rows))


def write_gathered(metrics: Sequence[Path], out: Path) -> None:
    """Gather what was measured of all designs, as far as it was: the tables ``GATHERED``.

    Parameters
    ----------
    metrics
        Folders of the stage metrics, one a design, in the order of the rows.
    out
        Folder of the tables.
    """
    for name, own, columns in GATHERED:
        parts = [folder / own for folder in metrics]
        concatenate(out / name, [part for part in parts if part.is_file()], columns)


def performance_row(record: Record) -> dict[str, Any]:
    """Return a design's row of the table ``PERFORMANCE`` from its record of the stage metrics."""
    figures = record.figures
    row = {column.name: figures.get(column.name) for column in PERFORMANCE}
    own = record.timings_s
    return row | {
        "design_id": record.design_id,
        "name": figures.get("name", record.design_id),
        "status": record.status.value,
        "reason": record.reason,
        "fidelity": "full",
        # The record's figures were written before the stage itself had ended, or not if it crashed.
        "cpu_s": figures.get("cpu_s", 0.0) + own["cpu"],
        "wall_s": figures.get("wall_s", 0.0) + own["wall"],
        "peak_memory_MB": max(figures.get("peak_memory_MB", 0.0), record.peak_memory_MB),
    }


def _for_people(records: Sequence[Record], rows: Sequence[Mapping[str, Any]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["design", *(heading for heading, _, _ in FOR_PEOPLE), "status", "reason"])
    for record, row in zip(records, rows, strict=True):
        figures = {**record.figures, **row}
        cells = [_cell(figures.get(key), form) for _, key, form in FOR_PEOPLE]
        writer.writerow([record.design_id, *cells, record.status.value, record.reason or ""])
    return text.getvalue()


def _cell(value: Any, form: str) -> str:
    return "" if value is None else format(value, form)
