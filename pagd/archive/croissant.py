"""Metadata of the data set in the Croissant format: what files there are, and what is in them.

Croissant 1.1 of MLCommons, by its own library, which also checks and loads what is written.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import date, datetime
from pathlib import Path
from typing import Final

import mlcroissant as mlc

from pagd import __version__
from pagd.archive.card import DESCRIPTION, NAME
from pagd.archive.splits import SPLITS
from pagd.archive.tables import TABLES, Archived
from pagd.errors import InputError
from pagd.files import must_exist
from pagd.tables import Column

__all__ = ["CREATOR", "CROISSANT", "KEYWORDS", "croissant", "version_of", "version_on"]

CROISSANT: Final = "croissant.json"

_TYPES: Final = {
    "string": mlc.DataType.TEXT,
    "double": mlc.DataType.FLOAT,
    "int32": mlc.DataType.INTEGER,
    "int64": mlc.DataType.INTEGER,
}
_PARQUET: Final = "application/x-parquet"
_LICENCE: Final = "https://spdx.org/licenses/MIT.html"
CREATOR: Final = "The pagd authors"
_CITATION: Final = f"The pagd authors: {NAME}, made with pagd {__version__}."
KEYWORDS: Final = (
    "soft robotics",
    "soft pneumatic actuator",
    "pneu-net",
    "finite element method",
    "generative design",
)


def croissant(digests: Mapping[str, str], published: date) -> str:
    """Return the metadata as JSON text.

    Parameters
    ----------
    digests
        SHA-256 of the files of the tables, by path in the data set.
    published
        Date of publication.
    """
    files = [
        mlc.FileObject(
            id=path,
            name=path,
            content_url=path,
            encoding_formats=[_PARQUET],
            sha256=digest,
        )
        for path, digest in digests.items()
    ]
    sets = [_records(name, split, table) for name, table in TABLES.items() for split in SPLITS]
    metadata = mlc.Metadata(
        name=NAME,
        description=DESCRIPTION,
        version=version_on(published),
        license=[_LICENCE],
        creators=[mlc.Organization(name=CREATOR)],
        cite_as=_CITATION,
        keywords=list(KEYWORDS),
        date_published=datetime(published.year, published.month, published.day),
        distribution=files,
        record_sets=sets,
    )
    text = json.dumps(metadata.to_json(), indent=2, ensure_ascii=False, default=str)
    return text + "\n"


def version_on(published: date) -> str:
    """Return the version of a data set: the day that it was published, as 2026.1.31."""
    return f"{published.year}.{published.month}.{published.day}"


def version_of(archive: Path) -> str:
    """Return the version that a data set tells of itself.

    Raises
    ------
    InputError
        If it has no metadata.
    """
    path = archive / CROISSANT
    must_exist(path)
    try:
        return str(json.loads(path.read_text(encoding="utf-8"))["version"])
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: tells no version ({error}).") from None


def _records(name: str, split: str, table: Archived) -> mlc.RecordSet:
    key = f"{name}/{split}"
    return mlc.RecordSet(
        id=key,
        name=key,
        description=f"A row is {table.row}: the part {split}.",
        fields=[_field(key, f"data/{key}.parquet", column) for column in table.columns],
    )


def _field(record_set: str, path: str, column: Column) -> mlc.Field:
    unit = f" ({column.unit})" if column.unit not in ("", "1") else ""
    return mlc.Field(
        id=f"{record_set}/{column.name}",
        name=column.name,
        description=f"{column.description}{unit}",
        data_types=[_TYPES[column.type]],
        source=mlc.Source(file_object=path, extract=mlc.Extract(column=column.name)),
    )
