"""Tables of designs as people bring them: each is read, or refused in one sentence."""

from __future__ import annotations

import string
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pagd.catalogue import NamedDesign, read_designs
from pagd.cli import main
from pagd.design import PARAMETERS
from pagd.errors import InputError

HEAD = "name,L,W,H,t,t_n,t_h,t_ab,t_b,N,theta,alpha"
ROW = "a,9.5,15,13,4,2,4,2,2.2,2,0,0"
SOUND = f"{HEAD}\n{ROW}\n"
WIDE = ",".join(f"c{n}" for n in range(10_989))

MANY = pd.DataFrame([[1] * 10_989], columns=WIDE.split(","))

#: Files: content as bytes, and words of the sentence that refuses it.
BAD = {
    "sixteen bits": (SOUND.encode("utf-16"), "must be UTF-8 text"),
    "latin": (f"{HEAD},source\n{ROW},Müller\n".encode("latin-1"), "must be UTF-8 text"),
    "binary": (bytes(range(256)), "must be UTF-8 text"),
    "empty": (b"", "is empty, and must have a row of headings"),
    "semicolons": (SOUND.replace(",", ";").encode(), "must be separated by commas"),
    "tabs": (SOUND.replace(",", "\t").encode(), "must be separated by commas"),
    "column twice": (f"{HEAD},L\n{ROW},8\n".encode(), "must have one column L, not two"),
    "column missing": (SOUND.replace(",t_n", "").replace(",2,4", ",4", 1).encode(), "t_n missing"),
    "row too long": (f"{HEAD}\n{ROW},1\n".encode(), "(no heading) is not a known key"),
    "row too short": (f"{HEAD}\n{ROW[:-2]}\n".encode(), "alpha missing"),
    "name twice": (f"{SOUND}{ROW}\n".encode(), "row 3: name = 'a' must be unique"),
    "no number": (SOUND.replace("9.5", '"9,5"').encode(), "L = '9,5' must be a number"),
    "null byte": (SOUND.replace("9.5", "9\0.5").encode(), "row 2: L = "),
    "metres": (
        f"{HEAD}\na,.0095,.015,.013,.004,.002,.004,.002,.0022,2,0,0\n".encode(),
        "lengths must be in mm, and these look like metres",
    ),
    "shell": (SOUND.replace("\na,", '\n"a; touch pwned",').encode(), "must consist of letters"),
    "path": (SOUND.replace("\na,", "\n../../a,").encode(), "must consist of letters"),
    "11,001 columns": (
        f"{HEAD},{WIDE}\n{ROW}{',1' * 10_989}\n".encode(),
        "row 2: c0, c1, c2, c3 and 10,985 more are not known keys",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_table_is_refused_in_one_sentence(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content, words = BAD[name]
    table, out = tmp_path / "table.csv", tmp_path / "out"
    table.write_bytes(content)
    assert main(["screen", str(table), "--out", str(out)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("pagd: ")
    assert str(table) in line
    assert words in line
    assert len(line) < 400
    assert [path.name for path in tmp_path.iterdir()] == ["table.csv"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda frame: frame.drop(columns="t_n"), "t_n missing"),
        (lambda frame: frame.assign(L=None), "L missing"),
        (lambda frame: frame.assign(L="wide"), "L = 'wide' must be a number"),
        (lambda frame: pd.concat([frame, frame]), "row 2: name = 'a' must be unique"),
        (lambda frame: frame.join(MANY), "10,985 more are not known keys"),
    ],
)
def test_a_bad_parquet_table_is_refused_too(tmp_path: Path, change: object, words: str) -> None:
    (tmp_path / "table.csv").write_text(SOUND)
    frame = pd.read_csv(tmp_path / "table.csv").rename(columns={"name": "design_id"})
    table = tmp_path / "table.parquet"
    assert callable(change)
    change(frame).to_parquet(table)
    with pytest.raises(InputError) as caught:
        read_designs({"own": str(table)})
    assert words in str(caught.value)


def test_the_mark_that_spreadsheets_put_first_is_no_part_of_a_name(tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    table.write_text(SOUND, encoding="utf-8-sig")
    assert list(read_designs({"own": str(table)})) == ["a"]


CELLS = st.one_of(
    st.floats(width=32).map(str),
    st.integers(-10, 100).map(str),
    st.text(alphabet=string.printable, max_size=8),
    st.sampled_from(["", "nan", "inf", "-0", "1e400", "0x10", "１", "١", "$(reboot)", "'", '"']),
)
TABLES = st.lists(st.lists(CELLS, min_size=1, max_size=14), max_size=4)
SLOW_FOLDER = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def read_or_refused(table: Path) -> dict[str, NamedDesign]:
    """The designs of a table; none where it is refused, in a sentence that names it."""
    refusal = None
    try:
        return read_designs({"own": str(table)})
    except InputError as error:
        refusal = str(error)
    assert str(table) in refusal
    return {}


@SLOW_FOLDER
@given(rows=TABLES, heading=st.sampled_from([HEAD, HEAD[:-6], f"{HEAD},notes"]))
def test_any_table_is_read_or_refused(tmp_path: Path, rows: list[list[str]], heading: str) -> None:
    table = tmp_path / "table.csv"
    text = "\n".join([heading, *(",".join(row) for row in rows)])
    table.write_text(text, encoding="utf-8", newline="")
    for name, named in read_or_refused(table).items():
        assert name == named.name
        assert set(name) <= set(string.ascii_letters + string.digits + "_-")
        assert all(isinstance(value, int | float) for value in named.design.as_dict().values())


@SLOW_FOLDER
@given(content=st.binary(max_size=400), ending=st.sampled_from([".csv", ".parquet"]))
def test_any_bytes_are_read_or_refused(tmp_path: Path, content: bytes, ending: str) -> None:
    table = tmp_path / f"table{ending}"
    table.write_bytes(content)
    assert read_or_refused(table) == {}


@given(values=st.dictionaries(st.sampled_from(list(PARAMETERS)), st.floats(0.6, 1e3)))
def test_sound_numbers_come_through(values: dict[str, float], tmp_path_factory: object) -> None:
    assert isinstance(tmp_path_factory, pytest.TempPathFactory)
    row = dict(zip(HEAD.split(","), ROW.split(","), strict=True)) | {"N": "3"}
    row |= {key: repr(value) for key, value in values.items() if key != "N"}
    table = tmp_path_factory.getbasetemp() / "numbers.csv"
    table.write_text(f"{HEAD}\n{','.join(row.values())}\n")
    (named,) = read_designs({"own": str(table)}).values()
    assert named.design.as_dict() == {key: float(row[key]) for key in PARAMETERS}
