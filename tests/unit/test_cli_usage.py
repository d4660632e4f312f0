"""What somebody new meets: the help, words that are misspelt, the examples of the documents."""

from __future__ import annotations

import argparse
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import pytest

from pagd.cli import main
from pagd.cli.parser import make_parser

ROOT = Path(__file__).parents[2]
THIN = (
    '{"name": "thin", "L": 9.5, "W": 15, "H": 13, "t": 0.1, "t_n": 1.5, "t_h": 4, "t_ab": 2,'
    ' "t_b": 2.2, "N": 2, "theta": 0, "alpha": 0}'
)


def commands() -> dict[str, argparse.ArgumentParser]:
    """Every subcommand by its words."""

    def below(parser: argparse.ArgumentParser, words: str) -> Iterator[tuple[str, object]]:
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                for name, one in action.choices.items():
                    yield f"{words}{name}", one
                    yield from below(one, f"{words}{name} ")

    return dict(below(make_parser(), ""))  # type: ignore[arg-type]


def examples() -> list[str]:
    """The commands in the documents' blocks of shell."""
    found = []
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        for block in re.findall(r"^```sh\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE):
            for line in block.replace("\\\n", " ").splitlines():
                if line.startswith("pagd ") and "…" not in line:
                    found.append(line.partition(" > ")[0])
    return found


def test_every_command_is_under_one_heading(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    headings = make_parser().headings
    listed = [name for names in headings.values() for name in names]
    assert sorted(listed) == sorted(name for name in commands() if " " not in name)
    text = make_parser().format_help()
    for line in listed:
        assert re.search(rf"^  {line} +\S.*\n(  \S|\n)", text, re.MULTILINE), f"{line}: two lines"
    places = [text.index(f"\n{heading}:\n") for heading in headings]
    assert places == sorted(places)


@pytest.mark.parametrize("command", list(commands()))
def test_help_of_every_command(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main([*command.split(), "--help"])
    assert end.value.code == 0
    told = capsys.readouterr().out
    assert told.startswith(f"usage: pagd {command}")
    if command != "design":
        assert "--json" in told
        example = told[told.index("\nexample:\n  ") :].split()[1:]
        assert example[: 1 + len(command.split())] == ["pagd", *command.split()]
        assert callable(make_parser().parse_args(example[1:]).handler)


def test_pagd_alone_prints_its_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert "one design:\n  run " in told.err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["sovle"], "'sovle' is no command (did you mean solve?)."),
        (["xyz"], "'xyz' is no command (see pagd --help)."),
        (["design", "chek", "a"], "'chek' is no action (did you mean check?)."),
        (
            ["screen", "a.csv", "--out", "b", "--matrial", "c"],
            "--matrial is not an option of pagd screen (did you mean --material?).",
        ),
        (
            ["run", "a", "b", "--out", "c"],
            "b is not an argument of pagd run (see pagd run --help).",
        ),
        (["--json", "status"], "--json must come after the subcommand: pagd status … --json."),
        (
            ["design", "--json", "show", "a"],
            "--json must come after the subcommand: pagd design show … --json.",
        ),
        (
            ["status", "--js"],
            "--js is not an option of pagd status (did you mean --json?).",
        ),
        (["run", "a"], "the following arguments are required: --out (see pagd run --help)."),
        (
            ["generate", "--mode", "bent", "--out", "a"],
            "argument --mode: invalid choice: 'bent' (choose from",
        ),
    ],
)
def test_bad_usage_is_one_sentence(
    words: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"pagd: {sentence}")
    assert told.count("\n") == 1


@pytest.mark.parametrize("words", [["view"], ["view", "empty"], ["report", "empty", "--out", "a"]])
def test_without_results_the_user_is_told_what_to_do(
    words: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty").mkdir()
    assert main(words) == 2
    assert "`pagd run DESIGN.yaml --out FOLDER` makes some" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["empty"]


def test_view_takes_the_designs_of_a_run_of_the_workflow(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["run", THIN, "--out", "results/designs/thin"]) == 1
    (tmp_path / "results/designs/begun").mkdir()
    capsys.readouterr()
    assert main(["view", "--no-browser"]) == 0
    told = capsys.readouterr()
    page = tmp_path / "results/designs.html"
    assert told.out == f"{page}\n"
    assert "1 of 2 designs have results" in told.err
    assert "thin" in page.read_text()


def test_the_documents_have_examples() -> None:
    assert len(examples()) > 20


@pytest.mark.parametrize("line", examples())
def test_examples_of_the_documents_are_commands(line: str) -> None:
    words = shlex.split(line, comments=True)[1:]
    if "--print-completion" in words:
        return
    options = make_parser().parse_args(words)
    assert callable(options.handler)


@pytest.mark.parametrize("name", ["one.yaml", "one.yml", "one.json"])
def test_screen_wants_a_table(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_text(THIN)
    assert main(["screen", str(tmp_path / name), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert told == (
        f"pagd: table of designs {tmp_path / name}: must be a table, CSV or Parquet, of designs.\n"
    )
