"""How far long work has come, told to whoever has asked for it; to nobody, unless someone has.

The library counts, and knows nothing of terminals: the command line shows bars, and so does
:func:`pagd.simulate` in a notebook or an interactive session; the workflow and a program that calls
the library see none, unless it asks for them.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager
from contextvars import ContextVar
from typing import Protocol, TypeVar

__all__ = ["Display", "Shown", "counted", "is_shown", "long_work", "shown_by"]

Item = TypeVar("Item")


class Shown(Protocol):
    """One piece of long work, while it is shown."""

    def reach(self, value: float) -> None:
        """Tell how much of the whole is done."""

    def name(self, part: str) -> None:
        """Tell what is at work."""


#: Shows a piece of work until the block ends: (what, whole, unit, even), as of :func:`long_work`.
Display = Callable[[str, float, str, bool], AbstractContextManager[Shown]]

_DISPLAY: ContextVar[Display | None] = ContextVar("display", default=None)


class _Nobody:
    def reach(self, value: float) -> None:
        pass

    def name(self, part: str) -> None:
        pass


@contextlib.contextmanager
def shown_by(display: Display | None) -> Iterator[None]:
    """Show the long work of the block by a display; with None, by none."""
    token = _DISPLAY.set(display)
    try:
        yield
    finally:
        _DISPLAY.reset(token)


def is_shown() -> bool:
    """Whether anybody has asked how far long work is."""
    return _DISPLAY.get() is not None


@contextlib.contextmanager
def long_work(what: str, whole: float, unit: str, *, even: bool = True) -> Iterator[Shown]:
    """Yield what the block tells how far it is.

    Parameters
    ----------
    what
        What is done, in a word or two.
    whole
        How much there is of it, in ``unit``.
    unit
        Unit of what is done: designs, kPa.
    even
        Whether its parts take about as long as each other, so that the time left can be told.
    """
    display = _DISPLAY.get()
    if display is None:
        yield _Nobody()
        return
    with display(what, whole, unit, even) as shown:
        yield shown


def counted(
    items: Iterable[Item], what: str, whole: int, unit: str, *, even: bool = True
) -> Iterator[Item]:
    """Yield the items, and tell how many of them are done.

    >>> list(counted("ab", "spelling", 2, "letters"))
    ['a', 'b']
    """
    with long_work(what, whole, unit, even=even) as shown:
        for done, item in enumerate(items, start=1):
            yield item
            shown.reach(done)
