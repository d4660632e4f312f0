"""Limits of time and memory: work in a process of its own, which may hang, swell or crash."""

from __future__ import annotations

import contextlib
import ctypes
import os
import pickle
import select
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any, Final, TypeVar

import psutil

from pagd.errors import MachineError, PagdError, StageFailure, Status

__all__ = ["Limits", "die_with_parent", "in_force", "run_apart", "under"]

Result = TypeVar("Result")

# How often time and memory are looked at, and a result that comes between is taken at once.
_LOOK_S: Final = 0.5
_LENGTH: Final = 8
_PR_SET_PDEATHSIG: Final = 1

_IN_FORCE: ContextVar[Limits | None] = ContextVar("limits", default=None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """What one stage of one design may take.

    ``time_s``: seconds of wall time. ``memory_MB``: resident memory of the process and of all that
    it has started, in 10⁶ bytes. ``final``: nobody tries again with more, so that a limit exceeded
    is how the design ends.
    """

    time_s: float
    memory_MB: float
    final: bool = True


@contextlib.contextmanager
def under(limits: Limits | None) -> Iterator[None]:
    """Put limits in force for the stages that the block runs; with None, there are none."""
    token = _IN_FORCE.set(limits)
    try:
        yield
    finally:
        _IN_FORCE.reset(token)


def in_force() -> Limits | None:
    """Return the limits that a stage has to keep to."""
    return _IN_FORCE.get()


def run_apart(function: Callable[[], Result], limits: Limits) -> Result:
    """Call a function in a fork of this process, and end it where it exceeds a limit.

    Parameters
    ----------
    function
        What it returns, or raises, must be such as ``pickle`` takes. It must not rely on threads
        that this process has started.
    limits
        What it may take.

    Raises
    ------
    StageFailure
        ``timed_out`` or ``out_of_memory``; ``crashed`` where a signal ended it, or it raised what
        is neither a ``PagdError`` nor a fault of the machine (``OSError``).
    MachineError
        If it was killed from outside, or exceeded limits that are not final.
    """
    reading, writing = os.pipe()
    # What is buffered would be written by both.
    sys.stdout.flush()
    sys.stderr.flush()
    parent = os.getpid()
    process = os.fork()
    if process == 0:
        code = os.EX_SOFTWARE
        try:
            os.close(reading)
            code = _work(function, writing, parent)
        finally:
            # Whatever is raised here must not run on in what is the parent's work.
            os._exit(code)
    os.close(writing)
    try:
        answer = _awaited(process, reading, limits)
    finally:
        os.close(reading)
        _kill(process)
        _, status = os.waitpid(process, 0)
    try:
        result: Result = _outcome(answer, os.waitstatus_to_exitcode(status))
    except MemoryError:
        raise _exceeded(limits, Status.out_of_memory, "It was refused more memory.") from None
    return result


def _work(function: Callable[[], object], writing: int, parent: int) -> int:
    """Call the function in the fork and send what becomes of it."""
    _die_with(parent)
    try:
        answer = pickle.dumps((True, function()))
    except (PagdError, OSError, MemoryError) as error:
        answer = pickle.dumps((False, error))
    except KeyboardInterrupt:
        return 130
    except BaseException as error:
        with contextlib.suppress(OSError):
            traceback.print_exc()
        told = f"A fault: {type(error).__name__}: {error}."
        answer = pickle.dumps((False, StageFailure(Status.crashed, told)))
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):
            stream.flush()
    with os.fdopen(writing, "wb") as file:
        # Its length first: it may be killed while it writes.
        file.write(len(answer).to_bytes(_LENGTH) + answer)
    return 0


def die_with_parent() -> None:
    """Have the kernel kill this process when its parent is killed; Linux alone can."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _die_with(parent: int) -> None:
    die_with_parent()
    if os.getppid() != parent:  # gone before that
        os._exit(1)


def _awaited(process: int, reading: int, limits: Limits) -> bytes:
    """Return what the fork sends; nothing where it ends without a word."""
    end = time.monotonic() + limits.time_s
    parts: list[bytes] = []
    while True:
        left = end - time.monotonic()
        if left <= 0:
            raise _exceeded(limits, Status.timed_out, f"It took more than {limits.time_s:g} s.")
        if select.select([reading], [], [], min(left, _LOOK_S))[0]:
            part = os.read(reading, 1 << 20)
            parts.append(part)
            # Not only its end: what the work has started may hold the pipe for longer.
            if not part or _is_whole(b"".join(parts)):
                return b"".join(parts)
        elif _memory_MB(process) > limits.memory_MB:
            told = f"It took more than {limits.memory_MB:g} MB of memory."
            raise _exceeded(limits, Status.out_of_memory, told)


def _is_whole(answer: bytes) -> bool:
    return len(answer) >= _LENGTH and len(answer) == _LENGTH + int.from_bytes(answer[:_LENGTH])


def _exceeded(limits: Limits, status: Status, told: str) -> PagdError:
    return StageFailure(status, told) if limits.final else MachineError(told)


def _memory_MB(process: int) -> float:
    total = 0.0
    for one in _family(process):
        with contextlib.suppress(psutil.Error):
            total += one.memory_info().rss / 1e6
    return total


def _family(process: int) -> list[psutil.Process]:
    """The process and all that it has started, as far as they still are."""
    try:
        root = psutil.Process(process)
        return [*root.children(recursive=True), root]
    except psutil.Error:
        return []


def _kill(process: int) -> None:
    """Kill the fork with all that it has started; one that has ended is left as it is."""
    for one in _family(process):
        with contextlib.suppress(psutil.Error):
            one.kill()


def _outcome(answer: bytes, code: int) -> Any:
    if not _is_whole(answer):
        raise _end_without_a_word(code)
    done, value = pickle.loads(answer[_LENGTH:])
    if done:
        return value
    raise value


def _end_without_a_word(code: int) -> BaseException:
    if code == 130:
        return KeyboardInterrupt()
    if -code == signal.SIGKILL:
        # Not ours: the kernel, short of memory, or an operator. It tells nothing of the design.
        return MachineError("The process that did the work was killed from outside.")
    how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
    return StageFailure(Status.crashed, f"The process that did the work crashed ({how}).")
