"""Tasks in processes of their own, a few at a time; whatever one of them does ends only itself."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Literal

__all__ = ["End", "Ending", "Task", "run_tasks"]

WORKER = Path(__file__).with_name("worker.py")

# Usually one design a core: threads would only wait for each other.
_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS")

_LOOK_EVERY_S = 0.1

End = Literal["finished", "crashed", "time_limit"]


@dataclass(frozen=True, slots=True)
class Task:
    """What one process does: ``line`` goes to its standard input, ``log`` takes what it prints."""

    name: str
    line: str
    log: Path


@dataclass(frozen=True, slots=True)
class Ending:
    """How the process of a task ended, why unless it finished, and the seconds it took."""

    end: End
    cause: str | None
    seconds: float


class _Running:
    """A task that has been started."""

    def __init__(self, task: Task, limit_s: float, program: Sequence[str], threads: int) -> None:
        self.task, self._limit_s = task, limit_s
        self._start = time.monotonic()
        with task.log.open("wb") as log:
            # A session of its own, so that a mesher or OpenSCAD started by it can be ended too.
            self._process = subprocess.Popen(
                program,
                stdin=subprocess.PIPE,
                stdout=log,
                stderr=subprocess.STDOUT,
                env=os.environ | dict.fromkeys(_THREADS, str(threads)),
                start_new_session=True,
            )
        # Left open: its end tells the worker that the study is no more.
        assert self._process.stdin is not None
        self._stdin = self._process.stdin
        with suppress(BrokenPipeError):  # when it has crashed already, which its code tells
            self._stdin.write(f"{task.line}\n".encode())
            self._stdin.flush()

    def ending(self) -> Ending | None:
        """How it ended; None while it runs. One beyond its time is ended here."""
        seconds, code = time.monotonic() - self._start, self._process.poll()
        if code is None:
            if seconds < self._limit_s:
                return None
            self.kill()
            return Ending("time_limit", f"It took more than {self._limit_s:g} s.", seconds)
        self.kill()
        if code == 0:
            return Ending("finished", None, seconds)
        return Ending("crashed", _cause(code, self.task.log), seconds)

    def kill(self) -> None:
        """End the process and all that it has started."""
        with suppress(ProcessLookupError):  # when nothing is left of it
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        with suppress(BrokenPipeError):
            self._stdin.close()


def run_tasks(
    tasks: Iterable[Task],
    processes: int,
    limit_s: float,
    ended: Callable[[Task, Ending], None],
    program: Sequence[str] = (sys.executable, "-P", str(WORKER)),
    threads: int = 1,
) -> None:
    """Run every task, ``processes`` of them at a time.

    Parameters
    ----------
    tasks
        In the order in which they are started; each is asked for when there is room for it.
    processes
        How many at a time.
    limit_s
        A task that takes longer, in seconds, is ended.
    ended
        Told of every task as soon as it has ended, however it has.
    program
        Reads a task from standard input and does it.
    threads
        That each of them may use.
    """
    waiting, running = iter(tasks), list[_Running]()
    try:
        while True:
            for task in islice(waiting, processes - len(running)):
                running.append(_Running(task, limit_s, program, threads))
            if not running:
                return
            time.sleep(_LOOK_EVERY_S)
            for one in list(running):
                ending = one.ending()
                if ending:
                    running.remove(one)
                    ended(one.task, ending)
    finally:
        for one in running:
            one.kill()


def _cause(code: int, log: Path) -> str:
    if code < 0:
        return f"The process was ended by {signal.Signals(-code).name}."
    lines = log.read_text(encoding="utf-8", errors="replace").split("\n")
    said = next((line.strip() for line in reversed(lines) if line.strip()), "it said nothing")
    return f"The process ended with code {code}: {said}"
