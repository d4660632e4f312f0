"""A sweep through Kubernetes: the real client and executor, and a stand-in for the cluster."""

from __future__ import annotations

import os
import re
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
PROPERTIES = (
    '#!/bin/sh\n# properties = {"rule": "prepare", "params": {"a": 1}, "jobid": 7, '
    '"input": ["results/in"], "output": ["results/one"]}\n'
)


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
    # What was done when Snakemake was killed has not been submitted again. (What came to its end
    # while no Snakemake was there to note it may have been: up to two, on two processors.)
    rules = Counter(name.split("-")[1] for name in cluster.jobs)
    assert rules["prepare"] == 3
    assert 4 <= rules["solve"] <= 6


def test_the_job_is_one_by_the_models_of_the_official_client(cloned: Project) -> None:
    answer = script(cloned, *SUBMIT, "--cores", 2, "--minutes", 40, "--dry-run", "jobscript")
    assert answer.returncode == 0, answer.stderr
    job = yaml.safe_load(answer.stdout)
    assert fault_of(job) is None
    # Of the pod, not of the Job, whose time would count while the pod waits for a node.
    assert "activeDeadlineSeconds" not in job["spec"]
    assert job["spec"]["template"]["spec"]["activeDeadlineSeconds"] == 2400
    (container,) = job["spec"]["template"]["spec"]["containers"]
    assert container["resources"] == {
        "requests": {"cpu": "2", "memory": "2000M"},
        "limits": {"memory": "2000M"},
    }
    assert container["workingDir"] == str(cloned.folder)
    assert job["metadata"]["name"].startswith("pagd-prepare-")


def test_snakemake_in_a_pod_may_do_what_the_script_asks_for() -> None:
    parts = yaml.safe_load_all((ROOT / "profiles/kubernetes/snakemake.yaml").read_text())
    by_kind = {part["kind"]: part for part in parts}
    assert fault_of(by_kind["Job"]) is None
    (rule,) = by_kind["Role"]["rules"]
    source = (ROOT / "workflow/scripts/kubernetes_job.py").read_text()
    asked = set(re.findall(r'"(\w+)_namespaced_job"', source))
    assert {one if one != "read" else "get" for one in asked} == set(rule["verbs"])
    account = by_kind["Job"]["spec"]["template"]["spec"]["serviceAccountName"]
    assert account == by_kind["ServiceAccount"]["metadata"]["name"]


def lacking_spec(job: dict[str, Any]) -> None:
    del job["spec"]["template"]["spec"]["containers"]


def mistyped(job: dict[str, Any]) -> None:
    job["spec"]["backofLimit"] = 1


def on_the_nodes(job: dict[str, Any]) -> None:
    pod = job["spec"]["template"]["spec"]
    pod["volumes"][0] = {"name": "project", "emptyDir": {}}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lacking_spec, "job.yaml lacks containers."),
        (mistyped, "job.yaml is no Job of Kubernetes: spec.backofLimit: Extra inputs"),
        (on_the_nodes, "is below no mountPath of a shared volume (none)."),
        (lambda job: job.update(kind="Pod"), "is not a Job of Kubernetes."),
    ],
)
def test_a_template_that_cannot_be_used_is_told(
    cluster: Cluster, cloned: Project, change: Any, words: str
) -> None:
    adapt(cloned, change)
    answer = ask(cloned, cluster, *SUBMIT, "--minutes", 40, "jobscript")
    assert (answer.returncode, answer.stdout) == (2, "")
    assert answer.stderr.startswith("pagd: ")
    assert words in answer.stderr
    assert len(answer.stderr.splitlines()) == 1
    assert cluster.jobs == {}


def test_a_job_script_of_nobody_is_refused(cluster: Cluster, cloned: Project) -> None:
    (cloned.folder / "jobscript").write_text("sleep 1\n")
    answer = ask(cloned, cluster, *SUBMIT, "--minutes", 40, "jobscript")
    assert answer.stderr == "pagd: jobscript: is no job script of Snakemake.\n"


