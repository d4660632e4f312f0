"""Novelty: how far designs lie from the nearest known one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from sklearn.preprocessing import MinMaxScaler

__all__ = [
    "Nearest",
    "leave_one_out_distances",
    "nearest",
    "nearest_distances",
    "nearest_other",
    "novelty",
    "share_in_columns",
    "unit_square",
]

FloatArray = NDArray[np.float64]


class Nearest(NamedTuple):
    """The nearest of some points: distances (n,) and its row (n,)."""

    distances: FloatArray
    rows: NDArray[np.int64]


def nearest(points: FloatArray, known: FloatArray) -> Nearest:
    """Find the known point nearest to each point, min_j ‖x_i − y_j‖ (Euclidean).

    Parameters
    ----------
    points
        Shape (n, d).
    known
        Shape (m, d), m at least 1. The search is exact; a k-d tree only saves time.
    """
    if len(known) == 0:
        raise ValueError("there is no known point to be near to")
    return Nearest(*KDTree(known).query(points))


def nearest_other(known: FloatArray) -> Nearest:
    """Find the other point nearest to each of the points (m, d), m at least 2."""
    if len(known) < 2:
        raise ValueError("the nearest other point takes at least two points")
    distances, rows = KDTree(known).query(known, k=2)
    # With a double, the point itself may come second; the distance, 0, is right either way.
    own = rows[:, 1] == np.arange(len(known))
    return Nearest(distances[:, 1], np.where(own, rows[:, 0], rows[:, 1]))


def nearest_distances(points: FloatArray, known: FloatArray) -> FloatArray:
    """Return the distance of each point (n, d) to the nearest known one (m, d), shape (n,)."""
    return nearest(points, known).distances


def novelty(points: FloatArray, known: FloatArray) -> float:
    """Return d_new of the paper: the mean over points (n, d) of the distance to the nearest known.

    The value belongs to a space and to a number of known designs: it shrinks with the scaling,
    and as m^(-1/d) with the number m of known designs that fill d dimensions.
    """
    return float(nearest_distances(points, known).mean())


def leave_one_out_distances(known: FloatArray) -> FloatArray:
    """Return the distance of each known point (m, d) to the nearest other one, shape (m,).

    The yardstick of novelty: points drawn as the known ones were lie about that far from them.
    """
    return nearest_other(known).distances


def share_in_columns(first: FloatArray, second: FloatArray, columns: Sequence[int]) -> float:
    """Return how much of the squared distances between pairs of points is due to some columns.

    Σ_i Σ_{c in columns} (x_ic − y_ic)² / Σ_i ‖x_i − y_i‖², from 0 to 1, of points (n, d) and
    (n, d); not a number where no pair differs.
    """
    squares = np.square(first - second)
    total = squares.sum()
    return float(squares[:, list(columns)].sum() / total) if total else float("nan")


def unit_square(points: FloatArray, reference: FloatArray) -> FloatArray:
    """Scale points (n, d) so that the reference (m, d) just fills the unit square (cube).

    Each axis by itself is shifted and scaled, (x − min) / (max − min) over the reference. Points
    beyond the reference come to lie outside.
    """
    scaler = MinMaxScaler().fit(reference)
    return np.asarray(scaler.transform(points), dtype=np.float64)
