"""Shape functions: node order, completeness and derivatives."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from pagd.fem import shapes
from pagd.mesh.types import TET_EDGES, TRI_EDGES

Functions = Callable[[NDArray[np.float64]], NDArray[np.float64]]
ELEMENTS = [
    pytest.param(
        shapes.tetrahedron_values,
        shapes.tetrahedron_derivatives,
        shapes.TETRAHEDRON_EDGES,
        4,
        id="tetrahedron",
    ),
    pytest.param(
        shapes.triangle_values,
        shapes.triangle_derivatives,
        shapes.TRIANGLE_EDGES,
        3,
        id="triangle",
    ),
]
each_element = pytest.mark.parametrize(("values", "derivatives", "edges", "corners"), ELEMENTS)


def node_places(edges: tuple[tuple[int, int], ...], corners: int) -> NDArray[np.float64]:
    """Barycentric coordinates of the nodes."""
    unit = np.eye(corners)
    return np.vstack([unit, [(unit[a] + unit[b]) / 2 for a, b in edges]])


def inner_points(corners: int) -> NDArray[np.float64]:
    return np.random.default_rng(3).dirichlet(np.ones(corners), 7)


def test_edge_order_is_that_of_the_mesh() -> None:
    np.testing.assert_array_equal(shapes.TETRAHEDRON_EDGES, TET_EDGES)
    np.testing.assert_array_equal(shapes.TRIANGLE_EDGES, TRI_EDGES)


@each_element
def test_one_at_the_own_node(
    values: Functions, derivatives: Functions, edges: tuple[tuple[int, int], ...], corners: int
) -> None:
    found = values(node_places(edges, corners))
    np.testing.assert_allclose(found, np.eye(len(found)), atol=1e-15)


@each_element
def test_partition_of_unity(
    values: Functions, derivatives: Functions, edges: tuple[tuple[int, int], ...], corners: int
) -> None:
    points = inner_points(corners)
    np.testing.assert_allclose(values(points).sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(derivatives(points).sum(axis=1), 0.0, atol=1e-14)


@each_element
def test_quadratic_fields_are_reproduced(
    values: Functions, derivatives: Functions, edges: tuple[tuple[int, int], ...], corners: int
) -> None:
    random = np.random.default_rng(5)
    dimension = corners - 1
    hessian, slope = random.normal(size=(dimension, dimension)), random.normal(size=dimension)
    hessian = hessian + hessian.T

    def field(barycentric: NDArray[np.float64]) -> NDArray[np.float64]:
        x = barycentric[:, 1:]
        return np.asarray(0.5 * np.einsum("pi,ij,pj->p", x, hessian, x) + x @ slope + 0.3)

    points, nodes = inner_points(corners), field(node_places(edges, corners))
    np.testing.assert_allclose(values(points) @ nodes, field(points), rtol=1e-13)
    gradient = np.einsum("pai,a->pi", derivatives(points), nodes)
    np.testing.assert_allclose(gradient, points[:, 1:] @ hessian + slope, atol=1e-13)


@each_element
def test_derivatives_by_central_differences(
    values: Functions, derivatives: Functions, edges: tuple[tuple[int, int], ...], corners: int
) -> None:
    points, step = inner_points(corners), 1e-5
    found = derivatives(points)
    for axis in range(1, corners):
        # Along a reference axis l_k grows and l_0 shrinks.
        offset = step * (np.eye(corners)[axis] - np.eye(corners)[0])
        slope = (values(points + offset) - values(points - offset)) / (2 * step)
        np.testing.assert_allclose(found[:, :, axis - 1], slope, atol=1e-9)


def test_triangle_hessians_are_derivatives_of_the_derivatives() -> None:
    points = inner_points(3)
    found = shapes.triangle_hessians()
    for axis in (1, 2):
        offset = 0.1 * (np.eye(3)[axis] - np.eye(3)[0])
        change = shapes.triangle_derivatives(points + offset)
        change = (change - shapes.triangle_derivatives(points - offset)) / 0.2
        np.testing.assert_allclose(
            change, np.broadcast_to(found[:, :, axis - 1], change.shape), atol=1e-13
        )
