"""Where the pressure, along the path, has a maximum."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# A fall by less than this share of the largest pressure is the tolerance of the iteration.
_PROMINENCE = 1e-3


def limit_points(pressure_kPa: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the steps (k,) at which the pressure (n,) was highest before it fell.

    >>> limit_points(np.array([0.0, 1.0, 3.0, 2.0, 2.5])).tolist()
    [2]
    """
    if (np.diff(pressure_kPa) >= 0).all():
        return np.zeros(0, np.int64)
    # Half a second of imports, for the few paths along which the pressure falls.
    from scipy.signal import find_peaks

    found, _ = find_peaks(pressure_kPa, prominence=_PROMINENCE * float(pressure_kPa.max()))
    return np.asarray(found, dtype=np.int64)
