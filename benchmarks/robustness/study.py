"""The folder of a study: which designs are done, and by what."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from pagd import __version__
from pagd.catalogue import NamedDesign
from pagd.config import material_as_json, material_file, part
from pagd.errors import InputError
from pagd.files import write_text
from pagd.record import read_record
from pagd.stages import STAGE_VERSIONS
from robustness.processes import Ending, Task

__all__ = ["STAGES", "Study", "commit", "made_of"]

#: The stages of the chain, in order.
STAGES: Final = ("geometry", "repair", "mesh", "solve", "metrics")

_RUN = "run.json"
_STARTED = "started"


@dataclass(frozen=True, slots=True)
class Study:
    """Random designs, the configuration they run with, and the folder of their results.

    Under ``out`` every design has a folder ``designs/NAME`` with its stages, the output of its
    process, and ``run.json``: what was asked for and how the process ended. ``halvings``: how
    often every edge of the meshes is halved before they are solved.
    """

    out: Path
    designs: Sequence[NamedDesign]
    config: Mapping[str, Any]
    halvings: int = 0

    def folder(self, named: NamedDesign) -> Path:
        """Folder of a design."""
        return self.out / "designs" / named.name

    def run_of(self, named: NamedDesign) -> dict[str, Any] | None:
        """How the process of a design ended, if one has, for what is asked for now.

        With the keys ``end`` (see :class:`robustness.processes.Ending`), ``cause``, ``seconds``
        and ``commit``. One that was made of something else, by other stages, or that was killed
        with the study, is none; nor is one that finished and whose records are not all there.
        Another commit alone is no reason to run a design again: a long study goes on after an edit
        that leaves the stages' versions as they are, and the report says what is of which commit.
        """
        try:
            run: dict[str, Any] = json.loads((self.folder(named) / _RUN).read_text("utf-8"))
        except (OSError, ValueError):
            return None
        if run.get("made_of") != self._made_of(named) or run.get("end") in (None, _STARTED):
            return None
        return None if run["end"] == "finished" and not self._is_complete(named) else run

    def unfinished(self) -> list[NamedDesign]:
        """Designs still to be run: those without a run, crashed, or over the time limit."""
        runs = ((named, self.run_of(named)) for named in self.designs)
        return [named for named, run in runs if run is None or run["end"] != "finished"]

    def start(self, named: NamedDesign) -> Task:
        """Make room for a design and return the task of its process.

        Raises
        ------
        InputError
            If its folder is there and is none of a study.
        """
        folder = self.folder(named)
        if folder.exists() and any(folder.iterdir()) and not (folder / _RUN).is_file():
            raise InputError(f"{folder}: exists and holds no {_RUN}, so it is not replaced.")
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        self._note(named, {"end": _STARTED})
        task = {
            "design": json.loads(named.as_json()),
            "out": str(folder),
            "config": self.config,
            "halvings": self.halvings,
        }
        return Task(named.name, json.dumps(task), folder / "output.txt")

    def end(self, named: NamedDesign, ending: Ending) -> dict[str, Any]:
        """Note how the process of a design ended, and return it as :meth:`run_of` does."""
        end, cause = ending.end, ending.cause
        if end == "finished" and not self._is_complete(named):
            end, cause = "crashed", "The process ended well but left no complete records."
        how = {"end": end, "cause": cause, "seconds": round(ending.seconds, 3), "commit": commit()}
        self._note(named, how)
        return how

    def _note(self, named: NamedDesign, how: Mapping[str, Any]) -> None:
        content = {"made_of": self._made_of(named), **how}
        text = json.dumps(content, indent=2, ensure_ascii=False)
        write_text(self.folder(named) / _RUN, text + "\n")

    def _made_of(self, named: NamedDesign) -> dict[str, Any]:
        return made_of(named, self.config, self.halvings)

    def _is_complete(self, named: NamedDesign) -> bool:
        try:
            records = [read_record(self.folder(named) / stage) for stage in STAGES]
        except InputError:
            return False
        return all(record.design_id == named.name for record in records)


def made_of(named: NamedDesign, config: Mapping[str, Any], halvings: int = 0) -> dict[str, Any]:
    """Return all that the result of a design depends on, as it reads in a file of JSON."""
    sections = {stage: part(config, stage) for stage in STAGES}
    file = str(material_file(config))
    ingredients = {
        "design": named.as_json(),
        "config": sections,
        "halvings": halvings,
        "material": material_as_json(file, config["material"], "material"),
        "paper": material_as_json(file, config["paper"], "paper"),
        "versions": {"pagd": __version__, **{s: STAGE_VERSIONS[s] for s in STAGES}},
    }
    # Tuples are lists there.
    return dict(json.loads(json.dumps(ingredients)))


def commit() -> str | None:
    """Commit of the repository, with a mark where files differ from it; None outside of one.

    Pages in docs do not count: other commands write their sections there.
    """
    try:
        name = _git("rev-parse", "--short", "HEAD")
        differs = _git("status", "--porcelain", "--untracked-files=no", "--", ":/", ":!/docs")
    except (OSError, subprocess.CalledProcessError):
        return None
    return f"{name}-dirty" if differs else name


def _git(*words: str) -> str:
    answer = subprocess.run(
        ["git", *words], cwd=Path(__file__).parent, capture_output=True, text=True, check=True
    )
    return answer.stdout.strip()
