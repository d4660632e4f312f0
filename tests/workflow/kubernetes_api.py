"""A stand-in for a cluster of Kubernetes: its interface for Jobs, the pods being processes here.

Bodies are read by the models of the official client, and refused where these do not know a field,
or lack one that is required.
"""

from __future__ import annotations

import json
import math
import os
import re
import signal
import subprocess
import threading
import time
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlparse

import yaml
from kubernetes import client

_PLACE = re.compile(r"/apis/batch/v1/namespaces/(?P<namespace>[^/]+)/jobs(?:/(?P<name>[^/]+))?$")


class _Answer:
    """What the client reads a body from."""

    def __init__(self, text: str) -> None:
        self.data = text


def fault_of(body: dict[str, Any]) -> str | None:
    """What is wrong with a Job, by the models of the official client."""
    api = client.ApiClient()
    try:
        read = api.deserialize(json.dumps(body), "V1Job", "application/json")
    except (ValueError, TypeError) as error:
        return str(error)
    back = api.sanitize_for_serialization(read)
    return None if back == body else f"unknown fields: {_lost(body, back)}"


def _lost(told: Any, kept: Any, place: str = "") -> list[str]:
    if isinstance(told, dict) and isinstance(kept, dict):
        parts = [_lost(told[key], kept.get(key), f"{place}.{key}") for key in told]
        return [one for part in parts for one in part]
    if isinstance(told, list) and isinstance(kept, list):
        parts = [_lost(a, b, f"{place}[]") for a, b in zip(told, kept, strict=True)]
        return [one for part in parts for one in part]
    return [] if told == kept else [place]


@dataclass
class Cluster:
    """A cluster whose pods are processes of this machine."""

    folder: Path
    cpus: int = 2
    jobs: dict[str, dict[str, Any]] = field(default_factory=dict)
    processes: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)
    refusals: int = 0
    #: What every question is answered with, where it is not None: a code.
    out_of_order: int | None = None
    #: How many questions that is so for.
    out_of_order_for: float = math.inf

    def start(self) -> None:
        """Listen, and write the file that tells clients where."""
        self._room = threading.Semaphore(self.cpus)
        self.server = ThreadingHTTPServer(("127.0.0.1", 0), _handler(self))
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        url = f"http://127.0.0.1:{self.server.server_address[1]}"
        content = {
            "apiVersion": "v1",
            "kind": "Config",
            "clusters": [{"name": "here", "cluster": {"server": url}}],
            "users": [{"name": "anyone", "user": {}}],
            "contexts": [{"name": "here", "context": {"cluster": "here", "user": "anyone"}}],
            "current-context": "here",
        }
        self.configuration.write_text(yaml.safe_dump(content))

    @property
    def configuration(self) -> Path:
        """The file for the variable KUBECONFIG."""
        return self.folder / "kubeconfig"

    def stop(self) -> None:
        """End all pods, and listen no more."""
        self.server.shutdown()
        self.server.server_close()
        for name in list(self.processes):
            self.kill(name)

    def create(self, body: dict[str, Any]) -> None:
        """Start the pod of a Job when there is room."""
        name = body["metadata"]["name"]
        self.jobs[name] = body | {"status": {}}
        threading.Thread(target=self._run, args=(name,), daemon=True).start()

    def _run(self, name: str) -> None:
        body = self.jobs[name]
        container = body["spec"]["template"]["spec"]["containers"][0]
        # What a pod is given by its image and its own disk is that of this machine here.
        told = {one["name"]: one["value"] for one in container.get("env", [])}
        with self._room, (self.folder / f"{name}.log").open("wb") as log:
            if name not in self.jobs:
                return
            self.processes[name] = subprocess.Popen(
                container["command"],
                cwd=container["workingDir"],
                env=os.environ | told,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
            limit = body["spec"]["template"]["spec"].get("activeDeadlineSeconds")
            try:
                code = self.processes[name].wait(timeout=limit)
            except subprocess.TimeoutExpired:
                self.kill(name)
                code = 1
        body["status"] = {"succeeded": 1} if code == 0 else {"failed": 1}

    def kill(self, name: str) -> None:
        """End a pod with all that it has started."""
        process = self.processes.get(name)
        if process is not None and process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)

    def wait_for(self, rule: str, run: subprocess.Popen[bytes], memory: str = "") -> str:
        """Wait until a pod of a rule, with so much memory, is at work; its Job."""
        while run.poll() is None:
            for name, process in list(self.processes.items()):
                wanted = name.startswith(f"pagd-{rule}-") and process.poll() is None
                if wanted and memory in memory_of(self.jobs[name]):
                    return name
            time.sleep(0.05)
        raise AssertionError(f"no pod of the rule {rule} was ever at work")


def memory_of(job: dict[str, Any]) -> str:
    """The memory that the pod of a Job may take."""
    container = job["spec"]["template"]["spec"]["containers"][0]
    return str(container["resources"]["limits"]["memory"])


def _handler(cluster: Cluster) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def parse_request(self) -> bool:
            if not super().parse_request():
                return False
            if cluster.out_of_order is None:
                return True
            self.close_connection = True
            self._answer(cluster.out_of_order, {"message": "out of order"})
            cluster.out_of_order_for -= 1
            if cluster.out_of_order_for <= 0:
                cluster.out_of_order = None
            return False

        def do_POST(self) -> None:
            length = int(self.headers["Content-Length"])
            body = json.loads(self.rfile.read(length))
            fault = fault_of(body)
            if fault is not None:
                cluster.refusals += 1
                self._answer(422, {"message": fault})
            elif body["metadata"]["name"] in cluster.jobs:
                self._answer(409, {"message": "already there"})
            else:
                cluster.create(body)
                self._answer(201, body)

        def do_GET(self) -> None:
            place = _PLACE.match(urlparse(self.path).path)
            name = place["name"] if place else None
            if name and name not in cluster.jobs:
                self._answer(404, {"message": "no such Job"})
                return
            if name:
                self._answer(200, cluster.jobs[name])
                return
            query = parse_qs(urlparse(self.path).query)
            wanted = [one.partition("=") for one in query["labelSelector"][0].split(",")]
            items = [
                job
                for job in list(cluster.jobs.values())
                if all(
                    key in job["metadata"]["labels"]
                    and (not value or job["metadata"]["labels"][key] == value)
                    for key, _, value in wanted
                )
            ]
            self._answer(200, {"kind": "JobList", "items": items})

        def do_DELETE(self) -> None:
            found = _PLACE.match(urlparse(self.path).path)
            name = found["name"] if found else ""
            if cluster.jobs.pop(name, None) is None:
                self._answer(404, {"message": "no such Job"})
                return
            cluster.kill(name)
            self._answer(200, {"kind": "Status", "status": "Success"})

        def _answer(self, code: int, content: dict[str, Any]) -> None:
            text = json.dumps(content).encode()
            self.send_response(code)
            self.send_header("Content-Type", "application/json")
            self.send_header("Content-Length", str(len(text)))
            self.end_headers()
            self.wfile.write(text)

        def log_message(self, *arguments: Any) -> None:
            pass

    return Handler
