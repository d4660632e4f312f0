#!/usr/bin/env python3
"""Jobs of the workflow as Jobs of Kubernetes, for the executor cluster-generic of Snakemake.

    kubernetes_job.py submit job.yaml --rule solve --memory-mb 4000 --minutes 120 jobscript
    kubernetes_job.py status job.yaml NAME
    kubernetes_job.py NAME…             ends them, as the executor asks for it

The first prints the name of the Job, the second success, running or failed, as the executor reads
it. Errors are one sentence on stderr and exit code 2.
"""

from __future__ import annotations

import argparse
import hashlib
import itertools
import json
import os
import re
import subprocess
import sys
import time
import uuid
from pathlib import Path
from typing import Any

import yaml

# One question to the cluster answers for all jobs, for so many seconds.
KEPT_S = 5.0
KEPT = Path(".snakemake") / "kubernetes.json"
# Where the executor names no file: it hands on names of Jobs, and nothing else.
TEMPLATE = Path("profiles") / "kubernetes" / "job.yaml"
LABEL = "pagd-project"
# Of HTTP: what is to be created is there already.
ALREADY_THERE = 409
# How the line of a job script begins that tells what the job is.
PROPERTIES = "# properties = "
# Properties that may differ between two jobs that do the same.
DIFFERENT = ("jobid", "cluster", "resources")
# A name of Kubernetes has 63 letters at most; the rule is there for people.
LONGEST_RULE = 40


class RefusedError(Exception):
    """What the user has asked for cannot be done; the message says why."""


class NoAnswerError(Exception):
    """The cluster does not do what it is asked for; the message is its own."""


class AlreadyThereError(NoAnswerError):
    """There is a Job of that name."""


def job(
    template: dict[str, Any], rule: str, cores: int, memory_MB: int, minutes: int, script: Path
) -> dict[str, Any]:
    """Return the Job of a job: the template with name, command, resources and time.

    Memory is asked for and limited; of cores so many are asked for, and idle ones may be used.
    """
    here = Path.cwd()
    pod = template["spec"]["template"]["spec"]
    container = pod["containers"][0]
    mounts = [Path(mount["mountPath"]) for mount in container.get("volumeMounts", [])]
    if not any(here.is_relative_to(mount) for mount in mounts):
        places = ", ".join(map(str, mounts)) or "none"
        raise RefusedError(f"{here} is below no mountPath of the pods ({places}): see job.yaml.")
    readable = re.sub(r"[^a-z0-9]+", "-", rule.lower())[:LONGEST_RULE].strip("-")
    metadata = template.setdefault("metadata", {})
    metadata["name"] = f"pagd-{readable}-{key_of(script)}"
    metadata.setdefault("labels", {})[LABEL] = label_of(here)
    template["spec"]["activeDeadlineSeconds"] = 60 * minutes
    container["command"] = ["/bin/sh", str(script.resolve())]
    container["workingDir"] = str(here)
    container["resources"] = {
        "requests": {"cpu": str(cores), "memory": f"{memory_MB}M"},
        "limits": {"memory": f"{memory_MB}M"},
    }
    return template


