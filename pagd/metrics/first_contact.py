"""Pressure at which neighbouring chambers begin to push each other apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

__all__ = ["first_contact_pressure"]


def first_contact_pressure(
    pressure_kPa: FloatArray, smallest_gap_mm: FloatArray, width_mm: float
) -> float | None:
    """Return the pressure at which the gap passes the width of the contact law, in kPa.

    From there on contact pushes back, and the gap closes no further or slowly. The gap of the last
    two steps before is therefore extended in a straight line to the width, not beyond the first
    step that is pushed; the error is of second order in the steps. Where these two do not close,
    or there is one only, the straight line between the two steps around the width is taken.

    Parameters
    ----------
    pressure_kPa, smallest_gap_mm
        (k,) pressure and smallest gap between chambers of every converged step from the first
        on, in the order of the path; NaN where nothing is near enough to be measured.
    width_mm
        Gap from which on contact pushes.

    Returns
    -------
    float or None
        None if no step comes nearer than ``width_mm``; the first known pressure if that step is
        nearer already.
    """
    known = np.isfinite(smallest_gap_mm)
    pressure, left = pressure_kPa[known], smallest_gap_mm[known] - width_mm
    pushed = left < 0.0
    if not pushed.any():
        return None
    first = int(pushed.argmax())
    if first == 0:
        return float(pressure[0])
    around = slice(first - 1, first + 1)
    if first >= 2 and left[first - 2] > left[first - 1]:
        # Behind a limit point the pressure falls while the gap closes.
        low, high = np.sort(pressure[around])
        before = slice(first - 2, first)
        return float(np.clip(_zero(pressure[before], left[before]), low, high))
    return _zero(pressure[around], left[around])


def _zero(pressure: FloatArray, left: FloatArray) -> float:
    """Return where the straight line through two steps has nothing left."""
    return float(pressure[1] + left[1] * (pressure[1] - pressure[0]) / (left[0] - left[1]))
