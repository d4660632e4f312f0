"""The kinds of volume cells: their nodes, functions and quadrature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.fem import quadrature, shapes
from pagd.fem.quadrature import Quadrature

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Cell:
    """One kind of cell.

    Attributes
    ----------
    name
        In the plural, for messages.
    rule
        The quadrature of its stiffness.
    volume
        Volume of the reference cell.
    values, derivatives
        The functions at points of the rule's coordinates: (points, n) and (points, n, 3).
    places
        Coordinates (n, …) of the nodes, as those of the rule.
    corners
        Which of the n nodes are corners.
    linear
        Values (points, corners) of the functions that interpolate between the corners alone.
    """

    name: str
    rule: Quadrature
    volume: float
    values: Callable[[FloatArray], FloatArray]
    derivatives: Callable[[FloatArray], FloatArray]
    places: FloatArray
    corners: IntArray
    linear: Callable[[FloatArray], FloatArray]


def _trilinear(points: FloatArray) -> FloatArray:
    x, y, z = (np.stack([1 - points[:, k], points[:, k]], axis=-1) for k in range(3))
    return np.asarray(np.einsum("qi,qj,qk->qijk", x, y, z).reshape(len(points), 8))


def _wedge_linear(points: FloatArray) -> FloatArray:
    height = np.stack([1 - points[:, 3], points[:, 3]], axis=-1)
    return np.asarray(np.einsum("qk,qa->qka", height, points[:, :3]).reshape(len(points), 6))


def _middles(corners: int, edges: tuple[tuple[int, int], ...]) -> FloatArray:
    """Barycentric coordinates of the corners and of the middles of edges."""
    unit = np.eye(corners)
    return np.vstack([unit, [(unit[a] + unit[b]) / 2 for a, b in edges]])


_LAYERS = np.array([0.0, 0.5, 1.0])
_TRIANGLE = _middles(3, shapes.TRIANGLE_EDGES)

#: Cells by their number of nodes.
CELLS = {
    10: Cell(
        "tetrahedra",
        quadrature.tetrahedron(),
        1 / 6,
        shapes.tetrahedron_values,
        shapes.tetrahedron_derivatives,
        _middles(4, shapes.TETRAHEDRON_EDGES),
        np.arange(4),
        lambda points: points,
    ),
    18: Cell(
        "wedges",
        quadrature.wedge(),
        1 / 2,
        shapes.wedge_values,
        shapes.wedge_derivatives,
        np.vstack([np.column_stack([_TRIANGLE, np.full(6, z)]) for z in _LAYERS]),
        np.array([0, 1, 2, 12, 13, 14]),
        _wedge_linear,
    ),
    27: Cell(
        "hexahedra",
        quadrature.hexahedron(),
        1.0,
        shapes.hexahedron_values,
        shapes.hexahedron_derivatives,
        np.stack(np.meshgrid(_LAYERS, _LAYERS, _LAYERS, indexing="ij"), axis=-1).reshape(-1, 3),
        np.array([0, 2, 6, 8, 18, 20, 24, 26]),
        _trilinear,
    ),
}


def cell_of(nodes: IntArray) -> Cell:
    """The kind of the cells whose node numbers (E, n) are given."""
    return CELLS[nodes.shape[1]]


def reference_geometry(points: FloatArray, nodes: IntArray) -> tuple[FloatArray, FloatArray]:
    """Gradients (E, Q, 3, n) in 1/mm and weights (E, Q) in mm³ at the quadrature points.

    Isoparametric, so that curved elements are right too. Raises ``InputError`` where
    an element is inverted.
    """
    cell = cell_of(nodes)
    derivatives = cell.derivatives(cell.rule.points)
    jacobians = np.einsum("eai,qaj->eqij", points[nodes], derivatives, optimize=True)
    determinants = np.linalg.det(jacobians)
    if not determinants.min() > 0:
        inverted = int((determinants <= 0).any(axis=1).sum())
        raise InputError(f"the mesh has {inverted} inverted {cell.name}")
    inverses = np.linalg.inv(jacobians)
    gradients = np.einsum("qaj,eqji->eqia", derivatives, inverses, optimize=True)
    return np.ascontiguousarray(gradients), determinants * cell.rule.weights * cell.volume
