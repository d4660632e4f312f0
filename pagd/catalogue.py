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

from pagd.design import Design, Parameter
from pagd.design.model import as_number
from pagd.documents import read_document
from pagd.errors import InputError
from pagd.families import PNEUNET, Actuator, PneuNet, actuator_of, family_named
from pagd.families.parameters import schema_of
from pagd.validation import check, check_by, check_each

__all__ = ["NamedDesign", "design_from", "design_of", "name_from", "read_designs", "read_pneunets"]


# Files of a single design.
_DOCUMENTS = (".yaml", ".yml", ".json")
# A tenth of the smallest side of the sampling box, and more than the largest one is in metres.
_SMALLEST_SIDE_MM = 0.5
# The same of families: so small a share of what their sampling boxes begin with.
_METRES = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class NamedDesign:
    """A design, its name (unique in a run: the design_id) and the table it comes from.

    The design of a pneu-net is a :class:`pagd.design.Design`, that of another family an actuator.
    """

    name: str
    origin: str
    design: Design | Actuator

    @classmethod
    def from_row(cls, row: Mapping[str, Any]) -> NamedDesign:
        """Make one of a row that has passed the schema of designs, with name and origin."""
        family = family_named(row.get("family", PNEUNET))
        made = family.from_mapping({key: row[key] for key in family.parameters()})
        design = made.design if isinstance(made, PneuNet) else made
        return cls(name=row["name"], origin=row["origin"], design=design)

    @property
    def actuator(self) -> Actuator:
        """The design, as the stages ask for it."""
        return actuator_of(self.design)

    @property
    def pneunet(self) -> Design:
        """The design of a pneu-net; ``InputError`` if it is of another family."""
        if isinstance(self.design, Design):
            return self.design
        raise InputError(
            f"design {self.name}: family = {self.design.family!r} must be {PNEUNET} here: data "
            "set, generators, and analyses by a chamber each, are of pneu-nets alone."
        )

    def as_json(self) -> str:
        """Return it as one line of JSON with a fixed order of keys."""
        # A pneu-net names no family, now as before there were others.
        family = {} if isinstance(self.design, Design) else {"family": self.design.family}
        row = {"name": self.name, "origin": self.origin, **family, **self.design.as_dict()}
        return json.dumps(row)


def design_from(source: str) -> NamedDesign:
    """Read one design from JSON text, or from a YAML or JSON file.

    Raises
    ------
    InputError
        If it is neither, or describes no design.
    """
    given, file = read_document(source, "design")
    name = name_from(Path(file))
    where = f"design {file or given.get('name', name)}"
    return design_of({"name": name, "origin": "own", **given}, where)


def design_of(row: Mapping[str, Any], where: str) -> NamedDesign:
    """Return the design of a row with name and origin; ``InputError``, with where, if it is none.

    Raises
    ------
    InputError
        Naming every fault of the row.
    """
    checked = _with_family(where, row)
    _check_row(where, checked)
    return NamedDesign.from_row(checked)


def name_from(file: Path) -> str:
    """Return the name that a design without one has from its file."""
    return re.sub(r"[^A-Za-z0-9_-]+", "-", file.stem).strip("-") or "design"


