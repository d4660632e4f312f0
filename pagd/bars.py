"""Bars that show a person at a terminal how far long work is, by tqdm."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Iterator
from typing import Any

from pagd.long_work import Display, Shown, shown_by

__all__ = ["bars"]

_FORM = "{desc}: {percentage:3.0f} % |{bar}| {n:.5g} of {total:.5g} {unit}, {elapsed}"
_LEFT = ", {remaining} left"


@contextlib.contextmanager
def bars(wanted: bool) -> Iterator[None]:
    """Show bars on stderr for the long work of the block, with the lines of the log above them.

    None are shown where they are not ``wanted``.
    """
    if not wanted:
        yield
        return
    # Imported only here: most commands are over before it is.
    from tqdm import tqdm
    from tqdm.contrib.logging import logging_redirect_tqdm

    # Neither a thread that watches the bars nor a semaphore: stages fork this process.
    with _lone(tqdm), logging_redirect_tqdm(), shown_by(_display(os.getpid())):
        yield


@contextlib.contextmanager
def _lone(tqdm: Any) -> Iterator[None]:
    """Let tqdm do without its thread and its semaphore in the block; the caller may need both."""
    # It has no lock before its first bar, and asking for one would make it, with a semaphore.
    interval, lock = tqdm.monitor_interval, vars(tqdm).get("_lock")
    tqdm.monitor_interval = 0
    tqdm.set_lock(threading.RLock())
    try:
        yield
    finally:
        tqdm.monitor_interval = interval
        if lock is None:
            del tqdm._lock
        else:
            tqdm.set_lock(lock)


def _display(process: int) -> Display:
    from tqdm import tqdm

    @contextlib.contextmanager
    def show(what: str, whole: float, unit: str, even: bool) -> Iterator[Shown]:
        # The bars of a fork would be drawn over those of this process.
        own = os.getpid() == process
        with tqdm(
            desc=what,
            total=whole,
            unit=unit,
            bar_format=_FORM + (_LEFT if even else ""),
            file=sys.stderr,
            leave=False,
            dynamic_ncols=True,
            # By time alone: of steps that take long, each is to be seen.
            miniters=0,
            disable=not own,
        ) as bar:
            yield _Bar(bar)

    return show


class _Bar:
    def __init__(self, bar: Any) -> None:
        self._bar = bar

    def reach(self, value: float) -> None:
        # Pressure may fall, on a branch behind a limit point: so does the bar. A last step may go
        # beyond the whole.
        self._bar.update(min(value, self._bar.total) - self._bar.n)

    def name(self, part: str) -> None:
        self._bar.set_description_str(part)
