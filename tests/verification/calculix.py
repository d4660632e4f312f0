"""Runs CalculiX on the decks of :mod:`pagd.deck`, where the program is there."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from solving import FloatArray

from pagd.deck import write_deck
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import Mesh

PROGRAM = "ccx"

#: Criteria of convergence: residual force and correction, relative; many iterations allowed.
#: CalculiX takes forces under 1e-6 for zero, therefore forces in µN.
TIGHT: dict[str, Any] = {
    "stress_unit": "Pa",
    "controls": (
        "*CONTROLS, PARAMETERS=FIELD",
        "1e-6, 1e-3, , , 1e-6, 1e-10, 1e-10, 1e-20",
        "*CONTROLS, PARAMETERS=TIME INCREMENTATION",
        "200, 200, 200, 200, 200, 4, , 5",
        "0.25, 0.5, 0.75, 0.85, , , 1.5",
    ),
}


class CalculixError(RuntimeError):
    """CalculiX failed or ran out of time; the message ends with the tail of what it printed."""


def is_there() -> bool:
    return shutil.which(PROGRAM) is not None


@lru_cache
def version() -> str:
    """Such as ``CalculiX 2.20``."""
    told = subprocess.run([PROGRAM, "-v"], capture_output=True, text=True).stdout
    found = re.search(r"Version (\S+)", told)
    return f"CalculiX {found[1] if found else '(version unknown)'}"


def displacements(
    mesh: Mesh,
    material: Elastomer,
    paper: Sheet | None,
    pressures_kPa: Sequence[float],
    *,
    threads: int = 1,
    time_limit_s: float = 1500.0,
    **deck: Any,
) -> list[FloatArray]:
    """Displacements (n, 3) in mm of the nodes at each pressure; ``deck`` as for write_deck.

    Raises CalculixError where the program fails, or needs longer than the limit.
    """
    with tempfile.TemporaryDirectory() as folder:
        write_deck(Path(folder, "job.inp"), mesh, material, paper, pressures_kPa, **deck)
        told = _run(Path(folder), threads, time_limit_s)
        printed = Path(folder, "job.dat")
        lines = printed.read_text().splitlines() if printed.exists() else []
    found = [_moved(block, len(mesh.points)) for block in _blocks(lines)]
    if len(found) != len(pressures_kPa):
        raise CalculixError(f"{len(found)} of {len(pressures_kPa)} steps were solved.\n{told}")
    return found


def _run(folder: Path, threads: int, time_limit_s: float) -> str:
    """Run the job and return the last lines it printed."""
    log = folder / "job.log"
    try:
        with log.open("w") as stream:
            subprocess.run(
                [PROGRAM, "-i", "job"],
                cwd=folder,
                stdout=stream,
                stderr=subprocess.STDOUT,
                timeout=time_limit_s,
                env=os.environ | {"OMP_NUM_THREADS": str(threads)},
            )
    except subprocess.TimeoutExpired:
        raise CalculixError(f"More than {time_limit_s:g} s.\n{_tail(log)}") from None
    return _tail(log)


def _tail(log: Path) -> str:
    return "\n".join(log.read_text(errors="replace").splitlines()[-25:])


def _blocks(lines: Iterable[str]) -> list[list[str]]:
    """Lines of the tables of displacements, one table a step."""
    blocks: list[list[str]] = []
    for line in lines:
        if "displacements" in line:
            blocks.append([])
        elif line.strip():
            blocks[-1].append(line)
    return blocks


def _moved(block: Sequence[str], nodes: int) -> FloatArray:
    table = np.array([line.split() for line in block], np.float64)
    result = np.full((nodes, 3), np.nan)
    result[table[:, 0].astype(np.int64) - 1] = table[:, 1:]
    return result
