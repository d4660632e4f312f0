"""A folder of its own for Snakemake, in which the sweep runs."""

from __future__ import annotations

import csv
import io
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import yaml

from pagd.catalogue import NamedDesign
from pagd.errors import InputError
from pagd.files import write_text

__all__ = ["ROOT", "DryRun", "Project"]

ROOT: Final = Path(__file__).parents[2]
_LOOK_EVERY_S: Final = 1.0


@dataclass(frozen=True, slots=True)
class DryRun:
    """Seconds until the table of jobs is there, and until the last of them is listed."""

    designs: int
    jobs: int
    table_s: float
    all_s: float


@dataclass(frozen=True, slots=True)
class Project:
    """A folder with a configuration and results; ``snakemake.log`` has what Snakemake says."""

    folder: Path

    @property
    def results(self) -> Path:
        """Folder of the results."""
        return self.folder / "results"

    def write(self, config: Mapping[str, Any]) -> None:
        """Write a whole configuration, beside the tables that it may name."""
        shutil.copytree(ROOT / "config", self.folder / "config", dirs_exist_ok=True)
        text = yaml.safe_dump(dict(config), allow_unicode=True)
        write_text(self.folder / "config" / "config.yaml", text)

    def write_table_alone(self, designs: Sequence[NamedDesign], config: Mapping[str, Any]) -> None:
        """Write a configuration whose designs are those given, in a table, and no others."""
        self.write({**config, "designs": {"random": "config/designs.csv"}})
        rows = [{"name": named.name, **named.design.as_dict()} for named in designs]
        text = io.StringIO()
        writer = csv.DictWriter(text, fieldnames=list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
        write_text(self.folder / "config" / "designs.csv", text.getvalue())

    def run(
        self, cores: int, targets: Sequence[str], look: Callable[[], None] = lambda: None
    ) -> int:
        """Let the sweep make its targets; return Snakemake's exit code.

        ``look`` is called every now and then meanwhile.
        """
        command = self._command("--cores", str(cores), "--", *targets)
        with (
            self._log.open("w", encoding="utf-8") as log,
            subprocess.Popen(command, cwd=self.folder, stdout=log, stderr=log) as process,
        ):
            while process.poll() is None:
                time.sleep(_LOOK_EVERY_S)
                look()
            return process.returncode

    def must_run(self, cores: int, targets: Sequence[str]) -> None:
        """Do the same, with ``InputError`` where it does not succeed."""
        if self.run(cores, targets) != 0:
            raise InputError(f"Snakemake has failed; {self._log} tells why.")

    def dry_run(self, designs: int) -> DryRun:
        """Time a dry run of the tables alone, which hold so many designs, up to the summary."""
        alone = ("--config", 'selection={"designs": 0}')
        command = self._command("--cores", "1", "--dry-run", *alone, "--", "summary")
        start, table_s, jobs = time.monotonic(), None, 0
        with (
            self._log.open("w", encoding="utf-8") as log,
            subprocess.Popen(
                command, cwd=self.folder, stdout=subprocess.PIPE, stderr=log, text=True
            ) as process,
        ):
            assert process.stdout is not None
            for line in process.stdout:
                if table_s is None and line.startswith("Job stats:"):
                    table_s = time.monotonic() - start
                if line.startswith("total "):
                    jobs = int(line.split()[1])
        if process.returncode != 0 or table_s is None:
            raise InputError(f"The dry run has failed; {self._log} tells why.")
        return DryRun(designs, jobs, table_s, time.monotonic() - start)

    @property
    def _log(self) -> Path:
        return self.folder / "snakemake.log"

    def _command(self, *arguments: str) -> list[str]:
        command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
        command += ["--profile", str(ROOT / "profiles" / "sweep")]
        # A run that was killed leaves its lock; nothing else runs in this folder.
        return [*command, "--nolock", *arguments]
