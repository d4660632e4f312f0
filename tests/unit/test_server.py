"""Commands that a server runs: as by themselves, and whatever dies takes no other with it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from pagd.cli import server
from pagd.cli.client import SERVED, SERVER, ask_server
from pagd.cli.parser import make_parser
from pagd.record import read_record

DESIGN = {
    "name": "small", "L": 9.5, "W": 15, "H": 13, "t": 4, "t_n": 1.5, "t_h": 4, "t_ab": 2,
    "t_b": 2.2, "N": 2, "theta": 0, "alpha": 0,
}  # fmt: skip
STARTER = """
import os, sys
from pagd.cli import server
server.start()
print(os.environ["PAGD_SERVER"], flush=True)
sys.stdin.read()
"""
CLIENT = [sys.executable, "-c", "import sys; from pagd.cli import main; sys.exit(main())"]


class Served:
    """A process that has started a server, and commands that find it."""

    def __init__(self) -> None:
        self.starter = subprocess.Popen(
            [sys.executable, "-c", STARTER],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.starter.stdout is not None
        self.socket = Path(self.starter.stdout.readline().strip())

    def environment(self, path: Path | None = None) -> dict[str, str]:
        """The environment of a command; programs are looked for in ``path`` first."""
        found = f"{path}:{os.environ['PATH']}" if path else os.environ["PATH"]
        return os.environ | {SERVER: str(self.socket), "OMP_NUM_THREADS": "1", "PATH": found}

    def run(self, folder: Path, *words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*CLIENT, *map(str, words)],
            cwd=folder,
            env=self.environment(),
            capture_output=True,
            text=True,
            check=False,
        )

    def start(self, folder: Path, openscad: Path) -> subprocess.Popen[str]:
        """Start the geometry of a design with another OpenSCAD; return the client."""
        return subprocess.Popen(
            [*CLIENT, "geometry", "--design", json.dumps(DESIGN), "--out", "geometry"],
            cwd=folder,
            env=self.environment(openscad),
            stderr=subprocess.PIPE,
            text=True,
        )

    def end(self) -> None:
        self.starter.kill()
        self.starter.wait()
        for stream in (self.starter.stdin, self.starter.stdout):
            assert stream is not None
            stream.close()


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """What is started can be interrupted, also where the tests run in a shell's background."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    server = Served()
    yield server
    server.end()


@pytest.fixture
def slow(tmp_path: Path) -> Path:
    """A folder with an OpenSCAD that notes its number, and its parent's, and never ends."""
    folder = tmp_path / "slow"
    folder.mkdir()
    program = folder / "openscad"
    note = f"echo $$ $PPID > {folder}/now && mv {folder}/now {folder}/both"
    program.write_text(f"#!/bin/sh\n{note}\nexec sleep 600\n")
    program.chmod(0o755)
    return folder


def processes(slow: Path) -> tuple[int, int]:
    """Wait until that OpenSCAD runs; return its number and that of its parent, the worker."""
    until(lambda: (slow / "both").is_file())
    program, worker = (slow / "both").read_text().split()
    return int(program), int(worker)


def until(done: Callable[[], bool], seconds: float = 30.0) -> None:
    limit = time.monotonic() + seconds
    while not done():
        assert time.monotonic() < limit
        time.sleep(0.02)


def is_gone(process: int) -> bool:
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return True
    return state == "Z"


def test_served_commands_are_stages_of_one_design() -> None:
    subcommands = make_parser()._subparsers._group_actions[0].choices  # type: ignore[union-attr]
    for name in SERVED:
        assert any(action.dest == "out" for action in subcommands[name]._actions)  # type: ignore[index]


@pytest.mark.parametrize(
    ("variables", "arguments"),
    [
        ({}, ["geometry", "--help"]),  # no server
        ({SERVER: "/nowhere/socket"}, ["geometry", "--help"]),  # none that answers
        ({SERVER: "socket", "OMP_NUM_THREADS": "2"}, ["geometry", "--help"]),
        ({SERVER: "socket"}, ["design", "--help"]),
        ({SERVER: "socket"}, []),
    ],
)
def test_commands_that_run_by_themselves(
    monkeypatch: pytest.MonkeyPatch, variables: dict[str, str], arguments: list[str]
) -> None:
    for name, value in {SERVER: "", "OMP_NUM_THREADS": "1", **variables}.items():
        monkeypatch.setenv(name, value)
    assert ask_server(arguments) is None


