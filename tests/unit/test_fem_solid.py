"""The two solid elements: derivatives, objectivity, volume, inadmissible states."""

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

from pagd.errors import InputError
from pagd.fem.solid import (
    ElementPressureSolid,
    TaylorHoodSolid,
    principal_stretches,
    reference_geometry,
)
from pagd.fem.term import ElementSystem
from pagd.materials import Elastomer
from pagd.mesh.primitives import box, cylinder_quarter
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]
Solid = TaylorHoodSolid | ElementPressureSolid

ELEMENTS = ["taylor_hood", "element_pressure"]
each_element = pytest.mark.parametrize("element", ELEMENTS)
each_law = pytest.mark.parametrize("law", LAWS)


def small_mesh() -> Mesh:
    """Six tetrahedra, a little distorted."""
    mesh = box((3.0, 2.0, 2.5), (1, 1, 1))
    noise = np.random.default_rng(2).normal(size=mesh.points.shape)
    return Mesh(points=mesh.points + 0.03 * noise, tets=mesh.tets, surfaces=mesh.surfaces)


def solid(element: str, mesh: Mesh, material: Elastomer) -> Solid:
    if element == "taylor_hood":
        return TaylorHoodSolid(mesh.points, mesh.tets, material, 3 * len(mesh.points))
    return ElementPressureSolid(mesh.points, mesh.tets, material)


def deformed(term: Solid, mesh: Mesh, size: float = 0.5) -> FloatArray:
    """A random state with random pressures."""
    unknowns = random_displacement(mesh.points, size)
    if isinstance(term, TaylorHoodSolid):
        pressures = np.random.default_rng(4).normal(scale=0.05, size=term.pressures)
        return np.append(unknowns, pressures)
    return unknowns


@each_element
@each_law
def test_derivatives(element: str, law: str) -> None:
    mesh = small_mesh()
    term = solid(element, mesh, elastomer(law, poisson_ratio=0.49))
    check_derivatives(term, deformed(term, mesh))


@each_element
def test_energy_does_not_change_under_rigid_motion(element: str) -> None:
    mesh = small_mesh()
    term = solid(element, mesh, elastomer("yeoh"))
    state = deformed(term, mesh)
    energy = term.energy(state, 0.0)
    assert energy != 0
    assert term.energy(moved(mesh.points, state), 0.0) == pytest.approx(energy, rel=1e-12)


@each_element
@each_law
def test_no_force_in_a_rigidly_moved_body(element: str, law: str) -> None:
    mesh = small_mesh()
    term = solid(element, mesh, elastomer(law))
    rest = np.zeros_like(deformed(term, mesh))
    energy, residual, _ = linearized(term, moved(mesh.points, rest))
    assert abs(energy) < 1e-12
    np.testing.assert_allclose(residual, 0.0, atol=1e-11)


@each_element
def test_element_forces_balance(element: str) -> None:
    """Σ f = 0 and Σ x × f = 0: internal forces do no work in a rigid motion."""
    mesh = small_mesh()
    term = solid(element, mesh, elastomer("yeoh"))
    state = deformed(term, mesh)
    count = 3 * len(mesh.points)
    forces = linearized(term, state)[1][:count].reshape(-1, 3)
    places = mesh.points + state[:count].reshape(-1, 3)
    size = np.abs(forces).max()
    np.testing.assert_allclose(forces.sum(axis=0), 0.0, atol=1e-12 * size)
    np.testing.assert_allclose(np.cross(places, forces).sum(axis=0), 0.0, atol=1e-11 * size)


def test_condensed_pressure_does_not_enter_the_residual() -> None:
    """With the pressure eliminated, the residual is that of the energy, whatever is stored."""
    mesh = small_mesh()
    term = solid("element_pressure", mesh, elastomer("yeoh"))
    state, system = deformed(term, mesh), ElementSystem.of(term.dofs)
    term.linearize(state, term.internal_at_rest(), 0.0, system)
    first = system.residual.copy()
    term.linearize(state, np.full_like(term.internal_at_rest(), 0.7), 0.0, system)
    np.testing.assert_allclose(system.residual, first, atol=1e-10 * np.abs(first).max())


