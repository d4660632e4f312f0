"""Write config/README.md: every key of the configuration, from its schema.

    python workflow/scripts/config_readme.py

A test keeps the page in step with the schema.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pagd.documents import parse_yaml

ROOT = Path(__file__).parents[2]

INTRODUCTION = """\
# Configuration

`config.yaml` holds every scientific number of the workflow, with its unit. Threads, memory and
paths of a machine are in `profiles/`. A key that is left out takes its default; a key that is
not listed here is refused. `materials.yaml` is the file of materials.

This page is made from `workflow/schemas/` by `python workflow/scripts/config_readme.py`.

## config.yaml
"""

TABLES = """\
## Tables of designs

CSV files with these columns, one row a design. A column `family` names what is no pneu-net, such as
`half_bellows`: such a row has name, origin, source, notes and the parameters of its family instead
(`docs/extending.md`), and leaves the others empty.
"""


def rows(schema: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, str, str, str, str]]:
    """Yield key, default, unit, rule and description of every key, sections by their keys."""
    for name, part in schema["properties"].items():
        key = f"{prefix}{name}"
        if "properties" in part:
            yield (f"**`{key}`**", _default(part), "", "", part["description"])
            yield from rows(part, f"{key}.")
        else:
            unit = part["unit"] if part["unit"] not in ("", "1") else "–"
            yield (f"`{key}`", _default(part), unit, _rule(part), part["description"])


def _default(part: dict[str, Any]) -> str:
    return _value(part["default"]) if "default" in part else ""


def _value(value: Any) -> str:
    text = json.dumps(value).replace('"', "")
    return f"`{text}`"


def _rule(part: dict[str, Any]) -> str:
    if "enum" in part:
        return ", ".join(_value(value) for value in part["enum"])
    bounds = [f"{sign} {part[word]}" for word, sign in _SIGNS.items() if word in part]
    kinds = part["type"] if isinstance(part["type"], list) else [part["type"]]
    return ", ".join([" or ".join(_KINDS[kind] for kind in kinds), *bounds])


_KINDS = {
    "number": "number",
    "integer": "whole number",
    "boolean": "true, false",
    "string": "text",
    "array": "list",
    "null": "null",
}
_SIGNS = {"minimum": "≥", "exclusiveMinimum": ">", "maximum": "≤", "exclusiveMaximum": "<"}


def table(schema: dict[str, Any]) -> str:
    """Return the keys of a schema as a Markdown table."""
    head = ("key", "default", "unit", "values", "meaning")
    lines = [head, ("---",) * len(head), *rows(schema)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def page(schemas: Path = ROOT / "workflow" / "schemas") -> str:
    """Return the whole page."""
    config, designs = (
        parse_yaml((schemas / f"{name}.schema.yaml").read_text(encoding="utf-8"))
        for name in ("config", "designs")
    )
    return f"{INTRODUCTION}\n{table(config)}\n{TABLES}\n{table(designs)}"


if __name__ == "__main__":
    (ROOT / "config" / "README.md").write_text(page(), encoding="utf-8")
