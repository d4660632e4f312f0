"""Work of the pressure, and its balance with the stored energy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_ROUND_OFF_MJ = 1e-9

__all__ = ["energy_balance", "work_density", "work_of_pressure"]


def work_of_pressure(pressure_kPa: FloatArray, volume_mm3: FloatArray) -> FloatArray:
    """Return the work so far (k,) in mJ, ∫ p dV along the converged steps by trapezoids.

    Parameters
    ----------
    pressure_kPa, volume_mm3
        (k,) pressure and cavity volume in the order of the path, from the state without pressure
        on.
    """
    steps = 0.5 * (pressure_kPa[1:] + pressure_kPa[:-1]) * np.diff(volume_mm3)
    # 1 kPa mm³ = 1e-3 MPa mm³ = 1e-3 mJ.
    return np.concatenate([[0.0], np.cumsum(steps)]) * 1e-3


def energy_balance(work_mJ: FloatArray, stored_mJ: FloatArray) -> FloatArray:
    """Return |∫ p dV − U| / U for the stored energy U, element by element.

    Stored energies below 1e-9 mJ are round-off of the state without pressure: 0 there, and infinite
    for work that nothing stores.
    """
    gap = np.abs(work_mJ - stored_mJ)
    unstored = np.where(gap > _ROUND_OFF_MJ, np.inf, 0.0)
    return np.divide(gap, stored_mJ, out=unstored, where=stored_mJ > _ROUND_OFF_MJ)


def work_density(work_mJ: FloatArray, solid_volume_mm3: float) -> FloatArray:
    """Return the work per volume of elastomer in kJ/m³; 1 mJ/mm³ is 1000 kJ/m³."""
    return work_mJ / solid_volume_mm3 * 1e3
