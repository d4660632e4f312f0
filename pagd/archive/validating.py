"""Whether what describes a data set is sound: its Croissant, by its own library; its provenance."""

from __future__ import annotations

import json
from itertools import islice
from pathlib import Path

import mlcroissant as mlc
import pandas as pd
import pyarrow.parquet as pq

from pagd.archive.croissant import CROISSANT
from pagd.archive.provenance import PROVENANCE, key_of
from pagd.archive.splits import SPLITS
from pagd.archive.tables import TABLES
from pagd.errors import InputError
from pagd.files import must_exist

__all__ = ["faults_of_metadata", "faults_of_provenance"]


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


def faults_of_provenance(folder: Path, performance: pd.DataFrame) -> list[str]:
    """Return what made an analysis of the data set and is not told, a sentence each.

    Parameters
    ----------
    folder
        The data set.
    performance
        Its table of that name.

    Raises
    ------
    InputError
        If it has no file of its provenance, or its tables do not name any.
    """
    path = folder / PROVENANCE
    must_exist(path)
    if "provenance" not in performance:
        raise InputError(f"{folder}: made by an older pagd, which told no provenance.")
    told = json.loads(path.read_text(encoding="utf-8"))
    wrong = [key for key, made_by in told.items() if key_of(made_by) != key]
    faults = [f"{key} is not the hash of what it names." for key in wrong]
    named = performance["provenance"].fillna("nothing").unique()
    return faults + [f"an analysis names {key}, which is not there." for key in {*named} - {*told}]


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
