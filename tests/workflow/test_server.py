"""The server that runs the stages of a workflow, and what is left of it after a kill."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from pagd.record import read_record

from .conftest import ROOT, STRAIGHT, THIN, Project


def test_stages_run_in_forks_of_the_server(project: Project) -> None:
    project.write(STRAIGHT)
    note, endless = project.folder / "note", project.folder / "openscad"
    tell = f"echo $$ $PPID > {note}.new && mv {note}.new {note}"
    endless.write_text(f"#!/bin/sh\n{tell}\nexec sleep 600\n")
    endless.chmod(0o755)
    snakemake = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    target = "results/designs/straight/geometry"
    path = f"{project.folder}:{os.environ['PATH']}"
    with (
        (project.folder / "output").open("w") as output,
        subprocess.Popen(
            [*snakemake, "--profile", str(ROOT / "profiles/default"), "--", target],
            cwd=project.folder,
            env=os.environ | {"PATH": path},
            stdout=output,
            stderr=output,
        ) as process,
    ):
        wait_for(note.is_file)
        openscad, worker = map(int, note.read_text().split())
        server = int(re.findall(r"^PPid:\s+(\d+)$", status(worker), re.MULTILINE)[0])
        assert "pagd.cli.server" in Path(f"/proc/{server}/cmdline").read_text()
        process.send_signal(signal.SIGKILL)
    wait_for(lambda: not any(status(one) for one in (openscad, worker, server)))

    # Nothing is left of the design, and the run goes on once the lock is taken away.
    assert not (project / "designs/straight/geometry").exists()
    assert project.snakemake("--unlock").returncode == 0
    assert project.snakemake("--", target).returncode == 0
    assert read_record(project / "designs/straight/geometry").status == "ok"


def test_a_run_on_this_machine_has_no_limit_of_jobs_per_second(project: Project) -> None:
    """With one, the looks at the ready jobs grow more and more frequent."""
    project.write(THIN, THIN.replace("thin", "other"))
    targets = [f"results/designs/{name}/mesh" for name in ("thin", "other")]
    answer = project.snakemake("--max-jobs-per-timespan", "1/1s", "--", *targets)
    assert answer.returncode == 0, answer.stderr
    assert "rate limit" not in answer.stderr


def status(process: int) -> str:
    """Return what the system tells of a process; nothing if it has ended."""
    try:
        text = Path(f"/proc/{process}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return ""
    return "" if re.search(r"^State:\s+Z", text, re.MULTILINE) else text


def wait_for(condition: Callable[[], bool], seconds: float = 30.0) -> None:
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit
        time.sleep(0.02)
