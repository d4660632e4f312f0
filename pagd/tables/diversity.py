"""Columns of the comparison of generators, and of the reduced space."""

from __future__ import annotations

from pagd.tables.column import Column

__all__ = ["COMPARISON", "HULLS", "HULL_POINTS", "reduced_space"]

COMPARISON = (
    Column("generator", "string", "", "generator; training: the training designs themselves"),
    Column("space", "string", "", "space in which it is measured"),
    Column("mode", "string", "", "mode of the designs, or all"),
    Column("metric", "string", "", "metric; diversity.json says what each is"),
    Column("better", "string", "", "where more novelty, diversity or likeness lies"),
    Column("value", "double", "1", "value; null: not defined"),
    Column("low", "double", "1", "lower end of its interval; null: it has none"),
    Column("high", "double", "1", "upper end of its interval"),
    Column("count", "int64", "1", "designs, or seeds in the space plane_sample"),
)

HULLS = (
    Column("generator", "string", "", "generator"),
    Column("repeat", "int64", "1", "number of the draw, from 0"),
    Column("training", "double", "1", "area of the hull of training designs, unit square"),
    Column("generated", "double", "1", "area of the hull of as many generated designs"),
)

HULL_POINTS = (
    Column("generator", "string", "", "generator"),
    Column("set", "string", "", "training or generated"),
    Column("z1", "double", "1", "first coordinate in the unit square"),
    Column("z2", "double", "1", "second coordinate"),
    Column("corner", "int64", "1", "place around the hull, from 0; null: within it"),
)


def reduced_space(dimensions: int) -> tuple[Column, ...]:
    """Return the columns of the training designs' places in a space of so many dimensions."""
    coordinates = (
        Column(f"z{i}", "double", "1", f"coordinate {i} in the reduced space")
        for i in range(1, dimensions + 1)
    )
    return (Column("design_id", "string", "", "name of the training design"), *coordinates)
