"""docs/verification.md has every case, and nothing on it fails; what fails would show."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import running
from catalogue import CASES, find
from figure import Case, Figure, Group
from report import page, write_data
from running import Outcome, outcome
from written_page import PAGE, names_on_page, sections

GOOD = Figure(name="a | b", source="rule", reference=2.0, value=2.01, tolerance=0.01, unit="mm")
BAD = Figure(name="c", source="rule", reference=2.0, value=2.1, tolerance=0.01)
CIRCUMSTANCES = {
    "versions": {"python": "3.11", "numpy": "2", "scipy": "1", "numba": "0"}
    | {"gmsh": "4", "pypardiso": None},
    "machine": {"cores": 2, "processor": "a processor"},
    "processes": 2,
    "seconds": 60.0,
    "commit": "abc",
    "date": "2026-01-01T00:00:00",
}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_case_has_rows_on_the_page_and_they_pass(case: Case) -> None:
    names = names_on_page(case)
    assert names, f"no rows of {case.name} on the page; make verify writes it"
    assert len(set(names)) == len(names)


def test_no_case_is_on_the_page_that_is_no_more() -> None:
    assert len(sections()) == len(CASES)


def test_everything_on_the_page_passes() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert "FAIL" not in text
    assert "broke off" not in text
    marks = [row[6] for rows in sections().values() for row in rows]
    assert set(marks) == {"pass"}


def test_errors_on_the_page_are_within_the_tolerances() -> None:
    for rows in sections().values():
        for *_, error, tolerance, _, _ in rows:
            assert abs(_share(error)) <= _share(tolerance)


def _share(cell: str) -> float:
    return float(cell[:-1]) / 100 if cell.endswith("%") else float(cell)


def test_every_row_names_its_source() -> None:
    assert all(row[-1] for rows in sections().values() for row in rows)


def test_what_fails_shows_on_the_page() -> None:
    name = CASES[0].name
    text = page([Outcome(case=name, figures=(GOOD, BAD))], CIRCUMSTANCES)
    assert "| a \\| b | 2 | 2.01 | mm | 0.50% | 1.00% | pass | rule |" in text
    assert "| c | 2 | 2.1 |  | 5.00% | 1.00% | **FAIL** | rule |" in text
    assert f"| [{CASES[0].group}](#elements-and-material) | 1 | 2 | 1 |" in text


def test_what_breaks_off_or_is_left_out_shows_on_the_page() -> None:
    outcomes = [
        Outcome(case=CASES[0].name, fault="ValueError: no"),
        Outcome(case=CASES[1].name, missing="ccx"),
    ]
    text = page(outcomes, CIRCUMSTANCES)
    assert "broke off" in text
    assert "ValueError: no" in text
    assert "Left out: the program `ccx`" in text


def test_the_rows_as_data(tmp_path: Path) -> None:
    file = tmp_path / "verification.json"
    write_data([Outcome(case=CASES[0].name, figures=(GOOD, BAD), seconds=2.0)], 1, 2.0, file)
    content = json.loads(file.read_text(encoding="utf-8"))
    assert [row["pass"] for row in content["rows"]] == [True, False]
    assert content["rows"][1]["pass"] is False
    assert content["rows"][0]["group"] == CASES[0].group
    assert content["rows"][0]["error"] == pytest.approx(0.005)
    assert content["machine"]["cores"] >= 1


def test_a_case_that_raises_is_an_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> list[Figure]:
        raise ValueError("no")

    monkeypatch.setattr(running, "find", lambda _: [Case(rows=broken, group=Group.solids)])
    found = outcome("broken")
    assert not found.passes
    assert "ValueError: no" in found.fault


def test_a_case_without_its_program_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    case = Case(rows=lambda: [BAD], group=Group.programs, program="no-such-program")
    monkeypatch.setattr(running, "find", lambda _: [case])
    found = outcome("anything")
    assert found.missing == "no-such-program"
    assert found.passes


def test_outcomes_pass_if_all_rows_do() -> None:
    assert Outcome(case="x", figures=(GOOD,)).passes
    assert not Outcome(case="x", figures=(GOOD, BAD)).passes
    assert not Outcome(case="x").passes


def test_a_name_that_is_no_case_is_refused() -> None:
    with pytest.raises(ValueError, match="'nothing' is no case"):
        find(["nothing"])
