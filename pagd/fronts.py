"""Pareto fronts of generated and training designs: which of both kinds can do more.

A design is better than another if it bends more, twists more and pushes harder. What a set of
designs can do together is the volume that its designs dominate (hypervolume indicator, Zitzler and
Thiele 1998, https://doi.org/10.1007/BFb0056872), from a design that does nothing. The ratio of two
such volumes does not depend on the units. Since a larger set reaches further by its size alone,
equally many designs of either kind are drawn, again and again; whether their ratio could be one of
chance tells a permutation test (Good, *Permutation, Parametric and Bootstrap Tests of Hypotheses*,
Springer 2005, chapter 3), whose draws are of both kinds mixed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.errors import Status

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

__all__ = ["OBJECTIVES", "compare", "known", "not_dominated", "reached", "values_of"]

#: What a design is to be good at: column of the table of performance, and its words.
OBJECTIVES: Final[Mapping[str, str]] = {
    "bending_deg": "bending",
    "twist_deg": "twist",
    "blocked_force_N": "blocked force",
}

# What a doubt of cells is about; their tips are near those of the full analysis anyway.
_DOUBTED: Final = ("blocked_force_N",)
# To either side is as good.
_EITHER_SIDE: Final = ("twist_deg",)
# What ended so is an equilibrium that the actuator comes to.
_REACHED: Final = (Status.ok.value, Status.bending_limit.value, Status.no_actuation.value)
# The middle 95 %.
_INTERVAL: Final = (2.5, 97.5)
# Designs of a draw, as a share of the rarer kind: draws from so many are nearly independent.
_SHARE: Final = 1 / 3
# Draws that the test statistic is the median of.
_DRAWS: Final = 25


def compare(
    training: pd.DataFrame, generated: pd.DataFrame, seed: int, repeats: int = 400
) -> dict[str, Any]:
    """Compare what training and generated designs can do, by all objectives and by each two.

    A design that does not come to its end counts as one that does nothing, unless that is doubted
    (:mod:`pagd.stages.gate`): then it is left out. So is one whose blocked force is not known, or
    doubted, where forces are compared: doubts are not as frequent in both kinds. An objective that
    no design of a kind has is left out.

    Parameters
    ----------
    training, generated
        Rows with the columns :data:`pagd.tables.PERFORMANCE` of one fidelity.
    seed
        Of all draws.
    repeats
        Number of draws, and of permutations.

    Returns
    -------
    dict
        ``training`` and ``generated``, how many there are; ``comparisons``, each with
        ``objectives``, ``compared`` (how many of either kind), ``drawn`` (how many of either a draw
        has), ``ratio`` (the volume of the generated designs by that of the training designs, median
        of the draws), ``low`` and ``high`` (the middle 95 % of the draws), ``p`` (of the
        permutation test, two-sided), ``share`` (mean share of generated designs in the front of a
        draw), ``front`` (all designs that none of all dominates, by kind and mode) and
        ``front_designs``. None are left where there are fewer than two objectives, too few designs,
        or a volume of nothing.
    """
    sets = {"training": training, "generated": generated}
    some = [name for name in OBJECTIVES if all(_has(frame, name) for frame in sets.values())]
    several = [names for size in range(len(some), 1, -1) for names in combinations(some, size)]
    found = [
        _comparison(sets, names, np.random.default_rng([seed, number]), repeats)
        for number, names in enumerate(several)
    ]
    return {
        **{kind: len(frame) for kind, frame in sets.items()},
        "comparisons": [each for each in found if each],
    }


def reached(frame: pd.DataFrame) -> pd.DataFrame:
    """The rows of designs that ended in an equilibrium they come to."""
    return frame[frame["status"].isin(_REACHED)].reset_index(drop=True)


def values_of(frame: pd.DataFrame, names: Sequence[str]) -> FloatArray:
    """What designs reach by objectives (n, m), at least 0; twist to either side.

    0 for what is not known or doubted, and of designs that did not come to their end.
    """
    values = _known(frame, names)
    either = np.isin(list(names), _EITHER_SIDE)
    sizes = np.where(either, np.abs(values), np.maximum(values, 0.0))
    ended = frame["status"].isin(_REACHED).to_numpy()
    return np.asarray(np.nan_to_num(sizes) * ended[:, None], dtype=np.float64)


def known(frame: pd.DataFrame, names: Sequence[str]) -> BoolArray:
    """Which rows (n,) have all of some objectives, none of them doubted."""
    return np.asarray(np.isfinite(_known(frame, names)).all(axis=1), dtype=np.bool_)


def _known(frame: pd.DataFrame, names: Sequence[str]) -> FloatArray:
    """The objectives (n, m) as they are in the table; not a number where unknown or doubted.

    What is doubtful of cells is their blocked force: it would be by its errors that a design is
    best (:mod:`pagd.stages.gate`).
    """
    numbers = frame[list(names)].apply(pd.to_numeric, errors="coerce")
    values = np.array(numbers, dtype=np.float64)
    values[np.ix_(_is_doubted(frame), np.isin(list(names), _DOUBTED))] = np.nan
    return values


def _is_doubted(frame: pd.DataFrame) -> BoolArray:
    """Which rows (n,) are of cells that the gate doubts."""
    if "doubt" not in frame:
        return np.zeros(len(frame), dtype=np.bool_)
    doubted = frame["doubt"].notna() & (frame["fidelity"] == "cells")
    return np.asarray(doubted, dtype=np.bool_)


def not_dominated(values: FloatArray) -> BoolArray:
    """Which rows (n,) of sizes (n, m) no other row is better than in all, equal ones once."""
    from moocore import is_nondominated

    return np.asarray(is_nondominated(values, maximise=True), dtype=np.bool_)


def _has(frame: pd.DataFrame, name: str) -> bool:
    return bool(pd.to_numeric(frame[name], errors="coerce").notna().any())


def _comparison(
    sets: Mapping[str, pd.DataFrame],
    names: Sequence[str],
    random: np.random.Generator,
    repeats: int,
) -> dict[str, Any] | None:
    sets = {kind: frame[_is_compared(frame, names)] for kind, frame in sets.items()}
    drawn = int(min(map(len, sets.values())) * _SHARE)
    if not drawn:
        return None
    old, new = (values_of(sets[kind], names) for kind in ("training", "generated"))
    logs = np.array([_log_ratio(*_draw(old, new, drawn, random)) for _ in range(repeats)])
    if not np.isfinite(logs).all():
        return None
    low, ratio, high = np.exp(np.percentile(logs, [_INTERVAL[0], 50.0, _INTERVAL[1]]))
    both = pd.concat([frame.assign(kind=kind) for kind, frame in sets.items()])
    front = both[not_dominated(np.vstack([old, new]))]
    return {
        "objectives": list(names),
        "compared": {kind: len(frame) for kind, frame in sets.items()},
        "drawn": drawn,
        "ratio": float(ratio),
        "low": float(low),
        "high": float(high),
        "p": _chance(old, new, float(np.median(logs)), drawn, random, repeats),
        "share": float(np.mean([_share(*_draw(old, new, drawn, random)) for _ in range(repeats)])),
        "front": {
            kind: dict(Counter(front.loc[front["kind"] == kind, "mode"].astype(str)))
            for kind in sets
        },
        "front_designs": front["design_id"].astype(str).tolist(),
    }


def _is_compared(frame: pd.DataFrame, names: Sequence[str]) -> BoolArray:
    """Which rows (n,) have all objectives, or do nothing since they fail, and no doubt of that."""
    ended = frame["status"].isin(_REACHED).to_numpy()
    return np.where(ended, known(frame, names), ~_is_doubted(frame))


def _draw(
    old: FloatArray, new: FloatArray, count: int, random: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """So many rows of either, none twice."""
    rows = [random.choice(len(values), size=count, replace=False) for values in (old, new)]
    return old[rows[0]], new[rows[1]]


def _chance(
    old: FloatArray,
    new: FloatArray,
    found: float,
    drawn: int,
    random: np.random.Generator,
    repeats: int,
) -> float:
    """How often labels given at random lead as far from no difference as ``found``."""
    pool = np.vstack([old, new])
    farther = 0
    for _ in range(repeats):
        mixed = pool[random.permutation(len(pool))]
        parts = mixed[: len(old)], mixed[len(old) :]
        logs = [_log_ratio(*_draw(*parts, drawn, random)) for _ in range(_DRAWS)]
        farther += not abs(float(np.median(logs))) < abs(found)
    return (1 + farther) / (1 + repeats)


def _log_ratio(old: FloatArray, new: FloatArray) -> float:
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.log(_volume(new)) - np.log(_volume(old)))


def _volume(values: FloatArray) -> float:
    from moocore import hypervolume

    return float(hypervolume(values, ref=np.zeros(values.shape[1]), maximise=True))


def _share(old: FloatArray, new: FloatArray) -> float:
    """The share of the new designs in the front of both."""
    front = not_dominated(np.vstack([old, new]))
    return float(front[len(old) :].sum() / front.sum())
