"""Powers, limits and crossings: what the tables derive from what was measured."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "EDGE_ORDER",
    "common_order",
    "extrapolated",
    "power",
    "relative_distance",
    "seconds_at",
]

FloatArray = NDArray[np.float64]

#: Order that the error of the tip comes down to on ever finer meshes: inward edges of the cavity,
#: 2 × 0.5445 (Williams 1952); docs/verification.md shows it.
EDGE_ORDER = 1.089

#: Orders among which a common one is looked for.
_ORDERS = np.linspace(0.8, 4.0, 321)


def power(x: Sequence[float], y: Sequence[float]) -> float | None:
    """Return the p of y = c xᵖ by least squares of the logarithms; None from less than two x.

    >>> round(power([1.0, 2.0, 4.0], [3.0, 12.0, 48.0]), 6)
    2.0
    """
    if len(set(x)) < 2 or min(*x, *y) <= 0:
        return None
    slope, _ = np.polyfit(np.log(x), np.log(y), 1)
    return float(slope)


def extrapolated(
    coarse: FloatArray, fine: FloatArray, ratio: float, order: float = EDGE_ORDER
) -> FloatArray:
    """Return the limit of a quantity on two meshes (Richardson).

    Parameters
    ----------
    coarse, fine
        The quantity on either mesh; any shape.
    ratio
        Of the element sizes, coarse by fine; above 1.
    order
        The error falls as so high a power of the size.
    """
    if not ratio > 1:
        raise ValueError(f"ratio = {ratio:g}: the coarse mesh must be the coarser one")
    return np.asarray(fine + (fine - coarse) / (ratio**order - 1.0))


def common_order(
    first: tuple[FloatArray, FloatArray], second: tuple[FloatArray, FloatArray], ratio: float
) -> float | None:
    """Return the order with which two kinds of meshes have the same limit, as nearly as they can.

    Parameters
    ----------
    first, second
        The quantity on a coarse and on a fine mesh of either kind.
    ratio
        Of the element sizes, coarse by fine; above 1.

    Returns
    -------
    float
        None where no order between 0.8 and 4 brings the limits nearest to each other.
    """
    gaps = [
        np.linalg.norm(
            extrapolated(*first, ratio, float(order)) - extrapolated(*second, ratio, float(order))
        )
        for order in _ORDERS
    ]
    best = int(np.argmin(gaps))
    return float(_ORDERS[best]) if 0 < best < len(_ORDERS) - 1 else None


def relative_distance(found: FloatArray, limit: FloatArray) -> float:
    """Return |found − limit| / |limit| of two vectors (3,)."""
    return float(np.linalg.norm(found - limit) / np.linalg.norm(limit))


def seconds_at(error: float, points: Iterable[tuple[float, float]]) -> tuple[str, float] | None:
    """Return the seconds at which an error is reached, by interpolation of logarithms.

    Parameters
    ----------
    error
        Wanted.
    points
        Seconds and error, of one kind of mesh at several sizes.

    Returns
    -------
    tuple
        ``=`` and the seconds; ``<`` and those of the cheapest mesh, which has a smaller error
        already; ``>`` and those of the dearest where none is good enough. None without points.
    """
    ordered = sorted(points)
    if not ordered:
        return None
    if ordered[0][1] <= error:
        return "<", ordered[0][0]
    for (cheap, large), (dear, small) in pairwise(ordered):
        if small <= error < large:
            share = np.log(large / error) / np.log(large / max(small, 1e-12))
            return "=", float(np.exp(np.log(cheap) + share * np.log(dear / cheap)))
    return ">", ordered[-1][0]
