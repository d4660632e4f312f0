"""Measured runs: one design through the chain, in a process of its own, its figures kept.

A run is kept as JSON under a name made of its label and of all that made it, so that a command
that is repeated goes on where it was.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from robustness.processes import Ending, Task, run_tasks
from robustness.sizes import sized
from robustness.study import commit, made_of

from pagd.catalogue import NamedDesign
from pagd.errors import InputError
from pagd.files import write_text
from performance.figures import figures_of

__all__ = ["Measured", "Measurement", "Run"]

# Neither too fine to be solved in a second or two, nor so coarse that gmsh has to try again.
_WARM_UP_MM = 5.0


@dataclass(frozen=True, slots=True)
class Run:
    """A design and a completed configuration; ``label`` is for people and unique in a study.

    ``halvings``: how often every edge of the mesh is halved before it is solved.
    """

    label: str
    named: NamedDesign
    config: Mapping[str, Any]
    halvings: int = 0

    def made_of(self) -> dict[str, Any]:
        """Return all that its figures depend on, ready for JSON."""
        return made_of(self.named, self.config, self.halvings)


@dataclass(frozen=True, slots=True)
class Measurement:
    """How a run ended and what it took.

    Attributes
    ----------
    end, cause, seconds
        See :class:`robustness.processes.Ending`.
    commit
        Of the repository that was run.
    figures
        See :func:`performance.figures.figures_of`; empty unless the process finished.
    """

    end: str
    cause: str | None
    seconds: float
    commit: str | None
    figures: Mapping[str, Any]

    @property
    def is_complete(self) -> bool:
        """Whether the free actuation reached its last pressure."""
        return self.end == "finished" and self.figures.get("free_status") == "ok"

    @property
    def trouble(self) -> str | None:
        """Why it is not complete, in one sentence; None where it is."""
        if self.is_complete:
            return None
        if self.end != "finished":
            return self.cause
        return f"{self.figures.get('free_status')}: {self.figures.get('reason')}"


@dataclass(frozen=True, slots=True)
class Measured:
    """The folder of kept runs.

    Attributes
    ----------
    folder
        Holds a file a run, and while a run lasts a folder for its stages.
    limit_s
        A run that takes longer, in seconds, is ended.
    anew
        Measure what is kept already once more.
    """

    folder: Path
    limit_s: float = 3600.0
    anew: bool = False

    def of(self, runs: Sequence[Run]) -> dict[str, Measurement]:
        """Return the measurement of every run by its label; those not kept are run, one by one."""
        waiting = [run for run in runs if self.anew or self.kept(run) is None]
        if waiting:
            self._warm_up(waiting)
        for number, run in enumerate(waiting, start=1):
            found = self._run(run)
            print(f"{number:3d}/{len(waiting)} {_told(run, found)}", file=sys.stderr, flush=True)
        read = ((run.label, self._read(run)) for run in runs)
        return {label: measurement for label, measurement in read if measurement}

    def kept(self, run: Run) -> Measurement | None:
        """Return the measurement of a run that has finished, if it is kept; else None."""
        found = self._read(run)
        return found if found and found.end == "finished" else None

    def _file(self, run: Run) -> Path:
        return self.folder / f"{run.label}-{_digest(run)}.json"

    def _read(self, run: Run) -> Measurement | None:
        try:
            return Measurement(**json.loads(self._file(run).read_text("utf-8"))["measurement"])
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def _run(self, run: Run) -> Measurement:
        endings: list[Ending] = []
        with _workplace(self.folder) as place:
            task = _task(run, place)
            run_tasks([task], 1, self.limit_s, lambda _, ending: endings.append(ending))
            found = _measurement(place, endings[0])
        content = {
            "label": run.label,
            "made_of": run.made_of(),
            "measurement": asdict(found),
        }
        text = json.dumps(content, indent=1, ensure_ascii=False)
        write_text(self._file(run), text + "\n")
        return found

    def _warm_up(self, runs: Sequence[Run]) -> None:
        """Compile what the runs need, once for all: a first call is not what is measured."""
        kinds = {_kind(run): run for run in runs}
        for run in kinds.values():
            with _workplace(self.folder) as place:
                coarse = Run(run.label, run.named, _coarse(run.config))
                run_tasks([_task(coarse, place)], 1, self.limit_s, lambda *_: None)


@contextmanager
def _workplace(folder: Path) -> Iterator[Path]:
    """A folder for the stages of one run, gone afterwards."""
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="working-", dir=folder) as name:
        yield Path(name)


def _task(run: Run, out: Path) -> Task:
    task = {
        "design": json.loads(run.named.as_json()),
        "out": str(out),
        "config": run.config,
        "halvings": run.halvings,
    }
    return Task(run.label, json.dumps(task), out / "output.txt")


def _measurement(folder: Path, ending: Ending) -> Measurement:
    end, cause, figures = ending.end, ending.cause, dict[str, Any]()
    if end == "finished":
        try:
            figures = figures_of(folder)
        except InputError as error:
            end, cause = "crashed", str(error)
    return Measurement(end, cause, round(ending.seconds, 3), commit(), figures)


def _digest(run: Run) -> str:
    text = json.dumps(run.made_of(), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def _kind(run: Run) -> tuple[str, ...]:
    """What decides which kernels are compiled."""
    return *run.config["mesh"]["meshers"], run.config["solve"]["element"]


def _coarse(config: Mapping[str, Any]) -> dict[str, Any]:
    solve = config["solve"] | {"maximum_pressure_kPa": 1.0, "recorded_step_kPa": 1.0}
    return sized(config, _WARM_UP_MM) | {"solve": solve}


def _told(run: Run, found: Measurement) -> str:
    figures = found.figures
    if not figures:
        return f"{run.label}: {found.end}, {found.cause}"
    unknowns = figures["unknowns"] or 0
    return (
        f"{run.label}: {figures['free_status']}, {unknowns:,} unknowns, "
        f"{figures['newton_iterations'] or 0} iterations, {found.seconds:.1f} s, "
        f"{figures['peak_memory_MB']:.0f} MB"
    )
