"""The membrane: derivatives, objectivity, known states, and no locking in bending."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import (
    PAPER,
    check_derivatives,
    consistent_internal,
    linearized,
    moved,
    random_displacement,
)
from numpy.typing import NDArray

from pagd.fem.membrane import Membrane
from pagd.fem.term import ElementSystem
from pagd.mesh.primitives import box
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]

SIZE = (6.0, 4.0, 2.0)


def sheet_in_a_box() -> Mesh:
    """A box with a flat sheet of eight faces in the middle."""
    return box(SIZE, (2, 2, 2), paper_layer=1)


def membrane(mesh: Mesh) -> Membrane:
    return Membrane(mesh.points, mesh.surfaces["paper"], PAPER)


def stretched(mesh: Mesh, gradient: FloatArray) -> FloatArray:
    return np.asarray((mesh.points @ (gradient - np.eye(3)).T).ravel())


def test_derivatives() -> None:
    mesh = sheet_in_a_box()
    check_derivatives(membrane(mesh), random_displacement(mesh.points, 0.3))


def test_derivatives_of_a_curved_sheet() -> None:
    mesh = sheet_in_a_box()
    points = mesh.points + 0.2 * np.sin(mesh.points[:, :1]) * [0, 0, 1]
    term = Membrane(points, mesh.surfaces["paper"], PAPER)
    check_derivatives(term, random_displacement(mesh.points, 0.3))


def test_energy_does_not_change_under_rigid_motion() -> None:
    mesh = sheet_in_a_box()
    term, state = membrane(mesh), random_displacement(mesh.points, 0.3)
    energy = term.energy(state, 0.0)
    assert energy > 0
    assert term.energy(moved(mesh.points, state), 0.0) == pytest.approx(energy, rel=1e-11)


def test_no_force_in_a_rigidly_moved_sheet() -> None:
    mesh = sheet_in_a_box()
    energy, forces, _ = linearized(membrane(mesh), moved(mesh.points, np.zeros(mesh.points.size)))
    assert abs(energy) < 1e-20 * PAPER.membrane_stiffness
    np.testing.assert_allclose(forces, 0.0, atol=1e-10)


@pytest.mark.parametrize(
    "gradient",
    [
        np.diag([1.2, 1.0, 1.0]),
        np.diag([0.9, 1.3, 2.0]),
        np.array([[1.1, 0.3, 0.0], [-0.1, 0.9, 0.0], [0.4, -0.2, 1.0]]),
    ],
)
def test_homogeneous_states(gradient: FloatArray) -> None:
    """½ C (E_xx² + E_yy² + 2 ν E_xx E_yy + 2 (1 − ν) E_xy²) per area, C = E h/(1 − ν²)."""
    mesh = sheet_in_a_box()
    plane = gradient[:, :2]
    strain = (plane.T @ plane - np.eye(2)) / 2
    nu = PAPER.poisson_ratio
    density = strain[0, 0] ** 2 + strain[1, 1] ** 2 + 2 * nu * strain[0, 0] * strain[1, 1]
    density += 2 * (1 - nu) * strain[0, 1] ** 2
    exact = 0.5 * PAPER.youngs_modulus * PAPER.thickness / (1 - nu**2) * density
    found = membrane(mesh).energy(stretched(mesh, gradient), 0.0)
    assert found == pytest.approx(exact * SIZE[0] * SIZE[1], rel=1e-12)


def test_small_strains_are_those_of_the_quadratic_displacement() -> None:
    """u = a (x², 0): the energy ½ C ∫ (2 a x)² dA, up to third order in a.

    The interpolated strain is linear, as that of a quadratic displacement is.
    """
    mesh = sheet_in_a_box()
    size = 1e-6
    state = np.zeros_like(mesh.points)
    state[:, 0] = size * mesh.points[:, 0] ** 2
    exact = 0.5 * PAPER.membrane_stiffness * 4 * size**2 * SIZE[0] ** 3 / 3 * SIZE[1]
    assert membrane(mesh).energy(state.ravel(), 0.0) == pytest.approx(exact, rel=1e-4)


def test_flat_sheet_has_no_stiffness_out_of_plane_and_no_other_mechanism() -> None:
    """Undeformed: three rigid motions in the plane, and every motion out of it."""
    mesh = sheet_in_a_box()
    nodes = mesh.nodes_of("paper")
    tangent = linearized(membrane(mesh), np.zeros(mesh.points.size))[2]
    in_plane = np.sort((3 * nodes[:, None] + [0, 1]).ravel())
    values = np.linalg.eigvalsh(tangent[np.ix_(in_plane, in_plane)])
    assert (np.abs(values[:3]) < 1e-9 * values[-1]).all()
    assert values[3] > 1e-4 * values[-1]
    np.testing.assert_allclose(tangent[3 * nodes + 2], 0.0, atol=1e-12)


def test_a_face_that_bends_to_a_parabola_is_not_stretched() -> None:
    """Nodes at equal distances on an arc of radius 5, faces 3 mm long (34°).

    A parabola through three of them has the same speed at the two Gauss points, and the arc is
    scaled so that it is one: then no fibre along x is stretched. The strain of the quadratic
    positions themselves is κ² (s² − h²/12)/2 along a face, its energy ½ C A κ⁴ h⁴/720.
    """
    mesh = sheet_in_a_box()
    radius, length = 5.0, SIZE[0] / 2
    angle = mesh.points[:, 0] / radius
    half = length / (2 * radius)
    secant, sag = radius * np.sin(half), radius * (1 - np.cos(half))
    speed = np.hypot(2 * secant, 4 * sag * 3**-0.5) / length
    places = np.column_stack(
        [radius * np.sin(angle), mesh.points[:, 1], radius * (1 - np.cos(angle))]
    )
    places[:, [0, 2]] /= speed
    found = membrane(mesh).energy((places - mesh.points).ravel(), 0.0)
    locked = 0.5 * PAPER.membrane_stiffness * SIZE[0] * SIZE[1] * (length / radius) ** 4 / 720
    assert found < 1e-20 * locked


def test_stored_forces_enter_only_the_geometric_stiffness() -> None:
    mesh = sheet_in_a_box()
    term, state = membrane(mesh), random_displacement(mesh.points, 0.3)
    first, second = ElementSystem.of(term.dofs), ElementSystem.of(term.dofs)
    stored = consistent_internal(term, state, 0.0)
    energy = term.linearize(state, stored, 0.0, first)
    assert term.linearize(state, 2 * stored, 0.0, second) == energy
    np.testing.assert_array_equal(first.residual, second.residual)
    without = ElementSystem.of(term.dofs)
    term.linearize(state, 0 * stored, 0.0, without)
    np.testing.assert_allclose(
        second.tangent - first.tangent, first.tangent - without.tangent, atol=1e-9
    )


def test_forces_advance_along_their_tangent() -> None:
    """The forces after a small correction are the consistent ones up to second order."""
    mesh = sheet_in_a_box()
    term, state = membrane(mesh), random_displacement(mesh.points, 0.3)
    correction = random_displacement(mesh.points, 1.0, seed=8)
    errors = []
    for size in (1e-3, 1e-4):
        exact = consistent_internal(term, state + size * correction, 0.0)
        consistent_internal(term, state, 0.0)
        errors.append(np.abs(term.advance(size * correction) - exact).max())
    assert errors[1] == pytest.approx(1e-2 * errors[0], rel=0.05)
