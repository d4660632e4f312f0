"""A program as a child process, with the time of all of it and how far it came when."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from pagd.cli.client import SERVER

__all__ = ["Ended", "run_timed", "thread_settings"]

_LOOK_EVERY_S = 0.01
_WATCH_EVERY_S = 0.25

_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@dataclass(frozen=True, slots=True)
class Ended:
    """How a program ended.

    Attributes
    ----------
    code
        Exit code; None if it was ended at the time limit.
    wall_s, cpu_s
        Seconds from start to end, and of all its threads and child processes.
    progress
        Seconds since the start at which each pressure (kPa) was first seen, rising.
    """

    code: int | None
    wall_s: float
    cpu_s: float
    progress: list[tuple[float, float]]


def thread_settings(threads: int) -> dict[str, str]:
    """Return the environment's variables that give a program so many threads."""
    return dict.fromkeys(_THREADS, str(threads))


def run_timed(
    command: Sequence[str],
    folder: Path,
    threads: int,
    time_limit_s: float,
    reached: Callable[[], float],
) -> Ended:
    """Run a program in a folder, its output to ``output.txt`` there, until it ends or has to.

    Parameters
    ----------
    command, folder
        What to run, and where.
    threads
        How many it may use.
    time_limit_s
        After so many seconds it is ended, with all that it started.
    reached
        Returns the pressure in kPa that its files tell of so far.
    """
    start, watched = time.perf_counter(), 0.0
    progress: list[tuple[float, float]] = []
    with (folder / "output.txt").open("wb") as output:
        process = subprocess.Popen(
            command,
            cwd=folder,
            env=_environment(threads),
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
    limit_reached = False
    try:
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            seconds = time.perf_counter() - start
            if pid or seconds - watched > _WATCH_EVERY_S:
                watched = seconds
                _note(progress, seconds, reached())
            if pid:
                break
            if seconds > time_limit_s and not limit_reached:
                limit_reached = True
                _kill(process)
            time.sleep(_LOOK_EVERY_S)
    except BaseException:
        _kill(process)
        raise
    # It has been waited for already.
    process.returncode = os.waitstatus_to_exitcode(status)
    code = None if limit_reached else process.returncode
    return Ended(code, seconds, usage.ru_utime + usage.ru_stime, progress)


def _environment(threads: int) -> dict[str, str]:
    """That of this process, without a server that would do the work in place of the child."""
    own = {name: value for name, value in os.environ.items() if name != SERVER}
    return own | thread_settings(threads)


def _note(progress: list[tuple[float, float]], seconds: float, pressure: float) -> None:
    if pressure > (progress[-1][1] if progress else 0.0):
        progress.append((round(seconds, 3), pressure))


def _kill(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
