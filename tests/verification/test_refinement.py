"""Halved meshes, what is carried over to them, and limits of series."""

from __future__ import annotations

import numpy as np
import pytest
from actuators import default_elastomer, default_paper
from refinement import ORDER, carried_over, halved, limit_of, observed_order

from pagd.actuation import Body
from pagd.mesh.primitives import hollow_block
from pagd.mesh.types import Mesh, corner_volumes


def block() -> Mesh:
    """A block with a cavity and paper, its corners moved so that no two tetrahedra are alike."""
    return hollow_block((3.0, 6.0, 4.5), (3, 3, 3), ((1, 2), (1, 2), (1, 2)), 1)


def test_halves_fill_the_same_space() -> None:
    mesh = block()
    fine = halved(mesh)
    fine.check()
    assert len(fine.tets) == 8 * len(mesh.tets)
    volumes = [corner_volumes(m.points, m.tets).sum() for m in (mesh, fine)]
    assert volumes[1] == pytest.approx(volumes[0], rel=1e-12)


def test_surfaces_are_halved_with_their_sides() -> None:
    mesh = block()
    fine = halved(mesh)
    assert set(fine.surfaces) == set(mesh.surfaces)
    for name, faces in mesh.surfaces.items():
        found = fine.surfaces[name]
        assert len(found) == 4 * len(faces)
        np.testing.assert_allclose(_area(fine, found), _area(mesh, faces), atol=1e-12)


def _area(mesh: Mesh, faces: np.ndarray) -> np.ndarray:
    """Sum of the area vectors (3,), and the area itself."""
    a, b, c = (mesh.points[faces[:, i]] for i in range(3))
    vectors = np.cross(b - a, c - a) / 2
    return np.append(vectors.sum(axis=0), np.linalg.norm(vectors, axis=1).sum())


def test_quadratic_fields_are_carried_over_exactly() -> None:
    mesh = block()
    coarse, fine = (Body(m, default_elastomer(), default_paper()) for m in (mesh, halved(mesh)))

    def field(points: np.ndarray) -> np.ndarray:
        x, y, z = points.T
        return np.column_stack([x**2 - y * z, 3 + z, x * y])

    found = carried_over(coarse, fine, field(mesh.points))
    np.testing.assert_allclose(found, field(fine.mesh.points), atol=1e-12)


@pytest.mark.parametrize("order", [0.8, 1.4, 3.0])
def test_order_of_a_series(order: float) -> None:
    values = (7 - 0.1 * h**order for h in (4.0, 2.0, 1.0))
    assert observed_order(*values) == pytest.approx(order, rel=1e-6)


def test_a_series_that_does_not_converge_has_no_order() -> None:
    assert np.isnan(observed_order(1.0, 2.0, 1.0))


def test_limit_of_a_mesh_and_its_halves() -> None:
    coarse, fine = (7 - 0.1 * h**ORDER for h in (4.0, 2.0))
    assert limit_of(coarse, fine) == pytest.approx(7.0, rel=1e-12)
