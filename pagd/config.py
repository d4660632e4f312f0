"""The configuration: checked against its schema, completed by defaults, split by stage."""

from __future__ import annotations

import copy
import importlib.resources
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pagd.documents import read_document
from pagd.errors import InputError
from pagd.materials import Use, find_material
from pagd.validation import check, defaults, schema

__all__ = [
    "SECTIONS",
    "checked",
    "completed",
    "load",
    "material_as_json",
    "material_file",
    "part",
    "part_as_json",
]

#: The sections of the configuration that each stage depends on, and no others.
SECTIONS = {
    "geometry": ("channel", "limits", "geometry"),
    "repair": ("repair",),
    "mesh": ("mesh",),
    "solve": ("solve",),
    "metrics": ("metrics",),
    "figures": ("figures",),
}

Config = dict[str, Any]


def load(source: str | None) -> Config:
    """Return the completed configuration of a file or of JSON text; all defaults for None.

    Raises
    ------
    InputError
        Naming key, value and rule of every fault.
    """
    if source is None:
        return completed({})
    given, file = read_document(source, "configuration")
    return checked(given, f"configuration {file}".strip())


def checked(given: Mapping[str, Any], where: str) -> Config:
    """Check a configuration and complete it by the defaults; ``InputError`` names the faults."""
    check(dict(given), "config", where)
    config = completed(given)
    _check_steps(config["solve"], where)
    return config


def _check_steps(solve: Mapping[str, float], where: str) -> None:
    # A schema has no word for what one key asks of another.
    first, smallest = solve["first_step_kPa"], solve["smallest_step_kPa"]
    if first < smallest:
        raise InputError(
            f"{where}: solve.first_step_kPa = {first:g} must be at least "
            f"solve.smallest_step_kPa = {smallest:g}."
        )


def completed(given: Mapping[str, Any]) -> Config:
    """Return the configuration with the default for every key that ``given`` lacks."""
    config: Config = copy.deepcopy(defaults(schema("config")))
    for key, value in given.items():
        # 'designs' is one value as a whole: to name other tables is to leave out the paper's.
        merge = isinstance(value, Mapping) and key != "designs"
        config[key] = {**config[key], **value} if merge else value
    return config


def part(config: Mapping[str, Any], stage: str) -> Config:
    """Return the sections of a configuration that ``stage`` depends on."""
    return {section: config[section] for section in SECTIONS[stage]}


def part_as_json(config: Mapping[str, Any], stage: str) -> str:
    """Return :func:`part` as one line of JSON, to be handed to a stage as it is."""
    return json.dumps(part(config, stage), ensure_ascii=False)


def material_file(config: Mapping[str, Any]) -> Path:
    """Return the file of materials; pagd's own where the default one is not there."""
    file = Path(config["material_file"])
    if file.is_file() or file != Path(completed({})["material_file"]):
        return file
    return Path(str(importlib.resources.files("pagd") / "data" / "materials.yaml"))


def material_as_json(file: str, name: str, use: Use) -> str:
    """Return an entry of the file of materials with its name, as one line of JSON.

    ``use`` is the key of the configuration that names it: material or paper.
    What the entry says about its source is left out: a better citation changes no result.

    Raises
    ------
    InputError
        If there is no such entry for this use.
    """
    entry = {"name": name, **find_material(Path(file), name, use)}
    entry.pop("source", None)
    return json.dumps(entry, ensure_ascii=False)
