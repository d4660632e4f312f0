"""Rigid motions x ↦ R x + t, and how a part of a deformed body has moved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.rotations import kabsch, rotation_matrix, rotation_vector

FloatArray = NDArray[np.float64]

# Gauss's rule with eight points: exact to the last digit for rotations up to half a turn.
_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(8)

__all__ = ["RigidMotion", "small_rotation"]


def small_rotation(points: FloatArray, moved: FloatArray) -> FloatArray:
    """The rotation vector (3,) of the rigid motion nearest to displacements of points.

    Parameters
    ----------
    points
        (k, 3) in mm, not all on a line.
    moved
        (k, 3), so small that they are linear in the rotation ω: d + ω × x in the mean square.
    """
    arms = points - points.mean(axis=0)
    inertia = np.sum(arms**2) * np.eye(3) - arms.T @ arms
    return np.asarray(np.linalg.solve(inertia, np.cross(arms, moved).sum(axis=0)))


@dataclass(frozen=True, eq=False, slots=True)
class RigidMotion:
    """A rotation (3, 3) and a displacement (3,) in mm."""

    rotation: FloatArray
    displacement: FloatArray

    @classmethod
    def of(cls, reference: FloatArray, moved: FloatArray) -> RigidMotion:
        """The motion that carries points (k, 3) best onto where they are (k, 3)."""
        rotation = kabsch(reference, moved, np.ones(len(reference)))
        return cls(rotation, moved.mean(axis=0) - rotation @ reference.mean(axis=0))

    @classmethod
    def shift(cls, x: float) -> RigidMotion:
        """The translation by x mm along the actuator."""
        return cls(np.eye(3), np.array([x, 0.0, 0.0]))

    def __call__(self, points: FloatArray) -> FloatArray:
        """Where it carries points (…, 3)."""
        return np.asarray(points @ self.rotation.T + self.displacement)

    def __matmul__(self, first: RigidMotion) -> RigidMotion:
        """The motion that does ``first`` and then this one."""
        return RigidMotion(self.rotation @ first.rotation, self(first.displacement))

    def power(self, share: float) -> RigidMotion:
        """So much of the screw motion that it is: a rotation by that share of the angle."""
        turned = rotation_vector(self.rotation)
        # The displacement is V(ω) v of the screw's rates ω and v.
        rate = np.linalg.solve(_mean_rotation(turned), self.displacement)
        displacement = _mean_rotation(share * turned) @ (share * rate)
        return RigidMotion(rotation_matrix(share * turned), displacement)

    def inverse(self) -> RigidMotion:
        """The motion back."""
        return RigidMotion(self.rotation.T, -self.rotation.T @ self.displacement)


def _mean_rotation(turned: FloatArray) -> FloatArray:
    """The mean V (3, 3) of exp(s [ω]×) over s from 0 to 1, for a rotation vector ω (3,)."""
    shares = 0.5 * (1.0 + _PLACES)
    rotations = rotation_matrix(shares[:, None] * turned)
    return np.asarray(np.einsum("s,sij->ij", 0.5 * _WEIGHTS, rotations))
