"""Contact between faces: gaps, derivatives, balance of forces, and two blocks pressed together."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fem_checks import check_derivatives, linearized, moved, residual
from numpy.typing import NDArray

from pagd.fem.contact import ContactLaw, FaceContact
from pagd.fem.contact_kernels import pressure_law, project
from pagd.fem.contact_pressures import inverse_law, pressure_near
from pagd.fem.term import ElementSystem

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def patch(height: float, up: bool, shift: float = 0.0) -> tuple[FloatArray, IntArray]:
    """A square of 4 mm of eight six-node faces at z = height, that looks up or down."""
    steps = np.linspace(0, 4, 5) + shift
    points = np.array([[x, y, height] for x in steps for y in steps])
    faces = []
    for i, j in ((0, 0), (0, 2), (2, 0), (2, 2)):
        a, b, c, d = (i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)
        for corners in ((a, b, c), (a, c, d)):
            turned = corners if up else corners[::-1]
            middles = [
                ((p[0] + q[0]) // 2, (p[1] + q[1]) // 2)
                for p, q in zip(turned, (*turned[1:], turned[0]), strict=True)
            ]
            faces.append([5 * p + q for p, q in (*turned, *middles)])
    return points, np.array(faces)


def facing(gap: float, law: ContactLaw) -> tuple[FaceContact, FloatArray]:
    """Contact of a lower patch (master) with an upper one (slave), and their points."""
    lower, masters = patch(0.0, up=True)
    upper, slaves = patch(gap, up=False, shift=0.3)
    points = np.vstack([lower, upper])
    return FaceContact(points, slaves + len(lower), masters, law), points


def waves(points: FloatArray, size: float = 0.05, seed: int = 0) -> FloatArray:
    return size * np.random.default_rng(seed).normal(size=points.size)


@pytest.mark.parametrize(("width", "step"), [(0.02, 1e-6), (0.3, 1e-5)])
def test_derivatives_on_curved_faces(width: float, step: float) -> None:
    law = ContactLaw(stiffness=5.0, width=width, reach=1.0)
    contact, points = facing(-0.03, law)
    unknowns = waves(points)
    assert contact.update(unknowns)
    check_derivatives(contact, unknowns, step=step)


def test_the_first_tangent_of_deep_faces_has_little_of_the_turning_normal() -> None:
    """With all the pressure the tangent has negative eigenvalues; at first it has a part of it."""
    contact, points = facing(-0.4, ContactLaw(reach=1.0))
    unknowns = waves(points)
    contact.update(unknowns)
    system = ElementSystem.of(contact.dofs)
    contact.linearize(unknowns, contact.internal_at_rest(), 0.0, system)
    full = np.zeros((len(contact.dofs), 36, 36))
    rows, columns = np.triu_indices(36)
    full[:, rows, columns] = full[:, columns, rows] = system.tangent
    first = np.zeros((unknowns.size, unknowns.size))
    np.add.at(first, (contact.dofs[:, :, None], contact.dofs[:, None, :]), full)
    last = linearized(contact, unknowns, 0.0)[2]
    lowest, converged = (np.linalg.eigvalsh(matrix)[0] for matrix in (first, last))
    assert converged < -0.1
    assert converged < 20 * lowest < 0


def test_too_deep_is_deeper_than_is_trusted() -> None:
    for gap, excess in ((0.0, 0.0), (-0.05, 0.0), (-0.07, 0.01)):
        contact, points = facing(gap, ContactLaw(trusted=0.06))
        contact.update(np.zeros(points.size))
        assert contact.excess == pytest.approx(excess)


def test_a_point_keeps_its_face_a_little_beyond_the_edge() -> None:
    """Over a ridge along x = 2 the near point stays with the first face until the next search."""
    corners = np.array([[0, -2, 0], [2, 0, 0], [0, 2, 0], [4, 0, -2.0]])
    first, second = (0, 1, 2), (1, 3, 2)
    slave = np.array([[1.4, 0.1, 0.1], [1.4, 0.2, 0.1], [1.5, 0.1, 0.1]])
    nodes, faces = [], []
    for triangle in (corners[list(first)], corners[list(second)], slave):
        middles = [(triangle[i] + triangle[(i + 1) % 3]) / 2 for i in range(3)]
        faces.append(len(nodes) + np.arange(6))
        nodes += [*triangle, *middles]
    points = np.array(nodes)
    contact = FaceContact(points, np.array(faces[2:]), np.array(faces[:2]), ContactLaw())
    contact.update(np.zeros(points.size))
    assert contact.smallest_gap == pytest.approx(0.1)
    over = np.zeros(points.shape)
    over[12:, 0] = 0.6
    contact.energy(over.ravel(), 0.0)
    assert contact.smallest_gap == pytest.approx(0.1)
    contact.update(over.ravel())
    assert contact.smallest_gap > 0.11


def test_a_rigid_motion_changes_nothing() -> None:
    contact, points = facing(-0.03, ContactLaw(width=0.3, reach=1.0))
    unknowns = waves(points)
    contact.update(unknowns)
    before = contact.energy(unknowns, 0.0)
    contact.update(moved(points, unknowns))
    assert before > 0
    assert contact.energy(moved(points, unknowns), 0.0) == pytest.approx(before, rel=1e-9)


def test_forces_and_moments_are_in_balance() -> None:
    contact, points = facing(-0.03, ContactLaw(width=0.3, reach=1.0))
    unknowns = waves(points)
    contact.update(unknowns)
    forces = residual(contact, unknowns).reshape(-1, 3)
    places = points + unknowns.reshape(-1, 3)
    assert np.abs(forces).max() > 1e-3
    np.testing.assert_allclose(forces.sum(axis=0), 0, atol=1e-12)
    np.testing.assert_allclose(np.cross(places, forces).sum(axis=0), 0, atol=1e-10)


def test_flat_faces_press_by_the_penalty_times_the_area() -> None:
    """Penetration 0.1 mm everywhere: the pressure is 20 MPa/mm · 0.1 mm on 3.7² mm² of overlap."""
    law = ContactLaw(stiffness=20.0, width=0.02, reach=0.5)
    contact, points = facing(-0.1, law)
    unknowns = np.zeros(points.size)
    contact.update(unknowns)
    force = residual(contact, unknowns).reshape(-1, 3)[25:, 2].sum()
    # Points of the slave beyond the edge of the master press nothing: an integral by points.
    assert force == pytest.approx(-2.0 * 3.7**2, rel=0.1)
    assert contact.smallest_gap == pytest.approx(-0.1)


def test_nothing_presses_beyond_the_width() -> None:
    contact, points = facing(0.05, ContactLaw(width=0.04, reach=0.5))
    unknowns = np.zeros(points.size)
    assert contact.update(unknowns)  # near enough to be coupled
    assert contact.energy(unknowns, 0.0) == 0.0
    assert contact.smallest_gap == pytest.approx(0.05)


def test_faces_out_of_reach_are_not_coupled() -> None:
    contact, points = facing(1.0, ContactLaw(reach=0.5))
    assert not contact.update(np.zeros(points.size))
    assert len(contact.dofs) == 0
    assert contact.energy(np.zeros(points.size), 0.0) == 0.0


def test_the_far_side_of_a_wall_is_no_penetration() -> None:
    contact, points = facing(-2.0, ContactLaw(deepest=0.75))
    contact.update(np.zeros(points.size))
    assert contact.smallest_gap == math.inf


def test_the_gap_at_rest_needs_no_reach() -> None:
    for gap in (0.3, 3.0, 30.0):
        contact, points = facing(gap, ContactLaw(reach=0.5))
        assert contact.gap_at_rest() == pytest.approx(gap)
        # Nothing of it is left: the contact is as new.
        assert contact.smallest_gap == math.inf
        assert contact.energy(np.zeros(points.size), 0.0) == 0.0
    lower, masters = patch(0.0, up=True)
    upper, slaves = patch(200.0, up=False)
    apart = FaceContact(np.vstack([lower, upper]), slaves + len(lower), masters)
    assert apart.gap_at_rest() == math.inf


def test_a_jump_through_a_wall_is_too_deep() -> None:
    """From 0.3 mm before the other faces to 2 mm behind them, in a guess or a correction."""
    contact, points = facing(0.3, ContactLaw())
    contact.update(np.zeros(points.size))
    through = np.zeros(points.shape)
    through[25:, 2] = -2.3
    assert contact.energy(through.ravel(), 0.0) > 0
    assert contact.excess == pytest.approx(2.0 - ContactLaw().trusted)
    assert not contact.update(through.ravel())
    assert contact.excess == pytest.approx(2.0 - ContactLaw().trusted)
    contact.update(np.zeros(points.size))
    assert contact.smallest_gap == pytest.approx(0.3)


def test_pairs_only_grow_and_keep_what_they_were() -> None:
    contact, points = facing(0.3, ContactLaw(reach=0.5))
    unknowns = np.zeros(points.size)
    contact.update(unknowns)
    first = contact.dofs.copy()
    assert not contact.update(unknowns)
    shifted = unknowns.reshape(-1, 3).copy()
    shifted[25:, 0] += 1.5
    assert contact.update(shifted.ravel())
    both = {tuple(row) for row in contact.dofs}
    assert {tuple(row) for row in first} < both


def test_a_point_without_its_pair_is_noticed() -> None:
    contact, points = facing(0.6, ContactLaw(reach=0.5, width=0.02))
    unknowns = np.zeros(points.size)
    contact.update(unknowns)
    contact.energy(unknowns, 0.0)
    assert contact.is_complete
    closed = unknowns.reshape(-1, 3).copy()
    closed[25:, 2] -= 0.62
    contact.energy(closed.ravel(), 0.0)
    assert not contact.is_complete
    contact.update(closed.ravel())
    contact.energy(closed.ravel(), 0.0)
    assert contact.is_complete


def test_the_pressure_has_no_kink() -> None:
    stiffness, width, step = 20.0, 0.04, 1e-7
    for gap in (-0.1, -width, -0.01, 0.0, 0.02, width, 0.1):
        energy, slope, curvature = pressure_law(gap, stiffness, width)
        ahead, behind = (pressure_law(gap + s, stiffness, width) for s in (step, -step))
        assert (ahead[0] - behind[0]) / (2 * step) == pytest.approx(slope, abs=1e-6)
        assert abs(ahead[2] - curvature) < 1e-3
        assert energy >= 0
        assert slope <= 0
    assert pressure_law(-0.1, stiffness, width)[1] == pytest.approx(-2.0)


@pytest.mark.parametrize("pressure", [1e-4, 0.02, 0.5, 0.6, 3.0])
def test_the_inverse_of_the_law(pressure: float) -> None:
    stiffness, width = 10.0, 0.06
    closing, slope = inverse_law(pressure, stiffness, width)
    _, force, curvature = pressure_law(width - closing, stiffness, width)
    assert -force == pytest.approx(pressure, rel=1e-12)
    assert slope == pytest.approx(curvature, rel=1e-12)


def test_iterated_pressures_come_to_that_of_the_law() -> None:
    """At a gap that stays; from little, from much, and from a point that has just come near."""
    law = ContactLaw()
    for gap in (0.05, 0.0, -0.1):
        wanted = -pressure_law(gap, law.stiffness, law.width)[1]
        for iterated in (0.0, 1e-3, 5.0):
            for _ in range(30):
                iterated = pressure_near(
                    iterated, gap, law.stiffness, law.width, law.first_pressure
                )[0]
            assert iterated == pytest.approx(wanted, rel=1e-9)


def test_a_point_that_opens_has_no_pressure() -> None:
    law = ContactLaw()
    known = (law.stiffness, law.width, law.first_pressure)
    assert pressure_near(0.0, law.width, *known) == (0.0, 0.0, 0.0)
    assert pressure_near(0.01, 1.0, *known) == (0.0, 0.0, 0.0)


def test_a_correction_takes_the_pressures_along() -> None:
    """To that of the law at the gap it leads to, as far as the inverse law is linear."""
    contact, points = facing(-0.1, ContactLaw(width=0.02))
    unknowns, deeper = np.zeros(points.size), np.zeros(points.shape)
    contact.update(unknowns)
    internal = contact.internal_at_rest()
    for _ in range(30):
        contact.linearize(unknowns, internal, 0.0, ElementSystem.of(contact.dofs))
        internal = contact.advance(unknowns)
    deeper[25:, 2] = -0.01
    after = contact.advance(deeper.ravel())
    law = contact.law
    assert internal.max() == pytest.approx(0.1 * law.stiffness, rel=1e-9)
    np.testing.assert_allclose(after[internal > 0], 0.11 * law.stiffness, rtol=1e-9)


def test_a_residual_near_a_state_is_that_of_the_state_and_its_tangent_further_on() -> None:
    """At the state itself; and at one near by, with the slopes k of the first."""
    contact, points = facing(-0.01, ContactLaw())
    unknowns, nearer = np.zeros(points.size), np.zeros(points.shape)
    contact.update(unknowns)
    internal, system = contact.internal_at_rest(), ElementSystem.of(contact.dofs)
    for _ in range(30):
        contact.linearize(unknowns, internal, 0.0, system)
        internal = contact.advance(unknowns)
    contact.linearize(unknowns, internal, 0.0, system)
    first = system.residual.copy()
    near = np.zeros_like(first)
    contact.residual_near(unknowns, internal, 0.0, near)
    np.testing.assert_allclose(near, first, rtol=1e-12)
    assert np.abs(first).max() > 1e-3
    # Flat and parallel: only the gap changes, and the pressure by k times as much.
    slope = -pressure_law(-0.01, contact.law.stiffness, contact.law.width)[1]
    stiffness = pressure_law(-0.01, contact.law.stiffness, contact.law.width)[2]
    nearer[25:, 2] = -0.002
    contact.residual_near(nearer.ravel(), internal, 0.0, near)
    np.testing.assert_allclose(near, first * (1 + 0.002 * stiffness / slope), rtol=1e-9)


def test_the_closest_point_on_a_curved_face() -> None:
    """A face bent to z = x²/10: the closest point to one above it has its normal through it."""
    corners = np.array([[0, 0], [4, 0], [0, 4]], float)
    flat = np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])
    positions = np.column_stack([flat, flat[:, 0] ** 2 / 10])
    x = 1.3
    normal = np.array([-x / 5, 0, 1]) / math.hypot(x / 5, 1)
    point = np.array([x, 0.7, x**2 / 10]) + 0.25 * normal
    parameters, work = np.empty(2), np.empty((10, 6))
    gap = project(point, positions, np.arange(6), parameters, work)
    assert gap == pytest.approx(0.25, rel=1e-12)
    np.testing.assert_allclose(parameters, [x / 4, 0.7 / 4], rtol=1e-9)


def test_a_point_beside_the_face_has_no_gap() -> None:
    positions = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], float)
    parameters, work = np.empty(2), np.empty((10, 6))
    outside = project(np.array([3.0, 3.0, 0.1]), positions, np.arange(6), parameters, work)
    assert outside == math.inf
