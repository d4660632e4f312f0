"""A sweep through Slurm: a dozen designs, a job of which is killed on its node."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest

from pagd.tables import read_rows

from .conftest import ROOT, Project
from .slurm import PLACE, PROGRAMS, Slurm, is_of_others

MISSING = [program for program in PROGRAMS if shutil.which(program) is None]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(bool(MISSING), reason=f"Slurm is not installed: {', '.join(MISSING)}"),
    pytest.mark.skipif(os.geteuid() != 0, reason="Slurm starts jobs as root only"),
    pytest.mark.skipif(is_of_others(), reason=f"{PLACE} is that of another cluster"),
]

ROWS = [
    f"s{n:02d},9.5,15,13,{3 + 0.1 * n:.1f},2,4,2,2.2,2,0,0"
    if n % 2
    else f"h{n:02d},8,16,10,{2 + 0.1 * n:.1f},3,3,2,2.4,2,20,1"
    for n in range(12)
]


@pytest.fixture(scope="module")
def slurm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Slurm]:
    """A cluster of one node."""
    cluster = Slurm(tmp_path_factory.mktemp("slurm"))
    try:
        cluster.start()
        yield cluster
    finally:
        cluster.stop()


def test_a_sweep_of_a_dozen_designs_survives_a_kill(slurm: Slurm, project: Project) -> None:
    project.write(*ROWS)
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--profile", str(ROOT / "profiles" / "slurm"), "--latency-wait", "5"]
    # This cluster keeps no accounts: what becomes of jobs is to be asked of the queue.
    command += ["--slurm-status-command", "squeue"]
    # Fewer at a time than are ready, as in any large sweep; and no more memory than a laptop has.
    command += ["--jobs", "8", "--set-resources", "solve:mem_mb=1500", "prepare:mem_mb=1500"]
    command += ["--slurm-init-seconds-before-status-checks", "2", "--", "summary"]
    output = project.folder / "output"
    with output.open("w") as file:
        run = subprocess.Popen(command, cwd=project.folder, stdout=file, stderr=file)
    try:
        killed = kill_a_solve(slurm, run)
        assert run.wait(timeout=600) == 0, output.read_text()[-3000:]
    finally:
        run.kill()

    rows = read_rows(project / "summary/performance.parquet")
    assert {row["design_id"]: row["status"] for row in rows} == {
        row.partition(",")[0]: "ok" for row in ROWS
    }
    told = output.read_text()
    assert f"external_jobid: {killed}" in told, "the killed job was not noticed"
    assert "Trying to restart job" in told


def kill_a_solve(slurm: Slurm, run: subprocess.Popen[bytes]) -> str:
    """Kill what a job of the rule solve runs on its node; return the job's number."""
    while run.poll() is None:
        lines = slurm.ask("squeue", "--noheader", "--states=RUNNING", "--format", "%i|%k")
        jobs = [line.partition("|")[0] for line in lines.splitlines() if "rule_solve" in line]
        if jobs:
            slurm.ask("scancel", "--signal=KILL", "--full", jobs[0])
            return jobs[0]
        time.sleep(0.2)
    pytest.fail("no design was solved by a job of Slurm")
