"""What class of machine a result was made on: enough to tell why last digits or times differ."""

from __future__ import annotations

import functools
import os
import platform
import re
from pathlib import Path

import psutil

__all__ = ["Machine", "machine_class"]

#: As it stands in records: ``processor``, ``cores``, ``memory_GB`` (of 10⁹ bytes) and ``system``.
Machine = dict[str, str | int]


@functools.cache
def _machine() -> Machine:
    return {
        "processor": _processor(),
        "cores": os.cpu_count() or 1,
        "memory_GB": round(psutil.virtual_memory().total / 1e9),
        "system": f"{platform.system()} {platform.machine()}",
    }


def machine_class() -> Machine:
    """Describe this machine by its kind; nothing in it tells which one it is, or whose."""
    return dict(_machine())


def _processor() -> str:
    try:
        found = re.search(r"model name\s*: (.+)", Path("/proc/cpuinfo").read_text("utf-8"))
    except OSError:
        found = None
    return found[1] if found else platform.processor() or platform.machine()
