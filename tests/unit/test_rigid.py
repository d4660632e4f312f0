"""Tests of rigid motions: shares of a screw, and the rotation nearest to displacements."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm, logm

from pagd.rigid import RigidMotion, small_rotation
from pagd.rotations import rotation_matrix


@pytest.mark.parametrize("turned", [[0.0, 0.0, 0.0], [0.3, -0.2, 0.1], [2.0, 1.0, -1.0]])
def test_a_share_of_a_motion_is_that_of_its_screw(turned: list[float]) -> None:
    motion = RigidMotion(rotation_matrix(np.array(turned)), np.array([10.0, 1.0, -2.0]))
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = motion.rotation, motion.displacement
    wanted = np.real(expm(0.3 * logm(whole)))
    share = motion.power(0.3)
    np.testing.assert_allclose(share.rotation, wanted[:3, :3], atol=1e-12)
    np.testing.assert_allclose(share.displacement, wanted[:3, 3], atol=1e-12)


def test_shares_add_up_to_the_motion() -> None:
    motion = RigidMotion(rotation_matrix(np.array([0.5, 0.4, -0.8])), np.array([3.0, 4.0, 5.0]))
    both = motion.power(0.4) @ motion.power(0.6)
    np.testing.assert_allclose(both.rotation, motion.rotation, atol=1e-12)
    np.testing.assert_allclose(both.displacement, motion.displacement, atol=1e-12)


def test_small_rotation_is_that_of_a_rigid_motion() -> None:
    draw = np.random.default_rng(3)
    points, turned = draw.normal(size=(12, 3)), np.array([1e-3, -2e-3, 3e-3])
    moved = np.cross(turned, points) + np.array([4.0, 5.0, 6.0])
    np.testing.assert_allclose(small_rotation(points, moved), turned, rtol=1e-9)


def test_a_stretch_is_no_rotation() -> None:
    corners = np.array([[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]], dtype=np.float64)
    points, turned = np.vstack([corners, -corners]), np.array([1e-3, -2e-3, 3e-3])
    moved = np.cross(turned, points) + points * np.array([0.1, 0.0, 0.0])
    np.testing.assert_allclose(small_rotation(points, moved), turned, rtol=1e-9)
