"""What an actuator does under pressure: trajectory, bending, twist, work and mode.

Angles
------
R_i is the rotation of section i (:mod:`pagd.sections`); the fixed end does not rotate, R_0 = I.
Joint i, the piece between sections i − 1 and i, turns by Q_i = R_{i−1}ᵀ R_i. Its rotation vector
in the frame that the section carries along,

    ω_i = log Q_i = (τ_i, β_i, γ_i),

has the twist τ about the deformed axis, the bending β about the deformed width axis and the
sideways bending γ about the normal of the paper. Sections in between add up:

    twist_i = Σ τ_j,   bending_i = Σ β_j,   sideways_i = Σ γ_j,   j = 1 … i.

Signs follow the right-hand rule about x, y and z: bending is positive towards the paper (the tip
goes to −z), twist is positive about +x (the edge at +y rises).

Sums of joints are unwrapped by themselves, since no joint comes near 180°. Where one does (few
stations), its branch is followed from one recorded pressure to the next. The sums do not depend
on the number of stations wherever curvature and twist are constant, as in a row of equal chambers
under uniform pressure, whose shape is a helix: there R = exp(s [κ]×), and bending and twist are
κ_y and κ_x times the length.

The swing–twist decomposition of a rotation, R = T S with T about the deformed axis, gives the
same twist to second order in the rotation, so that for the small rotation of a joint both agree.
For the whole actuator it answers another question, "how does the tip stand, as seen from the
fixed end", mixes bending into twist (a helix bent by 100° and twisted by 40° shows 54°) and has
no value where the tip points backwards (180°). It is given as `swing_twist_deg`, beside
`swing_deg`, the angle between the tip and the undeformed axis.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pagd.rotations import rotation_vector, swing_angle, twist_angle
from pagd.sections import Sections, Stations

FloatArray = NDArray[np.float64]
MeasuredMode = Literal["bending", "twisting", "mixed", "none"]

_ROUND_OFF_MJ = 1e-9

__all__ = [
    "MeasuredMode",
    "Thresholds",
    "Trajectory",
    "energy_balance",
    "is_still",
    "measure",
    "measured_mode",
    "performance",
    "work_density",
    "work_of_pressure",
]


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


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Trajectory:
    """Where the sections are at every recorded pressure, and how far they have turned.

    stations: the s stations, fixed end first and tip last.
    pressure_kPa: (p,) recorded pressures, rising from 0: the unloaded state is the first.
    positions: (p, s, 3) station points on the centre line of the paper plane, in mm.
    rotations: (p, s, 3, 3) frames relative to the fixed end.
    joints: (p, s − 1, 3) rotation vectors (τ, β, γ) of the joints in radians.
    """

    stations: Stations
    pressure_kPa: FloatArray
    positions: FloatArray
    rotations: FloatArray
    joints: FloatArray

    @property
    def twist_deg(self) -> FloatArray:
        """Twist of every section (p, s) about the deformed axis, in degrees."""
        return self._summed(0)

    @property
    def bending_deg(self) -> FloatArray:
        """Bending of every section (p, s) about the deformed width axis, in degrees."""
        return self._summed(1)

    @property
    def sideways_deg(self) -> FloatArray:
        """Bending of every section (p, s) within the paper, in degrees."""
        return self._summed(2)

    @property
    def swing_deg(self) -> FloatArray:
        """Angle (p,) between the tip's axis and the undeformed one, 0…180 degrees."""
        return np.asarray(np.degrees(swing_angle(self.rotations[:, -1])))

    @property
    def swing_twist_deg(self) -> FloatArray:
        """Twist part (p,) of the tip's whole rotation (swing–twist), −180…180 degrees."""
        return np.asarray(np.degrees(twist_angle(self.rotations[:, -1])))

    @property
    def chord_deg(self) -> FloatArray:
        """Angle (p,) of the line from fixed end to tip, atan2(|z|, x), 0…180 degrees.

        Much smaller than the bending angle of the same state: half of it for an arc.
        """
        chord = self.positions[:, -1] - self.positions[:, 0]
        return np.asarray(np.degrees(np.arctan2(np.abs(chord[:, 2]), chord[:, 0])))

    @property
    def out_of_plane_mm(self) -> FloatArray:
        """Deflection (p,) of the tip across, along y, in mm."""
        return np.asarray(self.positions[:, -1, 1] - self.positions[:, 0, 1])

    def columns(self) -> dict[str, NDArray[np.generic]]:
        """Return the table of all sections: one row a pressure and station, stations fastest."""
        p, s = self.positions.shape[:2]
        x, y, z = self.positions.reshape(-1, 3).T
        return {
            "pressure_kPa": np.repeat(self.pressure_kPa, s),
            "station": np.tile(np.arange(s, dtype=np.int32), p),
            "x_mm": x,
            "y_mm": y,
            "z_mm": z,
            "bending_deg": self.bending_deg.ravel(),
            "twist_deg": self.twist_deg.ravel(),
        }

    def _summed(self, axis: int) -> FloatArray:
        degrees = np.degrees(self.joints[:, :, axis])
        return np.concatenate([np.zeros((len(degrees), 1)), np.cumsum(degrees, axis=1)], axis=1)


