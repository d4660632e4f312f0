"""Whether the metadata of a data set is sound Croissant, by its own library, and loads the data."""

from __future__ import annotations

from itertools import islice
from pathlib import Path

import mlcroissant as mlc
import pyarrow.parquet as pq

from pagd.archive.croissant import CROISSANT
from pagd.archive.splits import SPLITS
from pagd.archive.tables import TABLES
from pagd.files import must_exist

__all__ = ["faults_of_metadata"]


def faults_of_metadata(folder: Path) -> list[str]:
    """Return what is wrong with the metadata of a data set, a sentence each.

    Parameters
    ----------
    folder
        The data set. Of every table and split the first record is loaded by the metadata, and
        compared with the file.

    Raises
    ------
    InputError
        If it has no metadata.
    """
    path = folder / CROISSANT
    must_exist(path)
    try:
        dataset = mlc.Dataset(jsonld=str(path))
    except mlc.ValidationError as error:
        return [str(error)]
    return [
        f"{table}/{split} does not load what is in the file."
        for table in TABLES
        for split in SPLITS
        if not _loads(dataset, folder, f"{table}/{split}")
    ]


def _loads(dataset: mlc.Dataset, folder: Path, key: str) -> bool:
    names = pq.read_schema(folder / "data" / f"{key}.parquet").names
    rows = pq.read_metadata(folder / "data" / f"{key}.parquet").num_rows
    try:
        first = list(islice(dataset.records(key), 1))
    except mlc.GenerationError:
        return False
    return len(first) == min(rows, 1) and all(
        list(one) == [f"{key}/{name}" for name in names] for one in first
    )
