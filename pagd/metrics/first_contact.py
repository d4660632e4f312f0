"""Pressure at which neighbouring chambers begin to touch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

__all__ = ["first_contact_pressure"]


def first_contact_pressure(
    pressure_kPa: FloatArray, smallest_gap_mm: FloatArray, width_mm: float
) -> float | None:
    """Return the pressure at which the gap would close if nothing pushed back, in kPa.

    Contact pushes from ``width_mm`` on, and then keeps the gap near zero instead of letting it
    close. The gap of the last two steps before that is therefore extended in a straight line to
    zero. Two bounds keep the answer between the steps: not before the last step that nothing
    pushed, and not after the first pushed step, or, where that one still has a gap, after the
    zero of the line through these two. The error is of second order in the steps.

    Parameters
    ----------
    pressure_kPa, smallest_gap_mm
        (k,) pressure and smallest gap between chambers of every converged step from the unloaded
        state on, in the order of the path; NaN where nothing is near enough to be measured.
    width_mm
        Gap from which on contact pushes.

    Returns
    -------
    float or None
        None if no step comes nearer than ``width_mm``, or the gap would close beyond the end of
        the path only; the first known pressure if that step is nearer.
    """
    known = np.isfinite(smallest_gap_mm)
    pressure, gap = pressure_kPa[known], smallest_gap_mm[known]
    pushed = gap < width_mm
    if not pushed.any():
        return None
    first = int(pushed.argmax())
    if first == 0:
        return float(pressure[0])
    closing = _zero(pressure[first - 1 : first + 1], gap[first - 1 : first + 1])
    latest = closing if gap[first] > 0.0 else float(pressure[first])
    if first >= 2 and gap[first - 2] > gap[first - 1]:
        closing = _zero(pressure[first - 2 : first], gap[first - 2 : first])
    # Behind a limit point the pressure falls while the gap closes.
    low, high = sorted((float(pressure[first - 1]), latest))
    found = min(max(closing, low), high)
    seen = pressure[first - 1 :]
    return found if seen.min() <= found <= seen.max() else None


def _zero(pressure: FloatArray, gap: FloatArray) -> float:
    """Return where the straight line through two steps has no gap left."""
    return float(pressure[1] + gap[1] * (pressure[1] - pressure[0]) / (gap[0] - gap[1]))
