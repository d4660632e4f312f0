"""Hexahedra and wedges with pressures of their own: derivatives, patch test, rigid motion."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import (
    LAWS,
    check_derivatives,
    consistent_internal,
    elastomer,
    linearized,
    moved,
    random_displacement,
)
from numpy.typing import NDArray

from pagd.fem.assembly import Assembly, State
from pagd.fem.cells import CELLS, reference_geometry
from pagd.fem.fields import strains
from pagd.fem.solid import ElementPressureSolid

FloatArray = NDArray[np.float64]
each_block = pytest.mark.parametrize("count", [18, 27])


def block(count: int, noise: float = 0.03) -> tuple[FloatArray, ElementPressureSolid]:
    """One block of ``count`` nodes, 3 × 2 × 2.5 mm, distorted; its points and its solid."""
    places = CELLS[count].places
    # Of a wedge the first barycentric coordinate follows from the others.
    points = places[:, -3:] * [3.0, 2.0, 2.5]
    points += noise * np.random.default_rng(2).normal(size=points.shape)
    nodes = np.arange(count)[None, :]
    material = elastomer("yeoh", poisson_ratio=0.49)
    return points, ElementPressureSolid(points, nodes, material)


@each_block
def test_the_functions_are_one_at_their_node(count: int) -> None:
    cell = CELLS[count]
    np.testing.assert_allclose(cell.values(cell.places), np.eye(count), atol=1e-14)
    assert cell.rule.weights.sum() == pytest.approx(1.0, rel=1e-14)


@each_block
def test_derivatives_of_the_functions(count: int) -> None:
    cell, step = CELLS[count], 1e-6
    points = cell.rule.points
    for axis in range(3):
        ahead = np.zeros(points.shape[1])
        if count == 27 or axis == 2:
            ahead[axis if count == 27 else 3] = step
        else:
            ahead[[0, axis + 1]] = [-step, step]
        slopes = (cell.values(points + ahead) - cell.values(points - ahead)) / (2 * step)
        np.testing.assert_allclose(cell.derivatives(points)[:, :, axis], slopes, atol=1e-9)


@each_block
@pytest.mark.parametrize("law", LAWS)
def test_derivatives(count: int, law: str) -> None:
    points, solid = block(count)
    solid.material = elastomer(law, poisson_ratio=0.49)
    check_derivatives(solid, random_displacement(points, 0.3))


@each_block
def test_rigid_motion_leaves_the_energy(count: int) -> None:
    points, solid = block(count)
    state = random_displacement(points, 0.3)
    energy = solid.energy(state, 0.0)
    assert energy > 0
    assert solid.energy(moved(points, state), 0.0) == pytest.approx(energy, rel=1e-11)
    _, residual, _ = linearized(solid, moved(points, np.zeros_like(state)))
    np.testing.assert_allclose(residual, 0.0, atol=1e-11)


@each_block
def test_patch(count: int) -> None:
    """A linear displacement gives one stress: forces on inner nodes vanish, strain is uniform."""
    points, solid = block(count)
    gradient = np.array([[0.2, 0.1, 0.0], [-0.05, -0.1, 0.02], [0.03, 0.0, 0.05]])
    state = (points @ gradient.T).ravel()
    found = strains([solid], state, len(points))
    stretch = np.sqrt(np.linalg.eigvalsh((np.eye(3) + gradient) @ (np.eye(3) + gradient).T)[2])
    np.testing.assert_allclose(found.nodes, np.log(stretch), rtol=1e-12)
    assert found.largest == pytest.approx(np.log(stretch))
    forces = linearized(solid, state)[1].reshape(-1, 3)
    inside = {27: [13], 18: []}[count]
    np.testing.assert_allclose(forces[inside], 0.0, atol=1e-12 * np.abs(forces).max())
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-12 * np.abs(forces).max())


@each_block
def test_a_quadratic_displacement_is_exact(count: int) -> None:
    """Stretches of a state that is quadratic in x are those of its gradient, in a straight cell."""
    points, solid = block(count, noise=0.0)
    state = np.zeros_like(points)
    state[:, 0] = 0.05 * points[:, 0] ** 2
    cell = CELLS[count]
    x = cell.values(cell.rule.points) @ points[:, 0]
    found = strains([solid], state.ravel(), len(points))
    assert found.largest == pytest.approx(np.log(1 + 0.1 * x.max()), rel=1e-9)


@each_block
def test_internal_variables_advance_along_their_tangent(count: int) -> None:
    """Pressures and stresses after a small correction are consistent up to second order."""
    points, solid = block(count)
    state, correction = random_displacement(points, 0.3), random_displacement(points, 1.0, seed=8)
    errors = []
    for size in (1e-3, 1e-4):
        exact = consistent_internal(solid, state + size * correction, 0.0)
        consistent_internal(solid, state, 0.0)
        errors.append(np.abs(solid.advance(size * correction) - exact).max())
    assert errors[1] == pytest.approx(1e-2 * errors[0], rel=0.05)


@each_block
def test_corrections_with_an_old_tangent_lead_home(count: int) -> None:
    """From beside the state linearised, at rest, nearly incompressible: each one shrinks.

    Condensed by slopes of its own, the pressure would throw them off.
    """
    points, solid = block(count)
    solid = ElementPressureSolid(points, solid.nodes, elastomer("yeoh", poisson_ratio=0.49999))
    free = np.arange(27, points.size)
    assembly = Assembly([solid], points.size, np.arange(points.size) < 27)
    rest = State(0.0, np.zeros(points.size), (solid.internal_at_rest(),))
    tangent = linearized(solid, rest.unknowns)[2][np.ix_(free, free)]
    _, residual, _ = assembly.linearize(rest)
    np.testing.assert_allclose(assembly.residual_near(rest)[1], residual, atol=1e-14)
    aside = np.zeros(points.size)
    aside[free] = 0.02 * random_displacement(points, 1.0)[free]
    sizes = []
    state = State(0.0, aside, rest.internal)
    for _ in range(4):
        correction = np.zeros(points.size)
        correction[free] = -np.linalg.solve(tangent, assembly.residual_near(state)[1][free])
        state = assembly.advance(state, correction)
        sizes.append(np.abs(state.unknowns).max())
    assert sizes[0] < 0.1 * np.abs(aside).max()
    assert sizes[3] < 1e-3 * sizes[0]
    # The other residual, by the same tangent, leads away.
    away = -np.linalg.solve(tangent, linearized(solid, aside)[1][free])
    assert np.abs(aside[free] + away).max() > np.abs(aside).max()


def test_a_cell_turned_inside_out_is_refused() -> None:
    places = CELLS[27].places * [1, 1, -1]
    with pytest.raises(Exception, match="1 inverted hexahedra"):
        reference_geometry(places, np.arange(27)[None, :])
