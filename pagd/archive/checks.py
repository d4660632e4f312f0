"""What a reviewer of the data set would look at first, each a count of rows that break a rule."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd

from pagd.archive.splits import SPLITS, split_of
from pagd.archive.tables import TABLES
from pagd.dataset import designs_of
from pagd.design import identity

__all__ = ["CHECKS", "Check", "Finding", "check_tables"]

Frames = Mapping[str, pd.DataFrame]

#: Columns of an analysis that every design has that ended well.
_ALWAYS: Final = (
    "pressure_kPa", "bending_deg", "twist_deg", "tip_x_mm", "tip_y_mm", "tip_z_mm", "work_mJ",
    "strain_p99", "measured_mode",
)  # fmt: skip
# Of the stored energy, what the work of the pressure may differ from it by. Chambers alone are
# solved with fewer steps, between which the work is interpolated.
_BALANCE: Final = {"full": 0.02, "pieces": 0.05, "cells": 0.05}
# Rounding of sums that are of the same numbers in another order.
_RELATIVE: Final = 1e-9
_MICROMETRE: Final = 1e-3


@dataclass(frozen=True, slots=True)
class Check:
    """A rule, and what tells the rows that break it.

    ``broken``: of the tables by name, one true or false a row that was looked at.
    """

    rule: str
    broken: Callable[[Frames], pd.Series[bool]]


@dataclass(frozen=True, slots=True)
class Finding:
    """How many rows a check has looked at, how many break the rule, and the first of them."""

    rule: str
    rows: int
    broken: int
    first: str | None


def check_tables(frames: Frames) -> list[Finding]:
    """Return what every check finds.

    Parameters
    ----------
    frames
        The tables of the data set by name, all splits together, with a column ``split``.
    """
    return [_finding(check, frames) for check in CHECKS]


def _finding(check: Check, frames: Frames) -> Finding:
    broken = check.broken(frames)
    first = str(broken.index[broken.to_numpy()][0]) if broken.any() else None
    return Finding(check.rule, len(broken), int(broken.sum()), first)


def _by_id(frame: pd.DataFrame, values: Any) -> pd.Series[bool]:
    return pd.Series(np.asarray(values, dtype=bool), index=frame["id"])


def _ids_of_parameters(frames: Frames) -> pd.Series[bool]:
    designs = frames["designs"]
    return _by_id(designs, [identity(d) for d in designs_of(designs)] != designs["id"])


def _twice(frames: Frames) -> pd.Series[bool]:
    designs = frames["designs"]
    return _by_id(designs, designs["id"].duplicated())


def _analysed_twice(frames: Frames) -> pd.Series[bool]:
    table = frames["performance"]
    return _by_id(table, table.duplicated(["id", "fidelity"]))


def _unknown(frames: Frames) -> pd.Series[bool]:
    known = set(frames["designs"]["id"])
    parts = [_by_id(f, ~f["id"].isin(known)) for name, f in frames.items() if name != "designs"]
    return pd.concat(parts)


def _wrong_split(frames: Frames) -> pd.Series[bool]:
    parts = [_by_id(f, f["id"].map(split_of) != f["split"]) for f in frames.values()]
    return pd.concat(parts)


def _training_without(frames: Frames) -> pd.Series[bool]:
    designs = frames["designs"]
    training = designs[designs["set"] == "training"]
    reduced = frames["performance"].query("fidelity != 'full'")["id"]
    return _by_id(training, ~training["id"].isin(set(reduced)))


def _nulls(frames: Frames) -> pd.Series[bool]:
    table = frames["performance"].query("status == 'ok'")
    numbers = table[list(_ALWAYS)]
    finite = numbers.select_dtypes("number").apply(np.isfinite).all(axis=1)
    return _by_id(table, numbers.isna().any(axis=1) | ~finite)


def _without_reason(frames: Frames) -> pd.Series[bool]:
    table = frames["performance"]
    return _by_id(table, (table["status"] == "ok") != table["reason"].isna())


def _falling(column: str) -> Callable[[Frames], pd.Series[bool]]:
    def broken(frames: Frames) -> pd.Series[bool]:
        table = frames["by_pressure"]
        steps = table.groupby(["id", "fidelity"], sort=False)
        # Behind a limit point the pressure falls, and with it what it has worked may.
        rising = steps["pressure_kPa"].diff() > 0
        fallen = steps[column].diff() < -_RELATIVE * table[column].abs()
        looked = table[rising]
        return _by_id(looked, fallen[rising])

    return broken


def _unbalanced(frames: Frames) -> pd.Series[bool]:
    table = frames["performance"].query("status == 'ok'")
    limit = table["fidelity"].map(_BALANCE)
    return _by_id(table, ~(table["energy_balance"] <= limit))


def _tips_apart(frames: Frames) -> pd.Series[bool]:
    """Whether the last section of the last state is where the tip is told to be."""
    keys = ["id", "fidelity"]
    last = frames["trajectories"].groupby(keys, sort=False).tail(1).set_index(keys)
    table = frames["performance"].query("status == 'ok'").set_index(keys)
    joined = table.join(last[["x_mm", "y_mm", "z_mm"]])
    apart = np.max([abs(joined[f"tip_{axis}_mm"] - joined[f"{axis}_mm"]) for axis in "xyz"], axis=0)
    return pd.Series(~(apart <= _MICROMETRE), index=joined.index.get_level_values(0))


def _chambers_apart(frames: Frames) -> pd.Series[bool]:
    """Whether the chambers' bending adds up to that of the tip, at every pressure."""
    keys = ["id", "fidelity", "pressure_kPa"]
    sums = frames["chambers"].groupby(keys, sort=False)["bending_deg"].sum()
    tips = frames["by_pressure"].drop_duplicates(keys).set_index(keys)["bending_deg"]
    both = pd.concat([sums.rename("sum"), tips], axis=1, join="inner")
    apart = (both["sum"] - both["bending_deg"]).abs() > 1e-6 + 1e-6 * both["bending_deg"].abs()
    return pd.Series(apart.to_numpy(), index=both.index.get_level_values(0))


def _pressures(frames: Frames) -> pd.Series[bool]:
    table = frames["by_pressure"]
    return _by_id(table, ~((table["pressure_kPa"] >= 0) & np.isfinite(table["pressure_kPa"])))


def _units(frames: Frames) -> pd.Series[bool]:
    """Whether every column has the unit that the data dictionary gives it."""
    broken = {
        f"{name}.{column.name}": frames[name].attrs.get("units", {}).get(column.name) != column.unit
        for name, table in TABLES.items()
        for column in table.columns
    }
    return pd.Series(broken, dtype=bool)


CHECKS: Final = (
    Check("ids are the hash of the parameters", _ids_of_parameters),
    Check("every design is there once", _twice),
    Check("every analysis is there once", _analysed_twice),
    Check("every row is of a design of the data set", _unknown),
    Check(f"rows are in the split of their id ({', '.join(SPLITS)})", _wrong_split),
    Check("every training design has its result by a chamber", _training_without),
    Check("where the status is ok, no figure is missing", _nulls),
    Check("there is a reason where the status is not ok, and only there", _without_reason),
    Check("pressures are finite and not negative", _pressures),
    Check("the cavity grows as the pressure rises", _falling("cavity_volume_mm3")),
    Check("the work of the pressure grows as it rises", _falling("work_mJ")),
    Check("where the status is ok, work and stored energy balance", _unbalanced),
    Check("the last section of a trajectory is the tip", _tips_apart),
    Check("the bending of the chambers adds up to that of the tip", _chambers_apart),
    Check("every column has its unit", _units),
)