def test_condensed_pressure_advances_along_its_tangent() -> None:
    """The pressure after a small correction is the consistent one up to second order."""
    mesh = small_mesh()
    term = solid("element_pressure", mesh, elastomer("yeoh", poisson_ratio=0.49))
    state = deformed(term, mesh)
    correction = random_displacement(mesh.points, 1.0, seed=8)
    errors = []
    for size in (1e-3, 1e-4):
        exact = consistent_internal(term, state + size * correction, 0.0)
        consistent_internal(term, state, 0.0)
        errors.append(np.abs(term.advance(size * correction) - exact).max())
    assert errors[1] == pytest.approx(1e-2 * errors[0], rel=0.05)


@each_element
def test_a_swollen_body_has_the_energy_of_its_bulk_modulus(element: str) -> None:
    """F = s I: W = V K/2 (J − 1)²; the pressure of P2–P1 is K (J − 1)."""
    mesh = small_mesh()
    material = elastomer("yeoh", poisson_ratio=0.45)
    term = solid(element, mesh, material)
    ratio = 1.05**3
    state = 0.05 * mesh.points.ravel()
    if isinstance(term, TaylorHoodSolid):
        pressure = material.bulk_modulus * (ratio - 1)
        state = np.append(state, np.full(term.pressures, pressure))
    exact = term.weights.sum() * material.bulk_modulus / 2 * (ratio - 1) ** 2
    assert term.energy(state, 0.0) == pytest.approx(exact, rel=1e-10)
    if isinstance(term, TaylorHoodSolid):
        residual = linearized(term, state)[1]
        np.testing.assert_allclose(residual[3 * len(mesh.points) :], 0.0, atol=1e-12)


@each_element
def test_inverted_elements_have_infinite_energy(element: str) -> None:
    mesh = small_mesh()
    term = solid(element, mesh, elastomer("yeoh"))
    state = np.zeros_like(deformed(term, mesh))
    state[0 : 3 * len(mesh.points) : 3] = -2 * mesh.points[:, 0]
    system = ElementSystem.of(term.dofs)
    assert term.linearize(state, term.internal_at_rest(), 0.0, system) == np.inf
    assert term.energy(state, 0.0) == np.inf


@each_element
def test_a_law_beyond_its_limit_has_infinite_energy(element: str) -> None:
    mesh = small_mesh()
    term = solid(element, mesh, elastomer("gent", mu=0.2, Jm=2.0))
    state = np.zeros_like(deformed(term, mesh))
    state[0 : 3 * len(mesh.points) : 3] = 3 * mesh.points[:, 0]
    system = ElementSystem.of(term.dofs)
    assert term.linearize(state, term.internal_at_rest(), 0.0, system) == np.inf


def test_inverted_meshes_are_refused() -> None:
    mesh = small_mesh()
    with pytest.raises(InputError, match="6 inverted"):
        reference_geometry(mesh.points * [1, 1, -1], mesh.tets)


def test_weights_add_up_to_the_volume() -> None:
    """A curved quarter of a cylinder: π/4 (B² − A²) h; eight elements leave 1e-5."""
    mesh = cylinder_quarter(10.0, 15.0, 2.0, (2, 8, 1))
    _, weights = reference_geometry(mesh.points, mesh.tets)
    assert weights.sum() == pytest.approx(np.pi / 4 * (15**2 - 10**2) * 2, rel=1e-5)


def test_principal_stretches_of_a_homogeneous_state() -> None:
    mesh = small_mesh()
    term = solid("taylor_hood", mesh, elastomer("yeoh"))
    gradient = np.array([[1.3, 0.4, -0.2], [0.1, 0.8, 0.3], [-0.3, 0.2, 1.1]])
    state = (mesh.points @ (gradient - np.eye(3)).T).ravel()
    largest = np.linalg.svd(gradient, compute_uv=False)[0]
    np.testing.assert_allclose(principal_stretches(term, state), largest, rtol=1e-12)
