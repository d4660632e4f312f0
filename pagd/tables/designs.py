"""Columns of the tables of designs: the parameters, and where a design comes from."""

from __future__ import annotations

from pagd.design import PARAMETERS
from pagd.tables.column import Column

__all__ = ["DESIGNS", "GENERATED"]


def _parameter(symbol: str) -> Column:
    parameter = PARAMETERS[symbol]
    kind = "int64" if parameter.whole else "double"
    return Column(symbol, kind, _UNITS.get(parameter.unit, parameter.unit), parameter.description)


_UNITS = {"degrees": "deg"}

DESIGNS = (
    Column("design_id", "string", "", "name of the design, unique"),
    *(_parameter(symbol) for symbol in PARAMETERS),
    Column("L_T", "double", "mm", "total length"),
    Column("N1", "int64", "1", "number of helical chambers, from the fixed end"),
    Column("N2", "int64", "1", "number of straight chambers, at the tip"),
    Column("mode", "string", "", "mode the design is drawn for: bending, twisting or mixed"),
    Column("cross_section", "string", "", "cross-section of a chamber"),
    Column("origin", "string", "", "where the design comes from"),
)

GENERATED = (
    *DESIGNS,
    Column("novelty", "double", "1", "distance to the nearest training design, encoded"),
    Column("novelty_plane", "double", "1", "the same in the embedding, scaled to the unit square"),
    Column("component", "int32", "1", "Gaussian it is drawn from; null: of no mixture"),
    Column("z1", "double", "1", "first coordinate in the reduced space; null: drawn without one"),
    Column("z2", "double", "1", "second coordinate in the reduced space"),
)
