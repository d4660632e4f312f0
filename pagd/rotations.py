"""Rotations in space: best fit to points, rotation vectors, swing and twist.

Every function works on stacks: leading axes are kept.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

__all__ = [
    "kabsch",
    "quaternion",
    "rotation_matrix",
    "rotation_vector",
    "swing_angle",
    "twist_angle",
]


def kabsch(reference: FloatArray, moved: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the rotations R (…, 3, 3) that carry reference points best onto moved ones.

    R minimises Σ w |R (X − X̄) − (x − x̄)|² over the proper rotations (Kabsch 1976). The points may
    lie in a plane, but not on a line.

    Parameters
    ----------
    reference, moved
        Points (…, k, 3), k ≥ 3.
    weights
        (…, k), not negative.
    """
    share = (weights / weights.sum(axis=-1, keepdims=True))[..., None]
    reference = reference - (share * reference).sum(axis=-2, keepdims=True)
    covariance = np.swapaxes(share * reference, -1, -2) @ moved
    u, _, vt = np.linalg.svd(covariance)
    # The least of the three directions takes the sign that makes the rotation proper.
    u[..., :, 2] *= np.sign(np.linalg.det(u @ vt))[..., None]
    return np.asarray(np.swapaxes(u @ vt, -1, -2))


def quaternion(rotation: FloatArray) -> FloatArray:
    """Return the unit quaternions (…, 4) = (w, x, y, z), w ≥ 0, of rotations (…, 3, 3).

    They are the eigenvectors for the largest eigenvalue of a symmetric 4 × 4 matrix made of the
    entries of R (Bar-Itzhack 2000), which is accurate at every angle.
    """
    r = rotation
    k = np.empty((*r.shape[:-2], 4, 4))
    k[..., 1:, 1:] = r + np.swapaxes(r, -1, -2)
    trace = np.trace(r, axis1=-2, axis2=-1)
    k[..., 1:, 1:] -= trace[..., None, None] * np.eye(3)
    k[..., 0, 0] = trace
    for i, (a, b) in enumerate(((2, 1), (0, 2), (1, 0)), start=1):
        k[..., 0, i] = k[..., i, 0] = r[..., a, b] - r[..., b, a]
    q = np.linalg.eigh(k)[1][..., -1]
    return np.asarray(np.where(q[..., :1] < 0.0, -q, q))


def rotation_vector(rotation: FloatArray) -> FloatArray:
    """Return the vectors ω (…, 3) in radians, |ω| ≤ π, with R = exp([ω]×)."""
    q = quaternion(rotation)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, q[..., :1])
    # angle / sine → 2 where the rotation vanishes.
    factor = np.divide(angle, sine, out=np.full_like(sine, 2.0), where=sine > 1e-12)
    return np.asarray(factor * q[..., 1:])


def rotation_matrix(vector: FloatArray) -> FloatArray:
    """Return R = exp([ω]×) (…, 3, 3) for rotation vectors ω (…, 3) in radians (Rodrigues)."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    cross = np.zeros((*vector.shape[:-1], 3, 3))
    for i, (a, b) in enumerate(((1, 2), (2, 0), (0, 1))):
        cross[..., b, a] = vector[..., i]
        cross[..., a, b] = -vector[..., i]
    # sin(a)/a and (1 − cos a)/a², both finite at a = 0.
    first = np.sinc(angle / np.pi)
    second = 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2
    return np.asarray(np.eye(3) + first * cross + second * (cross @ cross))


def twist_angle(rotation: FloatArray) -> FloatArray:
    """Return the twist (…) in radians, −π…π, of rotations R (…, 3, 3) about the x axis they carry.

    R = S T with the twist T about e_x and the swing S about an axis normal to e_x; it is also
    R = T' S with T' the same angle about the carried axis R e_x. With the quaternion (w, x, y, z)
    of R the angle is 2 atan2(x, w). It is undefined where the swing reaches 180° (w = x = 0).
    """
    q = quaternion(rotation)
    return np.asarray(2.0 * np.arctan2(q[..., 1], q[..., 0]))


def swing_angle(rotation: FloatArray) -> FloatArray:
    """Return the angles (…) in radians, 0…π, between e_x and the carried axis R e_x."""
    carried = rotation[..., :, 0]
    return np.asarray(np.arctan2(np.hypot(carried[..., 1], carried[..., 2]), carried[..., 0]))
