"""Strains of a solved state."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import elastomer

from pagd.fem.fields import share_beyond, strains, weighted_percentile
from pagd.fem.solid import ElementPressureSolid
from pagd.mesh.primitives import box

MESH = box((4.0, 2.0, 2.0), (4, 2, 2))
SOLID = ElementPressureSolid(MESH.points, MESH.tets, elastomer("yeoh"))


def test_homogeneous_state() -> None:
    gradient = np.array([[1.3, 0.4, -0.2], [0.1, 0.8, 0.3], [-0.3, 0.2, 1.1]])
    exact = np.log(np.linalg.svd(gradient, compute_uv=False)[0])
    state = (MESH.points @ (gradient - np.eye(3)).T).ravel()
    found = strains([SOLID], state, len(MESH.points))
    np.testing.assert_allclose(found.nodes, exact, rtol=1e-12)
    assert found.largest == pytest.approx(exact)
    assert found.percentile_99 == pytest.approx(exact)


def test_a_linear_strain_is_extrapolated_to_the_nodes() -> None:
    """Displacement a x²/2 along x: the stretch is 1 + a x, its logarithm a x for small a."""
    size = 1e-5
    state = np.zeros_like(MESH.points)
    state[:, 0] = size * MESH.points[:, 0] ** 2 / 2
    found = strains([SOLID], state.ravel(), len(MESH.points))
    np.testing.assert_allclose(found.nodes, size * MESH.points[:, 0], atol=1e-4 * size)


def test_nodes_without_elements_are_zero() -> None:
    found = strains([SOLID], np.zeros(MESH.points.size + 6), len(MESH.points) + 2)
    assert found.nodes[-2:].tolist() == [0.0, 0.0]


def test_share_of_the_volume_beyond_a_stretch() -> None:
    """The half x > 2 stretched by a half, the other not: with quadrature points, half the mesh."""
    state = np.zeros_like(MESH.points)
    state[:, 0] = 0.5 * np.maximum(MESH.points[:, 0] - 2.0, 0.0)
    assert share_beyond([SOLID], state.ravel(), 1.4) == pytest.approx(0.5)
    assert share_beyond([SOLID], state.ravel(), 1.6) == 0.0
    assert share_beyond([SOLID], state.ravel(), 0.9) == pytest.approx(1.0)


def test_weighted_percentile() -> None:
    values, weights = np.array([[3.0, 1.0], [2.0, 4.0]]), np.array([[0.1, 0.5], [0.3, 0.1]])
    assert weighted_percentile(values, weights, 0.49) == 1.0
    assert weighted_percentile(values, weights, 0.6) == 2.0
    assert weighted_percentile(values, weights, 0.85) == 3.0
    assert weighted_percentile(values, weights, 1.0) == 4.0
