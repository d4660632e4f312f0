"""Rotations against SciPy's, which are written independently."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from pagd.rotations import (
    kabsch,
    quaternion,
    rotation_matrix,
    rotation_vector,
    swing_angle,
    twist_angle,
)

RANDOM = Rotation.random(200, rng=np.random.default_rng(1))


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 1.0, 3.0, np.pi - 1e-7])
def test_rotation_vector_inverts_rotation_matrix_at_any_angle(angle):
    vector = angle * np.array([[2.0, -1.0, 2.0], [0.0, 3.0, 0.0], [0.0, 0.0, -3.0]]) / 3.0
    matrix = rotation_matrix(vector)
    np.testing.assert_allclose(matrix, Rotation.from_rotvec(vector).as_matrix(), atol=1e-14)
    np.testing.assert_allclose(rotation_vector(matrix), vector, atol=1e-12)


def test_half_turn_has_an_axis_up_to_sign():
    vector = np.pi * np.array([0.6, 0.0, 0.8])
    found = rotation_vector(rotation_matrix(vector))
    assert min(np.abs(found - vector).max(), np.abs(found + vector).max()) < 1e-7


def test_vectors_and_quaternions_agree_with_scipy():
    matrices = RANDOM.as_matrix()
    np.testing.assert_allclose(rotation_vector(matrices), RANDOM.as_rotvec(), atol=1e-12)
    xyzw = RANDOM.as_quat(canonical=True)
    np.testing.assert_allclose(quaternion(matrices), np.roll(xyzw, 1, axis=1), atol=1e-12)


def test_kabsch_finds_the_rotation_of_a_flat_set_of_points():
    rng = np.random.default_rng(2)
    points = np.concatenate([rng.normal(size=(200, 6, 2)), np.full((200, 6, 1), -1.3)], axis=-1)
    matrices = RANDOM.as_matrix()
    moved = points @ np.swapaxes(matrices, -1, -2) + rng.normal(size=(200, 1, 3))
    found = kabsch(points, moved, np.ones((200, 6)))
    np.testing.assert_allclose(found, matrices, atol=1e-12)


def test_kabsch_agrees_with_scipy_on_weighted_noisy_points():
    rng = np.random.default_rng(3)
    points, weights = rng.normal(size=(8, 3)), rng.uniform(0.0, 1.0, 8)
    moved = points @ RANDOM[0].as_matrix().T + 0.2 * rng.normal(size=(8, 3))
    mean = [np.average(a, axis=0, weights=weights) for a in (points, moved)]
    expected, _ = Rotation.align_vectors(moved - mean[1], points - mean[0], weights=weights)
    np.testing.assert_allclose(kabsch(points, moved, weights), expected.as_matrix(), atol=1e-9)


def test_kabsch_never_reflects():
    points = np.random.default_rng(4).normal(size=(9, 3))
    mirrored = points * [1.0, 1.0, -1.0]
    assert np.linalg.det(kabsch(points, mirrored, np.ones(9))) == pytest.approx(1.0)


def test_twist_and_swing_come_apart_again():
    twist = np.radians([-170.0, -20.0, 0.0, 40.0, 175.0])
    swing = np.radians([10.0, 90.0, 130.0, 0.0, 60.0])
    about = Rotation.from_rotvec(swing[:, None] * [0.0, 0.6, -0.8])
    both = (about * Rotation.from_rotvec(twist[:, None] * [1.0, 0.0, 0.0])).as_matrix()
    np.testing.assert_allclose(twist_angle(both), twist, atol=1e-12)
    np.testing.assert_allclose(swing_angle(both), swing, atol=1e-12)
