"""The section of a sweep, as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Final

import numpy as np
from performance.page import table, wrapped

from sweep.costs import STAGES, Cost, Overhead, hours_for
from sweep.project import DryRun

__all__ = ["as_markdown"]

#: Targets: hours for so many designs, shares, seconds, MB.
_DESIGNS: Final = 1000
_HOURS: Final = 4
_OVERHEAD: Final = 0.1
_OUTSIDE_S: Final = 3
_MEMORY_MB: Final = 1000
_DRY_RUN_S: Final = 60


def as_markdown(
    costs: Sequence[Cost],
    asked: int,
    overhead: Overhead,
    cores: int,
    dry_runs: Sequence[DryRun],
) -> str:
    """Return the section: the sample by stage, the overhead, the extrapolation, the dry runs.

    Parameters
    ----------
    costs
        Of the designs that are done, at least one.
    asked
        Size of the sample.
    overhead
        Of the runs that have simulated it.
    cores
        That the sweep is extrapolated to.
    dry_runs
        Those that were timed, by rising numbers of designs.
    """
    parts = [_sample(costs, asked), _table(costs, overhead), *_workflow(costs, overhead, cores)]
    if dry_runs:
        parts.append(_dry_runs(dry_runs))
    return "\n\n".join(parts)


def _sample(costs: Sequence[Cost], asked: int) -> str:
    counts = Counter(cost.status for cost in costs).most_common()
    statuses = ", ".join(f"`{status}` {count}" for status, count in counts)
    done = "" if len(costs) == asked else f" {len(costs)} of them are done so far:"
    return wrapped(
        f"{asked} designs drawn at random from the generated ones, through geometry, repair, mesh, "
        f"free actuation, blocked force and metrics by `snakemake --profile profiles/sweep`;{done} "
        f"{statuses}. Core-seconds a design, children included:"
    )


def _table(costs: Sequence[Cost], overhead: Overhead) -> str:
    rows = {stage: [cost.stages_s[stage] for cost in costs] for stage in STAGES}
    rows["all stages"] = [cost.core_s for cost in costs]
    rows["both analyses"] = [cost.analyses_s for cost in costs]
    more = _workflow_s(costs, overhead)
    rows["outside the analyses, with workflow"] = [cost.outside_s + more for cost in costs]
    return table(
        ["", "median", "90th percentile", "largest"],
        [[name, *(f"{figure:.2f}" for figure in _spread(values))] for name, values in rows.items()],
    )


def _spread(values: Sequence[float]) -> list[float]:
    return [*map(float, np.percentile(values, (50, 90))), max(values)]


def _workflow_s(costs: Sequence[Cost], overhead: Overhead) -> float:
    """Core-seconds of the workflow besides the stages, a design."""
    mean = float(np.mean([cost.wall_s for cost in costs]))
    return mean * overhead.share / (1 - overhead.share)


def _workflow(costs: Sequence[Cost], overhead: Overhead, cores: int) -> list[str]:
    hours, error = hours_for(_DESIGNS, costs, overhead, cores)
    memory = max(cost.peak_memory_MB for cost in costs)
    outside = np.median([cost.outside_s for cost in costs]) + _workflow_s(costs, overhead)
    return [
        table(
            ["", "measured", "target"],
            [
                [
                    "workflow, share of wall time × cores",
                    f"{overhead.share:.1%}",
                    f"{_OVERHEAD:.0%}",
                ],
                ["outside the analyses, median", f"{outside:.1f} core-s", f"{_OUTSIDE_S} core-s"],
                ["peak memory of a process", f"{memory:,.0f} MB", f"{_MEMORY_MB:,} MB"],
                [
                    f"{_DESIGNS:,} designs on {cores} cores, extrapolated",
                    f"{hours:.2f} ± {error:.2f} h",
                    f"{_HOURS} h",
                ],
            ],
        ),
        wrapped(
            f"The extrapolation is from {len(costs)} designs, with the standard error of their "
            "mean; it counts from the generated designs to their metrics, without pictures, "
            "tables, page and screening. Wall time × cores was "
            f"{overhead.whole_s:,.0f} core-s, of which {overhead.inside_s:,.0f} s were spent "
            "inside the stages."
        ),
    ]


def _dry_runs(dry_runs: Sequence[DryRun]) -> str:
    rows = [
        [f"{run.designs:,}", f"{run.jobs:,}", f"{run.table_s:.1f} s", f"{run.all_s:.1f} s"]
        for run in dry_runs
    ]
    told = (
        "A design costs the same however many there are, since its jobs share nothing with those "
        "of another. What Snakemake adds grows with their number: a dry run of a table of random "
        "designs, none of it done, up to the tables of all and without generated designs, has its "
        f"table of jobs and has listed every job after (target: {_DRY_RUN_S} s with 11,000):"
    )
    head = ["designs", "jobs", "table of jobs", "every job listed"]
    return f"{wrapped(told)}\n\n{table(head, rows)}"
