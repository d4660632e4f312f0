"""Numbers as they stand in the cells of a table; a dash where there is none."""

from __future__ import annotations

import math

__all__ = ["DASH", "cell", "count", "percent", "scaled", "significant"]

DASH = "–"


def cell(value: float | None, digits: int = 1) -> str:
    """Return a number with so many digits after the point."""
    return DASH if value is None or math.isnan(value) else f"{value:,.{digits}f}"


def count(value: float | None) -> str:
    """Return a whole number, grouped by thousands."""
    return cell(value, 0)


def percent(share: float | None, digits: int = 1) -> str:
    """Return a share in per cent."""
    return DASH if share is None or math.isnan(share) else f"{100 * share:.{digits}f} %"


def scaled(value: float | None, factor: float) -> float | None:
    """Return a number times a factor, None for None: from seconds to milliseconds, say."""
    return None if value is None else factor * value


def significant(value: float | None, digits: int = 3) -> str:
    """Return a number with so many significant digits.

    >>> significant(1234.5), significant(0.012345), significant(12.0)
    ('1,234', '0.0123', '12.0')
    """
    if value is None or math.isnan(value):
        return DASH
    if value == 0:
        return "0"
    after = max(digits - 1 - math.floor(math.log10(abs(value))), 0)
    return f"{value:,.{after}f}"
