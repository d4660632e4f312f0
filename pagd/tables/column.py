"""A declared column of a table."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["Column"]


class Column(NamedTuple):
    """One column: its name, its Arrow type, its unit ('1' for a pure number, '' for text)."""

    name: str
    type: str
    unit: str
    description: str
