"""The table of a family's parameters, and what it says of the designs of the family."""

from __future__ import annotations

import csv
import functools
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pagd.design import Parameter
from pagd.design.model import as_number
from pagd.errors import InputError
from pagd.validation import Schema, check, schema

__all__ = ["read_parameters", "schema_of"]

#: Keys of a design beside its parameters.
_COMMON = ("name", "origin", "source", "notes")


@functools.cache
def read_parameters(table: Path) -> Mapping[str, Parameter]:
    """Read the table of a family's parameters.

    Parameters
    ----------
    table
        CSV with the columns symbol, unit (mm, degrees or 1), low, high (the sampling box), whole
        (yes or no) and description; a row a parameter.

    Returns
    -------
    Mapping
        Every parameter by its symbol, in the order of the table.

    Raises
    ------
    InputError
        Naming the file, the row and every fault of it.
    """
    found: dict[str, Parameter] = {}
    for number, row in enumerate(_rows(table), start=2):  # row 1 is the heading
        where = f"table of parameters {table}, row {number}"
        check(row, "parameters", where)
        parameter = Parameter(**row | {"whole": row["whole"] == "yes"})
        if parameter.symbol in found:
            raise InputError(f"{where}: symbol = {parameter.symbol!r} must be unique.")
        if not parameter.low < parameter.high:
            raise InputError(
                f"{where}: low = {parameter.low:g} must be less than high = {parameter.high:g}."
            )
        found[parameter.symbol] = parameter
    if not found:
        raise InputError(f"table of parameters {table}: must have at least one parameter.")
    return MappingProxyType(found)


def schema_of(parameters: Mapping[str, Parameter]) -> Schema:
    """Return the schema of a row of a table of such designs: that of pneu-nets, with these."""
    whole = schema("designs")
    common = {key: whole["properties"][key] for key in _COMMON}
    symbols = {
        symbol: {"type": "integer" if parameter.whole else "number"}
        for symbol, parameter in parameters.items()
    }
    return {
        "$schema": whole["$schema"],
        "type": "object",
        "additionalProperties": False,
        "required": ["name", *symbols],
        "properties": common | {"family": {"type": "string"}} | symbols,
    }


def _rows(table: Path) -> list[dict[str, Any]]:
    try:
        with table.open(newline="", encoding="utf-8-sig") as file:
            rows = list(csv.DictReader(file, restkey="(no heading)", strict=True))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"table of parameters {table}: cannot be read ({error}).") from None
    return [_typed(row) for row in rows]


def _typed(row: Mapping[str, Any]) -> dict[str, Any]:
    given = {key: value for key, value in row.items() if value not in ("", None)}
    numbers = {key: as_number(given[key]) for key in ("low", "high") if key in given}
    return given | {key: value for key, value in numbers.items() if value is not None}
