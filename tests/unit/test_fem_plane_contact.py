"""Contact with a rigid plane: derivatives, resultant, what is pushed and what is not."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import ROTATION, SHIFT, check_derivatives, linearized, moved, random_displacement
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.fem.contact import ContactLaw
from pagd.fem.contact_kernels import pressure_law
from pagd.fem.plane_contact import PlaneContact
from pagd.mesh.primitives import box, sphere_octant
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]

SOFT = ContactLaw(stiffness=5.0, width=0.3)
UP = np.array([0.0, 0.0, 1.0])


def block() -> Mesh:
    """A box of 4 × 3 × 2 mm; its underside, at z = 0, has an area of 12 mm²."""
    return box((4.0, 3.0, 2.0), (2, 2, 1))


def contact(mesh: Mesh, height: float, law: ContactLaw = SOFT) -> PlaneContact:
    """Contact of the underside with a plane at a height."""
    return PlaneContact(mesh.points, mesh.surfaces["z0"], np.array([7.0, -3.0, height]), UP, law)


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, -2, 3), (-1, 0.2, 0.1)])
def test_derivatives_on_curved_faces(normal: tuple[float, ...]) -> None:
    mesh = block()
    faces = np.vstack([mesh.surfaces["z0"], mesh.surfaces["x1"]])
    middle = mesh.points[np.unique(faces)].mean(axis=0)
    term = PlaneContact(mesh.points, faces, middle, np.array(normal), SOFT)
    check_derivatives(term, random_displacement(mesh.points, 0.3), step=1e-6)


def test_a_uniform_gap_presses_by_the_law_times_the_area() -> None:
    mesh, rest = block(), np.zeros(3 * len(block().points))
    for gap in (-1.0, -0.1, 0.0, 0.2):
        term = contact(mesh, -gap)
        energy, slope, _ = pressure_law(gap, SOFT.stiffness, SOFT.width)
        assert term.energy(rest, 0.0) == pytest.approx(12 * energy, rel=1e-12)
        np.testing.assert_allclose(term.force(rest), [0, 0, -12 * slope], rtol=1e-12, atol=1e-12)
        assert term.smallest_gap == pytest.approx(gap, abs=1e-12)


def test_nothing_presses_beyond_the_width() -> None:
    term, rest = contact(block(), -0.31), np.zeros(3 * len(block().points))
    assert term.smallest_gap == np.inf
    assert term.energy(rest, 0.0) == 0.0
    assert not term.force(rest).any()
    assert term.smallest_gap == pytest.approx(0.31)


def test_a_body_that_leaves_is_let_go() -> None:
    mesh = block()
    term, state = contact(mesh, 0.1), np.zeros(3 * len(mesh.points))
    assert term.force(state)[2] > 0
    state[2::3] = 1.0
    _, forces, tangent = linearized(term, state)
    assert not forces.any()
    assert not tangent.any()


def test_the_force_is_the_derivative_by_a_shift() -> None:
    """A shift along the plane leaves the energy as it is; one along the normal takes −force."""
    mesh, step = block(), 1e-6
    term, state = contact(mesh, 0.1), random_displacement(mesh.points, 0.2)
    for i in range(3):
        shift = np.zeros_like(state)
        shift[i::3] = step
        slope = (term.energy(state + shift, 0.0) - term.energy(state - shift, 0.0)) / (2 * step)
        assert term.force(state)[i] == pytest.approx(-slope, rel=1e-6, abs=1e-8)


def test_body_and_plane_may_be_moved_together() -> None:
    mesh = block()
    here, state = contact(mesh, 0.1), random_displacement(mesh.points, 0.2)
    there = PlaneContact(
        mesh.points,
        mesh.surfaces["z0"],
        ROTATION @ here.origin + SHIFT,
        5 * ROTATION @ UP,
        SOFT,
    )
    turned = moved(mesh.points, state)
    assert there.energy(turned, 0.0) == pytest.approx(here.energy(state, 0.0), rel=1e-9)
    np.testing.assert_allclose(there.force(turned), ROTATION @ here.force(state), rtol=1e-9)


def test_areas_of_curved_faces() -> None:
    """An octant of a sphere, all of it below the plane z = 3.5: its surface has z = 1.5 on average.

    The gap is linear in z and the penalty linear in the gap, so that the mean gives the force.
    """
    mesh = sphere_octant(2.0, 3.0, (1, 6))
    law = ContactLaw(stiffness=2.0, width=0.1)
    term = PlaneContact(mesh.points, mesh.surfaces["outer"], np.array([0, 0, 3.5]), UP, law)
    force = term.force(np.zeros(3 * len(mesh.points)))
    area = np.pi / 2 * 3.0**2
    np.testing.assert_allclose(force, [0, 0, 2.0 * (3.5 - 1.5) * area], rtol=1e-3, atol=1e-12)


def test_a_normal_without_direction_is_refused() -> None:
    mesh = block()
    with pytest.raises(InputError, match=r"normal of the plane is \[0\.0, 0\.0, 0\.0\]"):
        PlaneContact(mesh.points, mesh.surfaces["z0"], np.zeros(3), np.zeros(3))
