"""Bending and twist of every chamber by itself.

The stations of a design are its fixed end, the middle of every gap and its tip
(:func:`pagd.sections.stations_of`), so that joint i is chamber i with half of the gap on either
side of it. The joint's bending and twist are that chamber's; all chambers add up to the tip.
A section is a strip straight across, and the walls of helical chambers run aslant: the corners of
such a chamber lie in the neighbouring joints, and what they do is shared with the neighbours.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pagd.design import Design
from pagd.metrics.trajectory import Trajectory

Kind = Literal["helical", "straight"]

__all__ = ["Kind", "chamber_columns", "kinds_of"]


def kinds_of(design: Design) -> list[Kind]:
    """Return the kind of each chamber, from the fixed end; without a slant all are straight."""
    return ["helical" if skew != 0.0 else "straight" for skew in design.chamber_skews()]


def chamber_columns(
    trajectory: Trajectory, kinds: Sequence[Kind | None] | None = None
) -> dict[str, NDArray[np.generic]]:
    """Return the table of all chambers: one row a pressure and chamber, chambers fastest.

    Parameters
    ----------
    trajectory
        Measured at the stations of the chambers, N + 1 for N chambers.
    kinds
        (N,) kind of each chamber; None where the stations are those of no design.
    """
    pressures, chambers = trajectory.joints.shape[:2]
    known = np.array([None] * chambers if kinds is None else list(kinds), dtype=object)
    twist, bending = np.degrees(trajectory.joints[:, :, :2]).reshape(-1, 2).T
    return {
        "pressure_kPa": np.repeat(trajectory.pressure_kPa, chambers),
        "chamber": np.tile(np.arange(1, chambers + 1, dtype=np.int32), pressures),
        "kind": np.tile(known, pressures),
        "bending_deg": bending,
        "twist_deg": twist,
    }
