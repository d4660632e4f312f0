"""Steps of the analyses of a design as compact JSON, for the page to draw as curves."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.figures.load import (
    Steps,
    has_blocked_force,
    has_history,
    load_blocked_force,
    load_history,
)

__all__ = ["curves_of", "steps_data"]


def curves_of(folder: Path) -> dict[str, Any]:
    """Return what :func:`steps_data` gives of each analysis of a design: free, and held."""
    found = {}
    if has_history(folder):
        found["free"] = steps_data(load_history(folder))
    if has_blocked_force(folder):
        found["held"] = steps_data(load_blocked_force(folder))
    return found


def steps_data(steps: Steps) -> dict[str, list[float | None]]:
    """Return pressure, volume (in multiples of that without pressure), gap and force of the steps.

    What no step knows is left out, what one does not know is None.
    """
    columns = {
        "pressure_kPa": steps.pressure_kPa,
        "volume": steps.cavity_volume_mm3 / steps.cavity_volume_mm3[0],
        "gap_mm": steps.smallest_gap_mm,
        "force_N": steps.blocked_force_N,
    }
    there = {name: v for name, v in columns.items() if v is not None and np.isfinite(v).any()}
    return {name: _listed(values) for name, values in there.items()}


def _listed(values: NDArray[np.float64]) -> list[float | None]:
    return [float(f"{v:.5g}") + 0.0 if np.isfinite(v) else None for v in values]
