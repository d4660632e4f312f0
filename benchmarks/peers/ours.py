"""Whole analyses by ``pagd solve``."""

from __future__ import annotations

import json
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np

from pagd import __version__
from pagd.errors import InputError
from pagd.mesh.msh import read_msh
from pagd.record import Record, read_record
from pagd.stages.mesh import identity, mesh_file
from pagd.stages.solve import STATES_NAME
from pagd.states import read_states
from peers.bodies import Body, tip_displacement
from peers.child import Ended, run_timed
from peers.kept import Keeper, source_digest
from peers.solved import Load, Solved

__all__ = ["solve"]

# Up to here all kernels have been called; it compiles them where that has not been done.
_WARM_UP_KPA = 1.0

_STEP = re.compile(rb"([\d.eE+-]+) kPa: iterations")


def solve(
    body: Body, mesh: Path, load: Load, keeper: Keeper, element: str | None = None, repeat: int = 0
) -> Solved:
    """Solve a body, free, without contact, as a child process.

    Parameters
    ----------
    body, mesh
        What is solved, and the folder of its mesh.
    load
        Pressure, threads, time limit.
    keeper
        Keeps the results.
    element
        As in the configuration, whose default it is unless given.
    repeat
        Number of the run among equal ones.
    """
    config = _config(load.maximum_kPa, element)
    made_of = {
        "program": "pagd",
        "source": source_digest(),
        "body": body.name,
        "mesh": identity(read_msh(mesh_file(mesh))),
        "config": config,
        "threads": load.threads,
        "repeat": repeat,
    }
    name = f"{body.name}-pagd{f'-{element}' if element else ''}-{load.maximum_kPa:g}kPa"

    def run() -> dict[str, Any]:
        folder = keeper.folder / "runs" / name
        _run(mesh, folder, _config(_WARM_UP_KPA, element), load)
        ended = _run(mesh, folder, config, load)
        return _read(mesh, folder, ended).as_dict()

    return Solved.of(keeper.result(f"{name}-{repeat + 1}", made_of, run, load.is_answered_by))


def _config(maximum_kPa: float, element: str | None) -> dict[str, Any]:
    settings = {"contact": False, "blocked_force": "none", "maximum_pressure_kPa": maximum_kPa}
    return {"solve": settings | ({"element": element} if element else {})}


def _run(mesh: Path, folder: Path, config: dict[str, Any], load: Load) -> Ended:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    command = [sys.executable, "-m", "pagd", "solve", "--mesh", str(mesh.resolve())]
    command += ["--out", "solve", "--threads", str(load.threads), "--config", json.dumps(config)]
    return run_timed(command, folder, load.threads, load.time_limit_s, lambda: _reached(folder))


def _reached(folder: Path) -> float:
    """The highest pressure that the log tells of."""
    found = _STEP.findall((folder / "output.txt").read_bytes())
    return max(map(float, found), default=0.0)


def _read(mesh: Path, folder: Path, ended: Ended) -> Solved:
    solid = read_msh(mesh_file(mesh))
    common: dict[str, Any] = {
        "program": f"pagd {__version__}",
        "wall_s": ended.wall_s,
        "cpu_s": ended.cpu_s,
        "tets": len(solid.tets),
        "progress": ended.progress,
    }
    if ended.code is None:
        return Solved(
            status="time_limit",
            reason=f"It took more than {ended.wall_s:.0f} s.",
            pressure_kPa=_reached(folder),
            iterations=0,
            unknowns=3 * len(solid.points),
            tips=[],
            **common,
        )
    record = _record(folder)
    states = read_states(folder / "solve" / STATES_NAME)
    pairs = zip(states.pressure_kPa.tolist(), states.displacement, strict=True)
    return Solved(
        status=record.status.value,
        reason=record.reason,
        pressure_kPa=record.figures["pressure_kPa"],
        iterations=record.figures["newton_iterations"],
        unknowns=record.figures["unknowns"],
        tips=[(p, np.round(tip_displacement(solid, u), 6).tolist()) for p, u in pairs if p],
        **common,
    )


def _record(folder: Path) -> Record:
    try:
        return read_record(folder / "solve")
    except InputError:
        said = (folder / "output.txt").read_text(encoding="utf-8", errors="replace").strip()
        last = said.splitlines()[-1] if said else "it said nothing"
        raise InputError(f"{folder}: pagd solve left no record ({last}).") from None
