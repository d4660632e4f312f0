"""The page of costs: its sections, the commands that they name, and numbers in cells."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from pagd.errors import InputError
from pagd.fem.linear_solver import PardisoSolver, linear_solver

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

from performance import bounds, cells  # noqa: E402
from performance.memory import Memory  # noqa: E402
from performance.options import add_common, command_of, must_be_positive  # noqa: E402
from performance.origin import origin_lines  # noqa: E402
from performance.page import (  # noqa: E402
    must_have_section,
    publish,
    read_section,
    table,
    wrapped,
    write_section,
)

PAGE = ROOT / "docs" / "performance.md"
SECTIONS = (
    *("profile", "bounds", "random", "elements", "peers-same-mesh", "peers-equal-error"),
    *("peers-iteration", "sweep", "unknowns", "chambers", "cores"),
)


@pytest.fixture
def page(tmp_path: Path) -> Path:
    file = tmp_path / "page.md"
    one, two = (f"<!-- begin {name} -->\n\nold\n\n<!-- end {name} -->" for name in ("one", "two"))
    file.write_text(f"# A page\n\n{one}\n\nBetween.\n\n{two}\n\nLast.\n", encoding="utf-8")
    return file


def test_a_section_is_replaced_and_nothing_else(page: Path) -> None:
    before = page.read_text(encoding="utf-8")
    write_section(page, "two", "\nnew: ≤ 3 %\n\n")
    after = page.read_text(encoding="utf-8")
    assert read_section(page, "two") == "new: ≤ 3 %"
    assert read_section(page, "one") == "old"
    assert after == "new: ≤ 3 %".join(before.rsplit("old", 1))
    write_section(page, "two", "old")
    assert page.read_text(encoding="utf-8") == before


def test_a_section_may_be_empty_and_a_name_the_beginning_of_another(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- begin a-b -->\n<!-- end a-b -->\n<!-- begin a -->\n<!-- end a -->\n")
    assert read_section(page, "a") == ""
    write_section(page, "a", "here")
    assert (read_section(page, "a-b"), read_section(page, "a")) == ("", "here")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("nothing", "must hold the line <!-- begin one --> once, not 0 times"),
        ("<!-- begin one -->", "must hold the line <!-- end one --> once, not 0 times"),
        ("<!-- end one -->\n<!-- begin one -->", "must begin before it ends"),
        ("<!-- begin one -->\n<!-- end one -->\n" * 2, "once, not 2 times"),
    ],
)
def test_markers_must_be_there_once_and_in_order(content: str, said: str, tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(content)
    with pytest.raises(InputError, match=re.escape(said)):
        write_section(page, "one", "text")
    assert page.read_text() == content
    with pytest.raises(InputError, match=re.escape(said)):
        must_have_section(page, "one")


def test_a_text_with_markers_is_refused(page: Path) -> None:
    before = page.read_text(encoding="utf-8")
    with pytest.raises(InputError, match="must not hold markers"):
        write_section(page, "one", "<!-- begin two -->")
    assert page.read_text(encoding="utf-8") == before


def test_a_page_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"page\.md: there is no such file"):
        write_section(tmp_path / "page.md", "one", "text")


def test_without_a_page_the_section_is_printed(
    page: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    publish(None, "one", "text\n")
    assert capsys.readouterr().out == "text\n"
    publish(page, "one", "text\n")
    assert "section 'one'" in capsys.readouterr().out
    assert read_section(page, "one") == "text"


@pytest.mark.parametrize("name", SECTIONS)
def test_every_section_of_the_page_begins_with_a_command(name: str) -> None:
    text = read_section(PAGE, name)
    first, _, _ = text.partition("\n\n")
    script = re.search(r"\bpython (benchmarks/\w+\.py)", first)
    assert script
    assert (ROOT / script[1]).is_file()
    if not first.startswith("Not measured yet"):
        assert re.search(r"\bCommit [0-9a-f]{7}", " ".join(text.split()))


def test_the_page_has_no_other_sections() -> None:
    found = re.findall(r"<!-- begin (\S+) -->", PAGE.read_text(encoding="utf-8"))
    assert sorted(found) == sorted(SECTIONS)


def test_a_section_tells_command_machine_versions_and_commit() -> None:
    command, told = origin_lines("python benchmarks/x.py", ["numpy", "absent"]).split("\n\n")
    assert command == "`python benchmarks/x.py`"
    line = " ".join(told.split())
    assert re.search(r"\d+ cores, \d+ GB, .*\bnumpy \d.*\bpagd \d.*\bpython 3", line)
    assert "absent" not in line
    assert re.search(r"Commit \S+\.$", line)
    several = origin_lines("x", commits=["b2", "a1", None, "a1"])
    assert several.endswith("Commit a1, b2, unknown.")


def test_a_long_command_has_a_line_for_each_option() -> None:
    command = "python benchmarks/x.py" + "".join(f" --option-{k} {k}{k}" for k in range(9))
    shown = origin_lines(command).partition("\n\n")[0]
    lines = shown.removeprefix("```sh\n").removesuffix("\n```").split(" \\\n  ")
    assert len(lines) == 10
    assert " ".join(lines) == command


def options(*words: str) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    parser.add_argument("--sizes", type=float, nargs="+", default=[5.0, 3.0])
    add_common(parser)
    return parser.parse_args(words)


@pytest.mark.parametrize(
    ("words", "printed"),
    [
        ([], ""),
        (["--out", "elsewhere", "--anew", "--time-limit", "1", "--sizes", "5", "3"], ""),
        (["--sizes", "2.5", "2"], " --sizes 2.5 2"),
        (
            ["--config", '{"paper": "x"}', "--page", "p.md"],
            """ --page p.md --config '{"paper": "x"}'""",
        ),
    ],
)
def test_the_command_has_the_options_that_change_what_it_prints(
    words: list[str], printed: str
) -> None:
    found = command_of("x.py", vars(options(*words)), vars(options()), "cores")
    assert found == "python x.py cores" + printed


def test_options_must_be_positive() -> None:
    must_be_positive({"size": 1.0, "sizes": [1.0, 2]})
    with pytest.raises(InputError, match="--sizes = -2 must be greater than 0"):
        must_be_positive({"size": 1.0, "sizes": [1.0, -2.0]})
    with pytest.raises(InputError, match="--size = nan"):
        must_be_positive({"size": float("nan")})


def test_cells() -> None:
    assert [cells.cell(None), cells.cell(float("nan")), cells.cell(1234.56)] == [
        "–",
        "–",
        "1,234.6",
    ]
    assert [cells.count(1234.5678), cells.count(None)] == ["1,235", "–"]
    assert [cells.percent(0.1234), cells.percent(0.03, 0), cells.percent(None)] == [
        *("12.3 %", "3 %", "–"),
    ]
    assert [cells.significant(x) for x in (12345.6, 12.345, 0.0012345, -0.5, 0.0, None)] == [
        *("12,346", "12.3", "0.00123", "-0.500", "0", "–"),
    ]
    assert (cells.scaled(2.0, 1e3), cells.scaled(None, 1e3)) == (2e3, None)


def test_tables_and_paragraphs() -> None:
    assert table(["a", "b"], [["c", "1"]]) == "| a | b |\n| --- | ---: |\n| c | 1 |"
    lines = wrapped("word " * 60, "  ").split("\n")
    assert max(map(len, lines)) <= 100
    assert lines[1].startswith("  word")


def test_bounds_are_the_least_times_over_those_measured() -> None:
    rates = bounds.Rates(operations=80.0, memory=20.0)
    one = bounds.Bounds(40_000, 12, 10_000_000, 4.0, 0.1, factorisation_s=0.2, solution_s=0.016)
    held = Memory(imports=300, body=350, tangent=400, factors=600, nonzeros=80, peak=650)
    text = bounds.text_of(rates, {"bending": one}, {"bending": held}, 30.0)
    assert "| non-zeros of the factors among it | 80 |" in text
    assert "at 30 kPa" in text
    cells = dict(re.findall(r"^\| (.+?) \| (.+?) \|$", text, re.MULTILINE))
    assert cells["factorisation, GFLOP/s"] == "20.0"
    assert cells["factorisation, share of the dense product's rate"] == "25%"
    assert cells["solution, least time over time"] == "50%"


@pytest.mark.skipif(
    not isinstance(linear_solver(), PardisoSolver), reason="MKL exists for x86-64 only"
)
def test_operations_of_a_factorisation_are_counted() -> None:
    """Of a full symmetric matrix n³/3 at least; Pardiso's blocks do some twice."""
    solver = bounds.CountingSolver()
    for size in (400, 500):
        rows, columns = np.triu_indices(size)
        starts = np.searchsorted(rows, np.arange(size + 1)).astype(np.int32)
        values = np.where(rows == columns, 2.0 * size, 1.0)
        solver.analyse(starts, columns.astype(np.int32))
        solver.solve(values, np.ones(size))
        assert 1.0 <= solver.operations / (size**3 / 3 / 1e9) <= 1.5
