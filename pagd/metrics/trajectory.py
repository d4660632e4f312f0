"""Where the sections are at every recorded pressure, and how far they have turned.

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

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.rotations import rotation_vector, swing_angle, twist_angle
from pagd.sections import Sections, Stations

FloatArray = NDArray[np.float64]

__all__ = ["Trajectory", "measure"]


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Trajectory:
    """Where the sections are at every recorded pressure, and how far they have turned.

    stations: the s stations, fixed end first and tip last.
    pressure_kPa: (p,) recorded pressures in the order of the path, the state without pressure
    first; behind a limit point they may fall.
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
        (p,) recorded pressures in the order of the path; they may fall.
    displacement
        (p, n, 3) displacements of the mesh's nodes at these pressures, in mm. Where the first
        pressure is not 0, the undeformed state is put before it.
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


def _followed(joints: FloatArray) -> FloatArray:
    """Return rotation vectors (p, j, 3), each on the branch nearest to the state before it.

    ω and ω + 2πk n, n = ω/|ω|, are the same rotation. Before the first state, the one without
    pressure, stands the undeformed one, ω = 0.
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
