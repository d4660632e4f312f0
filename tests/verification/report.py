"""What is written of a run: verification.json, for programs, and the page, for people."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import textwrap
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from catalogue import CASES
from figure import Case, Figure, Group, percent
from running import Outcome

from pagd.files import write_text
from pagd.record import versions

LIBRARIES = ("numpy", "scipy", "numba", "gmsh", "pypardiso")

INTRODUCTION = """\
# Verification

What the finite-element analysis of pagd computes, beside what it should: closed forms, identities,
symmetries, published results and other programs. `make verify` installs what it needs, computes
every row anew and writes this page, with the same rows as data in
`results/verification/verification.json`; it ends with an error if a row does not pass.
`python tests/verification --only CASE` computes the rows of one case, in the environment of
`make verify`, and `--list` names the cases. The quick ones are part of `make test`.

The error is (ours − reference) / reference, or relative to what the row says where the reference
is zero. Tolerances have the reason given above each table. Most are the largest error that the
coarse mesh of the case may have, not the accuracy that can be reached; those of the mesh studies
are bounds against getting worse, a third above what was found.
There is no published measurement of a twist with complete geometry and material, so that nothing
here claims agreement with an experiment.
"""


def write_data(outcomes: Sequence[Outcome], processes: int, seconds: float, file: Path) -> None:
    """Write the rows and what made them."""
    content = {
        "rows": [row for outcome in outcomes for row in _rows(outcome)],
        "left_out": {o.case: f"needs the program {o.missing}" for o in outcomes if o.missing},
        "broken_off": {o.case: o.fault for o in outcomes if o.fault},
        **_circumstances(processes, seconds),
    }
    text = json.dumps(content, indent=2, ensure_ascii=False, default=float)
    write_text(file, text + "\n")


def _rows(outcome: Outcome) -> list[dict[str, Any]]:
    """The rows as they stand in the file; seconds are those of the whole case."""
    group = _case(outcome.case).group.value
    return [
        asdict(figure)
        | {
            "group": group,
            "case": outcome.case,
            "error": figure.error,
            "pass": figure.passes,
            "seconds": round(outcome.seconds, 2),
        }
        for figure in outcome.figures
    ]


def _case(name: str) -> Case:
    return next(case for case in CASES if case.name == name)


def _circumstances(processes: int, seconds: float) -> dict[str, Any]:
    return {
        "versions": versions(1, LIBRARIES),
        "machine": {"cores": os.cpu_count(), "processor": _processor()},
        "processes": processes,
        "seconds": round(seconds, 1),
        "commit": _commit(),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def _processor() -> str:
    """The model of the processor, as far as the system tells."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    models = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return models[0] if models else platform.machine()


def _commit() -> str | None:
    """The commit that the repository stands at; None outside of one."""
    command = ["git", "-C", str(Path(__file__).parent), "rev-parse", "--short", "HEAD"]
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return None
    return found.stdout.strip()


def write_page(outcomes: Sequence[Outcome], processes: int, seconds: float, file: Path) -> None:
    """Write the page."""
    write_text(file, page(outcomes, _circumstances(processes, seconds)))


def page(outcomes: Sequence[Outcome], circumstances: dict[str, Any]) -> str:
    """The page in Markdown: a summary, then a table a case."""
    known = {outcome.case: outcome for outcome in outcomes}
    cases = [case for case in CASES if case.name in known]
    groups = [group for group in Group if any(case.group is group for case in cases)]
    parts = [INTRODUCTION, _made(circumstances), _summary(cases, groups, known)]
    for group in groups:
        parts.append(f"## {group}\n")
        parts += [_section(case, known[case.name]) for case in cases if case.group is group]
    return "\n".join(parts)


def _made(circumstances: dict[str, Any]) -> str:
    """When, where and by which versions the page was made: the one sentence that always changes."""
    found, machine = circumstances["versions"], circumstances["machine"]
    libraries = ", ".join(f"{name} {found[name]}" for name in LIBRARIES if found[name])
    text = (
        f"Made on {circumstances['date'][:10]} at commit {circumstances['commit']} in "
        f"{circumstances['seconds'] / 60:.0f} minutes by {circumstances['processes']} processes on "
        f"{machine['processor']} ({machine['cores']} cores); python {found['python']}, "
        f"{libraries}."
    )
    return textwrap.fill(text, 100) + "\n"


def _summary(cases: Sequence[Case], groups: Sequence[Group], known: dict[str, Outcome]) -> str:
    lines = ["| about | cases | rows | rows that pass |", "| --- | --- | --- | --- |"]
    for group in groups:
        found = [known[case.name] for case in cases if case.group is group]
        figures = [figure for outcome in found for figure in outcome.figures]
        passing = sum(figure.passes for figure in figures)
        anchor = group.lower().replace(" ", "-")
        lines.append(f"| [{group}](#{anchor}) | {len(found)} | {len(figures)} | {passing} |")
    return "\n".join(lines) + "\n"


def _section(case: Case, outcome: Outcome) -> str:
    parts = [f"### {title(case.name)}\n", _prose(case)]
    if outcome.missing:
        parts.append(f"Left out: the program `{outcome.missing}` is not there.\n")
    if outcome.fault:
        parts.append(f"**This case broke off:**\n\n```text\n{outcome.fault}\n```\n")
    if outcome.figures:
        parts.append(_table(outcome.figures))
    return "\n".join(parts)


def title(name: str) -> str:
    """The heading of a case: its name in words."""
    return name.replace("_", " ").capitalize()


def _prose(case: Case) -> str:
    """The docstring of the case, in lines of a hundred."""
    text = " ".join((case.rows.__doc__ or "").split()).replace("``", "`")
    return "\n".join(textwrap.wrap(text, 100, break_on_hyphens=False)) + "\n"


def _table(figures: Sequence[Figure]) -> str:
    head = ["row", "reference", "ours", "unit", "error", "tolerance", "", "source"]
    rows = [head, ["---"] * len(head), *(cells(figure) for figure in figures)]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows) + "\n"


def cells(figure: Figure) -> list[str]:
    """A row of the table."""
    noise = figure.reference == 0 and abs(figure.value) < 1e-4
    return [
        figure.name.replace("|", "\\|"),
        f"{figure.reference:.6g}",
        # What should be zero is round-off, of which more digits say nothing.
        f"{figure.value:.1g}" if noise else f"{figure.value:.6g}",
        figure.unit,
        percent(figure.error),
        percent(figure.tolerance),
        "pass" if figure.passes else "**FAIL**",
        figure.source.replace("|", "\\|"),
    ]
