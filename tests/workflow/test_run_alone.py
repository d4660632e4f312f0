"""One run in a folder at a time, and what a killed one has left is no hindrance."""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys

import pytest

from pagd.record import read_record

from .conftest import ROOT, STRAIGHT, Project

TARGET = "results/designs/straight/geometry"


@pytest.fixture
def begun(project: Project) -> Project:
    """A project that has drawn its design."""
    project.write(STRAIGHT)
    assert run_alone(project).returncode == 0
    return project


def run_alone(project: Project) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "workflow/scripts/run_alone.py")]
    command += ["--snakefile", str(ROOT / "Snakefile")]
    command += ["--profile", str(ROOT / "profiles/default"), "--cores", "1", "--", TARGET]
    return subprocess.run(command, cwd=project.folder, capture_output=True, text=True, check=False)


def test_a_second_run_is_refused_in_one_sentence(begun: Project) -> None:
    with (begun.folder / ".snakemake/run.lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        answer = run_alone(begun)
    assert answer.returncode == 2
    assert answer.stderr == f"pagd: another run is at work in {begun.folder}; wait for it.\n"
    assert "Nothing to be done" in run_alone(begun).stderr


def test_a_run_without_the_script_is_noticed_too(begun: Project) -> None:
    own = begun.folder / "snakemake"
    own.write_text("import time\ntime.sleep(60)\n")
    with subprocess.Popen([sys.executable, str(own)], cwd=begun.folder) as other:
        try:
            assert run_alone(begun).returncode == 2
        finally:
            other.kill()
    assert run_alone(begun).returncode == 0


def test_the_lock_of_a_killed_run_is_taken_away(begun: Project) -> None:
    shutil.rmtree(begun.folder / TARGET)
    lock = begun.folder / ".snakemake/locks/0.output.lock"
    lock.parent.mkdir(exist_ok=True)
    lock.write_text(f"{TARGET}\n")
    assert "LockException" in begun.snakemake("--", TARGET).stderr
    answer = run_alone(begun)
    assert answer.returncode == 0, answer.stderr
    assert "going on where it was" in answer.stderr
    assert read_record(begun.folder / TARGET).status == "ok"


def test_what_a_power_cut_has_damaged_is_made_again(begun: Project) -> None:
    whole = (begun.folder / TARGET / "design.scad").read_bytes()
    os.truncate(begun.folder / TARGET / "design.scad", 10)
    assert run_alone(begun).returncode == 0
    assert (begun.folder / TARGET / "design.scad").read_bytes() == whole
    assert read_record(begun.folder / TARGET).status == "ok"
