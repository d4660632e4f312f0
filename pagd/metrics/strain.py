"""Strain and its rate by pressure, where the pressure rises."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

__all__ = ["strain_columns", "strain_rate"]


def strain_rate(pressure_kPa: FloatArray, strain: FloatArray) -> FloatArray:
    """Return dε/dp (p,) in 1/kPa by differences of second order.

    Central differences for uneven steps, one-sided ones at the ends. Where the pressure falls or
    stays from one state to the next, ε is no function of p across the two: the states before and
    after are taken apart, and a state that is left alone has no rate (NaN).

    Parameters
    ----------
    pressure_kPa, strain
        (p,) recorded pressures in the order of the path, and a strain at each.
    """
    rate = np.full(len(pressure_kPa), np.nan)
    breaks = np.flatnonzero(np.diff(pressure_kPa) <= 0.0) + 1
    for rising in np.split(np.arange(len(pressure_kPa)), breaks):
        if len(rising) >= 2:
            steps = pressure_kPa[rising]
            rate[rising] = np.gradient(
                strain[rising], steps, edge_order=2 if len(rising) > 2 else 1
            )
    return rate


def strain_columns(
    pressure_kPa: FloatArray,
    strain_max: FloatArray,
    strain_p99: FloatArray,
    ramp_kPa_per_s: float | None = None,
) -> dict[str, FloatArray]:
    """Return strains and their rates, one row a recorded pressure.

    Parameters
    ----------
    pressure_kPa, strain_max, strain_p99
        (p,) recorded pressures in the order of the path, largest strain and its 99th percentile;
        the rate is that of the percentile, as the largest strain sits in a corner and grows with
        the mesh.
    ramp_kPa_per_s
        How fast the pressure rises; None leaves the rate per second open (NaN).
    """
    rate = strain_rate(pressure_kPa, strain_p99)
    return {
        "strain_max": strain_max,
        "strain_p99": strain_p99,
        "strain_rate_per_kPa": rate,
        "strain_rate_per_s": rate * (np.nan if ramp_kPa_per_s is None else ramp_kPa_per_s),
    }
