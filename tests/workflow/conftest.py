"""A project of its own for Snakemake: tiny designs, a coarse mesh, a few kPa."""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import pytest
import yaml

from pagd.tables import units

ROOT = Path(__file__).parents[2]
HEAD = "name,L,W,H,t,t_n,t_h,t_ab,t_b,N,theta,alpha"
STRAIGHT = "straight,9.5,15,13,4,2,4,2,2.2,2,0,0"
SLANTED = "slanted,8,16,10,2,3,3,2,2.4,2,20,1"
#: Walls of 0.2 mm: refused before anything is drawn.
THIN = "thin,9.5,15,13,0.2,2,4,0.2,2.2,2,0,0"

SETTINGS: dict[str, Any] = {
    "designs": {"own": "config/designs.csv"},
    "mesh": {"size_mm": 6.0},
    "solve": {"maximum_pressure_kPa": 4.0, "recorded_step_kPa": 2.0},
    # So little pressure moves the tip by a fraction of a degree.
    "metrics": {"still_deg": 0.01, "joint_deg": 0.001},
    "figures": {"resolution_dpi": 60},
    # Without it, nothing of the generative half belongs to a run.
    "selection": {"designs": 0},
}

#: A small generative half: 300 training designs, 40 generated ones, 3 of which are simulated.
GENERATIVE: dict[str, Any] = {
    "solve": {"maximum_pressure_kPa": 2.0, "recorded_step_kPa": 1.0},
    "figures": {"drawn_designs": 0},
    "dataset": {"size": 300},
    "embedding": {"perplexity": 10.0},
    "generator": {"designs": 40, "largest_components": 3},
    "diversity": {
        "plane_designs": 60,
        "plane_seeds": 2,
        "hull_designs": 20,
        "hull_repeats": 10,
        "neighbours": 3,
    },
    "selection": {"designs": 3},
    "screening": {"training_designs": 10, "designs_per_job": 10},
}


@dataclass(frozen=True)
class Project:
    """A folder with a configuration, and Snakemake to run in it."""

    folder: Path

    def write(self, *rows: str, **settings: dict[str, Any]) -> None:
        """Write the table of designs and the configuration."""
        config = self.folder / "config"
        config.mkdir(exist_ok=True)
        shutil.copy(ROOT / "config" / "materials.yaml", config)
        (config / "designs.csv").write_text("\n".join([HEAD, *rows, ""]))
        whole = {key: SETTINGS.get(key, {}) | settings.get(key, {}) for key in SETTINGS | settings}
        (config / "config.yaml").write_text(yaml.safe_dump(whole))

    def snakemake(self, *arguments: str, **options: Any) -> subprocess.CompletedProcess[str]:
        """Run Snakemake; its output is in ``stdout`` and ``stderr``."""
        command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
        command += ["--profile", str(ROOT / "profiles" / "default"), "--cores", "2", *arguments]
        return subprocess.run(
            command, cwd=self.folder, capture_output=True, text=True, check=False, **options
        )

    def pending(self) -> set[str]:
        """Return the outputs that a run would make or make again."""
        answer = self.snakemake("--summary")
        assert answer.returncode == 0, answer.stderr
        heading, *lines = answer.stdout.splitlines()
        plan = heading.split("\t").index("plan")
        rows = [line.split("\t") for line in lines]
        return {row[0].removeprefix("results/") for row in rows if row[plan] != "no update"}

    def __truediv__(self, path: str) -> Path:
        return self.folder / "results" / path


def undeclared_tables(results: Path) -> list[str]:
    """Return the tables under ``results`` that docs/data.md lacks, or has with other columns."""
    path = ROOT / "workflow" / "scripts" / "data_dictionary.py"
    spec = importlib.util.spec_from_file_location("data_dictionary", path)
    assert spec is not None
    assert spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    declared = {file: table.columns for table in script.TABLES for file in table.files}
    found = sorted(str(file.relative_to(results)) for file in results.rglob("*.parquet"))
    assert found
    told = {
        file: next((c for pattern, c in declared.items() if fnmatch(file, pattern)), ())
        for file in found
    }
    return [
        file
        for file, columns in told.items()
        if units(results / file) != {column.name: column.unit for column in columns}
    ]


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """An empty project."""
    return Project(tmp_path)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """A project that has run: a straight, a slanted and an impossible design."""
    project = Project(tmp_path_factory.mktemp("finished"))
    project.write(STRAIGHT, SLANTED, THIN)
    answer = project.snakemake()
    assert answer.returncode == 0, answer.stderr
    return project


@pytest.fixture(scope="module")
def generative(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """A project that has run with its generative half, and one small design of its own."""
    project = Project(tmp_path_factory.mktemp("generative"))
    project.write(STRAIGHT, **GENERATIVE)
    answer = project.snakemake()
    assert answer.returncode == 0, answer.stderr
    return project


@pytest.fixture
def copied(generative: Project, tmp_path: Path) -> Project:
    """A copy of that project, to be changed and run."""
    shutil.copytree(generative.folder, tmp_path / "copy")
    return Project(tmp_path / "copy")
