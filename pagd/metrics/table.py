"""Table of performance: one row a recorded pressure."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from pagd.metrics.energy import energy_balance, work_density, work_of_pressure
from pagd.metrics.mode import Thresholds, measured_mode
from pagd.metrics.trajectory import Trajectory

FloatArray = NDArray[np.float64]
Columns = Mapping[str, NDArray[np.generic]]

__all__ = ["blocked_force_at", "performance", "recorded_rows"]

# Pressures that are the same within this share are the same pressure.
_SAME = 1e-6


def performance(
    trajectory: Trajectory,
    history: Columns,
    solid_volume_mm3: float,
    thresholds: Thresholds | None = None,
) -> dict[str, NDArray[np.generic]]:
    """Return the table of performance: one row a recorded pressure.

    Parameters
    ----------
    trajectory
        The measured sections.
    history
        pressure_kPa, cavity_volume_mm3, stored_energy_mJ, smallest_gap_mm and recorded, (k,)
        each, of every converged step from the state without pressure on, in the order of the path.
    solid_volume_mm3
        Volume of elastomer of the body that `history` is about: for a half model, either both
        are of the half or both of the whole.
    thresholds
        For the measured mode; the usual ones unless given.

    Raises
    ------
    ValueError
        If the recorded steps of the history are not the states of the trajectory.
    """
    pressure = np.asarray(history["pressure_kPa"], dtype=np.float64)
    volume = np.asarray(history["cavity_volume_mm3"], dtype=np.float64)
    stored = np.asarray(history["stored_energy_mJ"], dtype=np.float64)
    rows = recorded_rows(history, trajectory.pressure_kPa)
    work = work_of_pressure(pressure, volume)[rows]
    x, y, z = trajectory.positions[:, -1].T
    bending, twist = trajectory.bending_deg, trajectory.twist_deg
    limits = thresholds or Thresholds()
    modes = [measured_mode(b, t, limits) for b, t in zip(bending, twist, strict=True)]
    return {
        "pressure_kPa": trajectory.pressure_kPa,
        "bending_deg": bending[:, -1],
        "twist_deg": twist[:, -1],
        "sideways_deg": trajectory.sideways_deg[:, -1],
        "swing_deg": trajectory.swing_deg,
        "swing_twist_deg": trajectory.swing_twist_deg,
        "chord_deg": trajectory.chord_deg,
        "out_of_plane_mm": trajectory.out_of_plane_mm,
        "tip_x_mm": x,
        "tip_y_mm": y,
        "tip_z_mm": z,
        "measured_mode": np.array(modes),
        "cavity_volume_mm3": volume[rows],
        "work_mJ": work,
        "stored_energy_mJ": stored[rows],
        "energy_balance": energy_balance(work, stored[rows]),
        "work_density_kJ_m3": work_density(work, solid_volume_mm3),
        "smallest_gap_mm": history["smallest_gap_mm"][rows],
    }


def recorded_rows(history: Columns, pressure_kPa: FloatArray) -> NDArray[np.int64]:
    """Return the row of the history (k,) of each recorded state (p,).

    By the column ``recorded`` alone: along a path that is followed by its volume, pressures fall
    and come again.

    Raises
    ------
    ValueError
        If there are not as many, or their pressures differ.
    """
    rows = np.flatnonzero(history["recorded"])
    found = np.asarray(history["pressure_kPa"], dtype=np.float64)[rows]
    if len(rows) != len(pressure_kPa) or not _same(found, pressure_kPa).all():
        raise ValueError(
            f"the recorded steps of the history are at {found.tolist()} kPa, "
            f"the states at {pressure_kPa.tolist()} kPa"
        )
    return rows


def blocked_force_at(pressure_kPa: FloatArray, blocked: Columns) -> FloatArray:
    """Return the blocked force (p,) in N at recorded pressures; NaN where it was not reached.

    Parameters
    ----------
    pressure_kPa
        (p,) recorded pressures of the free actuation.
    blocked
        pressure_kPa, blocked_force_N and recorded, (k,) each, of the steps of the blocked
        analysis, which has a path of its own: of states at the same pressure the first counts.
    """
    rows = np.flatnonzero(blocked["recorded"])
    # Behind the last step stands one at no pressure, with no force.
    pressure, force = (
        np.append(np.asarray(blocked[key], dtype=np.float64)[rows], np.nan)
        for key in ("pressure_kPa", "blocked_force_N")
    )
    same = _same(pressure[None, :], pressure_kPa[:, None])
    return np.asarray(force[np.where(same.any(axis=1), same.argmax(axis=1), -1)])


def _same(a: FloatArray, b: FloatArray) -> NDArray[np.bool_]:
    return np.asarray(np.abs(a - b) <= _SAME * np.maximum(1.0, np.abs(b)))
