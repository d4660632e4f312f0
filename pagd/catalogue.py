"""Designs with names: from a table (CSV, Parquet), a file (YAML, JSON) or JSON text."""

from __future__ import annotations

import csv
import json
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pagd.design import PARAMETERS, Design
from pagd.design.model import as_number
from pagd.documents import read_document
from pagd.errors import InputError
from pagd.validation import check, check_each

__all__ = ["NamedDesign", "design_from", "read_designs"]


# A tenth of the smallest side of the sampling box, and more than the largest one is in metres.
_SMALLEST_SIDE_MM = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedDesign:
    """A design, its name (unique in a run: the design_id) and the table it comes from."""

    name: str
    origin: str
    design: Design

    @classmethod
    def from_row(cls, row: Mapping[str, Any]) -> NamedDesign:
        """Make one of a row that has passed the schema of designs, with name and origin."""
        parameters = {key: row[key] for key in PARAMETERS}
        design = Design.from_mapping(parameters)
        return cls(name=row["name"], origin=row["origin"], design=design)

    def as_json(self) -> str:
        """Return it as one line of JSON with a fixed order of keys."""
        return json.dumps({"name": self.name, "origin": self.origin, **self.design.as_dict()})


def design_from(source: str) -> NamedDesign:
    """Read one design from JSON text, or from a YAML or JSON file.

    Raises
    ------
    InputError
        If it is neither, or describes no design.
    """
    given, file = read_document(source, "design")
    # A file's name serves as the name of a design that has none.
    name = re.sub(r"[^A-Za-z0-9_-]+", "-", Path(file).stem).strip("-") or "design"
    row = {"name": name, "origin": "own", **given}
    where = f"design {file or row['name']}"
    check(row, "designs", where)
    _check_unit(where, row)
    return NamedDesign.from_row(row)


def read_designs(tables: Mapping[str, str], *, checked: bool = True) -> dict[str, NamedDesign]:
    """Read tables of designs: a column ``name``, one a parameter, and if wanted origin and source.

    Parameters
    ----------
    tables
        Origin of the designs to the table's path: CSV, or Parquet as pagd itself writes it, with
        ``design_id`` for the name. What Parquet has of columns that follow from the parameters,
        or were measured on generated designs, is not read.
    checked
        False leaves out the check against the schema, for tables that have passed it.

    Returns
    -------
    dict
        The designs by name, in the order of the tables.

    Raises
    ------
    InputError
        Naming the file, the row and every fault of it.
    """
    rows = [row for origin, path in tables.items() for row in _rows(Path(path), origin)]
    if checked:
        check_each(rows, "designs")
        for where, row in rows:
            _check_unit(where, row)
    return _by_name((where, NamedDesign.from_row(row)) for where, row in rows)


def _rows(path: Path, origin: str) -> list[tuple[str, dict[str, Any]]]:
    """Return the rows of a table, each with the place where it stands."""
    if path.suffix == ".parquet":
        first, rows = 1, _rows_of_parquet(path)
    else:
        first, rows = 2, _rows_of_csv(path)  # row 1 of the file is the heading
    return [(f"{path}, row {i}", _typed(row, origin)) for i, row in enumerate(rows, start=first)]


def _rows_of_csv(path: Path) -> list[dict[str, Any]]:
    try:
        # Spreadsheets put a byte-order mark before the text.
        with path.open(newline="", encoding="utf-8-sig") as file:
            reader = csv.DictReader(file, restkey="(no heading)", strict=True)
            _check_heading(path, reader.fieldnames or [])
            return list(reader)
    except UnicodeDecodeError as error:
        raise InputError(f"table of designs {path}: must be UTF-8 text ({error}).") from None
    except (OSError, csv.Error) as error:
        raise InputError(f"table of designs {path}: cannot be read ({error}).") from None


def _check_heading(path: Path, columns: Sequence[str]) -> None:
    """Refuse a table that is none; what its columns are called is for the schema."""
    if not columns:
        raise InputError(f"table of designs {path}: is empty, and must have a row of headings.")
    if len(columns) == 1 and any(mark in columns[0] for mark in ";\t|"):
        raise InputError(
            f"table of designs {path}: columns must be separated by commas (the heading is "
            f"{columns[0]!r})."
        )
    twice = next((name for name, count in Counter(columns).items() if count > 1), None)
    if twice is not None:
        raise InputError(f"table of designs {path}: must have one column {twice}, not two.")


def _rows_of_parquet(path: Path) -> list[dict[str, Any]]:
    """Return the rows of a Parquet table as rows of CSV would be."""
    # Arrow takes a fifth of a second that no stage of a design has to wait for.
    from pagd.tables import GENERATED, read_rows

    # A design is its independent parameters: the rest is computed anew, and cannot contradict them.
    left_out = {column.name for column in GENERATED} - {*PARAMETERS, "origin"}
    # Nor is the index that pandas adds to what has been filtered.
    left_out |= {f"__index_level_{level}__" for level in range(2)}
    return [
        {"name": row.get("design_id")} | {k: v for k, v in row.items() if k not in left_out}
        for row in read_rows(path)
    ]


def _typed(row: Mapping[str, Any], origin: str) -> dict[str, Any]:
    given = {key: value for key, value in row.items() if value not in ("", None)}
    numbers = {key: _number(given[key]) for key in PARAMETERS if key in given}
    return {"origin": origin, **given, **numbers}


def _number(text: str) -> float | str:
    # What is no number stays as it is, for the schema to refuse it by its name.
    number = as_number(text)
    return text if number is None else number


def _check_unit(where: str, row: Mapping[str, Any]) -> None:
    """Refuse lengths that can only be metres: no actuator is so small, and all would fail."""
    sides = {key: row[key] for key in ("L", "W", "H")}
    if all(0 < side < _SMALLEST_SIDE_MM for side in sides.values()):
        told = ", ".join(f"{key} = {side:g}" for key, side in sides.items())
        raise InputError(f"{where}: {told}: lengths must be in mm, and these look like metres.")


def _by_name(designs: Iterable[tuple[str, NamedDesign]]) -> dict[str, NamedDesign]:
    found: dict[str, NamedDesign] = {}
    for where, named in designs:
        if named.name in found:
            raise InputError(f"{where}: name = '{named.name}' must be unique, but is taken.")
        found[named.name] = named
    return found