def measure(sections: Sections, pressure_kPa: FloatArray, displacement: FloatArray) -> Trajectory:
    """Measure the sections at every recorded pressure.

    Parameters
    ----------
    sections
        The s sections, placed in the mesh.
    pressure_kPa
        (p,) rising pressures.
    displacement
        (p, n, 3) displacements of the mesh's nodes at these pressures, in mm. Where the first
        pressure is not 0, the unloaded state is put before it.
    """
    if len(pressure_kPa) == 0 or pressure_kPa[0] > 0.0:
        pressure_kPa = np.pad(pressure_kPa, (1, 0))
        displacement = np.pad(displacement, ((1, 0), (0, 0), (0, 0)))
    positions = np.stack([sections.positions(u) for u in displacement])
    rotations = np.stack([sections.frames(u) for u in displacement])
    # The clamp holds the first section exactly; its strips, of finite length, see some bending.
    rotations[:, 0] = np.eye(3)
    joints = rotation_vector(np.swapaxes(rotations[:, :-1], -1, -2) @ rotations[:, 1:])
    return Trajectory(
        stations=sections.stations,
        pressure_kPa=np.asarray(pressure_kPa, dtype=np.float64),
        positions=positions,
        rotations=rotations,
        joints=_followed(joints),
    )


def measured_mode(
    bending_deg: FloatArray, twist_deg: FloatArray, thresholds: Thresholds = Thresholds()
) -> MeasuredMode:
    """Tell the mode of one state from the joints' own rotation.

    Every joint that moves either twists or does not. All twist: "twisting"; none: "bending";
    some of each: "mixed", the row has joints of both kinds. Slanted chambers bend AND twist:
    that alone is not mixed.

    Parameters
    ----------
    bending_deg, twist_deg
        (s,) angles of the sections from the fixed end to the tip.
    thresholds
        What counts as moving, twisting and mixed.
    """
    if is_still(float(bending_deg[-1]), float(twist_deg[-1]), thresholds):
        return "none"
    twist, bending = np.abs(np.diff(twist_deg)), np.abs(np.diff(bending_deg))
    whole = np.hypot(twist, bending)
    moving = whole >= thresholds.joint_deg
    share = float(np.mean(twist[moving] >= thresholds.twist_share * whole[moving]))
    if share < thresholds.mixed_share:
        return "bending"
    return "twisting" if share > 1.0 - thresholds.mixed_share else "mixed"


def is_still(bending_deg: float, twist_deg: float, thresholds: Thresholds = Thresholds()) -> bool:
    """Tell whether bending and twist of the tip are both below the threshold: no actuation."""
    return max(abs(bending_deg), abs(twist_deg)) < thresholds.still_deg


