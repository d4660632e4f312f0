#!/usr/bin/env python3
"""Jobs of the workflow as Jobs of Kubernetes, for the executor cluster-generic of Snakemake.

    kubernetes_job.py submit job.yaml --rule solve --memory-mb 4000 --minutes 120 JOBSCRIPT
    kubernetes_job.py status NAMESPACE/NAME
    kubernetes_job.py NAMESPACE/NAME…       ends them, as the executor asks for it

The first prints NAMESPACE/NAME of the Job, the second success, running or failed, as the executor
reads it. Errors are one sentence on stderr and exit code 2.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml

# One question to the cluster answers for all jobs, for so many seconds.
KEPT_S = 5.0
KEPT = Path(".snakemake") / "kubernetes.json"
# Labels of a Job: of which folder it is, what it is to make, and of what.
FOLDER, OUTPUT, MADE_OF = "pagd-folder", "pagd-output", "pagd-made-of"
# How the line of a job script begins that tells what the job is.
PROPERTIES = "# properties = "
# Of these, what tells one job from another; the rest may differ from run to run.
OF_JOB = ("rule", "wildcards", "params", "output")
# A name of Kubernetes has 63 letters at most; the rule is there for people.
LONGEST_RULE = 40
# Answers of the interface after which asking again may help; 404: what is gone is gone.
PASSING, GONE = (408, 429, 500, 502, 503, 504), 404
# Seconds: until an answer must be there, between tries, and until a pod must be gone.
ANSWER_S, PAUSES_S, GONE_S = 30, (1, 4, 15), 120


class RefusedError(Exception):
    """What the user has asked for cannot be done; the message says why."""


class NoAnswerError(Exception):
    """The cluster does not answer now."""


class GoneError(Exception):
    """There is no such Job."""


# ---- what a Job is -------------------------------------------------------------------------------


def job(
    template: dict[str, Any], rule: str, cores: int, memory_MB: int, minutes: int, script: Path
) -> dict[str, Any]:
    """Return the Job of a job: the template with name, labels, command, resources and time.

    Memory is asked for and limited; of cores so many are asked for, and idle ones may be used. The
    time counts from when a node takes the pod, however long that has waited.
    """
    here, pod = Path.cwd(), part(template, "spec", "template", "spec")
    container = part(pod, "containers")[0]
    told = properties(script)
    # The same path may be another folder, on another volume.
    place = [here.as_uri(), volume_of(pod, container, here)]
    metadata = template["metadata"] = dict(template.get("metadata") or {})
    metadata["labels"] = dict(metadata.get("labels") or {}) | {
        FOLDER: digest(place),
        OUTPUT: digest([place, told.get("output")]),
        MADE_OF: digest([place, {key: told.get(key) for key in OF_JOB}, inputs(told)]),
    }
    readable = re.sub(r"[^a-z0-9]+", "-", rule.lower())[:LONGEST_RULE].strip("-")
    metadata["name"] = f"pagd-{readable}-{metadata['labels'][MADE_OF]}"
    pod["activeDeadlineSeconds"] = 60 * minutes
    container["command"] = ["/bin/sh", str(script.resolve())]
    container["workingDir"] = str(here)
    container["resources"] = {
        "requests": {"cpu": str(cores), "memory": f"{memory_MB}M"},
        "limits": {"memory": f"{memory_MB}M"},
    }
    return template


def volume_of(pod: dict[str, Any], container: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the volume that the pods see a folder on; a pod's own disk is none of these."""
    volumes = {one.get("name"): one for one in pod.get("volumes") or []}
    shared = {
        Path(mount["mountPath"]): volumes[mount["name"]]
        for mount in container.get("volumeMounts") or []
        if mount.get("name") in volumes and "emptyDir" not in volumes[mount["name"]]
    }
    for place, volume in shared.items():
        if folder.is_relative_to(place):
            return volume
    places = ", ".join(map(str, shared)) or "none"
    raise RefusedError(f"{folder} is below no mountPath of a shared volume ({places}).")


def properties(script: Path) -> dict[str, Any]:
    """Return what a job script of Snakemake tells of its job."""
    try:
        lines = script.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise RefusedError(f"{script}: cannot be read ({error}).") from None
    told = next((line for line in lines if line.startswith(PROPERTIES)), None)
    if told is None:
        raise RefusedError(f"{script}: is no job script of Snakemake.")
    found: dict[str, Any] = json.loads(told.removeprefix(PROPERTIES))
    return found


