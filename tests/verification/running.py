"""Run cases side by side, each in one thread; one that raises does not keep the others."""

from __future__ import annotations

import os
import time
import traceback
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context

from catalogue import find
from figure import Case, Figure


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What came of a case.

    Attributes
    ----------
    case
        Its name.
    figures
        Its rows, in order.
    seconds
        What it took.
    fault
        Why it broke off; empty if it did not.
    missing
        The program for want of which it was left out; empty if it was not.
    """

    case: str
    figures: tuple[Figure, ...] = ()
    seconds: float = 0.0
    fault: str = ""
    missing: str = ""

    @property
    def passes(self) -> bool:
        """Whether it ran to its end and every row passes; what was left out does not count."""
        if self.missing:
            return True
        return not self.fault and bool(self.figures) and all(f.passes for f in self.figures)


def run(cases: Sequence[Case], processes: int) -> Iterator[Outcome]:
    """Outcomes as they come; the costly cases are begun first, the last of them before others."""
    for variable in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
        os.environ[variable] = "1"
    # New processes, which read the variables; of this one the libraries are loaded already.
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        # Those of the whole actuators at the end of the list take longest.
        costly = [case for case in reversed(cases) if case.costly]
        begun = [*costly, *(case for case in cases if not case.costly)]
        waiting = [pool.submit(outcome, case.name) for case in begun]
        for done in as_completed(waiting):
            yield done.result()


def outcome(name: str) -> Outcome:
    """Run the case of a name."""
    (case,) = find([name])
    if not case.is_possible:
        return Outcome(case=name, missing=case.program or "")
    start = time.perf_counter()
    figures: list[Figure] = []
    fault = ""
    try:
        figures = case.rows()
    except Exception:  # whatever it is, it goes on the page, and the other cases go on
        fault = traceback.format_exc(limit=-1).strip()
    return Outcome(
        case=name, figures=tuple(figures), seconds=time.perf_counter() - start, fault=fault
    )
