"""Fields of a solved state: principal stretch and strain, at points and at nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.quadrature import tetrahedron
from pagd.fem.shapes import TETRAHEDRON_EDGES
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
        each element, averaged over the elements of a node; means of the ends on edges.
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


def share_beyond(solid: Solid, unknowns: FloatArray, stretch: float) -> float:
    """Share of the volume whose largest principal stretch exceeds ``stretch``."""
    beyond = principal_stretches(solid, unknowns, stretch) > stretch
    return float(solid.weights[beyond].sum() / solid.weights.sum())


def strains(solid: Solid, unknowns: FloatArray, node_count: int) -> Strains:
    """Evaluate the strains of a state of ``node_count`` nodes."""
    values = np.log(principal_stretches(solid, unknowns))
    return Strains(
        nodes=_at_nodes(solid.nodes, values, node_count),
        largest=float(values.max()),
        percentile_99=weighted_percentile(values, solid.weights, 0.99),
    )


def _at_nodes(nodes: IntArray, values: FloatArray, count: int) -> FloatArray:
    corner_values = values @ np.linalg.inv(tetrahedron().points).T
    corners = nodes[:, :4]
    total = np.bincount(corners.ravel(), corner_values.ravel(), minlength=count)
    share = np.bincount(corners.ravel(), minlength=count)
    result = total / np.maximum(share, 1)
    for k, (a, b) in enumerate(TETRAHEDRON_EDGES):
        result[nodes[:, 4 + k]] = 0.5 * (result[nodes[:, a]] + result[nodes[:, b]])
    return np.asarray(result)