def read_designs(tables: Mapping[str, str], *, checked: bool = True) -> dict[str, NamedDesign]:
    """Read tables of designs: a column ``name``, one a parameter, and if wanted others.

    They are ``origin``, ``source``, ``notes``, and ``family`` where designs are no pneu-nets. A
    table may have designs of several families: what has no value in a row is not of it.

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
        # Tables of pneu-nets may be long: they are checked by one validator.
        check_each([pair for pair in rows if _is_pneunet(pair[1])], "designs")
        for where, row in rows:
            _check_row(where, row, anew=not _is_pneunet(row))
    return _by_name((where, NamedDesign.from_row(row)) for where, row in rows)


def read_pneunets(tables: Mapping[str, str], *, checked: bool = True) -> dict[str, NamedDesign]:
    """Read tables of pneu-nets as :func:`read_designs` does.

    Raises
    ------
    InputError
        As there, and if a design is of another family.
    """
    found = read_designs(tables, checked=checked)
    for named in found.values():
        _ = named.pneunet
    return found


def _rows(path: Path, origin: str) -> list[tuple[str, dict[str, Any]]]:
    """Return the rows of a table, each with the place where it stands."""
    if path.suffix.lower() in _DOCUMENTS:
        raise InputError(f"table of designs {path}: must be a table, CSV or Parquet, of designs.")
    if path.suffix == ".parquet":
        first, rows = 1, _rows_of_parquet(path)
    else:
        first, rows = 2, _rows_of_csv(path)  # row 1 of the file is the heading
    numbered = ((f"{path}, row {i}", row) for i, row in enumerate(rows, start=first))
    return [(where, _typed(where, row, origin)) for where, row in numbered]


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
    computed = {column.name for column in GENERATED} - {"origin"}
    # Nor is the index that pandas adds to what has been filtered.
    index = {f"__index_level_{level}__" for level in range(2)}
    found = []
    for number, row in enumerate(read_rows(path), start=1):
        own = _parameters_of(f"{path}, row {number}", row)
        left_out = (computed - set(own)) | index
        rest = {key: value for key, value in row.items() if key not in left_out}
        found.append({"name": row.get("design_id")} | rest)
    return found


def _typed(where: str, row: Mapping[str, Any], origin: str) -> dict[str, Any]:
    given = {key: value for key, value in row.items() if value not in ("", None)}
    parameters = _parameters_of(where, given)
    numbers = {key: _number(given[key]) for key in parameters if key in given}
    return _with_family(where, {"origin": origin, **given, **numbers})


def _with_family(where: str, row: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row without the family where it is the one that need not be told."""
    _parameters_of(where, row)
    return {key: value for key, value in row.items() if (key, value) != ("family", PNEUNET)}


def _is_pneunet(row: Mapping[str, Any]) -> bool:
    return "family" not in row


def _parameters_of(where: str, row: Mapping[str, Any]) -> Mapping[str, Parameter]:
    try:
        return family_named(row.get("family") or PNEUNET).parameters()
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _number(text: str) -> float | str:
    # What is no number stays as it is, for the schema to refuse it by its name.
    number = as_number(text)
    return text if number is None else number


def _check_row(where: str, row: Mapping[str, Any], *, anew: bool = True) -> None:
    """Refuse a row that breaks the schema of its family, or that has lengths in metres.

    ``anew`` is false for one that has passed the schema already.
    """
    if _is_pneunet(row):
        if anew:
            check(row, "designs", where)
        _refuse_metres(where, row, dict.fromkeys(("L", "W", "H"), _SMALLEST_SIDE_MM))
        return
    parameters = _parameters_of(where, row)
    check_by(schema_of(parameters), row, where)
    lengths = {key: _METRES * p.low for key, p in parameters.items() if p.unit == "mm" and p.low}
    _refuse_metres(where, row, lengths)


def _refuse_metres(where: str, row: Mapping[str, Any], smallest: Mapping[str, float]) -> None:
    """Refuse lengths that can only be metres: no actuator is so small, and all would fail."""
    sides = {key: row[key] for key in smallest}
    if sides and all(0 < side < smallest[key] for key, side in sides.items()):
        told = ", ".join(f"{key} = {side:g}" for key, side in sides.items())
        raise InputError(f"{where}: {told}: lengths must be in mm, and these look like metres.")


def _by_name(designs: Iterable[tuple[str, NamedDesign]]) -> dict[str, NamedDesign]:
    found: dict[str, NamedDesign] = {}
    for where, named in designs:
        if named.name in found:
            raise InputError(f"{where}: name = '{named.name}' must be unique, but is taken.")
        found[named.name] = named
    return found
