"""The configuration: checked against its schema, completed by defaults, split by stage."""

from __future__ import annotations

import copy
import importlib.resources
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from yaml import YAMLError

from pagd.documents import parse_yaml, read_document
from pagd.errors import InputError
from pagd.materials import Use, find_material
from pagd.validation import check, defaults, schema

__all__ = [
    "SECTIONS",
    "check_study",
    "checked",
    "completed",
    "known_tables",
    "load",
    "material_as_json",
    "material_file",
    "packaged_tables",
    "part",
    "part_as_json",
    "refusal_of_cells",
    "retyped",
]

#: The sections of the configuration that each stage depends on, and no others.
SECTIONS = {
    "geometry": ("channel", "limits", "geometry"),
    "repair": ("repair",),
    "mesh": ("mesh",),
    "solve": ("solve",),
    "metrics": ("metrics",),
    "screening": ("channel", "limits", "mesh", "solve", "metrics"),
    "fronts": ("screening",),
    "figures": ("figures",),
    "export": ("geometry",),
    "dataset": ("channel", "limits", "dataset"),
    "embedding": ("embedding",),
    "generate": ("channel", "limits", "generator"),
    "diversity": ("diversity",),
    "selection": ("selection",),
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


def check_study(config: Mapping[str, Any], where: str) -> None:
    """Check what the sections of the generative half ask of each other.

    The stages check the same of the tables they are given, which may be anybody's.

    Parameters
    ----------
    config
        Completed configuration.
    where
        What the faults are found in, for the message.

    Raises
    ------
    InputError
        Naming the keys and the rule of the first fault.
    """
    size, generated = config["dataset"]["size"], config["generator"]["designs"]
    plane = config["diversity"]["plane_designs"]
    limits = {
        ("diversity", "plane_designs"): {"dataset.size": size},
        ("diversity", "hull_designs"): {"dataset.size": size, "generator.designs": generated},
        ("embedding", "perplexity"): {
            "a third of dataset.size": size / 3,
            "a third of diversity.plane_designs": plane / 3,
        },
        # A mixture is fitted to the plane of the data set, and to that of a few designs.
        **{
            ("generator", key): {"dataset.size": size, "diversity.plane_designs": plane}
            for key in ("components", "largest_components")
        },
    }
    for (section, key), bounds in limits.items():
        value = config[section][key]
        for name, bound in bounds.items():
            if value != "bic" and value > bound:
                raise InputError(
                    f"{where}: {section}.{key} = {value:g} must be at most {name} = {bound:g}."
                )


def refusal_of_cells(solve: Mapping[str, Any]) -> str | None:
    """Why designs cannot be screened by their cells under such settings; none where they can.

    Parameters
    ----------
    solve
        The section of the completed configuration.
    """
    if any(solve["gravity_m_s2"]):
        return (
            f"solve.gravity_m_s2 = {list(solve['gravity_m_s2'])}: must be 0 to screen designs by "
            "their cells, which are not alike under gravity."
        )
    if solve["element"] not in ("auto", "hexahedron"):
        return (
            f"solve.element = {solve['element']!r}: must be auto or hexahedron to screen designs "
            "by their cells."
        )
    return None


def completed(given: Mapping[str, Any]) -> Config:
    """Return the configuration with the default for every key that ``given`` lacks."""
    config: Config = copy.deepcopy(defaults(schema("config")))
    for key, value in given.items():
        # 'designs' is one value as a whole: to name other tables is to leave out the paper's.
        merge = isinstance(value, Mapping) and key != "designs"
        config[key] = {**config[key], **value} if merge else value
    return config


def retyped(given: Mapping[str, Any]) -> Config:
    """Return a configuration with numbers for what is the text of one.

    Snakemake takes all values in ``--config 'mesh={"size_mm": 4}'`` for text. Keys that hold text
    by their schema keep it.
    """
    return dict(_retyped(given, schema("config")))


def _retyped(value: Any, by: Mapping[str, Any]) -> Any:
    if isinstance(value, Mapping):
        parts = by.get("properties", {})
        return {key: _retyped(entry, parts.get(key, {})) for key, entry in value.items()}
    if not isinstance(value, str) or "type" not in by or by["type"] == "string":
        return value
    try:
        return parse_yaml(value)
    except YAMLError:
        return value


def part(config: Mapping[str, Any], stage: str) -> Config:
    """Return the sections of a configuration that ``stage`` depends on."""
    return {section: config[section] for section in SECTIONS[stage]}


def part_as_json(config: Mapping[str, Any], stage: str) -> str:
    """Return :func:`part` as one line of JSON, to be handed to a stage as it is."""
    return json.dumps(part(config, stage), ensure_ascii=False)


def material_file(config: Mapping[str, Any]) -> Path:
    """Return the file of materials; pagd's own where the default one is not there."""
    return _found(config["material_file"], completed({})["material_file"])


def known_tables(config: Mapping[str, Any]) -> dict[str, str]:
    """Return the tables of known designs by origin; pagd's own where a default is not there."""
    default = completed({})["dataset"]["known"]
    known = config["dataset"]["known"]
    return {origin: str(_found(path, default.get(origin))) for origin, path in known.items()}


def packaged_tables() -> dict[str, str]:
    """Return the tables of known designs that come with pagd, by origin."""
    default = completed({})["dataset"]["known"]
    return {origin: str(_packaged(path)) for origin, path in default.items()}


def _found(path: str, default: str | None) -> Path:
    """Return the path, or pagd's own copy if it is the default one and there is no such file."""
    file = Path(path)
    if file.is_file() or path != default:
        return file
    return _packaged(path)


def _packaged(path: str) -> Path:
    return Path(str(importlib.resources.files("pagd") / "data" / Path(path).name))


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
