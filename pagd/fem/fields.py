"""Fields of a solved state: principal stretch and strain, at points and at nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.cells import Cell, cell_of
from pagd.fem.solid import Solid, principal_stretches

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Strains:
    """Largest principal logarithmic strain of a state.

    Attributes
    ----------
    nodes
        Values (n,) at the nodes: extrapolated from the quadrature points to the corners of
        each element, averaged over the elements of a node; means of the corners between them.
    largest, percentile_99
        Largest value at a quadrature point, and the value that 1 % of the volume exceeds.
        Sharp corners are singular: the largest value grows as the mesh is refined.
    """

    nodes: FloatArray
    largest: float
    percentile_99: float


def weighted_percentile(values: FloatArray, weights: FloatArray, share: float) -> float:
    """The value below which the given share of the total weight lies."""
    order = np.argsort(values, axis=None)
    summed = np.cumsum(weights.ravel()[order])
    position = np.searchsorted(summed, share * summed[-1])
    return float(values.ravel()[order][min(position, order.size - 1)])


def share_beyond(solids: Sequence[Solid], unknowns: FloatArray, stretch: float) -> float:
    """Share of the volume whose largest principal stretch exceeds ``stretch``."""
    beyond = whole = 0.0
    for solid in solids:
        beyond += solid.weights[principal_stretches(solid, unknowns, stretch) > stretch].sum()
        whole += solid.weights.sum()
    return float(beyond / whole)


def strains(solids: Sequence[Solid], unknowns: FloatArray, node_count: int) -> Strains:
    """Evaluate the strains of a state of ``node_count`` nodes; solids share their nodes."""
    values = [np.log(principal_stretches(solid, unknowns)) for solid in solids]
    weights = np.concatenate([solid.weights.ravel() for solid in solids])
    together = np.concatenate([found.ravel() for found in values])
    return Strains(
        nodes=_at_nodes([solid.nodes for solid in solids], values, node_count),
        largest=float(together.max()),
        percentile_99=weighted_percentile(together, weights, 0.99),
    )


def _at_nodes(nodes: Sequence[IntArray], values: Sequence[FloatArray], count: int) -> FloatArray:
    total, share = np.zeros(count), np.zeros(count, np.int64)
    for numbers, found in zip(nodes, values, strict=True):
        corners = numbers[:, cell_of(numbers).corners]
        corner_values = found @ _to_corners(cell_of(numbers)).T
        total += np.bincount(corners.ravel(), corner_values.ravel(), minlength=count)
        share += np.bincount(corners.ravel(), minlength=count)
    result = total / np.maximum(share, 1)
    for numbers in nodes:
        cell = cell_of(numbers)
        between = np.setdiff1d(np.arange(numbers.shape[1]), cell.corners)
        means = cell.linear(cell.places)[between] @ result[numbers[:, cell.corners]][..., None]
        result[numbers[:, between]] = means[..., 0]
    return np.asarray(result)


def _to_corners(cell: Cell) -> FloatArray:
    """From values at the quadrature points to the corners (corners, Q), by least squares."""
    return np.asarray(np.linalg.pinv(cell.linear(cell.rule.points)))
