"""What the quick start tells to type can be typed."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pagd
from pagd.catalogue import design_from
from pagd.cli import main
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


def files_told() -> list[str]:
    """The files of the table, as patterns within the folder of the run."""
    rows = TEXT.partition("| in `my_design/` |")[2].partition("\n\n")[0].splitlines()[2:]
    return [name for row in rows for name in re.findall(r"`([^`]+)`", row.split("|")[1])]


def test_the_files_are_those_that_a_run_leaves(tmp_path: Path) -> None:
    """The command as it is told, on a coarse mesh, and the folder that it leaves."""
    (tmp_path / "my_design.yaml").write_text(blocks("yaml")[0])
    (words,) = (each[1:] for each in commands() if each[:2] == ["pagd", "run"])
    words[words.index("my_design.yaml")] = str(tmp_path / "my_design.yaml")
    words[words.index("my_design")] = str(tmp_path / "my_design")
    words[words.index("--pressure-kPa") + 1] = "4"
    coarse = ["--block-mm", "12", "--config", json.dumps({"figures": {"resolution_dpi": 50}})]
    assert main([*words, *coarse]) == 0
    left = {path for path in (tmp_path / "my_design").rglob("*") if path.is_file()}
    told = {name: set((tmp_path / "my_design").glob(name)) for name in files_told()}
    assert [name for name, found in told.items() if not found] == []
    # One record a stage; and no picture that the table leaves out.
    assert {path.parent.name for path in told["*/record.json"]} == {
        path.parent.name for path in left
    }
    assert {path for path in left if path.suffix == ".png"} <= set().union(*told.values())
