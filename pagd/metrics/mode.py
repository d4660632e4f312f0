"""Mode of an actuator as measured: bending, twisting or mixed, from its joints."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
MeasuredMode = Literal["bending", "twisting", "mixed", "none"]

__all__ = ["MeasuredMode", "Thresholds", "is_still", "measured_mode"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Thresholds:
    """What counts as moving and as twisting.

    still_deg: an actuator that bends and twists less than this does not actuate.
    joint_deg: a joint that turns less than this is left out of the mode.
    twist_share: a joint twists if its |τ| is at least this share of its whole rotation |ω|.
    mixed_share: the mode is mixed if at least this share of the joints twists, and at least this
        share does not.
    """

    still_deg: float = 5.0
    joint_deg: float = 0.2
    twist_share: float = 0.15
    mixed_share: float = 0.2


def measured_mode(
    bending_deg: FloatArray, twist_deg: FloatArray, thresholds: Thresholds = Thresholds()
) -> MeasuredMode:
    """Tell the mode of one state from the joints' own rotation.

    Every joint that moves either twists or does not. All twist: "twisting"; none: "bending";
    some of each: "mixed", the row has joints of both kinds. Slanted chambers bend AND twist:
    that alone is not mixed. Where every joint turns too little to be told, the tip twists or not.

    Parameters
    ----------
    bending_deg, twist_deg
        (s,) angles of the sections from the fixed end to the tip.
    thresholds
        What counts as moving, twisting and mixed.
    """
    if is_still(float(bending_deg[-1]), float(twist_deg[-1]), thresholds):
        return "none"
    share = _twisting_share(np.diff(bending_deg), np.diff(twist_deg), thresholds)
    if share is None:
        # Many joints, each of which hardly turns: the tip is taken as a single one.
        tip = replace(thresholds, joint_deg=0.0)
        share = _twisting_share(bending_deg[-1:], twist_deg[-1:], tip)
    if share is None:
        return "none"
    if share < thresholds.mixed_share:
        return "bending"
    return "twisting" if share > 1.0 - thresholds.mixed_share else "mixed"


def _twisting_share(
    bending_deg: FloatArray, twist_deg: FloatArray, thresholds: Thresholds
) -> float | None:
    """Share of the joints that twist, of those that turn; None if none does."""
    twist, whole = np.abs(twist_deg), np.hypot(bending_deg, twist_deg)
    moving = (whole >= thresholds.joint_deg) & (whole > 0.0)
    if not moving.any():
        return None
    return float(np.mean(twist[moving] >= thresholds.twist_share * whole[moving]))


def is_still(bending_deg: float, twist_deg: float, thresholds: Thresholds = Thresholds()) -> bool:
    """Tell whether bending and twist of the tip are both below the threshold: no actuation."""
    return max(abs(bending_deg), abs(twist_deg)) < thresholds.still_deg
