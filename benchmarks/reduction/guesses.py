"""Designs solved in full from first guesses and step by step: what it took, and how far apart."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from performance.page import table, wrapped

from pagd.record import Record, read_record

__all__ = ["BothWays", "both_ways", "text_of"]

FloatArray = NDArray[np.float64]

# Pressures (kPa) that agree to so many digits are one.
_DIGITS = 6


@dataclass(frozen=True, slots=True)
class BothWays:
    """The free actuation of a design from first guesses, and step by step.

    status: of the chain, of either. factorisations: of the full model. cpu_s: with the cells.
    pressure_kPa: the last recorded one that both reached. apart_mm: the largest distance there
    between the places of a node; moved_mm: how far the node that moves most has moved.
    commits: of either.
    """

    name: str
    mode: str
    status: tuple[str, str]
    factorisations: tuple[int, int]
    cpu_s: tuple[float, float]
    pressure_kPa: float
    apart_mm: float
    moved_mm: float
    commits: tuple[str, str]


def both_ways(guessed: Path, stepped: Path) -> list[BothWays]:
    """The designs that both folders hold solved, of one mesh."""
    found = []
    for folder in sorted(guessed.iterdir()):
        other = stepped / folder.name
        if all((one / "solve" / "states.parquet").is_file() for one in (folder, other)):
            pair = _pair(folder, other)
            found += [pair] if pair else []
    return found


def _pair(guessed: Path, stepped: Path) -> BothWays | None:
    records = [read_record(folder / "solve") for folder in (guessed, stepped)]
    if len({record.figures["mesh_sha256"] for record in records}) > 1:
        return None
    mode = read_record(guessed / "metrics").figures["mode"]
    first, second = (_states(folder) for folder in (guessed, stepped))
    last = max(set(first) & set(second))
    apart = np.linalg.norm(first[last] - second[last], axis=1)
    return BothWays(
        name=guessed.name,
        mode=str(mode),
        status=_two(_status(folder) for folder in (guessed, stepped)),
        factorisations=_two(int(record.figures["factorisations"]) for record in records),
        cpu_s=_two(_seconds(record) for record in records),
        pressure_kPa=last,
        apart_mm=float(apart.max()),
        moved_mm=float(np.linalg.norm(second[last], axis=1).max()),
        commits=_two(_commit(folder) for folder in (guessed, stepped)),
    )


def _two(values: Any) -> tuple[Any, Any]:
    first, second = values
    return first, second


def _status(folder: Path) -> str:
    return read_record(folder / "metrics").status.value


def _seconds(record: Record) -> float:
    return float(record.timings_s["solve_cpu"])


def _commit(folder: Path) -> str:
    return str(json.loads((folder / "run.json").read_text(encoding="utf-8")).get("commit"))


def _states(folder: Path) -> dict[float, FloatArray]:
    """Displacements (n, 3) of all nodes by recorded pressure."""
    states = pd.read_parquet(folder / "solve" / "states.parquet")
    states["pressure_kPa"] = states["pressure_kPa"].round(_DIGITS)
    return {
        float(pressure): group.sort_values("node")[["ux", "uy", "uz"]].to_numpy(float)
        for pressure, group in states.groupby("pressure_kPa")
    }


def text_of(pairs: Sequence[BothWays]) -> str:
    """The section: what is saved, how far apart the states are, and how the designs end."""
    from_, to = (sorted({pair.commits[k] for pair in pairs}) for k in (0, 1))
    alike = sum(pair.status[0] == pair.status[1] for pair in pairs)
    counts = Counter(pair.status for pair in pairs if pair.status[0] != pair.status[1])
    differ = "; ".join(f"{b} by steps and {a}: {n}" for (a, b), n in counts.items())
    parts = [
        wrapped(
            f"{len(pairs)} random designs, free actuation to the last pressure with recorded ones "
            f"on the way; from first guesses at commit {', '.join(from_)}, by steps at "
            f"{', '.join(to)}. Factorisations are those of the full model, core-seconds those "
            "of the cells and pieces too. Ratios: by steps to from first guesses, 10th percentile, "
            "median and 90th."
        ),
        _savings(pairs),
        wrapped(
            f"{alike} of {len(pairs)} designs end alike{f' ({differ})' if differ else ''}. The "
            "nodes' largest distance between both states at the last recorded pressure that both "
            f"reached is {_three([p.apart_mm for p in pairs], '.2g')} mm, and by the largest "
            f"displacement {_three([100 * p.apart_mm / p.moved_mm for p in pairs], '.2g')} % "
            "(median, 90th percentile and largest)."
        ),
    ]
    return "\n\n".join(parts)


def _savings(pairs: Sequence[BothWays]) -> str:
    groups = {"all": list(pairs)}
    for pair in pairs:
        groups.setdefault(pair.mode, []).append(pair)
    rows = []
    for name, some in groups.items():
        counts = np.array([pair.factorisations for pair in some], dtype=float)
        seconds = np.array([pair.cpu_s for pair in some])
        rows.append(
            [
                name,
                str(len(some)),
                f"{np.median(counts[:, 1]):.0f}",
                f"{np.median(counts[:, 0]):.0f}",
                _spread(counts[:, 1] / counts[:, 0]),
                f"{np.median(seconds[:, 1]):.1f}",
                f"{np.median(seconds[:, 0]):.1f}",
                _spread(seconds[:, 1] / seconds[:, 0]),
            ]
        )
    return table(
        [
            "",
            "designs",
            "factorisations, by steps",
            "from guesses",
            "ratio",
            "core-s, by steps",
            "from guesses",
            "ratio",
        ],
        rows,
    )


def _spread(values: FloatArray) -> str:
    return " / ".join(f"{v:.1f}" for v in np.percentile(values, [10, 50, 90]))


def _three(values: Sequence[float], form: str) -> str:
    known = np.array(values)
    three = np.median(known), np.percentile(known, 90), known.max()
    return ", ".join(format(float(v), form) for v in three)
