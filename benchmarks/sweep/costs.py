"""What a design has taken, from its records, and what the workflow has taken besides."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Protocol

import numpy as np
from robustness.timings import cpu_of

from pagd.record import RECORD_NAME, Record, read_record

__all__ = [
    "ANALYSES",
    "STAGES",
    "Cost",
    "Overhead",
    "costs_of",
    "done_of",
    "hours_for",
    "inside_s",
    "overhead_of",
]

STAGES: Final = ("geometry", "repair", "mesh", "solve", "metrics")

#: Parts of the stage solve that are the analyses themselves.
ANALYSES: Final = ("solve", "blocked_force")


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """What a design has taken.

    ``stages_s`` is processor time by stage, ``analyses_s`` that of the analyses alone, in
    core-seconds; ``spans`` are start and end of every stage, in seconds since the epoch.
    """

    design_id: str
    status: str
    stages_s: Mapping[str, float]
    analyses_s: float
    spans: Sequence[tuple[float, float]]
    peak_memory_MB: float

    @property
    def core_s(self) -> float:
        """Core-seconds of all stages."""
        return sum(self.stages_s.values())

    @property
    def outside_s(self) -> float:
        """Core-seconds of the stages outside the analyses."""
        return self.core_s - self.analyses_s

    @property
    def wall_s(self) -> float:
        """Seconds inside the stages."""
        return sum(end - start for start, end in self.spans)


class Span(Protocol):
    """What is asked of a run of Snakemake."""

    @property
    def start(self) -> float:
        """In seconds since the epoch."""

    @property
    def end(self) -> float:
        """In seconds since the epoch."""

    @property
    def cores(self) -> int:
        """Number of cores."""


@dataclass(frozen=True, slots=True)
class Overhead:
    """Wall time × cores of runs, and what of it was time inside the stages; in core-seconds."""

    whole_s: float
    inside_s: float

    @property
    def share(self) -> float:
        """Share of the whole that no stage has had."""
        return 1 - self.inside_s / self.whole_s if self.whole_s > 0 else float("nan")


def costs_of(results: Path, names: Iterable[str]) -> list[Cost]:
    """Return the costs of the designs whose records are all there."""
    return [_cost(folder) for folder in done_of(results, names)]


def done_of(results: Path, names: Iterable[str]) -> list[Path]:
    """Return the folders of the designs whose records are all there."""
    folders = (results / "designs" / name for name in names)
    return [folder for folder in folders if _is_complete(folder)]


def overhead_of(runs: Iterable[Span], costs: Sequence[Cost]) -> Overhead:
    """Compare runs with the stages that ended in them; a run without any is left out."""
    inside = [(run, inside_s(run, costs)) for run in runs]
    working = [(run, seconds) for run, seconds in inside if seconds > 0]
    whole = sum((run.end - run.start) * run.cores for run, _ in working)
    return Overhead(whole, sum(seconds for _, seconds in working))


def inside_s(run: Span, costs: Sequence[Cost]) -> float:
    """Return the seconds inside the stages that ended in a run."""
    spans = [span for cost in costs for span in cost.spans]
    return sum(end - start for start, end in spans if run.start <= end <= run.end)


def hours_for(
    designs: int, costs: Sequence[Cost], overhead: Overhead, cores: int
) -> tuple[float, float]:
    """Return the hours for so many designs of this kind, and their standard error."""
    walls = np.array([cost.wall_s for cost in costs])
    factor = designs / (1 - overhead.share) / cores / 3600
    error = walls.std(ddof=1) / np.sqrt(len(walls)) if len(walls) > 1 else float("nan")
    return float(walls.mean() * factor), float(error * factor)


def _is_complete(folder: Path) -> bool:
    return all((folder / stage / RECORD_NAME).is_file() for stage in STAGES)


def _cost(folder: Path) -> Cost:
    records = {stage: read_record(folder / stage) for stage in STAGES}
    solve = records["solve"]
    return Cost(
        design_id=solve.design_id,
        status=records["metrics"].status.value,
        stages_s={stage: record.timings_s["cpu"] for stage, record in records.items()},
        analyses_s=sum(cpu_of(solve, part) or 0.0 for part in ANALYSES),
        spans=[_span(folder / stage, record) for stage, record in records.items()],
        peak_memory_MB=max(record.peak_memory_MB for record in records.values()),
    )


def _span(folder: Path, record: Record) -> tuple[float, float]:
    # The record is the last that a stage writes.
    end = (folder / RECORD_NAME).stat().st_mtime
    return end - record.timings_s["wall"], end