def test_a_served_stage_is_as_one_by_itself(served: Served, tmp_path: Path) -> None:
    words = ("geometry", "--design", json.dumps(DESIGN), "--out")
    answer = served.run(tmp_path, *words, "served")
    assert answer.returncode == 0, answer.stderr
    assert "geometry of small: ok" in answer.stderr
    by_itself = subprocess.run([*CLIENT, *words, "own"], cwd=tmp_path, check=False)
    assert by_itself.returncode == 0
    one, other = read_record(tmp_path / "served"), read_record(tmp_path / "own")
    same = ("stage", "design_id", "status", "figures", "configuration", "versions")
    assert [getattr(one, key) for key in same] == [getattr(other, key) for key in same]
    for name in ("body.stl", "base.stl", "body_half.stl", "base_half.stl", "design.scad"):
        assert (tmp_path / "served" / name).read_bytes() == (tmp_path / "own" / name).read_bytes()


def test_exit_codes_and_messages_come_back(served: Served, tmp_path: Path) -> None:
    thin = json.dumps(DESIGN | {"t": 0.1})
    answer = served.run(tmp_path, "geometry", "--design", thin, "--out", "thin")
    assert answer.returncode == 1
    assert "invalid_geometry" in answer.stderr
    answer = served.run(tmp_path, "repair", "--geometry", "absent", "--out", "repair")
    assert (answer.returncode, answer.stderr) == (2, "pagd: absent: there is no such folder.\n")
    answer = served.run(tmp_path, "repair", "--geometry", "absent")
    assert answer.returncode == 2
    assert "required: --out" in answer.stderr
    answer = served.run(tmp_path, "solve", "--help")
    assert answer.returncode == 0
    assert answer.stdout.startswith("usage: pagd solve")


def test_a_worker_that_dies_takes_no_other_with_it(
    served: Served, tmp_path: Path, slow: Path
) -> None:
    client = served.start(tmp_path, slow)
    program, worker = processes(slow)
    os.kill(worker, signal.SIGKILL)
    _, told = client.communicate()
    os.kill(program, signal.SIGKILL)
    assert client.returncode == 128 + signal.SIGKILL
    assert "pagd: the process was ended by SIGKILL" in told
    assert served.run(tmp_path, "geometry", "--help").returncode == 0


def test_a_worker_ends_with_its_client(served: Served, tmp_path: Path, slow: Path) -> None:
    client = served.start(tmp_path, slow)
    program, worker = processes(slow)
    client.terminate()
    client.communicate()
    until(lambda: is_gone(worker) and is_gone(program))
    assert [path.name for path in tmp_path.iterdir()] == ["slow"]


def test_an_interrupted_client_says_so(served: Served, tmp_path: Path, slow: Path) -> None:
    client = served.start(tmp_path, slow)
    _, worker = processes(slow)
    client.send_signal(signal.SIGINT)
    client.communicate()
    assert client.returncode == 130
    until(lambda: is_gone(worker))


def test_all_end_with_the_process_that_started_the_server(tmp_path: Path, slow: Path) -> None:
    served = Served()
    client = served.start(tmp_path, slow)
    program, worker = processes(slow)
    served.end()
    _, told = client.communicate()
    assert client.returncode == 130
    assert "pagd: interrupted" in told
    until(lambda: is_gone(worker) and is_gone(program))
    until(lambda: not served.socket.parent.exists())


def test_a_worker_keeps_the_threads_of_the_server(tmp_path: Path) -> None:
    """Whatever the command's environment says: Numba looks again at each compilation."""
    process = os.fork()
    if process == 0:
        server._take_place(server._Request([], str(tmp_path), {"NUMBA_NUM_THREADS": "7"}, []))
        os._exit(0 if os.environ == dict.fromkeys(server._THREADS, "1") else 1)
    _, status = os.waitpid(process, 0)
    assert os.waitstatus_to_exitcode(status) == 0
