from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from pagd.errors import InputError
from pagd.tables import (
    BLOCKED,
    CHAMBERS,
    COMPARISON,
    DESIGNS,
    GENERATED,
    HISTORY,
    MEASURES,
    PERFORMANCE,
    STATES,
    TRAJECTORY,
    Column,
    concatenate,
    read_rows,
    read_table,
    reduced_space,
    units,
    write_rows,
    write_table,
)

COLUMNS = (Column("x_mm", "double", "mm", "a length"), Column("name", "string", "", "a name"))


def test_round_trip_with_units(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "t.parquet"
    write_table(path, COLUMNS, {"x_mm": np.array([1.0, 2.0]), "name": ["a", None]})
    table = read_table(path)
    np.testing.assert_array_equal(table["x_mm"], [1.0, 2.0])
    assert list(table["name"]) == ["a", None]
    assert units(path) == {"x_mm": "mm", "name": ""}
    assert pq.read_schema(path).field("x_mm").metadata[b"description"] == b"a length"


def test_missing_columns_and_nan_become_null(tmp_path: Path) -> None:
    path = tmp_path / "t.parquet"
    write_table(path, COLUMNS, {"x_mm": [np.nan, 1.0]})
    assert read_rows(path) == [{"x_mm": None, "name": None}, {"x_mm": 1.0, "name": None}]
    assert np.isnan(read_table(path)["x_mm"][0])


def test_rows_may_lack_keys(tmp_path: Path) -> None:
    path = tmp_path / "t.parquet"
    write_rows(path, COLUMNS, [{"x_mm": 1.0}, {"name": "b"}])
    assert read_rows(path) == [{"x_mm": 1.0, "name": None}, {"x_mm": None, "name": "b"}]


@pytest.mark.parametrize("data", [{"y": [1]}, {"x_mm": [1.0], "name": ["a", "b"]}])
def test_columns_are_strict(tmp_path: Path, data: dict[str, list[object]]) -> None:
    with pytest.raises(ValueError, match=r"not declared|length"):
        write_table(tmp_path / "t.parquet", COLUMNS, data)
    assert list(tmp_path.iterdir()) == []


def test_unknown_keys_of_rows_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="not declared"):
        write_rows(tmp_path / "t.parquet", COLUMNS, [{"z": 1}])


def test_concatenate_keeps_order_and_types(tmp_path: Path) -> None:
    parts = [tmp_path / "a.parquet", tmp_path / "b.parquet"]
    write_table(parts[0], COLUMNS, {"x_mm": [1.0]})
    write_table(parts[1], COLUMNS, {"name": ["b"]})
    concatenate(tmp_path / "all.parquet", parts, COLUMNS)
    assert read_rows(tmp_path / "all.parquet") == [
        {"x_mm": 1.0, "name": None},
        {"x_mm": None, "name": "b"},
    ]


def test_concatenating_nothing_gives_an_empty_table(tmp_path: Path) -> None:
    concatenate(tmp_path / "none.parquet", [], TRAJECTORY)
    assert read_rows(tmp_path / "none.parquet") == []
    assert units(tmp_path / "none.parquet")["x_mm"] == "mm"


def test_a_broken_file_is_an_input_error(tmp_path: Path) -> None:
    (tmp_path / "t.parquet").write_text("no table")
    for name, words in (
        ("t.parquet", r"t\.parquet: not a readable Parquet table"),
        ("absent.parquet", r"absent\.parquet: there is no such file\.$"),
        ("absent/t.parquet", r"absent: there is no such folder\.$"),
    ):
        with pytest.raises(InputError, match=words):
            read_table(tmp_path / name)


ENDINGS = {"kPa": "kPa", "deg": "deg", "mm": "mm", "mm3": "mm³", "mJ": "mJ", "s": "s", "N": "N"}
DECLARED = (BLOCKED, CHAMBERS, HISTORY, MEASURES, PERFORMANCE, STATES, TRAJECTORY)


@pytest.mark.parametrize("columns", DECLARED)
def test_units_agree_with_the_names(columns: tuple[Column, ...]) -> None:
    for column in columns:
        words = column.name.split("_")
        if len(words) > 1 and words[-1] in ENDINGS:
            prefix = "1/" if words[-2] == "per" else ""
            assert column.unit == prefix + ENDINGS[words[-1]], column.name


@pytest.mark.parametrize("columns", [*DECLARED, DESIGNS, GENERATED, COMPARISON])
def test_every_column_is_told_once_with_a_type_and_a_unit(columns: tuple[Column, ...]) -> None:
    assert len({column.name for column in columns}) == len(columns)
    for column in columns:
        assert column.description
        number = pa.types.is_integer(kind := pa.type_for_alias(column.type))
        number = number or pa.types.is_floating(kind)
        assert bool(column.unit) == number, column.name


def test_the_reduced_space_has_a_column_a_dimension() -> None:
    assert [column.name for column in reduced_space(3)] == ["design_id", "z1", "z2", "z3"]
