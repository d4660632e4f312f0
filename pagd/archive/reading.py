"""The tables of a data set on disk, all splits together."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from pagd.archive.splits import SPLITS
from pagd.archive.tables import TABLES
from pagd.errors import InputError
from pagd.tables import units

__all__ = ["read_tables"]


def read_tables(folder: Path) -> dict[str, pd.DataFrame]:
    """Return the tables by name, with a column ``split``, and the units in ``attrs``.

    Raises
    ------
    InputError
        If a file is missing.
    """
    return {name: _read(folder, name) for name in TABLES}


def _read(folder: Path, name: str) -> pd.DataFrame:
    files = {split: folder / "data" / name / f"{split}.parquet" for split in SPLITS}
    for file in files.values():
        if not file.is_file():
            raise InputError(f"{file}: there is no such file; a data set has one.")
    parts = [pd.read_parquet(file).assign(split=split) for split, file in files.items()]
    frame = pd.concat(parts, ignore_index=True)
    frame.attrs["units"] = units(next(iter(files.values())))
    return frame