def test_a_cluster_that_does_not_answer_has_not_lost_its_jobs(
    cluster: Cluster, cloned: Project
) -> None:
    question = ("status", "default/pagd-solve-1")
    # A Job that is not there has been deleted.
    assert ask(cloned, cluster, *question).stdout == "failed\n"
    (cloned.folder / ".snakemake/kubernetes.json").unlink()
    cluster.out_of_order = 503
    answer = ask(cloned, cluster, *question)
    assert (answer.returncode, answer.stdout) == (0, "running\n")
    assert answer.stderr == "pagd: Kubernetes answers 503: out of order\n"
    # What will never be answered is not waited for.
    cluster.out_of_order = 403
    answer = ask(cloned, cluster, *question)
    assert (answer.returncode, answer.stdout) == (2, "")
    cluster.stop()
    answer = ask(cloned, cluster, *question)
    assert (answer.returncode, answer.stdout) == (0, "running\n")
    assert answer.stderr.startswith("pagd: Kubernetes does not answer: ")


def test_a_job_is_submitted_though_the_cluster_was_out_of_order(
    cluster: Cluster, cloned: Project
) -> None:
    cluster.out_of_order, cluster.out_of_order_for = 500, 1
    answer = ask(cloned, cluster, *SUBMIT, "--minutes", 40, "jobscript")
    assert answer.returncode == 0
    assert answer.stdout.strip().removeprefix("default/") in cluster.jobs
    assert "Kubernetes answers 500: out of order" in answer.stderr


def test_without_a_cluster_one_sentence(cloned: Project, tmp_path: Path) -> None:
    environment = os.environ | {"KUBECONFIG": str(tmp_path / "none")}
    answer = script(cloned, *SUBMIT, "--minutes", 40, "jobscript", env=environment)
    assert answer.returncode == 2
    assert answer.stderr == "pagd: neither KUBECONFIG nor a pod tells of a cluster.\n"


def ask(project: Project, cluster: Cluster, *arguments: object) -> subprocess.CompletedProcess[str]:
    """The same with a cluster."""
    environment = os.environ | {"KUBECONFIG": str(cluster.configuration)}
    return script(project, *arguments, env=environment)


def submitted(project: Project, cluster: Cluster) -> str:
    """Submit the job script; the name of the Job."""
    answer = ask(project, cluster, *SUBMIT, "--minutes", 40, "jobscript")
    assert answer.returncode == 0, answer.stderr
    return answer.stdout.strip().removeprefix("default/")


def change(project: Project, old: str, new: str) -> None:
    path = project.folder / "jobscript"
    path.write_text(path.read_text().replace(old, new))


def test_jobs_are_ended_where_the_executor_wants_it(cluster: Cluster, cloned: Project) -> None:
    first = submitted(cloned, cluster)
    change(cloned, "results/one", "results/two")
    second = submitted(cloned, cluster)
    # One that is gone keeps no other from being ended.
    answer = ask(cloned, cluster, f"default/{first}", "default/gone", f"default/{second}")
    assert answer.returncode == 0
    for _ in range(100):
        if not cluster.jobs:
            break
        time.sleep(0.1)
    assert cluster.jobs == {}


def test_a_job_at_work_is_taken_over(cluster: Cluster, cloned: Project) -> None:
    first = submitted(cloned, cluster)
    # The same job of another Snakemake, which numbers it otherwise.
    change(cloned, '"jobid": 7', '"jobid": 9')
    assert submitted(cloned, cluster) == first
    cluster.kill(first)
    while cluster.jobs[first]["status"] != {"failed": 1}:
        time.sleep(0.05)
    assert submitted(cloned, cluster) == f"{first}-2"


@pytest.mark.parametrize("what", ["params", "input"])
def test_a_job_at_work_on_something_else_is_ended(
    cluster: Cluster, cloned: Project, what: str
) -> None:
    record = cloned.folder / "results/in/record.json"
    record.parent.mkdir(parents=True)
    record.write_text("{}")
    first = submitted(cloned, cluster)
    if what == "params":
        change(cloned, '"a": 1', '"a": 2')
    else:
        record.write_text('{"made": "anew"}')
    second = submitted(cloned, cluster)
    assert second != first
    assert list(cluster.jobs) == [second]
    assert cluster.processes[first].wait(timeout=5) != 0


def test_the_same_place_on_another_volume_is_another_folder(cloned: Project) -> None:
    def labels() -> dict[str, str]:
        answer = script(cloned, *SUBMIT, "--minutes", 40, "--dry-run", "jobscript")
        found: dict[str, str] = yaml.safe_load(answer.stdout)["metadata"]["labels"]
        return found

    before = labels()
    assert labels() == before

    def other(job: dict[str, Any]) -> None:
        pod = job["spec"]["template"]["spec"]
        pod["volumes"][0]["persistentVolumeClaim"]["claimName"] = "of-somebody-else"

    adapt(cloned, other)
    after = labels()
    assert all(before[key] != after[key] for key in before if key != "app")
