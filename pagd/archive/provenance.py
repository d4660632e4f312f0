"""What made the analyses of a data set, each told once and named by a hash."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from pagd.record import Record, configuration_hash, read_record

__all__ = ["PROVENANCE", "Provenance", "key_of", "of_screening", "of_simulation"]

#: ``configuration`` by stage, its SHA-256, ``versions`` by stage, each that was at work, and
#: ``machines``. Of a screening, whose jobs may be spread over several, all are told.
Provenance = dict[str, Any]

#: File of what made the analyses, by the keys that the table ``performance`` has.
PROVENANCE: Final = "provenance.json"
_STAGES: Final = ("geometry", "repair", "mesh", "solve", "metrics")
# Digits of a hash that tell a few origins from each other.
_DIGITS: Final = 16


def key_of(provenance: Provenance) -> str:
    """Return the name of an origin: the first 16 hexadecimal digits of its SHA-256."""
    return configuration_hash(provenance)[:_DIGITS]


def of_screening(folder: Path) -> Provenance:
    """Return what made the results of a screening.

    Raises
    ------
    InputError
        If the folder has no record.
    """
    record = read_record(folder)
    made_by = record.figures.get("made_by") or [_made_by(record)]
    configuration = {"screening": record.configuration}
    return {
        "configuration": configuration,
        "configuration_sha256": configuration_hash(configuration),
        "versions": {"screening": _distinct(one["versions"] for one in made_by)},
        "machines": _distinct(one["machine"] for one in made_by),
    }


def of_simulation(folder: Path) -> Provenance:
    """Return what made the results of a design, from the records of its stages.

    Raises
    ------
    InputError
        If a stage has no record.
    """
    records = {stage: read_record(folder / stage) for stage in _STAGES}
    # What is drawn is not what it is drawn by.
    configuration = {
        stage: {key: value for key, value in record.configuration.items() if key != "design"}
        for stage, record in records.items()
    }
    return {
        "configuration": configuration,
        "configuration_sha256": configuration_hash(configuration),
        "versions": {stage: [record.versions] for stage, record in records.items()},
        "machines": _distinct(record.machine for record in records.values()),
    }


def _made_by(record: Record) -> dict[str, Any]:
    return {"versions": record.versions, "machine": record.machine}


def _distinct(found: Any) -> list[Mapping[str, Any]]:
    """Each of what was found once, without those of which nothing is known."""
    return list({configuration_hash(one): one for one in found if one}.values())
