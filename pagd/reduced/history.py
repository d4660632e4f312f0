"""What a whole row goes through, from what its parts do: volume, energy, gap, strain.

Parts take steps of their own. Between these, volume and energy are smooth in the pressure; they
are interpolated by cubic splines to all pressures at which any cell has a step.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.reduced.solve import ReducedRow

FloatArray = NDArray[np.float64]

__all__ = ["row_history", "row_strains"]

# Pressures that differ by less than this share of the largest are one.
_SAME = 1e-6


def row_history(reduced: ReducedRow, cavity_volume_mm3: float) -> dict[str, NDArray[Any]]:
    """The columns of a history as :class:`pagd.actuation.ActuationResult` has them.

    Parameters
    ----------
    reduced
        The solved parts.
    cavity_volume_mm3
        Volume of the air of the whole row without pressure, from which that of the parts goes on.
    """
    pressures = _pressures(reduced)
    volume = np.full(len(pressures), cavity_volume_mm3)
    energy, gap = np.zeros(len(pressures)), np.full(len(pressures), np.nan)
    iterations = np.zeros(len(pressures))
    for kind, cell in reduced.cells.items():
        count = _cells_of(reduced, kind)
        known = cell.result.history
        rising = _rising(known["pressure_kPa"])
        at = known["pressure_kPa"][rising]
        grown = known["cavity_volume_mm3"][rising] - known["cavity_volume_mm3"][0]
        volume += count * _between(at, grown)(pressures)
        energy += count * _between(at, known["stored_energy_mJ"][rising])(pressures)
        gap = np.fmin(gap, np.interp(pressures, at, known["smallest_gap_mm"][rising]))
        iterations += np.where(
            np.isclose(pressures[:, None], at, rtol=_SAME), known["newton_iterations"][rising], 0
        ).sum(axis=1)
    for piece in reduced.pieces:
        followed = piece.followed
        at = piece.pressure_kPa
        volume += _between(at, followed.volumes - followed.volumes[0])(pressures)
        energy += _between(at, followed.energies - followed.energies[0])(pressures)
    same = np.isclose(pressures[:, None], reduced.pressure_kPa, rtol=_SAME)
    recorded = np.asarray(same.any(axis=1))
    return {
        "pressure_kPa": pressures,
        "cavity_volume_mm3": volume,
        "stored_energy_mJ": energy,
        "newton_iterations": iterations.astype(np.int32),
        "smallest_gap_mm": gap,
        "recorded": recorded,
    }


def row_strains(reduced: ReducedRow) -> tuple[FloatArray, FloatArray]:
    """Largest strain and 99th percentile of the cells (p,), the larger of both kinds'."""
    count = len(reduced.pressure_kPa)
    largest, percentile = np.zeros(count), np.zeros(count)
    for cell in reduced.cells.values():
        states = cell.result.states[:count]
        largest = np.maximum(largest, [state.strain_max for state in states])
        percentile = np.maximum(percentile, [state.strain_p99 for state in states])
    return largest, percentile


def _cells_of(reduced: ReducedRow, kind: bool) -> int:
    """How many chambers of a kind are cells, and not in a piece."""
    kinds = reduced.design.chamber_skews() != 0.0
    alone = np.zeros(len(kinds), dtype=np.bool_)
    for piece in reduced.pieces:
        alone[piece.first : piece.last + 1] = True
    return int(((kinds == kind) & ~alone).sum())


def _pressures(reduced: ReducedRow) -> FloatArray:
    """Pressures of all cells' steps, as far as all parts came."""
    steps = [cell.result.history["pressure_kPa"] for cell in reduced.cells.values()]
    last = reduced.pressure_kPa[-1]
    every = np.sort(np.concatenate([reduced.pressure_kPa, *steps]))
    every = every[every <= last * (1 + _SAME)]
    apart = np.diff(every, prepend=-np.inf) > _SAME * max(last, 1.0)
    return np.asarray(every[apart])


def _rising(pressure_kPa: FloatArray) -> slice:
    """The steps before the pressure falls for the first time."""
    falls = np.flatnonzero(np.diff(pressure_kPa) <= 0.0)
    return slice(0, int(falls[0]) + 1 if len(falls) else len(pressure_kPa))


def _between(at: FloatArray, values: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """The cubic spline through values; a straight line or less where there are not four."""
    from scipy.interpolate import make_interp_spline

    if len(at) < 2:
        return lambda pressures: np.full(len(pressures), values[0])
    spline = make_interp_spline(at, values, k=min(3, len(at) - 1))
    return lambda pressures: np.asarray(spline(pressures))
