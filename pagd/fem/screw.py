"""Nodes that a screw motion ties to others: one cell of a row, all of whose cells are alike.

The place of a tied node (a slave) follows that of another (its master),

    x_s = R (x_m − c) + c + T + d,   R = exp([θ]×) ∈ SO(3),

with the translation T that carries the masters to the slaves in the undeformed body, a centre c,
and the motion (θ, d), zero at rest, whose six numbers are unknowns. At rest a row of cells is
carried into itself by T; under load by the screw motion x ↦ R (x − c) + c + T + d.

Corrections take R to exp([δθ]×) R, with a rotation δθ in space: to first order

    δx_s = R δx_m + δθ × y + δd,   y = R (x_m − c).

The energy of second order in a correction has, beside Kᵀ of the elements, what the nodal forces f
on the slaves do along the curved motion (of a rotation vector that is added in space; cf. Simo and
Vu-Quoc, *Comput. Methods Appl. Mech. Eng.* 58 (1986) 79):

    K_θm = −[f]× R,   K_θθ = ½ (f yᵀ + y fᵀ) − (f · y) I.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.rigid import RigidMotion
from pagd.rotations import rotation_matrix, rotation_vector

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

__all__ = ["ScrewMotion", "ScrewTie"]

# How far, in mm, a slave may be from where the translation carries its master.
_SAME_PLACE = 1e-4


@dataclass(frozen=True, eq=False, slots=True)
class ScrewMotion:
    """A motion x ↦ R (x − c) + c + T + d at a state.

    rotation: R (3, 3). arms: y = R (x_m − c) of the masters (k, 3), in mm.
    """

    rotation: FloatArray
    arms: FloatArray


class ScrewTie:
    """Slaves, their masters and where among the unknowns the motion is.

    Parameters
    ----------
    points
        Reference coordinates (n, 3) in mm; of the motion's two rows anything.
    slaves, masters
        Numbers (k,) of the tied nodes and of those that they follow. No slave is a master.
    motion
        Number of a row of three unknowns, as a node has, that holds θ; the next one holds d.

    Raises
    ------
    InputError
        Where no one translation carries the masters to the slaves.
    """

    def __init__(
        self, points: FloatArray, slaves: IntArray, masters: IntArray, motion: int
    ) -> None:
        self.slaves, self.masters, self.motion = slaves, masters, motion
        offsets = points[slaves] - points[masters]
        self.translation = offsets.mean(axis=0)
        away = float(np.abs(offsets - self.translation).max())
        if away > _SAME_PLACE:
            raise InputError(
                f"The two ends of a cell differ: nodes are up to {away:.3g} mm from where one "
                "translation carries those they follow."
            )
        self.centre = points[masters].mean(axis=0)
        self._points = points
        #: How many nodes and rows like them there are.
        self.points = len(points)

    def motion_at(self, unknowns: FloatArray) -> ScrewMotion:
        """The rotation and the arms at a state (size,)."""
        rows = unknowns[: self._points.size].reshape(-1, 3)
        rotation = rotation_matrix(rows[self.motion])
        places = self._points[self.masters] + rows[self.masters]
        return ScrewMotion(rotation, (places - self.centre) @ rotation.T)

    def rigid(self, rotation_vector: FloatArray, displacement: FloatArray) -> RigidMotion:
        """The motion x ↦ R (x − c) + c + T + d of a rotation vector θ and of d."""
        rotation = rotation_matrix(rotation_vector)
        shift = self.centre + self.translation + displacement - rotation @ self.centre
        return RigidMotion(rotation, shift)

    def settle(self, unknowns: FloatArray) -> None:
        """Put the slaves, in place, where the motion and their masters have them."""
        rows = unknowns[: self._points.size].reshape(-1, 3)
        carried = self.motion_at(unknowns).arms + self.centre + self.translation
        rows[self.slaves] = carried + rows[self.motion + 1] - self._points[self.slaves]

    def complete(self, motion: ScrewMotion, correction: FloatArray) -> None:
        """Add, in place, what a correction (size,) of all else means for the slaves."""
        rows = correction[: self._points.size].reshape(-1, 3)
        turned = rows[self.masters] @ motion.rotation.T + np.cross(rows[self.motion], motion.arms)
        rows[self.slaves] = turned + rows[self.motion + 1]

    def reduce(self, motion: ScrewMotion, gradient: FloatArray) -> None:
        """Pass, in place, what acts on the slaves (size,) on to masters and motion."""
        rows = gradient[: self._points.size].reshape(-1, 3)
        acting = rows[self.slaves].copy()
        rows[self.slaves] = 0.0
        np.add.at(rows, self.masters, acting @ motion.rotation)
        rows[self.motion] += np.cross(motion.arms, acting).sum(axis=0)
        rows[self.motion + 1] += acting.sum(axis=0)

    def compose(self, unknowns: FloatArray, correction: FloatArray) -> FloatArray:
        """The unknowns (size,) after a correction whose θ is a rotation δθ in space."""
        result = unknowns + correction
        at = slice(3 * self.motion, 3 * self.motion + 3)
        further = rotation_matrix(correction[at]) @ rotation_matrix(unknowns[at])
        result[at] = rotation_vector(further)
        self.settle(result)
        return result

    def turning(self, motion: ScrewMotion, forces: FloatArray) -> FloatArray:
        """Second derivatives (k, 6, 6) by master and θ, of ``forces`` (k, 3) on the slaves."""
        result = np.zeros((len(forces), 6, 6))
        mixed = -_cross(forces) @ motion.rotation
        result[:, 3:, :3], result[:, :3, 3:] = mixed, np.swapaxes(mixed, 1, 2)
        outer = forces[:, :, None] * motion.arms[:, None, :]
        along = np.einsum("kii->k", outer)
        result[:, 3:, 3:] = (outer + np.swapaxes(outer, 1, 2)) / 2 - along[:, None, None] * np.eye(
            3
        )
        return result


def _cross(vectors: FloatArray) -> FloatArray:
    """Matrices (k, 3, 3) of the cross product with vectors (k, 3) from the left."""
    result = np.zeros((len(vectors), 3, 3))
    for i, (a, b) in enumerate(((1, 2), (2, 0), (0, 1))):
        result[:, b, a] = vectors[:, i]
        result[:, a, b] = -vectors[:, i]
    return result
