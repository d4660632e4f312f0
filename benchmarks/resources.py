"""What the jobs of a run have taken, beside what their rules ask for.

    python benchmarks/resources.py results [MORE…] [--page docs/sweeps.md]

The folders are those of runs. Jobs of a design, and of a part of a screening, are told by the
records of their stages, whose memory is the largest of the process and its children; all others by
what Snakemake has measured of them. --page writes the section of the resources.
"""

from __future__ import annotations

import argparse
import csv
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from performance.page import must_have_section, publish, table, wrapped

from pagd.errors import InputError
from pagd.record import RECORD_NAME, read_record

_SECTION = "resources"
_RULES = Path(__file__).parents[1] / "workflow" / "rules"
#: Stages that are one job, by the name of its rule.
_STAGES = {
    "prepare": ("geometry", "repair", "mesh"),
    "solve": ("solve",),
    "metrics": ("metrics",),
    "figures": ("figures",),
}
_PART = "screen_part"
_SCREENED = ("generated", "training")
#: Rules whose measurements have another name than they: a file, or all of a folder.
_NAMES = {"selection": "select", "summary": "summary_tables", "screening": "screened"}


@dataclass(frozen=True, slots=True)
class Job:
    """Memory in MB and wall time in minutes of one job."""

    memory_MB: float
    minutes: float


@dataclass(frozen=True, slots=True)
class Asked:
    """What a rule asks for at the first try."""

    memory_MB: int
    minutes: int


def asked(rules: Path = _RULES) -> dict[str, Asked]:
    """Return what every rule asks for, in the order of the files."""
    found = {}
    for file in sorted(rules.glob("*.smk")):
        parts = re.split(r"^(?:rule|checkpoint) (\w+):\n", file.read_text("utf-8"), flags=re.M)
        for name, body in zip(parts[1::2], parts[2::2], strict=True):
            numbers = [
                re.search(rf"{key}=(?:growing\()?(\d+)", body) for key in ("mem_mb", "runtime")
            ]
            if all(numbers):
                found[name] = Asked(*(int(number[1]) for number in numbers if number))
    return found


def taken(folders: Sequence[Path]) -> dict[str, list[Job]]:
    """Return what the jobs of runs have taken, by rule."""
    found: dict[str, list[Job]] = {}
    for folder in folders:
        designs = sorted((folder / "designs").glob("*"))
        for rule, stages in _STAGES.items():
            jobs = [_by_records([one / stage for stage in stages]) for one in designs]
            found.setdefault(rule, []).extend(job for job in jobs if job)
        # Whole folders of one stage each, by the rule whose jobs they are.
        alone = {"export": folder / "report" / "designs", _PART: folder / "screening" / "parts"}
        for rule, place in alone.items():
            jobs = [_by_records([one]) for one in sorted(place.glob("*"))]
            found.setdefault(rule, []).extend(job for job in jobs if job)
        measured = folder / "benchmarks"
        files = {file: file.stem for file in sorted(measured.glob("*.tsv"))}
        files |= {measured / "screening" / f"{t}.tsv": "screening" for t in _SCREENED}
        for file, name in files.items():
            if file.is_file():
                found.setdefault(_NAMES.get(name, name), []).extend(_by_snakemake(file))
    return found


def _by_records(folders: Iterable[Path]) -> Job | None:
    """A job of stages one after the other; nothing unless all have come to their end."""
    stages = list(folders)
    if not all((stage / RECORD_NAME).is_file() for stage in stages):
        return None
    records = [read_record(stage) for stage in stages]
    seconds = sum(record.timings_s["wall"] for record in records)
    return Job(max(record.peak_memory_MB for record in records), seconds / 60)


def _by_snakemake(file: Path) -> list[Job]:
    with file.open(encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines, delimiter="\t"))
    known = [row for row in rows if row["max_rss"] not in ("-", "NA")]
    # Snakemake counts memory in MiB.
    return [Job(float(r["max_rss"]) * 2**20 / 1e6, float(r["s"]) / 60) for r in known]


def lines_of(found: Mapping[str, Sequence[Job]], rules: Mapping[str, Asked]) -> str:
    """Return the table, of rules that jobs were measured of."""
    rows = []
    for rule, wanted in rules.items():
        jobs = found.get(rule, ())
        if jobs:
            memory = np.array([job.memory_MB for job in jobs])
            minutes = np.array([job.minutes for job in jobs])
            rows.append(
                [
                    f"`{rule}`", f"{len(jobs):,}",
                    f"{np.median(memory):,.0f}", f"{memory.max():,.0f}", f"{wanted.memory_MB:,}",
                    f"{np.median(minutes):.2f}", f"{minutes.max():.2f}", f"{wanted.minutes}",
                ]
            )  # fmt: skip
    headings = ["rule", "jobs", "MB, median", "largest", "asked for"]
    return table([*headings, "minutes, median", "longest", "asked for"], rows)


def made_by(folders: Sequence[Path]) -> str:
    """Return on what machines and by which versions the analyses of runs were made."""
    machines: dict[str, None] = {}
    versions: dict[str, dict[str, None]] = {}
    for folder in folders:
        paths = [*(folder / "designs").glob("*/solve"), *(folder / "screening/parts").glob("*")]
        for path in sorted(one for one in paths if (one / RECORD_NAME).is_file()):
            record = read_record(path)
            machine = record.machine
            if machine:
                told = f"{machine['processor']}, {machine['cores']} cores"
                machines[f"{told}, {machine['memory_GB']} GB, {machine['system']}"] = None
            for name, version in record.versions.items():
                if version is not None and name != "stage":
                    versions.setdefault(name, {})[str(version)] = None
    told = ", ".join(f"{name} {'/'.join(some)}" for name, some in sorted(versions.items()))
    return f"{' and '.join(machines) or 'Machines of which records tell nothing'}. {told}."


def main() -> int:
    """Print the table, or write it to a page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("results", type=Path, nargs="+")
    parser.add_argument("--page", type=Path)
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
        found = taken(options.results)
    except (InputError, OSError) as error:
        parser.error(str(error))
    if not any(found.values()):
        parser.error(f"{options.results[0]}: no job of a run is there.")
    text = lines_of(found, asked())
    command = f"python benchmarks/resources.py {' '.join(map(str, options.results))}"
    command += f" --page {options.page}" if options.page else ""
    told = wrapped(made_by(options.results))
    publish(options.page, _SECTION, f"`{command}`\n\n{told}\n\n{text}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
