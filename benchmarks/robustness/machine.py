"""What the study ran on."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pagd.errors import InputError
from pagd.machine import machine_class
from pagd.record import read_record

__all__ = ["machine"]


def machine(folders: Iterable[Path], processes: int) -> dict[str, Any]:
    """Describe this machine, and the versions in the records of the designs' ``folders``."""
    return machine_class() | {"processes": processes, "versions": _versions(folders)}


def _versions(folders: Iterable[Path]) -> dict[str, str]:
    """Versions of what made the records, joined by a slash where there are several of one."""
    found: dict[str, set[str]] = {}
    for folder in folders:
        for stage in ("geometry", "repair", "mesh", "solve", "metrics"):
            for name, version in _versions_of(folder / stage).items():
                if version is not None:
                    label = f"stage {stage}" if name == "stage" else name
                    found.setdefault(label, set()).add(str(version))
    return {name: "/".join(sorted(versions)) for name, versions in sorted(found.items())}


def _versions_of(folder: Path) -> dict[str, Any]:
    try:
        return dict(read_record(folder).versions)
    except InputError:
        return {}
