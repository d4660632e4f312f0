"""Designs at once against cores: the same design, several processes side by side."""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from robustness.processes import Ending, Task, run_tasks
from robustness.sizes import size_of
from robustness.study import commit, made_of
from robustness.timings import cpu_of_process

from pagd.catalogue import NamedDesign
from pagd.errors import InputError
from pagd.files import write_text
from performance.cells import cell, percent
from performance.page import table, wrapped

__all__ = ["Crew", "Throughput", "crews_of", "text_of", "throughput_of"]


@dataclass(frozen=True, slots=True)
class Crew:
    """So many processes at once, with so many threads each."""

    processes: int
    threads: int = 1

    @property
    def cores(self) -> int:
        """Cores that it can keep busy."""
        return self.processes * self.threads


@dataclass(frozen=True, slots=True)
class Throughput:
    """Designs that a crew has done, wall and processor seconds for all of them, and the commit."""

    designs: int
    wall_s: float
    cpu_s: float
    commit: str | None

    @property
    def per_hour(self) -> float:
        """Designs an hour."""
        return 3600 * self.designs / self.wall_s


def crews_of(cores: int) -> list[Crew]:
    """Return 1, 2, … processes of one thread; last, if there are two cores, one of two threads."""
    side_by_side = [Crew(processes) for processes in range(1, cores + 1)]
    return [*side_by_side, *([Crew(1, 2)] if cores > 1 else [])]


def throughput_of(
    crew: Crew,
    named: NamedDesign,
    config: Mapping[str, Any],
    each: int,
    folder: Path,
    *,
    limit_s: float,
    anew: bool = False,
) -> Throughput:
    """Return what a crew gets done, kept or measured now.

    Parameters
    ----------
    crew
        Who works.
    named, config
        The design, the same for all, and its completed configuration.
    each
        Designs a process: equal work for all of them, so that none waits at the end.
    folder
        Of kept measurements.
    limit_s
        A design that takes longer, in seconds, is ended.
    anew
        Measure what is kept once more.

    Raises
    ------
    InputError
        If a process does not come to its end.
    """
    made = {"crew": asdict(crew), "each": each, "run": made_of(named, config)}
    digest = hashlib.sha256(json.dumps(made, sort_keys=True).encode()).hexdigest()[:12]
    file = folder / f"{named.name}-{crew.processes}x{crew.threads}-{digest}.json"
    if file.is_file() and not anew:
        return Throughput(**json.loads(file.read_text("utf-8"))["throughput"])
    task = json.dumps({"design": json.loads(named.as_json()), "config": config})
    _work(Crew(1, crew.threads), 1, task, folder, limit_s)  # compiles what is not compiled yet
    found = _work(crew, each * crew.processes, task, folder, limit_s)
    content = {"made_of": made, "throughput": asdict(found)}
    write_text(file, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
    return found


def text_of(found: Mapping[Crew, Throughput], design: str, config: Mapping[str, Any]) -> str:
    """Return the section without its first lines."""
    introduction = (
        f"The {design} example, mesh size {size_of(config):g} mm, free actuation to "
        f"{config['solve']['maximum_pressure_kPa']:g} kPa, over and over: each design through the "
        "whole chain in a process of its own. Efficiency: designs an hour, by those of one "
        "process with one thread, by cores."
    )
    one = next((each.per_hour for crew, each in found.items() if crew.cores == 1), None)
    rows = [
        [
            str(crew.processes),
            str(crew.threads),
            str(each.designs),
            cell(each.wall_s),
            cell(each.cpu_s / each.designs, 2),
            cell(each.per_hour, 0),
            percent(each.per_hour / one / crew.cores if one else None),
        ]
        for crew, each in found.items()
    ]
    headings = ["processes", "threads each", "designs", "wall, s", "core-s a design"]
    return f"{wrapped(introduction)}\n\n{table([*headings, 'designs an hour', 'efficiency'], rows)}"


def _work(crew: Crew, designs: int, task: str, folder: Path, limit_s: float) -> Throughput:
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="working-", dir=folder) as name:
        tasks = [_task(number, task, Path(name)) for number in range(designs)]
        start = time.monotonic()
        run_tasks(tasks, crew.processes, limit_s, _refuse_failure, threads=crew.threads)
        wall = time.monotonic() - start
        used = sum(cpu_of_process(Path(name, one.name)) or 0.0 for one in tasks)
    print(
        f"{crew.processes} processes, {crew.threads} threads each: {designs} designs in "
        f"{wall:.1f} s",
        file=sys.stderr,
        flush=True,
    )
    return Throughput(designs, round(wall, 3), round(used, 3), commit())


def _task(number: int, task: str, folder: Path) -> Task:
    out = folder / f"{number:03d}"
    out.mkdir()
    return Task(out.name, json.dumps(json.loads(task) | {"out": str(out)}), out / "output.txt")


def _refuse_failure(task: Task, ending: Ending) -> None:
    if ending.end != "finished":
        raise InputError(f"design {task.name} did not come to its end: {ending.cause}")
