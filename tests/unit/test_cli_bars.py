"""Bars: at a terminal, for long work; never in a file, a pipe or the workflow."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import pty
import struct
import subprocess
import sys
import termios
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from design_samples import training

from pagd.bars import bars
from pagd.cli.execute import execute
from pagd.embedding.tsne import TSNE
from pagd.long_work import Shown, counted, is_shown, long_work, shown_by

PAGD = [sys.executable, "-m", "pagd"]
DATASET = ["dataset", "--size", "60", "--out", "dataset"]
THIN = {
    "name": "thin", "L": 9.5, "W": 15, "H": 13, "t": 0.1, "t_n": 1.5, "t_h": 4, "t_ab": 2,
    "t_b": 2.2, "N": 2, "theta": 0, "alpha": 0,
}  # fmt: skip


def at_terminal(
    folder: Path, *words: str, terminal: str = "xterm", program: list[str] | None = None
) -> tuple[int, str, str]:
    """Run pagd with stderr a terminal of 100 columns; its exit code, stdout and stderr."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 100, 0, 0))
    with subprocess.Popen(
        [*(program or PAGD), *words],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=theirs,
        text=True,
        env=os.environ | {"TERM": terminal},
    ) as process:
        os.close(theirs)
        told = b""
        # Linux tells of the other end's closing by an error.
        with contextlib.suppress(OSError):
            while part := os.read(ours, 1 << 16):
                told += part
        os.close(ours)
        out, _ = process.communicate()
    return process.returncode, out, told.decode().replace("\r\n", "\n")


class Noted:
    """A display that keeps what it is told."""

    def __init__(self) -> None:
        self.told: list[object] = []

    @contextlib.contextmanager
    def __call__(self, what: str, whole: float, unit: str, even: bool) -> Iterator[Shown]:
        self.told.append((what, whole, unit))
        yield self

    def reach(self, value: float) -> None:
        self.told.append(value)

    def name(self, part: str) -> None:
        self.told.append(part)


def test_work_is_told_to_whoever_has_asked() -> None:
    noted = Noted()
    with shown_by(noted):
        assert is_shown()
        assert list(counted("ab", "spelling", 2, "letters")) == ["a", "b"]
    assert noted.told == [("spelling", 2, "letters"), 1, 2]
    with long_work("spelling", 2, "letters") as shown:
        shown.reach(1)
    assert not is_shown()
    assert len(noted.told) == 3


def test_the_plane_is_the_same_where_its_rounds_are_shown() -> None:
    noted, designs = Noted(), training()
    with shown_by(noted):
        shown = TSNE(perplexity=15.0, threads=1).fit(designs, seed=3)
    unseen = TSNE(perplexity=15.0, threads=1).fit(designs, seed=3)
    np.testing.assert_array_equal(shown.points, unseen.points)
    assert noted.told == [("t-SNE", 750, "rounds"), *range(10, 760, 10)]


def test_a_terminal_has_bars_and_ends_without(tmp_path: Path) -> None:
    code, out, told = at_terminal(tmp_path, *DATASET)
    assert code == 0
    assert "bending, random:   0 % |" in told
    assert "designs, 00:00" in told
    assert "60 designs" in out
    assert "\r" not in out
    # Each bar is wiped out again; the line of the log stays.
    assert told.split("\r")[-1].startswith("dataset of all: ok")


def test_the_stage_at_work_is_named(tmp_path: Path) -> None:
    code, _, told = at_terminal(tmp_path, "run", json.dumps(THIN), "--out", "thin")
    assert code == 1
    for stage in ("geometry", "repair", "mesh", "solve", "metrics", "figures"):
        assert f"\r{stage}: " in told
        assert f"\r{stage} of thin: invalid_geometry" in told
    assert told.endswith("at least 0.75 mm.\n")


def test_bars_leave_the_document_alone(tmp_path: Path) -> None:
    _, out, told = at_terminal(tmp_path, *DATASET, "--json")
    assert json.loads(out)["stage"] == "dataset"
    assert "random:   0 % |" in told


def test_a_terminal_that_cannot_go_back_has_none(tmp_path: Path) -> None:
    code, _, told = at_terminal(tmp_path, *DATASET, terminal="dumb")
    assert code == 0
    assert "%" not in told


def test_the_server_of_a_workflow_shows_none(tmp_path: Path) -> None:
    """Not even where its command has been given at a terminal."""
    program = "import sys; from pagd.cli.server import _run; sys.exit(_run(sys.argv[1:]))"
    words = [sys.executable, "-c", program]
    code, _, told = at_terminal(tmp_path, "run", json.dumps(THIN), "--out", "a", program=words)
    assert code == 1
    assert "figures of thin" in told
    assert "%" not in told


def test_pipes_have_none(tmp_path: Path) -> None:
    answer = subprocess.run([*PAGD, *DATASET], cwd=tmp_path, capture_output=True, check=True)
    assert b"%" not in answer.stderr
    assert b"\r" not in answer.stderr + answer.stdout
    assert b"INFO dataset of all: ok" in answer.stderr


def test_a_fork_shows_none(capfd: pytest.CaptureFixture[str]) -> None:
    with bars(True):
        process = os.fork()
        if process == 0:
            list(counted(range(3), "of the fork", 3, "things"))
            sys.stderr.flush()
            os._exit(0)
        os.waitpid(process, 0)
        list(counted(range(3), "of the parent", 3, "things"))
    told = capfd.readouterr().err
    assert "of the parent" in told
    assert "of the fork" not in told


def test_steps_of_a_solve_are_logged_only_where_no_bar_shows_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from pagd.cli.output import steps_of_solve

    assert steps_of_solve() is not None
    with bars(True):
        assert steps_of_solve() is None
    # As a library, nothing is shown unless it is asked for.
    assert execute(["design", "show", json.dumps(THIN)]) == 0


def test_bars_leave_tqdm_as_it_was(capfd: pytest.CaptureFixture[str]) -> None:
    """A program that has bars of its own goes on with them."""
    from tqdm import tqdm

    interval, lock = tqdm.monitor_interval, tqdm.get_lock()
    with contextlib.suppress(KeyError), bars(True):
        assert tqdm.monitor_interval == 0
        raise KeyError
    assert tqdm.monitor_interval == interval != 0
    assert tqdm.get_lock() is lock
    del tqdm._lock
    try:
        with bars(True):
            list(counted("ab", "spelling", 2, "letters"))
        assert "_lock" not in vars(tqdm)
    finally:
        tqdm.set_lock(lock)


def test_a_bar_ends_at_the_whole(capfd: pytest.CaptureFixture[str]) -> None:
    with bars(True), long_work("spelling", 2.0, "letters") as shown:
        shown.reach(3.0)
        shown.name("done")
    told = capfd.readouterr().err
    assert "2 of 2 letters" in told
    assert "3 of 2" not in told
