"""Pareto fronts of generated and training designs: which of both kinds can do more.

A design is better than another if it bends more, twists more and pushes harder. What a set of
designs can do together is the volume that its designs dominate (hypervolume indicator, Zitzler and
Thiele 1998, https://doi.org/10.1007/BFb0056872), from a design that does nothing. The ratio of two
such volumes does not depend on the units.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from pagd.errors import InputError, Status

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

__all__ = ["OBJECTIVES", "compare", "not_dominated", "reached", "values_of"]

#: What a design is to be good at: column of the table of performance, and its words.
OBJECTIVES: Final[Mapping[str, str]] = {
    "bending_deg": "bending",
    "twist_deg": "twist",
    "blocked_force_N": "blocked force",
}

# What ended so is an equilibrium that the actuator comes to.
_REACHED: Final = (Status.ok.value, Status.bending_limit.value)
# The middle 95 %.
_INTERVAL: Final = (2.5, 97.5)


def compare(
    training: pd.DataFrame, generated: pd.DataFrame, seed: int, repeats: int = 1000
) -> dict[str, Any]:
    """Compare what training and generated designs can do, by all objectives and by each two.

    Parameters
    ----------
    training, generated
        Rows with the columns :data:`pagd.tables.PERFORMANCE` of one fidelity.
    seed
        Of the draws that give the intervals.
    repeats
        How many there are: as many designs of either kind as there are of the rarer one, drawn with
        replacement.

    Returns
    -------
    dict
        ``training`` and ``generated``, how many could be compared; ``comparisons``, each with
        ``objectives``, ``ratio`` (the volume of the generated designs by that of the training
        designs, median of the draws), ``low`` and ``high`` (the middle 95 %), ``likely`` (share of
        draws with a ratio above 1), ``front`` (the designs of both that none dominates, by kind and
        mode) and ``front_designs``.

    Raises
    ------
    InputError
        If either has no design to compare.
    """
    sets = {"training": reached(training), "generated": reached(generated)}
    for kind, frame in sets.items():
        if frame.empty:
            raise InputError(f"No {kind} design was analysed to its end: there is no front.")
    random = np.random.default_rng(seed)
    several = [
        names for size in range(len(OBJECTIVES), 1, -1) for names in combinations(OBJECTIVES, size)
    ]
    return {
        "training": len(sets["training"]),
        "generated": len(sets["generated"]),
        "comparisons": [_comparison(sets, names, random, repeats) for names in several],
    }


def values_of(frame: pd.DataFrame, names: Sequence[str]) -> FloatArray:
    """The sizes (n, m) of objectives, whatever their sign; no force counts as none."""
    values = frame[list(names)].apply(pd.to_numeric, errors="coerce").to_numpy(dtype=np.float64)
    return np.asarray(np.nan_to_num(np.abs(values)), dtype=np.float64)


def not_dominated(values: FloatArray) -> BoolArray:
    """Which rows (n,) of sizes (n, m) no other row is better than in all, equal ones once."""
    from moocore import is_nondominated

    return np.asarray(is_nondominated(values, maximise=True), dtype=np.bool_)


def reached(frame: pd.DataFrame) -> pd.DataFrame:
    """The rows of designs that ended in an equilibrium they come to: to be compared."""
    return frame[frame["status"].isin(_REACHED)].reset_index(drop=True)


def _comparison(
    sets: Mapping[str, pd.DataFrame],
    names: Sequence[str],
    random: np.random.Generator,
    repeats: int,
) -> dict[str, Any]:
    values = {kind: values_of(frame, names) for kind, frame in sets.items()}
    ratios = _ratios(values["generated"], values["training"], random, repeats)
    low, ratio, high = np.percentile(ratios, [_INTERVAL[0], 50.0, _INTERVAL[1]])
    both = pd.concat([frame.assign(kind=kind) for kind, frame in sets.items()])
    front = both[not_dominated(np.vstack([values[kind] for kind in sets]))]
    return {
        "objectives": list(names),
        "ratio": float(ratio),
        "low": float(low),
        "high": float(high),
        "likely": float(np.mean(ratios > 1.0)),
        "front": {
            kind: dict(Counter(front.loc[front["kind"] == kind, "mode"].astype(str)))
            for kind in sets
        },
        "front_designs": front["design_id"].astype(str).tolist(),
    }


def _ratios(
    generated: FloatArray, training: FloatArray, random: np.random.Generator, repeats: int
) -> FloatArray:
    """Ratios (r,) of the dominated volumes of equally many designs drawn with replacement."""
    count = min(len(generated), len(training))
    drawn = (
        [values[random.integers(len(values), size=count)] for values in (generated, training)]
        for _ in range(repeats)
    )
    return np.array([_volume(new) / max(_volume(old), np.finfo(float).tiny) for new, old in drawn])


def _volume(values: FloatArray) -> float:
    from moocore import hypervolume

    return float(hypervolume(values, ref=np.zeros(values.shape[1]), maximise=True))
