"""Which part of the data set a design belongs to: by its id alone, so that none ever changes."""

from __future__ import annotations

from typing import Final

__all__ = ["SPLITS", "split_of"]

#: Parts of the data set, and the share of all designs that each has.
SPLITS: Final = {"train": 0.8, "validation": 0.1, "test": 0.1}

# The id is a hash: its first digits are as good as drawn at random.
_DIGITS: Final = 8


def split_of(design: str) -> str:
    """Return the part that a design belongs to.

    Parameters
    ----------
    design
        Its id, of :func:`pagd.design.identity`.
    """
    place, end = int(design[:_DIGITS], 16) / 16**_DIGITS, 0.0
    for name, share in SPLITS.items():
        end += share
        if place < end:
            return name
    return name
