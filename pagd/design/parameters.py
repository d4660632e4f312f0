"""The eleven parameters of the paper: symbol, meaning, unit and sampling bounds."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

__all__ = ["DECIMALS", "PARAMETERS", "Parameter"]

#: Designs are given to 0.01 mm and 0.01 degrees, as in Table 2; nothing finer can be cast anyway.
DECIMALS: Final = 2


@dataclass(frozen=True, slots=True)
class Parameter:
    """One independent design parameter.

    ``low`` and ``high`` span the sampling box: where designs are drawn from, not what is
    valid (see :class:`pagd.design.Limits` for that). The box brackets Table 2 of the paper.
    """

    symbol: str
    unit: str
    low: float
    high: float
    description: str
    whole: bool = False


_ALL: Final = (
    Parameter("L", "mm", 6, 12, "outer length of a chamber, along x"),
    Parameter("W", "mm", 12, 20, "outer width of a chamber, across (y)"),
    Parameter("H", "mm", 8, 20, "height of a chamber above the base"),
    Parameter("t", "mm", 0.75, 4.5, "thickness of the side walls"),
    Parameter("t_n", "mm", 1, 4, "gap between two chambers, along x"),
    Parameter("t_h", "mm", 2, 5, "thickness of the roof of a chamber"),
    Parameter("t_ab", "mm", 1, 3, "thickness, normal to them, of the walls facing other chambers"),
    Parameter("t_b", "mm", 1.5, 4, "thickness of the base, with the paper half-way down"),
    Parameter("N", "1", 6, 14, "number of chambers in the row", whole=True),
    Parameter("theta", "degrees", 10, 45, "slant of the helical chambers (bending designs: 0)"),
    Parameter("alpha", "1", 0, 1, "share of helical chambers, from the fixed end"),
)

PARAMETERS: Final = MappingProxyType({parameter.symbol: parameter for parameter in _ALL})
"""Every independent parameter by its symbol, in the order of the paper's Table 2."""
