import csv
import json
from pathlib import Path

import pytest

from pagd.catalogue import design_from, read_designs
from pagd.design import GeometryRules, violations
from pagd.errors import InputError
from pagd.tables import DESIGNS, GENERATED, Column, write_rows

ROOT = Path(__file__).parents[2]
TABLE2 = str(ROOT / "config" / "table2.csv")
PUBLISHED = str(ROOT / "config" / "published_designs.csv")
HEAD = "name,L,W,H,t,t_n,t_h,t_ab,t_b,N,theta,alpha\n"
ROW = "9.51,15.2,13.01,4.02,1.5,3.95,1.95,2.12,12,0,0\n"


def table(folder: Path, text: str) -> dict[str, str]:
    (folder / "designs.csv").write_text(text)
    return {"own": str(folder / "designs.csv")}


def test_table2_has_one_design_of_each_mode() -> None:
    designs = read_designs({"table2": TABLE2})
    assert {name: named.design.mode for name, named in designs.items()} == {
        "bending": "bending",
        "twisting": "twisting",
        "mixed": "mixed",
    }
    assert {named.origin for named in designs.values()} == {"table2"}


def test_a_design_survives_the_way_through_json(tmp_path: Path) -> None:
    for named in read_designs({"table2": TABLE2}).values():
        assert design_from(named.as_json()) == named
        (tmp_path / "design.json").write_text(named.as_json())
        assert design_from(str(tmp_path / "design.json")) == named


def test_a_number_that_is_not_finite_is_left_to_the_rules(tmp_path: Path) -> None:
    designs = read_designs(table(tmp_path, HEAD + "odd," + ROW.replace("9.51", "nan")))
    path = tmp_path / "design.json"
    path.write_text(designs["odd"].as_json())
    assert str(design_from(str(path)).design.L) == "nan"


def test_the_file_name_serves_as_name(tmp_path: Path) -> None:
    values = json.loads(read_designs({"table2": TABLE2})["mixed"].as_json())
    del values["name"], values["origin"]
    path = tmp_path / "my best design.yaml"
    path.write_text(json.dumps(values))
    named = design_from(str(path))
    assert (named.name, named.origin) == ("my-best-design", "own")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (HEAD + "a," + ROW.replace("15.2", "wide"), r"row 2: W = 'wide' must be a number"),
        (HEAD + "a," + ROW.replace(",12,", ",12.5,"), r"row 2: N = 12\.5 must be a whole number"),
        (HEAD + "a," + ROW.replace("15.2", ""), r"row 2: W missing"),
        (HEAD + "," + ROW, r"row 2: name missing"),
        (HEAD + "a b," + ROW, r"row 2: name = 'a b' must consist of letters, digits, _ and -"),
        (HEAD + "a," + ROW + "a," + ROW, r"row 3: name = 'a' must be unique"),
        (HEAD.replace("t_b", "tb") + "a," + ROW, r"tb is not a known key \(did you mean t_b\?\)"),
        (HEAD + "a," + ROW.strip() + ",7\n", r"\(no heading\) is not a known key"),
    ],
)
def test_a_bad_table_names_row_key_and_rule(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_designs(table(tmp_path, text))


def test_names_are_unique_over_all_tables(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"row 2: name = 'bending' must be unique"):
        read_designs({"table2": TABLE2, "own": TABLE2})


def test_a_missing_table_is_told() -> None:
    with pytest.raises(InputError, match=r"table of designs absent\.csv: cannot be read"):
        read_designs({"own": "absent.csv"})


def test_published_designs_can_be_built_and_name_their_sources() -> None:
    designs = read_designs({"table2": TABLE2, "published": PUBLISHED})
    published = [named for named in designs.values() if named.origin == "published"]
    assert len(published) == 3
    assert all(not violations(named.design, GeometryRules()) for named in published)
    with Path(PUBLISHED).open(newline="", encoding="utf-8") as file:
        assert all(row["source"] for row in csv.DictReader(file))


@pytest.mark.parametrize("name", ["srt_fast_pneunet", "gibbon_multi", "spa_fem_example"])
def test_published_cavities_have_the_published_size(name: str) -> None:
    design = read_designs({"published": PUBLISHED})[name].design
    inner = (design.L - 2 * design.t_ab, design.W - 2 * design.t, design.H - design.t_h)
    with Path(PUBLISHED).open(newline="", encoding="utf-8") as file:
        notes = next(row["notes"] for row in csv.DictReader(file) if row["name"] == name)
    assert notes.startswith("inner size " + " x ".join(f"{size:g}" for size in inner))


def test_a_better_citation_changes_no_design(tmp_path: Path) -> None:
    plain = read_designs(table(tmp_path, HEAD + "a," + ROW))["a"]
    text = HEAD.strip() + ",source,notes\n" + "a," + ROW.strip() + ',"A paper, 2020",3\n'
    cited = read_designs(table(tmp_path, text))["a"]
    assert cited == plain
    assert cited.as_json() == plain.as_json()
    assert design_from(json.dumps({**json.loads(plain.as_json()), "source": "A paper"})) == plain


def rows_of_table2() -> list[dict[str, object]]:
    named = read_designs({"table2": TABLE2}).values()
    return [{"design_id": n.name, "origin": n.origin, **n.design.as_dict()} for n in named]


@pytest.mark.parametrize("columns", [DESIGNS, GENERATED])
def test_a_table_of_pagd_s_own_comes_back(tmp_path: Path, columns: tuple[Column, ...]) -> None:
    # What follows from the parameters is not read, and so cannot contradict them.
    rows = [{**row, "L_T": 1.0, "mode": "bending"} for row in rows_of_table2()]
    write_rows(tmp_path / "designs.parquet", columns, rows)
    again = read_designs({"own": str(tmp_path / "designs.parquet")})
    assert again == read_designs({"table2": TABLE2})


def test_a_parquet_table_may_have_names_and_no_origin(tmp_path: Path) -> None:
    columns = [Column("name", "string", "", ""), *(c for c in DESIGNS if c.name != "design_id")]
    rows = [{**row, "name": row["design_id"]} for row in rows_of_table2()]
    for row in rows:
        del row["design_id"], row["origin"]
    write_rows(tmp_path / "designs.parquet", columns, rows)
    again = read_designs({"own": str(tmp_path / "designs.parquet")})
    assert list(again) == ["bending", "twisting", "mixed"]
    assert {named.origin for named in again.values()} == {"own"}


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ({"W": None}, r"designs\.parquet, row 2: W missing"),
        ({"design_id": None}, r"row 2: name missing"),
        ({"design_id": "bending"}, r"row 2: name = 'bending' must be unique"),
        ({"tb": 1.0}, r"row 2: tb is not a known key"),
    ],
)
def test_a_bad_parquet_table_names_row_key_and_rule(
    tmp_path: Path, fault: dict[str, object], words: str
) -> None:
    rows = rows_of_table2()
    rows[1] |= fault
    columns = [*DESIGNS, *(Column(key, "double", "mm", "") for key in fault if key == "tb")]
    write_rows(tmp_path / "designs.parquet", columns, rows)
    with pytest.raises(InputError, match=words):
        read_designs({"own": str(tmp_path / "designs.parquet")})


def test_a_parquet_file_that_is_none_is_told(tmp_path: Path) -> None:
    (tmp_path / "designs.parquet").write_text(HEAD)
    with pytest.raises(InputError, match="not a readable Parquet table"):
        read_designs({"own": str(tmp_path / "designs.parquet")})
