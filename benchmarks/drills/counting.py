"""What is left of a sweep after a fault and a restart, in figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from performance.page import table, wrapped

from drills.faults import Drill
from drills.project import Sweep
from pagd.tables import read_rows

__all__ = ["Count", "count", "text_of"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Count:
    """The figures of a drill.

    ``correct``: designs with the one row that they should have. ``before``: designs that were done
    before the fault; ``again``: those of them that were computed again. ``damaged``: folders that
    an audit finds. ``halves``: temporary files. ``why``: why there are no figures, and ``needs``
    whether that is because the fault cannot be done here.
    """

    drill: Drill
    designs: int
    correct: int = 0
    before: int = 0
    again: int = 0
    damaged: int = 0
    halves: int = 0
    why: str = ""
    needs: bool = False

    @property
    def is_sound(self) -> bool:
        """Whether all is as it must be, or the fault could not be done."""
        if self.why:
            return self.needs
        few = self.again <= self.drill.again
        return self.correct == self.designs and few and not (self.damaged or self.halves)

    def line(self) -> str:
        """One line for people."""
        if self.why:
            return f"{self.drill.name}: {'left out, needs' if self.needs else 'FAILED:'} {self.why}"
        return (
            f"{'passed' if self.is_sound else 'FAILED'}: {self.drill.name}: {self.correct} of "
            f"{self.designs} correct, {self.again} of {self.before} again, {self.damaged} damaged, "
            f"{self.halves} half-written"
        )


def count(
    drill: Drill, sweep: Sweep, before: Mapping[str, float], wanted: Mapping[str, Any]
) -> Count:
    """Count what is left of a sweep.

    Parameters
    ----------
    drill
        What was done to it.
    sweep
        The sweep, after the restart.
    before
        Designs that were done before the fault, with the times of their records.
    wanted
        What the records should say, by design; of slanted ones that fail, the status alone.
    """
    after, found = sweep.done(), sweep.results()
    rows = read_rows(sweep.folder / "results" / "summary" / "performance.parquet")
    names = [row["design_id"] for row in rows]
    correct = [
        name
        for name in sweep.names
        if names.count(name) == 1 and _is_right(drill, name, found.get(name), wanted[name])
    ]
    told = sweep.pagd("audit")
    assert told.returncode in (0, 1), told.stderr
    return Count(
        drill=drill,
        designs=sweep.designs,
        correct=len(correct),
        before=len(before),
        again=sum(1 for name, when in before.items() if after.get(name) != when),
        damaged=sum(1 for line in told.stdout.splitlines()[:-1] if line),
        halves=len(sweep.leftovers()),
    )


def _is_right(drill: Drill, name: str, found: Any, wanted: Any) -> bool:
    if found is None:
        return False
    if drill.failing is None:
        return bool(found == wanted)
    # Another mesher makes another mesh: of these drills, how the designs end is what counts.
    expected = drill.failing if name.startswith("h") else wanted[0]
    return bool(found[0] == expected)


def text_of(counts: Sequence[Count]) -> str:
    """Return the table of the drills in Markdown, and what the faults are."""
    headings = ("fault", "correct records", "done before", "of them again", "damaged", "half")
    rows = [
        [each.drill.name, "left out" if each.needs else "FAILED", "", "", "", ""]
        if each.why
        else [
            each.drill.name,
            f"{each.correct} of {each.designs}",
            str(each.before),
            str(each.again),
            str(each.damaged),
            str(each.halves),
        ]
        for each in counts
    ]
    notes = [wrapped(f"- {c.drill.name}: {c.drill.what}", "  ") for c in counts]
    left = [
        wrapped(f"{'Left out: it needs' if c.needs else 'FAILED:'} {c.why} ({c.drill.name})")
        for c in counts
        if c.why
    ]
    return "\n\n".join([table(headings, rows), "\n".join(notes), *left])
