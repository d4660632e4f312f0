"""Tables of the data set: those of a run, by ids that are the same in every run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

from pagd.tables import CHAMBERS, DESIGNS, MEASURES, PERFORMANCE, TRAJECTORY, Column

__all__ = ["PROVENANCE", "TABLES", "Archived"]

ID: Final = Column("id", "string", "", "hash of the parameters: 16 hexadecimal digits")

PROVENANCE: Final = Column(
    "provenance", "string", "", "what made it, by its name in provenance.json"
)


class Archived(NamedTuple):
    """A table: its columns, and what a row of it is."""

    columns: Sequence[Column]
    row: str


#: Tables of the data set by name, which is that of their folder too.
TABLES: Final = {
    "designs": Archived(
        (
            ID,
            Column("set", "string", "", "training, generated or other"),
            *DESIGNS,
            Column("novelty", "double", "1", "distance to the nearest training design, encoded"),
        ),
        "a design",
    ),
    "performance": Archived(
        (ID, *PERFORMANCE, PROVENANCE), "a design and fidelity, whatever became of it"
    ),
    "by_pressure": Archived((ID, *MEASURES), "a design, fidelity and recorded pressure"),
    "trajectories": Archived(
        (ID, *TRAJECTORY), "a design, fidelity, recorded pressure and section"
    ),
    "chambers": Archived((ID, *CHAMBERS), "a design, fidelity, recorded pressure and chamber"),
}
