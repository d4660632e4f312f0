"""Many designs as one table: a DataFrame a row of which is a design, with all 16 parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from pagd.design import PARAMETERS, Design
from pagd.errors import InputError
from pagd.tables import DESIGNS, Column, read_table, write_table

__all__ = [
    "CATEGORICAL",
    "DEPENDENT",
    "INDEPENDENT",
    "completed",
    "designs_of",
    "frame_of",
    "read_frame",
    "write_frame",
]

#: The 16 parameters of the paper: 11 independent, 3 that follow from them, 2 categories.
INDEPENDENT: Final = tuple(PARAMETERS)
DEPENDENT: Final = ("L_T", "N1", "N2")
CATEGORICAL: Final = ("mode", "cross_section")


def frame_of(
    designs: Iterable[Design], ids: Iterable[str], origins: str | Iterable[str]
) -> pd.DataFrame:
    """Return the table of some designs, with the columns :data:`pagd.tables.DESIGNS`.

    Parameters
    ----------
    designs
        The designs, in the order of the rows.
    ids
        Their names, unique.
    origins
        Where they come from: one for each, or one for all.
    """
    drawn = list(designs)
    frame = pd.DataFrame([d.as_dict() for d in drawn], columns=list(INDEPENDENT))
    for name in (*DEPENDENT, *CATEGORICAL):
        frame[name] = [getattr(design, name) for design in drawn]
    frame.insert(0, "design_id", list(ids))
    frame["origin"] = origins if isinstance(origins, str) else list(origins)
    return _typed(frame)


def designs_of(frame: pd.DataFrame) -> list[Design]:
    """Return the designs of a table that has at least the independent parameters as columns."""
    columns = [frame[symbol].tolist() for symbol in INDEPENDENT]
    return [
        Design(**dict(zip(INDEPENDENT, values, strict=True)))
        for values in zip(*columns, strict=True)
    ]


def completed(
    parameters: pd.DataFrame, ids: Iterable[str], origins: str | Iterable[str]
) -> pd.DataFrame:
    """Return a whole table for independent parameters; what depends on them is computed anew."""
    return frame_of(designs_of(parameters), ids, origins)


def write_frame(path: Path, frame: pd.DataFrame, columns: Sequence[Column] = DESIGNS) -> None:
    """Write a table to Parquet, with units and descriptions; equal tables are equal files."""
    write_table(path, columns, {column.name: frame[column.name] for column in columns})


def read_frame(path: Path) -> pd.DataFrame:
    """Read a table of designs from Parquet.

    Raises
    ------
    InputError
        If the file is no Parquet table, or lacks a column of a table of designs.
    """
    frame = pd.DataFrame(read_table(path))
    missing = [column.name for column in DESIGNS if column.name not in frame]
    if missing:
        raise InputError(f"{path}: is no table of designs, since {', '.join(missing)} is missing.")
    return _typed(frame)


def _typed(frame: pd.DataFrame) -> pd.DataFrame:
    kinds: dict[str, Any] = {"double": np.float64, "int64": np.int64, "string": object}
    return frame.astype({column.name: kinds[column.type] for column in DESIGNS})