def inputs(told: dict[str, Any]) -> list[list[str]]:
    """Return the inputs of a job and what tells that one has been made anew."""
    return [[name, _content(Path(name))] for name in told.get("input") or []]


def _content(path: Path) -> str:
    # The record of a stage has the checksums of its files.
    record = path / "record.json"
    if record.is_file():
        return hashlib.sha256(record.read_bytes()).hexdigest()
    return str(path.stat().st_mtime_ns) if path.exists() else "missing"


def digest(content: Any) -> str:
    """Return sixteen hexadecimal digits of the SHA-256 of some JSON."""
    text = json.dumps(content, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def state_of(status: Any) -> str:
    """Return the executor's word for the status of a Job."""
    if status.succeeded:
        return "success"
    conditions = status.conditions or []
    failed = any(one.type == "Failed" and one.status == "True" for one in conditions)
    return "failed" if status.failed or failed else "running"


def read(path: Path) -> dict[str, Any]:
    """Return the template."""
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise RefusedError(f"{path}: cannot be read ({error}).") from None
    if not isinstance(content, dict) or content.get("kind") != "Job":
        raise RefusedError(f"{path}: is not a Job of Kubernetes.")
    return content


def part(content: dict[str, Any], *keys: str) -> Any:
    """Return what is at some keys of a template."""
    for key in keys:
        if not isinstance(content, dict) or not content.get(key):
            raise RefusedError(f"job.yaml lacks {'.'.join(keys)}.")
        content = content[key]
    return content


# ---- what the executor asks for ------------------------------------------------------------------


def submit(options: argparse.Namespace) -> int:
    """Create a Job and print what it is named."""
    body = job(
        read(options.template),
        *(options.rule, options.cores, options.memory_mb, options.minutes, options.jobscript),
    )
    if options.dry_run:
        print(yaml.safe_dump(body, sort_keys=False), end="")
        return 0
    namespace = body["metadata"].get("namespace", "default")
    for pause in PAUSES_S:
        try:
            print(f"{namespace}/{created(namespace, body)}")
            return 0
        except NoAnswerError as error:
            print(f"pagd: {error}", file=sys.stderr)
            time.sleep(pause)
    return 2


def created(namespace: str, body: dict[str, Any]) -> str:
    """Return the name of the Job: a new one, or the same where it is at work already.

    A Snakemake that was killed leaves its Jobs at work; the next one takes them over. One that is
    at work on the same output with other inputs or settings is ended first.
    """
    labels = body["metadata"]["labels"]
    same = f"{FOLDER}={labels[FOLDER]},{OUTPUT}={labels[OUTPUT]}"
    there = asked("list_namespaced_job", namespace, label_selector=same).items
    for one in there:
        if state_of(one.status) == "running":
            if one.metadata.labels[MADE_OF] == labels[MADE_OF]:
                return str(one.metadata.name)
            end(namespace, one.metadata.name)
    first, taken = body["metadata"]["name"], {one.metadata.name for one in there}
    names = (first, *(f"{first}-{number}" for number in range(2, len(taken) + 2)))
    body["metadata"]["name"] = next(name for name in names if name not in taken)
    asked("create_namespaced_job", namespace, body)
    return str(body["metadata"]["name"])


def end(namespace: str, name: str) -> None:
    """Delete a Job, and wait until its pod is gone."""
    asked("delete_namespaced_job", name, namespace, propagation_policy="Foreground")
    for _ in range(GONE_S):
        try:
            asked("read_namespaced_job", name, namespace)
        except GoneError:
            return
        time.sleep(1)
    raise NoAnswerError(f"Job {name} is still there {GONE_S} s after it was deleted.")


def status(options: argparse.Namespace) -> int:
    """Print how a Job is, of a list of all that is asked for every few seconds."""
    namespace, _, name = options.job.rpartition("/")
    found, age = _kept()
    if age > KEPT_S:
        try:
            found = _states(namespace or "default")
        except NoAnswerError as error:
            # To be asked again: a cluster that does not answer has not lost its Jobs.
            print(f"pagd: {error}", file=sys.stderr)
            print("running")
            return 0
    elif name not in found:
        print("running")  # created after the list was made
        return 0
    # A Job that is not there has been deleted, by whoever.
    print(found.get(name, "failed"))
    return 0


def _kept() -> tuple[dict[str, str], float]:
    try:
        age = time.time() - KEPT.stat().st_mtime
        return json.loads(KEPT.read_text(encoding="utf-8")), age
    except (OSError, ValueError):
        return {}, float("inf")


def _states(namespace: str) -> dict[str, str]:
    """Ask the cluster how all Jobs of pagd are, and keep the answer."""
    answer = asked("list_namespaced_job", namespace, label_selector=FOLDER)
    found = {one.metadata.name: state_of(one.status) for one in answer.items}
    KEPT.parent.mkdir(exist_ok=True)
    temporary = KEPT.with_suffix(f".{os.getpid()}")
    temporary.write_text(json.dumps(found), encoding="utf-8")
    temporary.replace(KEPT)
    return found


def delete(jobs: Iterable[str]) -> int:
    """Delete Jobs with their pods; 2 where any is left."""
    left = 0
    for one in jobs:
        namespace, _, name = one.rpartition("/")
        try:
            asked(
                "delete_namespaced_job",
                *(name, namespace or "default"),
                propagation_policy="Background",
            )
        except GoneError:
            pass
        except (NoAnswerError, RefusedError) as error:
            print(f"pagd: {one}: {error}", file=sys.stderr)
            left += 1
    return 2 if left else 0


def asked(what: str, *arguments: Any, **options: Any) -> Any:
    """Return what Kubernetes answers; its library is imported late, since that takes a second."""
    from kubernetes import client, config
    from pydantic import ValidationError
    from urllib3.exceptions import HTTPError

    try:
        config.load_kube_config()
    except config.ConfigException:
        try:
            config.load_incluster_config()  # in a pod
        except config.ConfigException:
            raise RefusedError("neither KUBECONFIG nor a pod tells of a cluster.") from None
    try:
        call = getattr(client.BatchV1Api(), what)
        return call(*arguments, **options, _request_timeout=ANSWER_S)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(one) for one in first["loc"][1:])
        raise RefusedError(f"job.yaml is no Job of Kubernetes: {place}: {first['msg']}.") from None
    except client.ApiException as error:
        told = f"Kubernetes answers {error.status}: {_message(error)}"
        if error.status == GONE:
            raise GoneError(told) from None
        raise (NoAnswerError if error.status in PASSING else RefusedError)(told) from None
    except HTTPError as error:
        raise NoAnswerError(f"Kubernetes does not answer: {error}") from None


