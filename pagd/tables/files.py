"""Tables in Parquet files, with unit and description of every column in the metadata."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.files import must_exist, replaced_file
from pagd.tables.column import Column

__all__ = ["concatenate", "read_rows", "read_table", "units", "write_rows", "write_table"]


def write_table(path: Path, columns: Sequence[Column], data: Mapping[str, Any]) -> None:
    """Write one Parquet file with exactly the ``columns``; it appears complete or not at all.

    Parameters
    ----------
    path
        Target file.
    columns
        Declared columns, in order.
    data
        Column name to values, all of one length; a missing name becomes a column of nulls.

    Raises
    ------
    ValueError
        If ``data`` has a column that is not declared, or lengths differ.
    """
    unknown = sorted(set(data) - {column.name for column in columns})
    if unknown:
        raise ValueError(f"columns {unknown} are not declared for {path.name}")
    length = max((len(values) for values in data.values()), default=0)
    arrays = [
        pa.array(data.get(column.name, [None] * length), type=_arrow_type(column), from_pandas=True)
        for column in columns
    ]
    _write(path, pa.Table.from_arrays(arrays, schema=_arrow_schema(columns)))


def write_rows(path: Path, columns: Sequence[Column], rows: Iterable[Mapping[str, Any]]) -> None:
    """Write a table from its ``rows``; a key that a row lacks becomes null."""
    found = list(rows)
    unknown = {key for row in found for key in row} - {column.name for column in columns}
    if unknown:
        raise ValueError(f"columns {sorted(unknown)} are not declared for {path.name}")
    write_table(path, columns, {c.name: [row.get(c.name) for row in found] for c in columns})


def read_table(path: Path) -> dict[str, NDArray[Any]]:
    """Read a Parquet file into one array a column; nulls of numbers become NaN.

    Raises
    ------
    InputError
        If the file is missing or no Parquet file.
    """
    table = _read(path)
    return {
        name: np.asarray(table.column(name).to_numpy(zero_copy_only=False))
        for name in table.column_names
    }


def read_rows(path: Path) -> list[dict[str, Any]]:
    """Read a Parquet file into a dictionary a row; nulls become None."""
    rows: list[dict[str, Any]] = _read(path).to_pylist()
    return rows


def units(path: Path) -> dict[str, str]:
    """Return the unit of every column, from the file's metadata ('' where there is none)."""
    schema = pq.read_schema(path)
    return {f.name: (f.metadata or {}).get(b"unit", b"").decode() for f in schema}


def concatenate(path: Path, parts: Sequence[Path], columns: Sequence[Column]) -> None:
    """Write the rows of all ``parts``, in order, to one table."""
    schema = _arrow_schema(columns)
    tables = [_read(part).select(schema.names).cast(schema) for part in parts]
    _write(path, pa.concat_tables(tables) if tables else schema.empty_table())


def _read(path: Path) -> Any:
    must_exist(path)
    try:
        return pq.read_table(path)
    except (OSError, pa.ArrowInvalid) as error:
        raise InputError(f"{path}: not a readable Parquet table ({error}).") from error


def _write(path: Path, table: Any) -> None:
    with replaced_file(path) as temporary:
        pq.write_table(table, temporary, compression="zstd")


def _arrow_type(column: Column) -> Any:
    return pa.type_for_alias(column.type)


def _arrow_schema(columns: Sequence[Column]) -> Any:
    return pa.schema(
        pa.field(
            column.name,
            _arrow_type(column),
            metadata={"unit": column.unit, "description": column.description},
        )
        for column in columns
    )
