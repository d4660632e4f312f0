"""``--json``: one document on stdout whatever happens, and nothing else."""

from __future__ import annotations

import json
import subprocess
import sys
from argparse import Namespace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pagd.cli import main
from pagd.cli.answer import Answer
from pagd.record import RECORD_NAME

GOOD = {
    "name": "good", "L": 9.51, "W": 15.2, "H": 13.01, "t": 4.02, "t_n": 1.5, "t_h": 3.95,
    "t_ab": 1.95, "t_b": 2.12, "N": 2, "theta": 0, "alpha": 0,
}  # fmt: skip
THIN = GOOD | {"name": "thin", "t": 0.1}
PAGD = [sys.executable, "-m", "pagd"]


def refuse_word(word: str) -> None:
    raise AssertionError(f"{word} is no JSON")


def parsed(text: str) -> dict[str, Any]:
    """The one document of a text; NaN and Infinity are none."""
    document: dict[str, Any] = json.loads(text, parse_constant=refuse_word)
    return document


def answered(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, dict[str, Any], str]:
    """Exit code, document and what is for people of a command with ``--json``."""
    code = main([*map(str, words), "--json"])
    told = capsys.readouterr()
    return code, parsed(told.out), told.err


def test_check_and_show(capsys: pytest.CaptureFixture[str]) -> None:
    code, shown, for_people = answered(capsys, "design", "show", json.dumps(GOOD))
    assert (code, shown["mode"], shown["violations"]) == (0, "bending", [])
    assert shown["L_T"] == pytest.approx(20.52)
    assert "total length" in for_people
    code, checked, _ = answered(capsys, "design", "check", json.dumps(THIN))
    assert (code, checked["can_be_built"]) == (1, False)
    assert [one["key"] for one in checked["violations"]] == ["t"]
    assert "L_T" not in checked


def test_a_stage_answers_with_its_record(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "geometry"
    code, record, _ = answered(capsys, "geometry", json.dumps(GOOD), "--out", out)
    assert (code, record.pop("folder")) == (0, str(out))
    assert record == json.loads((out / RECORD_NAME).read_text())


@pytest.mark.parametrize(("more", "code"), [([], 1), (["--keep-going"], 0)])
def test_a_design_that_fails_answers_with_its_record_too(
    more: list[str], code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["geometry", json.dumps(THIN), "--out", tmp_path / "geometry", *more]
    ended, record, for_people = answered(capsys, *words)
    assert (ended, record["status"]) == (code, "invalid_geometry")
    assert record["reason"] in for_people


def test_the_chain_answers_with_the_record_of_its_metrics(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, record, _ = answered(capsys, "run", json.dumps(THIN), "--out", tmp_path)
    assert (code, record["stage"], record["folder"]) == (1, "metrics", str(tmp_path / "metrics"))
    code, made, _ = answered(capsys, "report", tmp_path, "--out", tmp_path / "page.html")
    assert (code, made) == (0, {"file": str(tmp_path / "page.html"), "designs": 1})
    code, made, _ = answered(capsys, "summary", tmp_path, "--out", tmp_path / "tables")
    assert (code, made["designs"], made["measured"]) == (0, 1, 1)
    code, made, _ = answered(capsys, "view", tmp_path, "--no-browser", "--out", tmp_path / "a.html")
    assert (code, made["designs"]) == (0, 1)
    code, found, _ = answered(capsys, "audit", tmp_path)
    assert (code, found) == (0, {"findings": [], "abandoned": [], "removed": []})
    code, found, _ = answered(capsys, "status", tmp_path)
    assert (code, found["done"]) == (0, 0)


def test_stages_of_all_designs_answer_with_their_record(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["dataset", "--size", "40", "--out", tmp_path / "dataset"]
    code, record, for_people = answered(capsys, *words)
    assert (code, record["stage"], record["figures"]["size"]) == (0, "dataset", 40)
    assert "40 designs" in for_people


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["repair", "--geometry", "absent", "--out", "out"], "absent: there is no such folder."),
        (["repair"], "the following arguments are required: --geometry, --out"),
        (["sovle"], "'sovle' is no command (did you mean solve?)."),
    ],
)
def test_bad_input_is_a_document_as_well(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, document, for_people = answered(capsys, *words)
    assert code == document["error"]["exit_code"] == 2
    assert document["error"]["message"].startswith(message)
    assert for_people == f"pagd: {document['error']['message']}\n"


def test_a_fault_is_a_document_as_well(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(options: Namespace) -> Answer:
        print("before the end")
        raise ZeroDivisionError

    monkeypatch.setattr("pagd.cli.commands.show_design", broken)
    code, document, for_people = answered(capsys, "design", "show", "a")
    assert code == document["error"]["exit_code"] == 70
    assert "before the end" in for_people


def test_numbers_that_json_lacks_are_null(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def odd(options: Namespace) -> Answer:
        return Answer(0, {"a": np.array([1.0, np.nan]), "b": (np.inf, np.int64(2)), "c": Path("d")})

    monkeypatch.setattr("pagd.cli.commands.show_design", odd)
    _, document, _ = answered(capsys, "design", "show", "a")
    assert document == {"a": [1.0, None], "b": [None, 2], "c": "d"}


def test_what_programs_and_libraries_print_is_not_in_between(tmp_path: Path) -> None:
    """They print to the descriptor, behind Python's back."""
    program = (
        "import os, sys\n"
        "from pagd.cli import commands, main\n"
        "from pagd.cli.answer import Answer\n"
        "def loud(options):\n"
        "    os.system('echo of a program'); os.write(1, b'of a library\\n'); print('of Python')\n"
        "    return Answer(0, {})\n"
        "commands.show_design = loud\n"
        "sys.exit(main(['design', 'show', 'a', '--json']))\n"
    )
    answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (answer.returncode, answer.stdout) == (0, "{}\n")
    for text in ("of a program", "of a library", "of Python"):
        assert text in answer.stderr


def test_whoever_has_read_enough_may_go(tmp_path: Path) -> None:
    words = [*PAGD, "design", "show", json.dumps(GOOD), "--json"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        told = process.stderr.read().decode()
    assert process.returncode == 1
    assert "Traceback" not in told


@pytest.mark.parametrize("words", [["--json", "--help"], ["-h", "--json"], ["--json", "-vh"]])
def test_help_is_on_stdout_all_the_same(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(["status", *words])
    assert end.value.code == 0
    told = capsys.readouterr()
    assert told.out.startswith("usage: pagd status")
    assert told.err == ""


def test_a_folder_of_that_name_asks_for_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["view", "--", "--json"]) == 2
    assert capsys.readouterr() == ("", "pagd: --json: there is no such folder.\n")
    assert main(["view", "--worse", "--", "--json"]) == 2
    assert capsys.readouterr().out == ""
