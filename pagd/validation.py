"""Checks of documents against JSON schemas, with faults told in one sentence each."""

from __future__ import annotations

import difflib
import functools
import importlib.resources
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeAlias

from pagd.documents import parse_yaml
from pagd.errors import InputError

__all__ = ["check", "check_by", "check_each", "defaults", "faults", "schema"]

Schema: TypeAlias = dict[str, Any]

# Whoever names another file by mistake need not read all keys that it has too much.
_TOLD = 4


@functools.cache
def schema(name: str) -> Schema:
    """Return the schema ``name`` that comes with pagd: config, designs or record."""
    file = importlib.resources.files("pagd") / "schemas" / f"{name}.schema.yaml"
    found: Schema = parse_yaml(file.read_text(encoding="utf-8"))
    return found


def check(document: Any, name: str, where: str) -> None:
    """Refuse a document that breaks the schema ``name``.

    Raises
    ------
    InputError
        One sentence: ``where``, then key, value and rule of every fault.
    """
    found = list(faults(document, name))
    if found:
        raise InputError(f"{where}: {'; '.join(found)}.")


def check_by(of: Schema, document: Any, where: str) -> None:
    """Refuse a document that breaks a schema that no file has; as :func:`check` otherwise.

    Numbers that are not finite pass, as those of designs do.
    """
    from jsonschema import Draft202012Validator

    found = list(_faults_by(Draft202012Validator(of), document))
    if found:
        raise InputError(f"{where}: {'; '.join(found)}.")


def check_each(documents: Iterable[tuple[str, Any]], name: str) -> None:
    """Check many documents, each with the place where it stands, against one schema."""
    validator = _validator(name)
    for where, document in documents:
        # Most are sound: the slow search for the words only for those that are not.
        if not validator.is_valid(document):
            check(document, name, where)


def faults(document: Any, name: str) -> Iterator[str]:
    """Yield every fault of a document as ``key = value must …``, each once."""
    return _faults_by(_validator(name), document)


def _faults_by(validator: Any, document: Any) -> Iterator[str]:
    seen: set[str] = set()
    for error in validator.iter_errors(document):
        key = error.json_path.removeprefix("$").removeprefix(".")
        sentence = _WORDS.get(error.validator, _other)(key, error)
        if sentence not in seen:
            seen.add(sentence)
            yield sentence


def defaults(of: Schema) -> Any:
    """Return the document that the ``default`` entries of a schema describe."""
    if "default" in of:
        return of["default"]
    return {key: defaults(part) for key, part in of.get("properties", {}).items()}


def _value(key: str, error: Any) -> str:
    return f"{key} = {error.instance!r}" if key else repr(error.instance)


def _type(key: str, error: Any) -> str:
    wanted = error.validator_value
    kinds = [wanted] if isinstance(wanted, str) else wanted
    if "number" in kinds and _is_number(error.instance):
        return f"{_value(key, error)} must be finite"
    return f"{_value(key, error)} must be {' or '.join(_KINDS[kind] for kind in kinds)}"


_KINDS = {
    "number": "a number",
    "integer": "a whole number",
    "string": "text",
    "boolean": "true or false",
    "object": "a table of keys and values",
    "array": "a list",
    "null": "empty",
}


def _bound(words: str) -> Callable[[str, Any], str]:
    return lambda key, error: f"{_value(key, error)} must be {words} {error.validator_value}"


def _length(key: str, error: Any) -> str:
    least, most = (error.schema.get(rule) for rule in ("minItems", "maxItems"))
    if error.validator == "minItems" and least == 1:
        return f"{key} must not be empty"
    words = {"minItems": "at least ", "maxItems": "at most "}[error.validator]
    count = f"{'' if least == most else words}{error.validator_value}"
    kind = "numbers" if error.schema.get("items") == {"type": "number"} else "entries"
    return f"{_value(key, error)} must have {count} {kind}"


def _enum(key: str, error: Any) -> str:
    return f"{_value(key, error)} must be one of {', '.join(map(str, error.validator_value))}"


def _unknown(key: str, error: Any) -> str:
    known = list(error.schema.get("properties", {}))
    unknown = [f"{key}{'.' if key else ''}{name}" for name in error.instance if name not in known]
    if len(unknown) > _TOLD:
        some = f"{', '.join(unknown[:_TOLD])} and {len(unknown) - _TOLD:,} more"
        return f"{some} are not known keys (known are {', '.join(known)})"
    return "; ".join(
        f"{name} is not a known key{_hint(name.rpartition('.')[2], known)}" for name in unknown
    )


def _hint(name: str, known: list[str]) -> str:
    near = difflib.get_close_matches(str(name), known, n=1)
    return f" (did you mean {near[0]}?)" if near else f" (known are {', '.join(known)})"


def _missing(key: str, error: Any) -> str:
    lacking = [name for name in error.validator_value if name not in error.instance]
    return f"{', '.join(lacking)} missing{f' in {key}' if key else ''}"


def _pattern(key: str, error: Any) -> str:
    # A regular expression is no sentence: its schema says beside it what it asks for.
    return f"{_value(key, error)} must {error.schema['words']}"


def _other(key: str, error: Any) -> str:
    return f"{key}: {error.message}" if key else str(error.message)


_WORDS: dict[str, Callable[[str, Any], str]] = {
    "type": _type,
    "enum": _enum,
    "const": lambda key, error: f"{_value(key, error)} must be {error.validator_value!r}",
    "minimum": _bound("at least"),
    "maximum": _bound("at most"),
    "exclusiveMinimum": _bound("greater than"),
    "exclusiveMaximum": _bound("less than"),
    "additionalProperties": _unknown,
    "required": _missing,
    "pattern": _pattern,
    "minProperties": lambda key, error: f"{key} must not be empty",
    "minItems": _length,
    "maxItems": _length,
}


@functools.cache
def _validator(name: str) -> Any:
    from jsonschema import Draft202012Validator, validators

    kind: Any = Draft202012Validator
    if name != _LEFT_TO_THE_RULES:
        numbers = kind.TYPE_CHECKER.redefine("number", lambda _, value: _is_finite(value))
        kind = validators.extend(kind, type_checker=numbers)  # type: ignore[no-untyped-call]
    return kind(schema(name))


# A design of numbers that are not finite is refused as one that cannot be built: it gets a record.
_LEFT_TO_THE_RULES = "designs"


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_finite(value: Any) -> bool:
    # JSON and YAML can spell nan, inf and whole numbers beyond any float.
    return _is_number(value) and abs(value) <= sys.float_info.max
