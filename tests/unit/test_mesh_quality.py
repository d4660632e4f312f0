import numpy as np
import pytest

from pagd.mesh.primitives import box, sphere_octant
from pagd.mesh.quality import mesh_quality, node_jacobians, scaled_jacobians
from pagd.mesh.types import TET_EDGES, corner_volumes

ONE = np.array([[0, 1, 2, 3]])
REGULAR = np.array([[1.0, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]])


def test_scaled_jacobian_is_one_for_regular_zero_for_flat_and_negative_for_inverted() -> None:
    assert scaled_jacobians(REGULAR, ONE) == pytest.approx(1.0)
    assert scaled_jacobians(7.0 * REGULAR, ONE) == pytest.approx(1.0)
    assert scaled_jacobians(-REGULAR, ONE) == pytest.approx(-1.0)
    flat = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    assert scaled_jacobians(flat, ONE) == 0.0
    assert scaled_jacobians(np.zeros((4, 3)), ONE) == 0.0


def test_scaled_jacobian_of_the_corner_of_a_cube() -> None:
    # The shortest edges meet at a right angle; the largest product is at any other corner.
    corner = np.vstack((np.zeros(3), np.eye(3)))
    assert scaled_jacobians(corner, ONE) == pytest.approx(np.sqrt(2) / 2)


def test_node_jacobians_of_straight_elements_are_six_volumes() -> None:
    mesh = box((1.0, 2.0, 3.0), (2, 1, 1))
    expected = 6 * corner_volumes(mesh.points, mesh.tets)[:, None] * np.ones(10)
    np.testing.assert_allclose(node_jacobians(mesh.points, mesh.tets), expected)


def test_node_jacobians_agree_with_differences_of_the_curved_map() -> None:
    rng = np.random.default_rng(3)
    points = np.vstack((REGULAR, REGULAR[TET_EDGES].mean(axis=1))) + rng.normal(0, 0.1, (10, 3))

    def position(xi: np.ndarray) -> np.ndarray:
        barycentric = np.append(1.0 - xi.sum(), xi)
        edges = 4 * barycentric[TET_EDGES].prod(axis=1)
        return np.append(barycentric * (2 * barycentric - 1), edges) @ points

    corners = np.vstack((np.zeros(3), np.eye(3)))
    at = np.vstack((corners, corners[TET_EDGES].mean(axis=1)))
    h = 1e-6
    maps = [[(position(x + h * e) - position(x - h * e)) / (2 * h) for e in np.eye(3)] for x in at]
    found = node_jacobians(points, np.arange(10)[None])[0]
    np.testing.assert_allclose(found, np.linalg.det(np.array(maps)), rtol=1e-7)


def test_figures_of_a_box() -> None:
    mesh = box((2.0, 2.0, 2.0), (2, 2, 2))
    figures = mesh_quality(mesh, exact_volume=10.0).as_dict()
    assert figures["tets"] == 48
    assert figures["nodes"] == 125
    assert figures["volume_mm3"] == pytest.approx(8.0)
    assert figures["volume_error"] == pytest.approx(-0.2)
    assert figures["scaled_jacobian_min"] == pytest.approx(1 / np.sqrt(3))
    assert mesh_quality(mesh).volume_error is None


def test_curved_sphere_has_no_inverted_elements() -> None:
    mesh = sphere_octant(1.0, 2.0, (1, 1))
    assert node_jacobians(mesh.points, mesh.tets).min() > 0
