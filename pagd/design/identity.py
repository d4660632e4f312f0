"""A name for a design that depends on its parameters alone, and is the same everywhere."""

from __future__ import annotations

import hashlib

from pagd.design.model import Design

__all__ = ["identity"]

_DIGITS = 16


def identity(design: Design) -> str:
    """Return the first 16 hexadecimal digits of the SHA-256 of a design's parameters.

    What is hashed is one line of ``symbol=value`` in the order of the parameters, separated by
    blanks; a value is the shortest decimal that gives the same double. Designs differ in it if and
    only if a parameter does, by however little. Among 12,000 designs, two would share one by chance
    once in 10¹¹ data sets.
    """
    # Whole numbers as others, and no minus zero.
    values = {symbol: float(value) + 0.0 for symbol, value in design.as_dict().items()}
    text = " ".join(f"{symbol}={value!r}" for symbol, value in values.items())
    return hashlib.sha256(text.encode("ascii")).hexdigest()[:_DIGITS]
