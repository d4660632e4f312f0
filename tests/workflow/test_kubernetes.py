"""A sweep through Kubernetes: the real client and executor, and a stand-in for the cluster."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from pagd.tables import read_rows

from .conftest import ROOT, SLANTED, STRAIGHT, Project
from .kubernetes_api import Cluster, fault_of, memory_of

ROWS = [
    STRAIGHT.replace("straight", "first"),
    SLANTED.replace("slanted", "second"),
    STRAIGHT.replace("straight", "third").replace(",13,4,", ",13,4.2,"),
]

#: The beginning of a job script of Snakemake.
PROPERTIES = '#!/bin/sh\n# properties = {"rule": "prepare", "params": {"a": 1}, "jobid": 7}\n'


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    """A cluster that knows no Jobs."""
    (tmp_path / "cluster").mkdir()
    found = Cluster(tmp_path / "cluster")
    found.start()
    yield found
    found.stop()


@pytest.fixture
def cloned(project: Project) -> Project:
    """The project with the workflow in its folder, as in a clone on a volume of the cluster."""
    for name in ("workflow", "profiles"):
        unwanted = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, project.folder / name, ignore=unwanted)
    shutil.copyfile(ROOT / "Snakefile", project.folder / "Snakefile")
    adapt(project, lambda pod: None)
    (project.folder / "jobscript").write_text(f"{PROPERTIES}sleep 60\n")
    return project


def adapt(project: Project, change: Any) -> None:
    """Change the template as a user would: the volume is where the project is, and …"""
    path = project.folder / "profiles/kubernetes/job.yaml"
    content = yaml.safe_load(path.read_text())
    container = content["spec"]["template"]["spec"]["containers"][0]
    container["volumeMounts"][0]["mountPath"] = str(project.folder.parent)
    container["env"][0]["value"] = str(project.folder.parent)
    change(content)
    path.write_text(yaml.safe_dump(content))


def start(project: Project, cluster: Cluster) -> subprocess.Popen[bytes]:
    """Start the sweep; what it says goes to the file ``output``."""
    command = [sys.executable, "-m", "snakemake", "--profile", "profiles/kubernetes"]
    command += ["--latency-wait", "5", "--seconds-between-status-checks", "1", "--", "summary"]
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    with (project.folder / "output").open("a") as file:
        return subprocess.Popen(
            command,
            cwd=project.folder,
            stdout=file,
            stderr=file,
            env=os.environ | {"KUBECONFIG": str(cluster.configuration), "PATH": path},
        )


def script(
    project: Project, *arguments: object, **options: Any
) -> subprocess.CompletedProcess[str]:
    """What the script of the profile answers."""
    command = [sys.executable, "workflow/scripts/kubernetes_job.py", *map(str, arguments)]
    return subprocess.run(
        command, cwd=project.folder, capture_output=True, text=True, check=False, **options
    )


SUBMIT = ("submit", "profiles/kubernetes/job.yaml", "--rule", "prepare", "--memory-mb", 2000)


@pytest.mark.slow
def test_a_sweep_survives_a_killed_pod_and_a_killed_snakemake(
    cluster: Cluster, cloned: Project
) -> None:
    cloned.write(*ROWS)
    run = start(cloned, cluster)
    try:
        killed = cluster.wait_for("solve", run)
        cluster.kill(killed)
        again = cluster.wait_for("solve", run, memory="8000M")
        # Pods go on while nobody asks for them, and the next Snakemake takes them over.
        run.kill()
        run.wait()
        shutil.rmtree(cloned.folder / ".snakemake/locks")
        run = start(cloned, cluster)
        assert run.wait(timeout=400) == 0, (cloned.folder / "output").read_text()[-3000:]
    finally:
        run.kill()
    rows = read_rows(cloned / "summary/performance.parquet")
    assert {row["design_id"]: row["status"] for row in rows} == dict.fromkeys(
        ("first", "second", "third"), "ok"
    )
    assert cluster.refusals == 0
    assert cluster.jobs[killed]["status"] == {"failed": 1}
    assert cluster.jobs[again]["status"] == {"succeeded": 1}
    assert memory_of(cluster.jobs[killed]) == "4000M"
    # Nothing that was done, or at work, when Snakemake was killed has been submitted again.
    rules = Counter(name.split("-")[1] for name in cluster.jobs)
    assert (rules["prepare"], rules["solve"], rules["metrics"]) == (3, 4, 3)


def test_the_job_is_one_by_the_models_of_the_official_client(cloned: Project) -> None:
    answer = script(cloned, *SUBMIT, "--cores", 2, "--minutes", 40, "--dry-run", "jobscript")
    assert answer.returncode == 0, answer.stderr
    job = yaml.safe_load(answer.stdout)
    assert fault_of(job) is None
    spec = job["spec"]
    assert spec["activeDeadlineSeconds"] == 2400
    (container,) = spec["template"]["spec"]["containers"]
    assert container["resources"] == {
        "requests": {"cpu": "2", "memory": "2000M"},
        "limits": {"memory": "2000M"},
    }
    assert container["workingDir"] == str(cloned.folder)
    assert job["metadata"]["name"].startswith("pagd-prepare-")


def test_a_template_with_an_unknown_field_is_told(cluster: Cluster, cloned: Project) -> None:
    adapt(cloned, lambda job: job["spec"].update(backofLimit=1))
    environment = os.environ | {"KUBECONFIG": str(cluster.configuration)}
    answer = script(cloned, *SUBMIT, "--minutes", 40, "jobscript", env=environment)
    assert (answer.returncode, answer.stdout) == (2, "")
    told = "pagd: job.yaml is no Job of Kubernetes: spec.backofLimit: Extra inputs"
    assert answer.stderr.startswith(told)
    assert len(answer.stderr.splitlines()) == 1


def test_a_project_that_pods_do_not_see_is_refused(cloned: Project) -> None:
    shutil.copyfile(
        ROOT / "profiles/kubernetes/job.yaml", cloned.folder / "profiles/kubernetes/job.yaml"
    )
    answer = script(cloned, *SUBMIT, "--minutes", 40, "--dry-run", "jobscript")
    assert answer.returncode == 2
    assert "is below no mountPath of the pods (/pagd, /scratch): see job.yaml." in answer.stderr


def test_a_cluster_that_does_not_answer_has_not_lost_its_jobs(
    cluster: Cluster, cloned: Project
) -> None:
    environment = os.environ | {"KUBECONFIG": str(cluster.configuration)}
    ask = ("status", "profiles/kubernetes/job.yaml", "pagd-solve-1")
    # A Job that is not there has been deleted.
    assert script(cloned, *ask, env=environment).stdout == "failed\n"
    cluster.stop()
    (cloned.folder / ".snakemake/kubernetes.json").unlink()
    answer = script(cloned, *ask, env=environment)
    assert answer.stdout == "running\n"
    assert answer.stderr.startswith("pagd: Kubernetes does not answer: ")
    assert answer.returncode == 0


def test_without_a_cluster_one_sentence(cloned: Project, tmp_path: Path) -> None:
    environment = os.environ | {"KUBECONFIG": str(tmp_path / "none")}
    answer = script(cloned, *SUBMIT, "--minutes", 40, "jobscript", env=environment)
    assert answer.returncode == 2
    assert answer.stderr == "pagd: neither KUBECONFIG nor a pod tells of a cluster.\n"


def test_jobs_are_ended_where_the_executor_wants_it(cluster: Cluster, cloned: Project) -> None:
    environment = os.environ | {"KUBECONFIG": str(cluster.configuration)}
    name = script(cloned, *SUBMIT, "--minutes", 40, "jobscript", env=environment).stdout.strip()
    assert name in cluster.jobs
    assert script(cloned, name, env=environment).returncode == 0
    for _ in range(100):
        if name not in cluster.jobs:
            break
        time.sleep(0.1)
    assert name not in cluster.jobs


def test_a_job_at_work_is_taken_over_and_a_finished_one_is_not(
    cluster: Cluster, cloned: Project
) -> None:
    environment = os.environ | {"KUBECONFIG": str(cluster.configuration)}

    def name() -> str:
        answer = script(cloned, *SUBMIT, "--minutes", 40, "jobscript", env=environment)
        assert answer.returncode == 0, answer.stderr
        return answer.stdout.strip()

    path = cloned.folder / "jobscript"
    first = name()
    # The same job of another Snakemake, which numbers it otherwise.
    path.write_text(path.read_text().replace('"jobid": 7', '"jobid": 9'))
    assert name() == first
    # The same rule with other settings.
    path.write_text(path.read_text().replace('"a": 1', '"a": 2'))
    other = name()
    assert other != first
    cluster.kill(other)
    while cluster.jobs[other]["status"] != {"failed": 1}:
        time.sleep(0.05)
    assert name() == f"{other}-2"
