"""The two categories of the data set, and their designs as rows of numbers.

A design of a category has fewer free parameters than the eleven: alpha is 0 in every bending
design and 1 in every twisting one, and bending designs have no slant. What is drawn, jittered
or interpolated is the matrix of the free ones.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from pagd.design import DECIMALS, PARAMETERS, Design, Parameter

__all__ = [
    "CATEGORIES",
    "Category",
    "category_of",
    "designs_from",
    "free_parameters",
    "in_box",
    "rounded",
    "values_of",
]

Category = Literal["bending", "twisting"]
FloatArray = NDArray[np.float64]

#: The categories of the paper's data set; its third mode, mixed, is for the generator to find.
CATEGORIES: Final[tuple[Category, ...]] = ("bending", "twisting")

_FIXED: Final[dict[Category, dict[str, float]]] = {
    "bending": {"theta": 0.0, "alpha": 0.0},
    "twisting": {"alpha": 1.0},
}


def free_parameters(category: Category) -> tuple[Parameter, ...]:
    """Return the parameters that differ within a category: 9 if bending, 10 if twisting."""
    return tuple(p for p in PARAMETERS.values() if p.symbol not in _FIXED[category])


def category_of(design: Design) -> Category | None:
    """Return the category that a design belongs to; None for a mixed one."""
    return None if design.mode == "mixed" else design.mode


def in_box(points: FloatArray, category: Category) -> FloatArray:
    """Return points of the unit cube, shape (n, free parameters), in the sampling box; rounded.

    Every whole number between the bounds of N is equally likely.
    """
    free = free_parameters(category)
    # Rounding would halve the share of the first and the last whole number.
    margins = np.array([0.5 if p.whole else 0.0 for p in free])
    low, high = np.array([p.low for p in free]), np.array([p.high for p in free])
    values = rounded(low - margins + points * (high - low + 2 * margins), category)
    return np.clip(values, low, high)


def rounded(values: FloatArray, category: Category) -> FloatArray:
    """Round rows of free parameters to 0.01 mm and 0.01 degrees, and N to a whole number."""
    whole = np.array([parameter.whole for parameter in free_parameters(category)])
    return np.where(whole, np.floor(values + 0.5), np.round(values, DECIMALS))


def values_of(designs: Iterable[Design], category: Category) -> FloatArray:
    """Return the free parameters of designs, shape (designs, free parameters)."""
    symbols = [parameter.symbol for parameter in free_parameters(category)]
    rows = [[float(getattr(design, symbol)) for symbol in symbols] for design in designs]
    return np.array(rows, dtype=np.float64).reshape(len(rows), len(symbols))


def designs_from(values: FloatArray, category: Category) -> list[Design]:
    """Return the designs of rows of free parameters; N must be whole or not finite."""
    return [_design(row, category) for row in values.tolist()]


def _design(row: list[float], category: Category) -> Design:
    free = free_parameters(category)
    values = {p.symbol: _number(p, value) for p, value in zip(free, row, strict=True)}
    return Design(**(values | _FIXED[category]))  # type: ignore[arg-type]


def _number(parameter: Parameter, value: float) -> float | int:
    return int(value) if parameter.whole and np.isfinite(value) else value
