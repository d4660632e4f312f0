"""The follower pressure: derivatives, volumes, balance of forces."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import check_derivatives, linearized, moved, random_displacement

from pagd.fem.follower_pressure import EQUAL_WEIGHTS, FollowerPressure
from pagd.mesh.blocks import block_faces
from pagd.mesh.primitives import cylinder_quarter, hollow_block, sphere_octant
from pagd.mesh.types import Mesh

LOAD = 0.37


def block() -> Mesh:
    """A block of 3 × 3 × 3 cells with a void of one cell, 1 × 2 × 1.5 mm."""
    return hollow_block((3.0, 6.0, 4.5), (3, 3, 3), ((1, 2), (1, 2), (1, 2)), 1)


def pressure(mesh: Mesh, weights: tuple[float, float, float] = EQUAL_WEIGHTS) -> FollowerPressure:
    return FollowerPressure(mesh.points, mesh.surfaces["cavity"], weights)


@pytest.mark.parametrize("weights", [EQUAL_WEIGHTS, (0.5, 0.5, 0.0), (0.0, 1.0, 0.0)])
def test_derivatives(weights: tuple[float, float, float]) -> None:
    mesh = block()
    check_derivatives(pressure(mesh, weights), random_displacement(mesh.points, 0.5), LOAD)


def test_derivatives_of_an_open_curved_surface() -> None:
    mesh = sphere_octant(2.0, 3.0, (1, 2))
    check_derivatives(pressure(mesh), random_displacement(mesh.points, 0.5), LOAD)


def bricks() -> tuple[Mesh, FollowerPressure]:
    """The same block of hexahedra, and the pressure on their faces of nine nodes."""
    mesh = hollow_block((3.0, 6.0, 4.5), (3, 3, 3), ((1, 2), (1, 2), (1, 2)), 1, blocks="hexahedra")
    four, three = block_faces(mesh, "cavity")
    return mesh, FollowerPressure(mesh.points, three, quadrilaterals=four)


def test_derivatives_on_nine_nodes() -> None:
    mesh, term = bricks()
    check_derivatives(term, random_displacement(mesh.points, 0.5), LOAD)


def test_a_face_of_nine_nodes_bulges_by_its_middle() -> None:
    """4/9 of its area and height, as ∫∫ 16 x (1 − x) y (1 − y); by two triangles a third."""
    mesh, term = bricks()
    four, _ = block_faces(mesh, "cavity")
    middle = four[0, 4]
    corners = mesh.points[four[0, [0, 2, 6]]]
    normal = np.cross(corners[2] - corners[0], corners[1] - corners[0])
    state = np.zeros_like(mesh.points)
    state[middle] = -0.1 * normal / np.linalg.norm(normal)
    growth = term.volume(state.ravel()) - 3.0
    assert growth == pytest.approx(4 / 9 * 0.1 * np.linalg.norm(normal), rel=1e-9)
    by_triangles = pressure(mesh).volume(state.ravel()) - 3.0
    assert by_triangles == pytest.approx(1 / 3 * 0.1 * np.linalg.norm(normal), rel=1e-9)


def test_volume_of_the_void() -> None:
    mesh = block()
    term, rest = pressure(mesh), np.zeros(3 * len(mesh.points))
    assert term.volume(rest) == pytest.approx(1.0 * 2.0 * 1.5, rel=1e-12)
    assert term.energy(rest, LOAD) == pytest.approx(-LOAD * 3.0, rel=1e-12)


def test_volume_scales_with_the_determinant() -> None:
    mesh = block()
    gradient = np.array([[1.3, 0.4, -0.2], [0.1, 0.8, 0.3], [-0.3, 0.2, 1.1]])
    state = (mesh.points @ (gradient - np.eye(3)).T).ravel()
    assert pressure(mesh).volume(state) == pytest.approx(3.0 * np.linalg.det(gradient), rel=1e-12)


def test_volume_of_a_closed_surface_does_not_depend_on_the_weights() -> None:
    mesh = block()
    state = random_displacement(mesh.points, 0.5)
    volumes = [pressure(mesh, tuple(w)).volume(state) for w in np.eye(3)]
    np.testing.assert_allclose(volumes, pressure(mesh).volume(state), rtol=1e-12)


def test_volumes_open_at_planes() -> None:
    """An octant of a sphere through the origin; a quarter cylinder with no weight on z."""
    sphere = sphere_octant(10.0, 15.0, (1, 6))
    found = pressure(sphere).volume(np.zeros(3 * len(sphere.points)))
    assert found == pytest.approx(4 / 3 * np.pi * 10**3 / 8, rel=5e-4)
    tube = cylinder_quarter(10.0, 15.0, 2.0, (1, 6, 1))
    lifted = np.tile([0.0, 0.0, 5.0], len(tube.points))  # away from the origin
    found = pressure(tube, (0.5, 0.5, 0.0)).volume(lifted)
    assert found == pytest.approx(np.pi / 4 * 10**2 * 2, rel=1e-4)


def test_volume_and_forces_under_rigid_motion() -> None:
    mesh = block()
    term, state = pressure(mesh), random_displacement(mesh.points, 0.5)
    assert term.volume(moved(mesh.points, state)) == pytest.approx(term.volume(state), rel=1e-10)


def test_pressure_on_a_closed_surface_has_no_resultant() -> None:
    """Σ f = 0 and Σ x × f = 0, whatever the shape."""
    mesh = block()
    state = random_displacement(mesh.points, 0.5)
    forces = linearized(pressure(mesh), state, LOAD)[1].reshape(-1, 3)
    places = mesh.points + state.reshape(-1, 3)
    size = np.abs(forces).max()
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-12 * size)
    np.testing.assert_allclose(np.cross(places, forces).sum(axis=0), 0.0, atol=1e-11 * size)


def test_pressure_pushes_the_walls_apart() -> None:
    """The load −dE/du on the upper wall of the void points up, with area times pressure."""
    mesh = block()
    forces = -linearized(pressure(mesh), np.zeros(3 * len(mesh.points)), LOAD)[1].reshape(-1, 3)
    upper = np.isclose(mesh.points[:, 2], 3.0)
    assert forces[upper, 2].sum() == pytest.approx(LOAD * 1.0 * 2.0, rel=1e-12)


def test_no_load_without_pressure() -> None:
    mesh = block()
    energy, residual, tangent = linearized(pressure(mesh), random_displacement(mesh.points, 0.5))
    assert energy == 0
    assert not residual.any()
    assert not tangent.any()


def test_half_of_a_symmetric_cavity_has_half_the_volume() -> None:
    half = hollow_block((3.0, 3.0, 4.5), (3, 3, 3), ((1, 2), (0, 1), (1, 2)), 1, half=True)
    assert pressure(half).volume(np.zeros(3 * len(half.points))) == pytest.approx(1.5, rel=1e-12)
