"""Bending of the sheet by an interior penalty: exact quadratics, coercivity, edges."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import PAPER, check_derivatives, moved, random_displacement, residual
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.fem.bending import bending_terms
from pagd.fem.quadratic_energy import QuadraticEnergy
from pagd.materials import Sheet
from pagd.mesh.primitives import box

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

L, B = 6.0, 4.0  # the sheet is 0 ≤ x ≤ L, −B/2 ≤ y ≤ B/2


def flat_sheet(cells: tuple[int, int] = (3, 4)) -> tuple[FloatArray, IntArray]:
    """Points and faces of a flat sheet, corners inside moved, edge nodes half-way."""
    mesh = box((L, B, 1.0), (*cells, 2), paper_layer=1)
    points, faces = mesh.points - [0, B / 2, 0.5], mesh.surfaces["paper"]
    inside = (points[:, 0] > 0) & (points[:, 0] < L) & (np.abs(points[:, 1]) < B / 2)
    corners = np.intersect1d(np.unique(faces[:, :3]), np.flatnonzero(inside))
    # The middle line stays straight: half of the sheet is a sheet.
    corners = corners[np.abs(points[corners, 1]) > 1e-9]
    random = np.random.default_rng(7)
    points[corners, :2] += 0.2 * random.uniform(-1, 1, (len(corners), 2))
    for k, (a, b) in enumerate(((0, 1), (1, 2), (2, 0))):
        points[faces[:, 3 + k]] = (points[faces[:, a]] + points[faces[:, b]]) / 2
    return points, faces


def total(terms: list[QuadraticEnergy], state: FloatArray) -> float:
    return sum(term.energy(state.ravel(), 0.0) for term in terms)


def forces(terms: list[QuadraticEnergy], state: FloatArray) -> FloatArray:
    return np.asarray(sum(residual(term, state.ravel()) for term in terms))


def quadratic(points: FloatArray, xx: float, xy: float, yy: float) -> FloatArray:
    """Deflection along z with constant second derivatives, and any slope."""
    x, y, _ = points.T
    result = np.zeros_like(points)
    result[:, 2] = xx * x**2 / 2 + xy * x * y + yy * y**2 / 2 + 0.3 * x - 0.2 * y
    return result


def on(points: FloatArray, axis: int, value: float) -> IntArray:
    return np.flatnonzero(np.isclose(points[:, axis], value))


@pytest.mark.parametrize("curvatures", [(0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1), (0.2, 0.1, -0.3)])
def test_constant_curvature_has_its_energy(curvatures: tuple[float, float, float]) -> None:
    """D/2 [(1 − ν) |∇²w|² + ν (Δw)²] per area: no kinks, so the hinges add nothing."""
    points, faces = flat_sheet()
    xx, xy, yy = curvatures
    nu = PAPER.poisson_ratio
    density = (1 - nu) * (xx**2 + 2 * xy**2 + yy**2) + nu * (xx + yy) ** 2
    exact = 0.5 * PAPER.bending_stiffness * density * L * B
    found = total(bending_terms(points, faces, PAPER), quadratic(points, xx, xy, yy))
    assert found == pytest.approx(exact, rel=1e-12)


def test_constant_curvature_needs_no_force_inside() -> None:
    """A bent sheet is in equilibrium away from its edges: the form is consistent."""
    points, faces = flat_sheet((6, 8))
    found = forces(bending_terms(points, faces, PAPER), quadratic(points, 0.2, 0.1, -0.3))
    border = [on(points, 0, 0.0), on(points, 0, L), on(points, 1, -B / 2), on(points, 1, B / 2)]
    # Nodes of faces with a corner on an edge take part in the moments there.
    near = np.isin(faces, np.concatenate(border)).any(axis=1)
    inside = np.setdiff1d(np.unique(faces), faces[near])
    assert len(inside) > 20
    size = np.abs(found).max()
    np.testing.assert_allclose(found.reshape(-1, 3)[inside], 0.0, atol=1e-11 * size)


def test_derivatives() -> None:
    points, faces = flat_sheet()
    terms = bending_terms(
        points, faces, PAPER, clamped=on(points, 0, 0.0), symmetry=on(points, 1, -B / 2)
    )
    assert [term.name for term in terms] == ["bending", "hinges", "held edges", "held edges"]
    for term in terms:
        check_derivatives(term, random_displacement(points, 0.3))


def test_energy_does_not_change_under_rigid_motion() -> None:
    points, faces = flat_sheet()
    terms, state = bending_terms(points, faces, PAPER), random_displacement(points, 0.3)
    energy = total(terms, state)
    assert energy > 0
    # As a form in the displacement it is one in the position: the flat sheet has no curvature.
    assert total(terms, moved(points, state)) == pytest.approx(energy, rel=1e-10)


def test_no_force_in_a_rigidly_moved_sheet() -> None:
    points, faces = flat_sheet()
    state = moved(points, np.zeros(points.size))
    size = PAPER.bending_stiffness * np.abs(state).max()
    np.testing.assert_allclose(
        forces(bending_terms(points, faces, PAPER), state), 0.0, atol=1e-11 * size
    )


@pytest.mark.parametrize("poisson_ratio", [0.0, 0.2, 0.45])
@pytest.mark.parametrize("cells", [(3, 4), (2, 12), (8, 2)])
def test_only_flat_sheets_have_no_energy(poisson_ratio: float, cells: tuple[int, int]) -> None:
    """Coercive on regular and stretched triangles: three zero eigenvalues, all others positive."""
    points, faces = flat_sheet(cells)
    sheet = Sheet(name="s", youngs_modulus=1.0, poisson_ratio=poisson_ratio, thickness=1.0)
    size = 3 * len(points)
    matrix = np.zeros((size, size))
    for term in bending_terms(points, faces, sheet):
        np.add.at(matrix, (term.dofs[:, :, None], term.dofs[:, None, :]), term._matrices)
    upright = 3 * np.unique(faces) + 2
    values = np.linalg.eigvalsh(matrix[np.ix_(upright, upright)])
    assert (np.abs(values[:3]) < 1e-10 * values[-1]).all()
    assert values[3] > 1e-8 * values[-1]


def test_a_clamped_edge_holds_the_slope() -> None:
    """No energy where the slope is zero; a slope costs; the other components are held too."""
    points, faces = flat_sheet()
    free = bending_terms(points, faces, PAPER)
    clamped = bending_terms(points, faces, PAPER, clamped=on(points, 0, 0.0))
    level = np.zeros_like(points)
    level[:, 2] = 0.05 * points[:, 0] ** 2
    assert total(clamped, level) == pytest.approx(total(free, level), rel=1e-12)
    for axis in range(3):
        tilted = np.zeros_like(points)
        tilted[:, axis] = 0.1 * points[:, 0]
        assert total(free, tilted) == pytest.approx(0.0, abs=1e-14)
        assert total(clamped, tilted) > 1e-3


def test_half_a_sheet_has_half_the_energy() -> None:
    """The symmetry edge stands for the hinge to the mirror image, kinks included."""
    points, faces = flat_sheet()
    half = faces[points[faces[:, :3], 1].mean(axis=1) > 0]
    nodes = np.unique(half)
    mirrored = points * [1, -1, 1]
    # The whole sheet: the half and its mirror image, which share the nodes on y = 0.
    other = np.arange(len(points)) + len(points)
    other[on(points, 1, 0.0)] = on(points, 1, 0.0)
    flipped = other[half][:, [0, 2, 1, 5, 4, 3]]
    whole_points = np.vstack([points, mirrored])
    whole = bending_terms(whole_points, np.vstack([half, flipped]), PAPER)
    parts = bending_terms(points, half, PAPER, symmetry=on(points, 1, 0.0))
    state = random_displacement(points, 0.3).reshape(-1, 3)
    state[on(points, 1, 0.0), 1] = 0
    both = np.vstack([state, state * [1, -1, 1]])
    assert len(nodes) > 20
    assert total(parts, state) == pytest.approx(total(whole, both) / 2, rel=1e-12)


def test_a_sheet_that_is_not_flat_is_refused() -> None:
    points, faces = flat_sheet()
    points[:, 2] += 0.01 * points[:, 0] ** 2
    with pytest.raises(InputError, match="not flat"):
        bending_terms(points, faces, PAPER)


def test_three_faces_at_an_edge_are_refused() -> None:
    points, faces = flat_sheet()
    with pytest.raises(InputError, match="more than two"):
        bending_terms(points, np.vstack([faces, faces[:1]]), PAPER)


def test_quadratic_energy_of_chosen_components() -> None:
    matrices = np.array([[[2.0, 1.0], [1.0, 3.0]]])
    term = QuadraticEnergy("spring", np.array([[0, 1]]), matrices, components=(0, 2))
    state = np.array([1.0, 10.0, 2.0, -1.0, 10.0, 3.0])
    # x: ½ (2·1 − 2·1 + 3·1); z: ½ (2·4 + 2·6 + 3·9); y takes no part.
    assert term.energy(state, 0.0) == pytest.approx(0.5 * 3 + 0.5 * 47)
    check_derivatives(term, state)
