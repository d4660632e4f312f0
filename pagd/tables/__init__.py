"""Tables in Parquet files: declared columns, with unit and description in the metadata.

:mod:`pagd.tables.files` reads and writes, the other modules declare columns by subject.
`docs/data.md` lists every table of a run with its columns.
"""

from pagd.tables.column import Column
from pagd.tables.designs import DESIGNS, GENERATED
from pagd.tables.diversity import COMPARISON, HULL_POINTS, HULLS, reduced_space
from pagd.tables.files import (
    concatenate,
    read_rows,
    read_table,
    units,
    write_rows,
    write_table,
)
from pagd.tables.measures import CHAMBERS, MEASURES, PERFORMANCE, TRAJECTORY
from pagd.tables.solution import BLOCKED, HISTORY, STATES

__all__ = [
    "BLOCKED",
    "CHAMBERS",
    "COMPARISON",
    "DESIGNS",
    "GENERATED",
    "HISTORY",
    "HULLS",
    "HULL_POINTS",
    "MEASURES",
    "PERFORMANCE",
    "STATES",
    "TRAJECTORY",
    "Column",
    "concatenate",
    "read_rows",
    "read_table",
    "reduced_space",
    "units",
    "write_rows",
    "write_table",
]
