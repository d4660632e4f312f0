"""Designs solved in full and by their parts, state by state."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from pagd.actuation import use_threads
from pagd.catalogue import NamedDesign
from pagd.record import read_record
from pagd.stages.gate import doubt_of
from pagd.stages.reduced import CELLS, PIECES, analyse
from pagd.stages.solve import Materials

__all__ = ["Pair", "compared", "full_of"]

_TIP = ("tip_x_mm", "tip_y_mm", "tip_z_mm")
# Pressures (kPa) that agree to so many digits are one.
_DIGITS = 6
# A chamber that turns by less has no share to speak of.
_TURNS_DEG = 0.05
#: The first pressure at which errors by a displacement mean something.
_FIRST_KPA = 5.0


@dataclass(frozen=True, eq=False, slots=True)
class Pair:
    """A design in full and reduced.

    rows: one row a recorded pressure that both reached: pressure_kPa, tip_error (by the full tip's
    displacement), bending_deg, twist_deg and blocked_force_N of either. status: of either. doubt:
    why the reduced result is not trusted, if it is not.
    ends: how much further the row turns in full than reduced, from the clamp to the first section
    and from the last one to the tip, by what a chamber in the middle turns; bending, last state.
    cpu_s: of the reduced analysis, and of all stages of the full one.
    """

    name: str
    mode: str
    chambers: int
    fidelity: str
    rows: pd.DataFrame
    status: str
    status_full: str
    first_contact_kPa: float | None
    doubt: str | None
    ends: tuple[float, float]
    cpu_s: float
    cpu_full_s: float


def full_of(folder: Path) -> dict[str, Any] | None:
    """What the full analysis of a design has left in its folder; None if it did not come so far."""
    metrics = folder / "metrics" / "performance.parquet"
    if not metrics.is_file():
        return None
    record = read_record(folder / "metrics")
    return {
        "table": pd.read_parquet(metrics),
        "trajectory": pd.read_parquet(folder / "metrics" / "trajectory.parquet"),
        "status": record.status.value,
        "cpu_s": float(record.figures["cpu_s"]) + record.timings_s["cpu"],
    }


def compared(
    designs: list[NamedDesign],
    folders: Mapping[str, Path],
    config: Mapping[str, Any],
    materials: Materials,
    processes: int,
) -> list[Pair]:
    """Analyse each design by its cells, and by its cells and pieces, beside the full result."""
    known = [(named, full_of(folders[named.name])) for named in designs]
    tasks = [
        (named, full, config, materials, fidelity)
        for named, full in known
        if full is not None
        for fidelity in (CELLS, PIECES)
    ]
    found: list[Pair] = []
    with ProcessPoolExecutor(
        processes, get_context("spawn"), initializer=use_threads, initargs=(1,)
    ) as pool:
        for number, pair in enumerate(pool.map(_pair, tasks), 1):
            found.append(pair)
            print(
                f"{number:4d}/{len(tasks)} {pair.name} {pair.fidelity:<6} {pair.status:<13} "
                f"{pair.cpu_s:5.1f} s, tip {_last(pair):.2%}",
                flush=True,
            )
    return found


def _last(pair: Pair) -> float:
    return float(pair.rows["tip_error"].iloc[-1]) if len(pair.rows) else np.nan


def _pair(task: tuple[NamedDesign, dict[str, Any], Any, Materials, str]) -> Pair:
    named, full, config, materials, fidelity = task
    reduced = analyse(named, config, materials, pieces=fidelity == PIECES)
    row = reduced.row
    return Pair(
        name=named.name,
        mode=named.design.mode,
        chambers=named.design.N,
        fidelity=fidelity,
        rows=_joined(pd.DataFrame(reduced.by_pressure), full["table"]),
        status=str(row["status"]),
        status_full=full["status"],
        first_contact_kPa=row.get("first_contact_pressure_kPa"),
        doubt=doubt_of(row, named.design),
        ends=_ends(pd.DataFrame(reduced.trajectory), full["trajectory"]),
        cpu_s=float(row["cpu_s"]),
        cpu_full_s=float(full["cpu_s"]),
    )


def _joined(reduced: pd.DataFrame, full: pd.DataFrame) -> pd.DataFrame:
    names = ["pressure_kPa", *_TIP, "bending_deg", "twist_deg", "blocked_force_N"]
    if not len(reduced):
        return pd.DataFrame(columns=["pressure_kPa", "tip_error"])
    sides = []
    for table in (reduced, full):
        side = table.reindex(columns=names).copy()
        side["pressure_kPa"] = side["pressure_kPa"].round(_DIGITS)
        sides.append(side.drop_duplicates("pressure_kPa"))
    both = sides[0].merge(sides[1], on="pressure_kPa", suffixes=("", "_full"))
    start = full[list(_TIP)].iloc[0].to_numpy(float)
    here = both[list(_TIP)].to_numpy(float)
    there = both[[f"{name}_full" for name in _TIP]].to_numpy(float)
    travel = np.linalg.norm(there - start, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        both["tip_error"] = np.linalg.norm(here - there, axis=1) / travel
    return both[both["pressure_kPa"] >= _FIRST_KPA].reset_index(drop=True)


def _ends(reduced: pd.DataFrame, full: pd.DataFrame) -> tuple[float, float]:
    if not len(reduced):
        return np.nan, np.nan
    tables = [side.assign(p=side["pressure_kPa"].round(_DIGITS)) for side in (reduced, full)]
    last = max(set(tables[0]["p"]) & set(tables[1]["p"]))
    mine, theirs = (
        side[side["p"] == last].sort_values("station")["bending_deg"].diff().dropna().to_numpy()
        for side in tables
    )
    middle = float(np.median(mine[1:-1]))
    if not abs(middle) > _TURNS_DEG:
        return np.nan, np.nan
    return float(theirs[0] - mine[0]) / middle, float(theirs[-1] - mine[-1]) / middle
