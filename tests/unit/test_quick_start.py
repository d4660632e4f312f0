"""What the quick start tells to type can be typed."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pagd
from pagd.catalogue import design_from
from pagd.cli.parser import make_parser
from pagd.simulation import simulate

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "quick-start.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", TEXT, flags=re.M | re.S)


def commands() -> list[list[str]]:
    return [shlex.split(line, comments=True) for line in "".join(blocks("sh")).splitlines()]


def test_the_design_can_be_built_and_is_that_of_the_python_code(tmp_path: Path) -> None:
    (described,) = blocks("yaml")
    file = tmp_path / "my_design.yaml"
    file.write_text(described)
    design = design_from(str(file)).design
    assert pagd.violations(design, pagd.GeometryRules()) == ()
    code = blocks("python")[0].partition("result =")[0]
    names: dict[str, object] = {}
    exec(code, names)
    assert names["design"] == design


def test_the_commands_are_those_of_pagd_and_make() -> None:
    targets = re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), flags=re.M)
    found = {"pagd": 0, "make": 0}
    for program, *arguments in commands():
        if program == "pagd":
            make_parser().parse_args(arguments)
        elif program == "make":
            assert set(arguments) <= set(targets)
        found[program] = found.get(program, 0) + 1
    assert found["pagd"] >= 3
    assert found["make"] >= 1


def test_the_python_code_names_what_there_is() -> None:
    code = blocks("python")[0]
    assert set(re.findall(r"pagd\.(\w+)", code)) <= set(pagd.__all__)
    assert "pressure_kPa" in simulate.__annotations__
    assert all(hasattr(pagd.Result, name) for name in re.findall(r"result\.(\w+)", code))


def test_the_files_are_those_that_the_stages_leave() -> None:
    from pagd.stages import metrics, solve

    for name in (solve.STATES_NAME, metrics.PERFORMANCE_NAME, metrics.TRAJECTORY_NAME):
        assert f"/{name}`" in TEXT
