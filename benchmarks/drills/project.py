"""A small sweep in a folder of its own, that faults can be done to, and what is left of it."""

from __future__ import annotations

import base64
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

ROOT = Path(__file__).parents[2]
STAGES = ("geometry", "repair", "mesh", "solve", "metrics")
HEAD = "name,L,W,H,t,t_n,t_h,t_ab,t_b,N,theta,alpha"

# Small actuators of two chambers that differ in their walls: a second or two each.
STRAIGHT = "s{n:02d},9.5,15,13,{t},2,4,2,2.2,2,0,0"
SLANTED = "h{n:02d},8,16,10,{t},3,3,2,2.4,2,20,1"

SETTINGS: dict[str, Any] = {
    "designs": {"own": "config/designs.csv"},
    "mesh": {"size_mm": 6.0},
    "solve": {"maximum_pressure_kPa": 4.0, "recorded_step_kPa": 2.0},
    "metrics": {"still_deg": 0.01, "joint_deg": 0.001},
    "selection": {"designs": 0},
}

#: Figures of a record that tell one run of a design from another, and nothing of its result.
_OF_THE_RUN = ("cpu_s", "wall_s", "peak_memory_MB")


def rows_of(count: int) -> list[str]:
    """Return the rows of so many designs, straight and slanted by turns."""
    return [
        (SLANTED if n % 2 else STRAIGHT).format(n=n, t=round(2.5 + 0.1 * n, 2))
        for n in range(count)
    ]


@dataclass
class Sweep:
    """A folder with a configuration, and Snakemake to run in it."""

    folder: Path
    designs: int = 6
    settings: dict[str, Any] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        config = self.folder / "config"
        config.mkdir(parents=True, exist_ok=True)
        materials = (ROOT / "config" / "materials.yaml").read_text(encoding="utf-8")
        (config / "materials.yaml").write_text(materials, encoding="utf-8")
        table = "\n".join([HEAD, *rows_of(self.designs), ""])
        (config / "designs.csv").write_text(table, encoding="utf-8")
        whole = SETTINGS | {
            key: SETTINGS.get(key, {}) | value for key, value in self.settings.items()
        }
        (config / "config.yaml").write_text(yaml.safe_dump(whole), encoding="utf-8")

    @property
    def names(self) -> list[str]:
        """Names of the designs."""
        return [row.partition(",")[0] for row in rows_of(self.designs)]

    def record(self, name: str, stage: str = "metrics") -> Path:
        """Where the record of a design's stage is."""
        return self.folder / "results" / "designs" / name / stage / "record.json"

    def command(self, *more: str) -> list[str]:
        """The command of a run, as the targets of the Makefile give it."""
        script = str(ROOT / "workflow" / "scripts" / "run_alone.py")
        snakemake = ["--snakefile", str(ROOT / "Snakefile")]
        profile = ["--profile", str(ROOT / "profiles" / "default"), "--cores", "2"]
        return [sys.executable, script, *snakemake, *profile, *more, "--", "summary"]

    def start(self, *more: str) -> subprocess.Popen[str]:
        """Begin a run."""
        with (self.folder / "output.txt").open("a", encoding="utf-8") as output:
            return subprocess.Popen(
                self.command(*more),
                cwd=self.folder,
                env=os.environ | self.environment,
                stdout=output,
                stderr=output,
                text=True,
                start_new_session=True,
            )

    def run(self, *more: str) -> int:
        """Run to the end; the exit code."""
        with self.start(*more) as process:
            return process.wait()

    def go_on(self, *more: str) -> None:
        """Start it again; AssertionError, with the last words, unless it comes to its end."""
        code = self.run(*more)
        told = (self.folder / "output.txt").read_text(encoding="utf-8").strip()[-500:]
        assert code == 0, f"started again, it ended with {code}: {told}"

    def pagd(self, *words: str) -> subprocess.CompletedProcess[str]:
        """Run a command of pagd in the folder."""
        command = [sys.executable, "-P", "-m", "pagd", *words]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)

    def done(self) -> dict[str, float]:
        """The designs that have a record of their last stage, with the time it was written."""
        found = {name: self.record(name) for name in self.names}
        return {name: p.stat().st_mtime for name, p in found.items() if p.is_file()}

    def noted(self) -> dict[str, float]:
        """Of those, the ones that Snakemake has noted as done: no job of theirs is still open."""
        markers = self.folder / ".snakemake" / "incomplete"
        opened = {_decoded(path.name) for path in markers.glob("*") if path.is_file()}
        return {name: when for name, when in self.done().items() if not _is_open(name, opened)}

    def results(self) -> dict[str, Any]:
        """What the records of the last stage say of the designs, but for times and memory."""
        found = {}
        for name in self.done():
            content = json.loads(self.record(name).read_text(encoding="utf-8"))
            figures = content["figures"]
            kept = {key: value for key, value in figures.items() if key not in _OF_THE_RUN}
            found[name] = (content["status"], content["reason"], kept)
        return found

    def leftovers(self) -> list[Path]:
        """Temporary files and folders that nobody will ever rename."""
        return sorted((self.folder / "results").rglob(".*.*"))


def _decoded(name: str) -> str:
    """The output that a marker of Snakemake's stands for: its path, in Base64."""
    return base64.b64decode(name, altchars=b"-_").decode(errors="replace")


def _is_open(name: str, outputs: set[str]) -> bool:
    return any(f"designs/{name}/" in output for output in outputs)


def wait_for(what: Callable[[], Any], seconds: float = 120.0) -> None:
    """Return as soon as something is so; AssertionError if it is not in time."""
    limit = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < limit, "it did not happen in time"
        time.sleep(0.02)


@contextmanager
def mounted(folder: Path, *how: str) -> Any:
    """Mount something on a folder for the block."""
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["mount", *how, str(folder)], check=True, capture_output=True)
    try:
        yield folder
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)
