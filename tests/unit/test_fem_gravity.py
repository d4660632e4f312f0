"""Gravity: weight, moments, derivatives, and a tangent that costs nothing."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import elastomer, linearized, random_displacement

from pagd.fem.assembly import Assembly, State
from pagd.fem.gravity import Gravity
from pagd.fem.solid import TaylorHoodSolid
from pagd.mesh.primitives import box, sphere_octant
from pagd.mesh.types import Mesh

DENSITY = 1130.0
ACCELERATION = np.array([1.0, -2.0, -9.81])


def block() -> Mesh:
    return box((4.0, 3.0, 2.0), (2, 2, 1))


def gravity(mesh: Mesh) -> Gravity:
    return Gravity(mesh.points, mesh.tets, DENSITY, ACCELERATION)


def test_the_weight_of_a_litre() -> None:
    """A cube of 100 mm of water weighs 9.81 N."""
    mesh = box((100.0, 100.0, 100.0), (1, 1, 1))
    weight = Gravity(mesh.points, mesh.tets, 1000.0, (0, 0, -9.81)).weight
    np.testing.assert_allclose(weight, [0, 0, -9.81], rtol=1e-12)


def test_forces_and_moments_are_those_of_the_weight_in_the_centre() -> None:
    mesh = block()
    term = gravity(mesh)
    forces = -linearized(term, np.zeros(3 * len(mesh.points)))[1].reshape(-1, 3)
    expected = 24.0 * DENSITY * 1e-9 * ACCELERATION
    np.testing.assert_allclose(forces.sum(axis=0), expected, rtol=1e-12)
    np.testing.assert_allclose(term.weight, expected, rtol=1e-12)
    moment = np.cross(mesh.points, forces).sum(axis=0)
    np.testing.assert_allclose(moment, np.cross([2.0, 1.5, 1.0], expected), rtol=1e-10)


def test_the_weight_of_curved_elements() -> None:
    """A thick octant; its elements are parabolas where the sphere is round."""
    mesh = sphere_octant(10.0, 15.0, (2, 6))
    volume = np.pi / 6 * (15.0**3 - 10.0**3)
    expected = volume * DENSITY * 1e-9 * ACCELERATION
    np.testing.assert_allclose(gravity(mesh).weight, expected, rtol=5e-4)


def test_the_energy_of_a_quadratic_field_is_exact() -> None:
    """u = (x², 0, x z) on the box 4 × 3 × 2: ∫u dV = (128, 0, 48)."""
    mesh = block()
    x, _, z = mesh.points.T
    state = np.column_stack([x**2, 0 * x, x * z]).ravel()
    expected = -DENSITY * 1e-9 * (128 * ACCELERATION[0] + 48 * ACCELERATION[2])
    assert gravity(mesh).energy(state, 0.0) == pytest.approx(expected, rel=1e-12)


def test_derivatives() -> None:
    mesh = block()
    term, state = gravity(mesh), random_displacement(mesh.points, 0.5)
    energy, forces, tangent = linearized(term, state, load=0.3)
    assert energy == term.energy(state, 0.0) != 0
    step = random_displacement(mesh.points, 1.0, seed=2)
    change = term.energy(state + step, 0.0) - energy
    assert forces @ step == pytest.approx(change, rel=1e-9)
    assert not tangent.any()


def test_a_share_of_it() -> None:
    mesh = block()
    term, state = gravity(mesh), random_displacement(mesh.points, 0.5)
    energy, forces, _ = linearized(term, state)
    term.share = 0.25
    part = linearized(term, state)
    assert part[0] == pytest.approx(energy / 4, rel=1e-12)
    np.testing.assert_allclose(part[1], forces / 4, rtol=1e-12)


def test_it_adds_nothing_to_the_matrix() -> None:
    mesh = block()
    size = 3 * len(mesh.points)
    solid = TaylorHoodSolid(mesh.points, mesh.tets, elastomer("yeoh"), size)
    size += solid.pressures
    held = np.zeros(size, np.bool_)
    held[3 * mesh.nodes_of("x0")] = True
    alone, both = Assembly([solid], size, held), Assembly([solid, gravity(mesh)], size, held)
    assert both.pattern.entries == alone.pattern.entries
    state = random_displacement(mesh.points, 0.01)
    state = np.concatenate([state, np.zeros(solid.pressures)])
    values = [a.linearize(State(0.0, state, a.at_rest().internal)) for a in (alone, both)]
    np.testing.assert_array_equal(values[0][2], values[1][2])
    difference = (values[1][1] - values[0][1])[: 3 * len(mesh.points)].reshape(-1, 3)
    np.testing.assert_allclose(-difference.sum(axis=0), gravity(mesh).weight, rtol=1e-9)


def test_directions_without_pull_have_no_elements() -> None:
    mesh = block()
    down = Gravity(mesh.points, mesh.tets, DENSITY, (0.0, 0.0, -9.81))
    assert len(down.dofs) == len(mesh.points)
    assert (down.dofs % 3 == 2).all()
    assert len(Gravity(mesh.points, mesh.tets, DENSITY, (0.0, 0.0, 0.0)).dofs) == 0