def work_of_pressure(pressure_kPa: FloatArray, volume_mm3: FloatArray) -> FloatArray:
    """Return the work so far (k,) in mJ, ∫ p dV along the converged steps by trapezoids.

    Parameters
    ----------
    pressure_kPa, volume_mm3
        (k,) pressure and cavity volume, from the unloaded state on.
    """
    steps = 0.5 * (pressure_kPa[1:] + pressure_kPa[:-1]) * np.diff(volume_mm3)
    # 1 kPa mm³ = 1e-3 MPa mm³ = 1e-3 mJ.
    return np.concatenate([[0.0], np.cumsum(steps)]) * 1e-3


def energy_balance(work_mJ: FloatArray, stored_mJ: FloatArray) -> FloatArray:
    """Return |∫ p dV − U| / U for the stored energy U, element by element.

    Energies below 1e-9 mJ are round-off of an unloaded state: 0 there, and infinite for work that
    nothing stores.
    """
    gap = np.abs(work_mJ - stored_mJ)
    unloaded = np.where(gap > _ROUND_OFF_MJ, np.inf, 0.0)
    return np.divide(gap, stored_mJ, out=unloaded, where=stored_mJ > _ROUND_OFF_MJ)


def work_density(work_mJ: FloatArray, solid_volume_mm3: float) -> FloatArray:
    """Return the work per volume of elastomer in kJ/m³; 1 mJ/mm³ is 1000 kJ/m³."""
    return work_mJ / solid_volume_mm3 * 1e3


def performance(
    trajectory: Trajectory,
    history: Mapping[str, NDArray[np.generic]],
    solid_volume_mm3: float,
    thresholds: Thresholds = Thresholds(),
) -> dict[str, NDArray[np.generic]]:
    """Return the table of performance: one row a recorded pressure.

    Parameters
    ----------
    trajectory
        The measured sections.
    history
        pressure_kPa, cavity_volume_mm3 and stored_energy_mJ, (k,) each, of every converged step
        from the unloaded state on; the recorded pressures are among the steps.
    solid_volume_mm3
        Volume of elastomer of the body that `history` is about: for a half model, either both
        are of the half or both of the whole.
    thresholds
        For the measured mode.
    """
    pressure = np.asarray(history["pressure_kPa"], dtype=np.float64)
    volume = np.asarray(history["cavity_volume_mm3"], dtype=np.float64)
    stored = np.asarray(history["stored_energy_mJ"], dtype=np.float64)
    rows = _rows_at(pressure, trajectory.pressure_kPa)
    work = work_of_pressure(pressure, volume)[rows]
    x, y, z = trajectory.positions[:, -1].T
    bending, twist = trajectory.bending_deg, trajectory.twist_deg
    modes = [measured_mode(b, t, thresholds) for b, t in zip(bending, twist, strict=True)]
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
    }


def _rows_at(steps_kPa: FloatArray, recorded_kPa: FloatArray) -> NDArray[np.int64]:
    """Return the step of each recorded pressure."""
    rows = np.abs(steps_kPa - recorded_kPa[:, None]).argmin(axis=1)
    off = np.abs(steps_kPa[rows] - recorded_kPa) > 1e-6 * np.maximum(1.0, recorded_kPa)
    if off.any():
        raise ValueError(f"no converged step at the recorded {recorded_kPa[off][0]:g} kPa")
    return np.asarray(rows)


def _followed(joints: FloatArray) -> FloatArray:
    """Return rotation vectors (p, j, 3), each on the branch nearest to the state before it.

    ω and ω + 2πk n, n = ω/|ω|, are the same rotation. The unloaded state, ω = 0, is the first.
    """
    followed = np.empty_like(joints)
    before = np.zeros_like(joints[0])
    for p, now in enumerate(joints):
        angle = np.linalg.norm(now, axis=-1, keepdims=True)
        known = angle > 1e-9
        # A whole turn has no axis of its own: keep the one before.
        fallback = before / np.maximum(np.linalg.norm(before, axis=-1, keepdims=True), 1e-9)
        axis = np.where(known, now / np.where(known, angle, 1.0), fallback)
        turns = np.round(((before * axis).sum(-1, keepdims=True) - angle) / (2.0 * np.pi))
        followed[p] = before = now + 2.0 * np.pi * turns * axis
    return followed
