"""Processor time of the analyses, from the records of a design."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from pagd.record import Record
from robustness.worker import USAGE_NAME

__all__ = ["cpu_of", "cpu_of_process"]


def cpu_of(record: Record, part: str) -> float | None:
    """Return the processor seconds of a part of a stage; None where there was no such part.

    Where the record holds wall time alone, it is scaled by the processor and wall time of the
    whole stage.
    """
    timings: Mapping[str, float] = record.timings_s
    if f"{part}_cpu" in timings:
        return timings[f"{part}_cpu"]
    if part not in timings:
        return None
    share = timings["cpu"] / timings["wall"] if timings["wall"] > 0 else 1.0
    return round(timings[part] * share, 3)


def cpu_of_process(folder: Path) -> float | None:
    """Return the processor seconds of a design's whole process, if it came to its end."""
    try:
        return float(json.loads((folder / USAGE_NAME).read_text("utf-8"))["cpu_s"])
    except (OSError, ValueError, KeyError):
        return None
