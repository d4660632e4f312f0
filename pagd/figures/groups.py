"""The designs of a picture that shows many: in which order, in which groups, in which lines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

from pagd.errors import InputError, Status
from pagd.figures.load import load_records
from pagd.figures.style import MODE_LOOKS, design_colours
from pagd.record import Record

__all__ = ["FEW", "Entry", "Line", "by_mode", "line_looks", "read_entries", "refuse_equal_names"]

#: Up to so many designs share a panel; more are parted by mode.
FEW: Final = 4
# Designs that others have built or simulated come first and carry their names.
_KNOWN = ("table2", "published")
# Dashes as matplotlib and as plotly call them.
_DASHES: Final[tuple[tuple[Any, str], ...]] = (
    ("-", "solid"),
    ((0, (5.0, 2.0)), "dash"),
    ((0, (1.5, 1.5)), "dot"),
    ((0, (6.0, 2.0, 1.5, 2.0)), "dashdot"),
)


@dataclass(frozen=True, eq=False, slots=True)
class Entry:
    """A design as pictures and page name it.

    folder: the folder of its stages' folders.
    record: that of the last stage that ran, which passes on what came before; None without any.
    """

    folder: Path
    record: Record | None

    @property
    def name(self) -> str:
        """Name of the design: that of its folder."""
        return self.folder.name

    @property
    def figures(self) -> dict[str, Any]:
        """Figures of the record, empty without one."""
        return self.record.figures if self.record else {}

    @property
    def origin(self) -> str:
        """Where the design comes from; "own" if no stage has said."""
        return str(self.figures.get("origin") or "own")

    @property
    def mode(self) -> str:
        """Mode the design was drawn for; "no mode" of a user's own mesh."""
        return str(self.figures.get("mode") or "no mode")

    @property
    def status(self) -> str:
        """How the design ended, in words."""
        return self.record.status.value.replace("_", " ") if self.record else "not run"

    @property
    def is_ok(self) -> bool:
        """Whether it went through all stages that it met."""
        return self.record is not None and self.record.status is Status.ok

    @property
    def is_known(self) -> bool:
        """Whether it is a published design or one of the paper's Table 2."""
        return self.origin in _KNOWN


class Line(NamedTuple):
    """Colour and line style of one design among others: for matplotlib, and for plotly."""

    colour: str
    dash: Any
    script: str


def read_entries(folders: Iterable[Path]) -> list[Entry]:
    """Return the designs of some folders, in their order."""
    found = []
    for folder in folders:
        records = list(load_records(folder).values())
        found.append(Entry(folder, records[-1] if records else None))
    return found


def refuse_equal_names(folders: Iterable[Path], names: Iterable[str]) -> None:
    """Refuse designs of one page that have the same name: one's card would replace the other's.

    Parameters
    ----------
    folders
        Folders of the designs, as whoever reads the message calls them.
    names
        Names of the designs, in their order.

    Raises
    ------
    InputError
        Naming the first two.
    """
    found: dict[str, Path] = {}
    for folder, name in zip(folders, names, strict=True):
        if name in found:
            raise InputError(
                f"{found[name]} and {folder} have the same name: each design of a page needs its "
                "own."
            )
        found[name] = folder


def by_mode(entries: Sequence[Entry]) -> dict[str, list[Entry]]:
    """Return the designs by the mode they were drawn for, Table 2 and published ones first."""
    order = (*_KNOWN, "own")
    ranked = sorted(
        entries, key=lambda e: order.index(e.origin) if e.origin in order else len(order)
    )
    modes = [*MODE_LOOKS, *sorted({e.mode for e in entries} - set(MODE_LOOKS))]
    groups = {mode: [e for e in ranked if e.mode == mode] for mode in modes}
    return {mode: group for mode, group in groups.items() if group}


def line_looks(names: Sequence[str]) -> dict[str, Line]:
    """Return a line a design: dashes begin where the colours begin anew."""
    colours = design_colours(names)
    distinct = len(set(colours.values())) or 1
    return {
        name: Line(colours[name], *_DASHES[i // distinct % len(_DASHES)])
        for i, name in enumerate(names)
    }