def key_of(script: Path) -> str:
    """Return what tells a job from all others that are not the same: of its inputs and settings."""
    try:
        lines = script.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise RefusedError(f"{script}: cannot be read ({error}).") from None
    told = next((line for line in lines if line.startswith(PROPERTIES)), None)
    if told is None:
        raise RefusedError(f"{script}: is no job script of Snakemake.")
    properties = json.loads(told.removeprefix(PROPERTIES))
    # The number of a job is another one in every run, and a second try is given more.
    same = {key: value for key, value in properties.items() if key not in DIFFERENT}
    text = json.dumps([Path.cwd().as_uri(), same], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def label_of(folder: Path) -> str:
    """Return what tells the Jobs of one folder from those of others."""
    return uuid.uuid5(uuid.NAMESPACE_URL, folder.as_uri()).hex


def state_of(status: Any) -> str:
    """Return the executor's word for the status of a Job."""
    if status.succeeded:
        return "success"
    conditions = status.conditions or []
    failed = any(one.type == "Failed" and one.status == "True" for one in conditions)
    return "failed" if status.failed or failed else "running"


def submit(options: argparse.Namespace) -> None:
    """Create a Job and print its name."""
    template = read(options.template)
    body = job(
        template, options.rule, options.cores, options.memory_mb, options.minutes, options.jobscript
    )
    if options.dry_run:
        print(yaml.safe_dump(body, sort_keys=False), end="")
        return
    print(created(namespace_of(template), body))


def created(namespace: str, body: dict[str, Any]) -> str:
    """Return the name of the Job: a new one, or the same where it is at work already.

    A Snakemake that was killed leaves its Jobs at work; the next one takes them over.
    """
    first = body["metadata"]["name"]
    for number in itertools.count(2):
        name = body["metadata"]["name"]
        try:
            asked("create_namespaced_job", namespace, body)
            return name
        except AlreadyThereError:
            there = asked("read_namespaced_job_status", name, namespace)
            if state_of(there.status) == "running":
                return name
        body["metadata"]["name"] = f"{first}-{number}"
    raise AssertionError("numbers have no end")


def status(options: argparse.Namespace) -> None:
    """Print how a Job is, of a list of all that is asked for every few seconds."""
    found, age = _kept()
    if options.name not in found and age <= KEPT_S:
        print("running")  # created after the list was made
        return
    if age > KEPT_S:
        try:
            found = _states(read(options.template))
        except NoAnswerError as error:
            # To be asked again: a cluster that does not answer has not lost its Jobs.
            print(f"pagd: {error}", file=sys.stderr)
            print("running")
            return
    # A Job that is not there has been deleted, by whoever.
    print(found.get(options.name, "failed"))


def _kept() -> tuple[dict[str, str], float]:
    try:
        age = time.time() - KEPT.stat().st_mtime
        return json.loads(KEPT.read_text(encoding="utf-8")), age
    except (OSError, ValueError):
        return {}, float("inf")


def _states(template: dict[str, Any]) -> dict[str, str]:
    """Ask the cluster how all Jobs of this folder are, and keep the answer."""
    label = f"{LABEL}={label_of(Path.cwd())}"
    answer = asked("list_namespaced_job", namespace_of(template), label_selector=label)
    found = {one.metadata.name: state_of(one.status) for one in answer.items}
    KEPT.parent.mkdir(exist_ok=True)
    temporary = KEPT.with_suffix(f".{os.getpid()}")
    temporary.write_text(json.dumps(found), encoding="utf-8")
    temporary.replace(KEPT)
    return found


def delete(names: list[str]) -> None:
    """Delete Jobs with their pods."""
    namespace = namespace_of(read(TEMPLATE))
    for name in names:
        asked("delete_namespaced_job", name, namespace, propagation_policy="Background")


def read(path: Path) -> dict[str, Any]:
    """Return the template."""
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise RefusedError(f"{path}: cannot be read ({error}).") from None
    if not isinstance(content, dict) or content.get("kind") != "Job":
        raise RefusedError(f"{path}: is not a Job of Kubernetes.")
    return content


def namespace_of(template: dict[str, Any]) -> str:
    """Return where the Jobs are."""
    return str(template.get("metadata", {}).get("namespace", "default"))


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
        return getattr(client.BatchV1Api(), what)(*arguments, **options)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(one) for one in first["loc"][1:])
        raise RefusedError(f"job.yaml is no Job of Kubernetes: {place}: {first['msg']}.") from None
    except client.ApiException as error:
        if error.status == ALREADY_THERE:
            raise AlreadyThereError(f"there is a Job of that name: {arguments}.") from None
        raise NoAnswerError(f"Kubernetes answers {error.status} {error.reason}.") from None
    except HTTPError as error:
        raise NoAnswerError(f"Kubernetes does not answer: {error}") from None


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
            delete(options.names)
        else:
            {"submit": submit, "status": status}[options.command](options)
    except (RefusedError, NoAnswerError) as error:
        print(f"pagd: {error}", file=sys.stderr)
        return 2
    return 0


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
    one.add_argument("template", type=Path)
    one.add_argument("name")
    one = commands.add_parser("delete", help="delete Jobs")
    one.add_argument("names", nargs="+")
    return found


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
