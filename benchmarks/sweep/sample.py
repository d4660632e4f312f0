"""The sample: which designs, the runs that have simulated them, and what these took."""

from __future__ import annotations

import csv
import json
import shutil
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from robustness.study import commit

from pagd.errors import InputError
from pagd.files import write_text
from pagd.stages import STAGE_VERSIONS
from sweep.costs import STAGES, Cost, costs_of, done_of
from sweep.project import Project

__all__ = ["Run", "Sample"]

_RUNS: Final = "runs.json"
_GENERATIVE: Final = ("dataset", "embedding", "generate", "selection")


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """A run of Snakemake: seconds since the epoch, cores, commit of the repository."""

    start: float
    end: float
    cores: int
    commit: str | None


@dataclass(frozen=True, slots=True)
class Sample:
    """Generated designs drawn at random, simulated by the sweep in a folder of its own."""

    project: Project
    config: Mapping[str, Any]
    designs: int
    seed: int

    def prepare(self, cores: int) -> list[str]:
        """Make the generated designs, unless they are there; return the names of the sample.

        Designs simulated with another configuration, by other stages or for another sample are
        removed, so that all costs are of the same.
        """
        self.project.write(self.config)
        self.project.must_run(cores, ["results/selection"])
        names = self._drawn()
        made_of = self._made_of(names)
        if self._kept().get("made_of") != made_of:
            shutil.rmtree(self.project.results / "designs", ignore_errors=True)
            self._keep(made_of, [])
        return names

    def simulate(self, names: list[str], cores: int) -> bool:
        """Run the sweep over the sample, telling how far it is; False if a design has crashed."""
        kept = self._kept()
        seen = -1

        def look() -> None:
            nonlocal seen
            done = len(done_of(self.project.results, names))
            if done != seen:
                seen = done
                minutes = (time.time() - start) / 60
                print(f"{done:4d}/{len(names)} designs, {minutes:.1f} min", flush=True)

        start = time.time()
        try:
            code = self.project.run(cores, [_target(name) for name in names], look)
        finally:
            run = Run(start=start, end=time.time(), cores=cores, commit=commit())
            self._keep(kept["made_of"], [*kept["runs"], asdict(run)])
        return code == 0

    def runs(self) -> list[Run]:
        """Return the runs so far, of which one that was killed is none."""
        return [Run(**run) for run in self._kept()["runs"]]

    def costs(self, names: list[str]) -> list[Cost]:
        """Return the costs of the designs that are done."""
        return costs_of(self.project.results, names)

    def _drawn(self) -> list[str]:
        path = self.project.results / "selection" / "designs.csv"
        with path.open(newline="", encoding="utf-8") as file:
            names = [row["name"] for row in csv.DictReader(file)]
        if self.designs > len(names):
            most = f"at most {len(names)}, as many as are generated"
            raise InputError(f"--designs = {self.designs} must be {most}.")
        chosen = np.random.default_rng(self.seed).permutation(len(names))[: self.designs]
        return [names[number] for number in np.sort(chosen)]

    def _made_of(self, names: list[str]) -> dict[str, Any]:
        sections = {key: self.config[key] for key in self.config if key != "figures"}
        versions = {stage: STAGE_VERSIONS[stage] for stage in (*_GENERATIVE, *STAGES)}
        whole = {"designs": names, "config": sections, "versions": versions}
        return dict(json.loads(json.dumps(whole)))

    def _kept(self) -> dict[str, Any]:
        try:
            return dict(json.loads(self._file.read_text(encoding="utf-8")))
        except (OSError, ValueError):
            return {}

    def _keep(self, made_of: Mapping[str, Any], runs: list[dict[str, Any]]) -> None:
        write_text(self._file, json.dumps({"made_of": made_of, "runs": runs}, indent=1) + "\n")

    @property
    def _file(self) -> Path:
        return self.project.folder / _RUNS


def _target(name: str) -> str:
    return f"results/designs/{name}/metrics"
