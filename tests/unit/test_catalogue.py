import json
from pathlib import Path

import pytest

from pagd.catalogue import design_from, read_designs
from pagd.errors import InputError

ROOT = Path(__file__).parents[2]
TABLE2 = str(ROOT / "config" / "table2.csv")
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
