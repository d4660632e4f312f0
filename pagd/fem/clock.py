"""Where the processor time of an analysis goes."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager


class Clock:
    """Seconds of processor time (all threads) by part.

    >>> clock = Clock()
    >>> with clock.part("assembly"):
    ...     _ = sum(range(10))
    >>> list(clock.seconds)
    ['assembly']
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def part(self, name: str) -> Iterator[None]:
        """Add the time of the block to the part ``name``."""
        start = time.process_time()
        try:
            yield
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.process_time() - start
