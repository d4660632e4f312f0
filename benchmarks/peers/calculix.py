"""Whole analyses by CalculiX, on the decks of :mod:`pagd.deck`."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd import config as configuration
from pagd.deck import write_deck
from pagd.errors import InputError
from pagd.mesh.msh import read_msh
from pagd.mesh.types import Mesh
from pagd.stages.mesh import mesh_file
from pagd.stages.solve import materials_of
from peers.bodies import Body, tip_displacement
from peers.child import Ended, run_timed
from peers.kept import Keeper, digest
from peers.solved import Load, Solved

__all__ = ["iterations_of", "pressure_of", "solve", "version"]

FloatArray = NDArray[np.float64]

_PROGRAM = "ccx"

# The first increment; the following ones are CalculiX' own choice.
_FIRST_KPA = 1.25


@lru_cache
def version() -> str:
    """Return the program's name and version; ``InputError`` if it is not installed."""
    if shutil.which(_PROGRAM) is None:
        raise InputError(
            f"{_PROGRAM} is not installed; setup/system.sh ../benchmarks/peer-packages.txt "
            "installs CalculiX."
        )
    told = subprocess.run([_PROGRAM, "-v"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"Version (\S+)", told)
    return f"CalculiX {found[1] if found else '(version unknown)'}"


def solve(body: Body, mesh: Path, load: Load, keeper: Keeper) -> Solved:
    """Solve a body by C3D10 and S6, in one step to the last pressure; see ``ours.solve``."""
    solid = read_msh(mesh_file(mesh))
    name = f"{body.name}-calculix-{load.maximum_kPa:g}kPa"
    folder = keeper.folder / "runs" / name
    pressures = [load.maximum_kPa]
    shutil.rmtree(folder, ignore_errors=True)
    deck = folder / "job.inp"
    materials = materials_of(configuration.completed({}))
    first = min(1.0, _FIRST_KPA / load.maximum_kPa)
    write_deck(deck, solid, materials.elastomer, materials.paper, pressures, first_increment=first)
    made_of = {
        "program": version(),
        "deck": digest(deck.read_text(encoding="ascii")),
        "threads": load.threads,
    }

    def run() -> dict[str, Any]:
        command, watched = [_PROGRAM, "-i", "job"], folder / "job.sta"

        def reached() -> float:
            return pressure_of(_lines(watched), pressures)

        ended = run_timed(command, folder, load.threads, load.time_limit_s, reached)
        return _read(solid, folder, pressures, ended).as_dict()

    result = Solved.of(keeper.result(name, made_of, run, load.is_answered_by))
    # Results and factors of a fine mesh fill a disk.
    shutil.rmtree(folder)
    return result


def pressure_of(lines: Iterable[str], pressures_kPa: Sequence[float]) -> float:
    """Return the pressure (kPa) that the lines of a ``.sta`` file tell of: step by step, linear.

    Increments that did not converge are marked by a ``U`` behind the number of the attempt.
    """
    steps = [0.0, *pressures_kPa]
    rows = [line.split() for line in lines]
    times = [
        float(row[4])
        for row in rows
        if len(row) == 7 and row[0].isdigit() and not row[2].endswith("U")
    ]
    return float(np.interp(max(times, default=0.0), range(len(steps)), steps))


def iterations_of(lines: Iterable[str]) -> int:
    """Return the number of iterations that a ``.cvg`` file tells of, all attempts counted."""
    return sum(line.split()[0].isdigit() for line in lines if line.strip())


def _read(solid: Mesh, folder: Path, pressures: Sequence[float], ended: Ended) -> Solved:
    blocks = _blocks(_lines(folder / "job.dat"))
    tips = [
        (pressure, np.round(tip_displacement(solid, _moved(block, solid)), 6).tolist())
        for pressure, block in zip(pressures, blocks, strict=False)
    ]
    status, reason = "ok", None
    if ended.code is None:
        # What it was writing when it was ended is not to be read.
        tips = [pair for pair in tips if np.isfinite(pair[1]).all()]
        status, reason = "time_limit", f"It took more than {ended.wall_s:.0f} s."
    elif len(tips) < len(pressures):
        status, reason = "not_converged", _complaint(folder / "output.txt", ended.code)
    equations = re.findall(r"number of equations\s+(\d+)", "\n".join(_lines(folder / "output.txt")))
    return Solved(
        program=version(),
        status=status,
        reason=reason,
        pressure_kPa=pressure_of(_lines(folder / "job.sta"), pressures),
        wall_s=ended.wall_s,
        cpu_s=ended.cpu_s,
        iterations=iterations_of(_lines(folder / "job.cvg")),
        tets=len(solid.tets),
        unknowns=max(map(int, equations), default=0),
        tips=tips,
        progress=ended.progress,
    )


def _lines(path: Path) -> list[str]:
    """Lines of a file of the run; none before it is there."""
    if not path.is_file():
        return []
    return path.read_text(encoding="ascii", errors="replace").splitlines()


def _blocks(lines: Iterable[str]) -> list[list[str]]:
    """Lines of the tables of displacements, one table a step."""
    blocks: list[list[str]] = []
    for line in lines:
        if "displacements" in line:
            blocks.append([])
        elif line.strip() and blocks:
            blocks[-1].append(line)
    return blocks


def _moved(block: Sequence[str], solid: Mesh) -> FloatArray:
    """Displacements (n, 3); not a number where the table lacks a node."""
    rows = [row for row in map(str.split, block) if len(row) == 4]
    result = np.full(solid.points.shape, np.nan)
    for number, *values in rows:
        result[int(number) - 1] = [float(value) for value in values]
    return result


def _complaint(output: Path, code: int) -> str:
    said = [line.strip() for line in _lines(output) if "*ERROR" in line]
    return said[-1] if said else f"It ended with code {code}."