def _message(error: Any) -> str:
    """The sentence of the interface, or the name of its answer where it has none."""
    try:
        return str(json.loads(error.body)["message"])
    except (ValueError, TypeError, KeyError):
        return f"{error.reason}."


# ---- command line --------------------------------------------------------------------------------


def main(arguments: list[str]) -> int:
    """Do what the executor asks for."""
    if arguments and arguments[0] not in ("submit", "status", "delete", "-h", "--help"):
        # The executor waits for two seconds at most: the end of the Jobs is not waited for.
        command = [sys.executable, __file__, "delete", *arguments]
        subprocess.Popen(command, start_new_session=True)
        return 0
    options = parser().parse_args(arguments)
    try:
        if options.command == "delete":
            return delete(options.jobs)
        return {"submit": submit, "status": status}[options.command](options)
    except (RefusedError, GoneError) as error:
        print(f"pagd: {error}", file=sys.stderr)
        return 2


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    summary = (__doc__ or "").partition("\n")[0]
    found = argparse.ArgumentParser(description=summary)
    commands = found.add_subparsers(dest="command", required=True)
    one = commands.add_parser("submit", help="create a Job")
    one.add_argument("template", type=Path)
    one.add_argument("--rule", required=True)
    one.add_argument("--cores", type=int, default=1)
    one.add_argument("--memory-mb", type=int, required=True)
    one.add_argument("--minutes", type=int, required=True)
    one.add_argument("--dry-run", action="store_true", help="print the Job, and create none")
    one.add_argument("jobscript", type=Path)
    one = commands.add_parser("status", help="how a Job is")
    one.add_argument("job", metavar="NAMESPACE/NAME")
    one = commands.add_parser("delete", help="delete Jobs")
    one.add_argument("jobs", nargs="+", metavar="NAMESPACE/NAME")
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
