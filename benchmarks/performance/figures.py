"""What is kept of one measured run: figures of its records, and where the tip was."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from robustness.study import STAGES
from robustness.timings import cpu_of, cpu_of_process

from pagd.record import Record, read_record
from pagd.stages.metrics import PERFORMANCE_NAME
from pagd.tables import read_table

__all__ = ["figures_of", "tips_of"]

Figures = dict[str, Any]

#: Figures of the free actuation that are kept as they are, where the record has them.
_OF_THE_ANALYSIS = (
    *("unknowns", "newton_iterations", "steps", "rejected_steps", "pressure_kPa"),
    *("factorisations", "factor_nonzeros", "profile_s"),
)


def figures_of(folder: Path) -> Figures:
    """Return the figures of a run whose stages lie in ``folder``, ready for JSON.

    Times are processor seconds, memory is in MB; None stands for what the records do not tell.

    Raises
    ------
    InputError
        If a record is missing or cannot be read.
    """
    records = {stage: read_record(folder / stage) for stage in STAGES}
    solved, final = records["solve"], records[STAGES[-1]]
    return {
        "status": final.status.value,
        "reason": final.reason,
        "free_status": solved.status.value,
        **{key: solved.figures.get(key) for key in _OF_THE_ANALYSIS},
        **_mesh(records["mesh"]),
        "stages_cpu_s": {stage: record.timings_s["cpu"] for stage, record in records.items()},
        "free_cpu_s": cpu_of(solved, "solve"),
        "blocked_cpu_s": cpu_of(solved, "blocked_force"),
        "process_cpu_s": cpu_of_process(folder),
        "peak_memory_MB": max(record.peak_memory_MB for record in records.values()),
        "tip_mm": tips_of(folder),
    }


def tips_of(folder: Path) -> list[list[float]] | None:
    """Return pressure (kPa) and place x, y, z (mm) of the tip, a row a recorded state.

    The first row is the tip at rest; None where nothing was measured.
    """
    file = folder / "metrics" / PERFORMANCE_NAME
    if not file.is_file():
        return None
    table = read_table(file)
    columns = [table[key] for key in ("pressure_kPa", "tip_x_mm", "tip_y_mm", "tip_z_mm")]
    return [[float(value) for value in row] for row in zip(*columns, strict=True)]


def _mesh(record: Record) -> Mapping[str, Any]:
    figures = record.figures
    counts = (figures.get(key) for key in ("elements", "hexahedra", "tets"))
    return {
        "mesher": figures.get("mesher"),
        "elements": next((count for count in counts if count), None),
        "nodes": figures.get("nodes"),
    }
