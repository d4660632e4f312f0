"""Where the time of a design goes, part by part, from the records that its stages leave.

    python benchmarks/where_time_goes.py [--designs bending twisting mixed]
        [--page docs/performance.md]

Each design of Table 2 goes through all stages but the pictures, by commands of their own and one
thread, twice: first with nothing compiled, then with the compiled kernels in their cache, which is
the table; the difference is what the first design on a machine costs more. Give nothing else to do
to the machine meanwhile.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from performance.options import add_examples, command_of, example_designs
from performance.origin import origin_lines
from performance.page import must_have_section, publish, table, wrapped

from pagd.catalogue import NamedDesign
from pagd.errors import InputError
from pagd.record import Record, read_record

_SECTION = "profile"
_STAGES = ("geometry", "repair", "mesh", "solve", "metrics")
#: Parts of an analysis, as the records name them, and what they are.
_PARTS = {
    "cells": "its cells and pieces before",
    "pattern": "pattern of the matrix",
    "assembly": "tangents and residuals",
    "residual": "residuals alone",
    "update": "what is condensed",
    "contact search": "contact search",
    "analysis": "symbolic factorisation",
    "factorisation": "factorisation",
    "solution": "solutions",
    "states": "energies, stretches, records of steps",
}


class _Run(NamedTuple):
    """Records of the stages, and their processes' wall seconds."""

    records: dict[str, Record]
    wall: dict[str, float]


def main() -> None:
    """Run the designs, print the table or write it to the page."""
    parser = _parser()
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
        known, usual = example_designs(), vars(_parser().parse_args([]))
        command = command_of("benchmarks/where_time_goes.py", vars(options), usual)
        text = _section([known[name] for name in options.designs])
        publish(options.page, _SECTION, f"{origin_lines(command)}\n\n{text}")
    except InputError as error:
        parser.error(str(error))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_examples(parser)
    return parser


def _section(designs: list[NamedDesign]) -> str:
    with tempfile.TemporaryDirectory(prefix="pagd-profile-") as folder:
        cache = Path(folder, "cache")
        cold = _all_stages(designs[0], Path(folder, "cold"), cache)
        runs = {d.name: _all_stages(d, Path(folder, d.name), cache) for d in designs}
    first = sum(cold.wall.values()) - sum(runs[designs[0].name].wall.values())
    text = wrapped(
        f"Processor seconds of the designs of Table 2, free actuation and blocked force, one "
        f"thread. Every stage is a process here, as in the workflow; each imports what it needs, "
        "which a process that does all stages would do once. Before kernels are compiled the first "
        f"design takes {first:.0f} s more (wall time), once on a machine."
    )
    return f"{text}\n\n{_table(runs)}"


def _all_stages(design: NamedDesign, out: Path, cache: Path) -> _Run:
    """Run every stage as a process of its own; ``cache`` is for the compiled kernels."""
    env = os.environ | {"NUMBA_CACHE_DIR": str(cache), "OMP_NUM_THREADS": "1"}
    env |= {"MKL_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
    at = {stage: str(out / stage) for stage in _STAGES}
    words = {
        "geometry": ["--design", design.as_json()],
        "repair": ["--geometry", at["geometry"]],
        "mesh": ["--geometry", at["geometry"], "--repair", at["repair"]],
        "solve": ["--mesh", at["mesh"], "--threads", "1"],
        "metrics": [word for s in _STAGES[:-1] for word in (f"--{s}", at[s])],
    }
    wall = {}
    for stage in _STAGES:
        print(f"{design.name}: {stage}", file=sys.stderr)
        command = [sys.executable, "-m", "pagd", stage, *words[stage], "--keep-going"]
        start = time.perf_counter()
        done = subprocess.run(
            [*command, "--out", at[stage]], env=env, check=False, capture_output=True, text=True
        )
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["no message"])[-1]
            raise InputError(f"--designs: the stage {stage} of {design.name} failed: {last}")
        wall[stage] = time.perf_counter() - start
    return _Run({stage: read_record(out / stage) for stage in _STAGES}, wall)


def _table(runs: dict[str, _Run]) -> str:
    rows = [["unknowns", *(f"{r.records['solve'].figures['unknowns']:,}" for r in runs.values())]]
    columns = [_column(run) for run in runs.values()]
    for name in columns[0]:
        rows.append([name, *(f"{column.get(name, 0.0):.2f}" for column in columns)])
    return table(["", *runs], rows)


def _column(run: _Run) -> dict[str, float]:
    """Processor seconds by part; what a process spends before its stage by its wall time."""
    records = run.records
    timings = {stage: record.timings_s for stage, record in records.items()}
    starting = sum(run.wall[stage] - timings[stage]["wall"] for stage in _STAGES)
    solve = timings["solve"]
    analyses = {
        "free actuation": (solve["solve_cpu"], records["solve"].figures["profile_s"]),
        "blocked force": (
            solve["blocked_force_cpu"],
            records["solve"].figures["blocked_force"]["profile_s"],
        ),
    }
    column = {"python, imports (wall)": starting}
    column |= {stage: timings[stage]["cpu"] for stage in ("geometry", "repair", "mesh")}
    for name, (whole, parts) in analyses.items():
        column[f"**{name}**"] = whole
        for part, what in _PARTS.items():
            if part in parts:
                column[f"{name}: {what}"] = parts[part]
        column[f"{name}: the rest"] = whole - sum(parts.values())
    column["solve: reading and writing"] = solve["cpu"] - sum(a for a, _ in analyses.values())
    column["metrics"] = timings["metrics"]["cpu"]
    column["**all**"] = starting + sum(one["cpu"] for one in timings.values())
    return column


if __name__ == "__main__":
    main()
