"""What the study ran on."""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import psutil

from pagd.errors import InputError
from pagd.record import read_record

__all__ = ["machine"]


def machine(folders: Iterable[Path], processes: int) -> dict[str, Any]:
    """Describe this machine, and the versions in the records of the designs' ``folders``."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "memory_GB": psutil.virtual_memory().total / 1e9,
        "system": f"{platform.system()} {platform.machine()}",
        "processes": processes,
        "versions": _versions(folders),
    }


def _processor() -> str:
    try:
        found = re.search(r"model name\s*: (.+)", Path("/proc/cpuinfo").read_text("utf-8"))
    except OSError:
        found = None
    return found[1] if found else platform.processor() or platform.machine()


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
