"""Tables of keys and values that a user hands over: as JSON text, or in a YAML or JSON file."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import yaml

from pagd.errors import InputError

__all__ = ["parse_yaml", "read_document"]


def read_document(source: str, what: str) -> tuple[dict[str, Any], str]:
    """Read a table of keys and values.

    Parameters
    ----------
    source
        JSON text (it begins with ``{``) or the name of a YAML or JSON file.
    what
        What it should be, for the message.

    Returns
    -------
    tuple
        The table, and the name of the file ('' for text).

    Raises
    ------
    InputError
        If it cannot be read, or is no such table.
    """
    if source.lstrip().startswith("{"):
        return _parsed_json(source, what), ""
    what = f"{what} {source}"
    text = _text_of(source, what)
    parse = _parsed_json if source.endswith(".json") else _parsed_yaml
    return parse(text, what), source


def parse_yaml(text: str) -> Any:
    """Return the content of YAML text, in which 1e-3 is a number; raises ``yaml.YAMLError``."""
    return yaml.load(text, Loader=_Loader)


def _text_of(file: str, what: str) -> str:
    try:
        return Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{what}: cannot be read ({error}).") from None


def _parsed_json(text: str, what: str) -> dict[str, Any]:
    try:
        return _table(json.loads(text), what)
    except ValueError as error:
        raise InputError(f"{what}: is not JSON ({error}).") from None


def _parsed_yaml(text: str, what: str) -> dict[str, Any]:
    try:
        return _table(parse_yaml(text), what)
    except yaml.YAMLError as error:
        raise InputError(f"{what}: is not YAML ({' '.join(str(error).split())}).") from None


def _table(content: Any, what: str) -> dict[str, Any]:
    if not isinstance(content, dict):
        raise InputError(f"{what}: must be a table of keys and values.")
    return content


# The loader in C is eight times as fast; not every build of PyYAML has it.
class _Loader(getattr(yaml, "CSafeLoader", yaml.SafeLoader)):  # type: ignore[misc]
    """YAML in which 1e-3 is a number, as in YAML 1.2 and in JSON; PyYAML asks for 1.0e-3."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"[-+]?[0-9]+(?:\.[0-9]*)?[eE][-+]?[0-9]+$"),
    list("-+0123456789"),
)
