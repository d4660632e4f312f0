import contextlib
import io
import json
import re
import shutil
import subprocess
import sys
import webbrowser
from pathlib import Path

import pytest

from pagd.cli import main
from pagd.cli.parser import make_parser
from pagd.record import read_record

GOOD = {
    "L": 9.51, "W": 15.2, "H": 13.01, "t": 4.02, "t_n": 1.5, "t_h": 3.95, "t_ab": 1.95,
    "t_b": 2.12, "N": 2, "theta": 0, "alpha": 0,
}  # fmt: skip
THIN = GOOD | {"name": "thin", "t": 0.1, "t_ab": 0.2}


def test_help_names_every_stage_and_imports_nothing_heavy() -> None:
    code = (
        "import sys\n"
        "from pagd.cli.parser import make_parser\n"
        "print(make_parser().format_help())\n"
        "heavy = {'gmsh', 'pymeshlab', 'pyvista', 'pandas', 'matplotlib', 'numba', 'scipy'}\n"
        "heavy |= {'sklearn', 'openTSNE', 'pyarrow'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules)\n"
    )
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert answer.returncode == 0, answer.stderr
    simulation = ("run", "design", "geometry", "repair", "mesh", "solve", "metrics", "figures")
    generation = ("dataset", "embed", "generate", "diversity", "select")
    for stage in simulation + generation:
        assert re.search(rf"^  {stage}\s", answer.stdout, re.MULTILINE)


def test_every_subcommand_has_a_handler() -> None:
    from pagd.cli import commands, generative

    subcommands = make_parser()._subparsers._group_actions[0].choices  # type: ignore[union-attr]
    for name, parser in subcommands.items():  # type: ignore[union-attr]
        if name != "design":
            assert parser.get_default("handler").__closure__ is not None
    for module in (commands, generative):
        for name in module.__all__:
            assert callable(getattr(module, name))


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_shells_can_complete_words(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--print-completion", shell])
    assert end.value.code in (None, 0)
    text = capsys.readouterr().out
    assert "check-archive" in text
    assert "keep-going" in text


@pytest.mark.skipif(not shutil.which("bash"), reason="needs: bash")
def test_bash_completes_subcommands_and_options(tmp_path: Path) -> None:
    with pytest.raises(SystemExit), contextlib.redirect_stdout(io.StringIO()) as script:
        main(["--print-completion", "bash"])
    (tmp_path / "completion").write_text(script.getvalue())
    words = """
        source completion
        complete_of() {
            COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=()
            function=$(complete -p pagd | sed -E 's/.*-F ([^ ]+).*/\\1/')
            "$function" pagd "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
            echo "${COMPREPLY[@]}"
        }
        complete_of pagd stat
        complete_of pagd status --js
    """
    answer = subprocess.run(
        ["bash", "-c", words], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert answer.stdout.split() == ["status", "--json"]


def test_view_writes_the_page_beside_the_design_and_opens_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", json.dumps(THIN), "--out", str(tmp_path / "thin")]) == 1
    capsys.readouterr()
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda url: bool(opened.append(url)))
    assert main(["view", str(tmp_path / "thin")]) == 0
    page = tmp_path / "thin.html"
    told = capsys.readouterr()
    assert opened == [page.as_uri()]
    assert told.out == f"{page}\n"
    assert told.err.endswith("pagd: no browser was found; open the page in one.\n")
    assert 'data-address="thin_files/thin"' in page.read_text()
    assert "t_ab = 0.2" in (tmp_path / "thin_files" / "thin" / "card.js").read_text()
    assert main(["view", str(tmp_path / "thin"), "--no-browser"]) == 0
    assert len(opened) == 1


def test_show_tells_what_follows(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["design", "show", json.dumps(GOOD)]) == 0
    shown = capsys.readouterr().out
    assert "L_T" in shown
    assert "20.52 mm" in shown
    assert "bending" in shown


def test_check_tells_every_broken_rule(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["design", "check", json.dumps(GOOD)]) == 0
    assert main(["design", "check", json.dumps(THIN)]) == 1
    told = capsys.readouterr().out
    assert "t = 0.1: the side walls must be at least 0.75 mm" in told
    assert "t_ab = 0.2: the walls between chambers must be at least 0.75 mm" in told


def test_limits_can_be_moved(capsys: pytest.CaptureFixture[str]) -> None:
    config = json.dumps({"limits": {"thickness_mm": 0.1}})
    assert main(["design", "check", json.dumps(THIN), "--config", config]) == 0


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["design", "show", '{"L": 1}'], "pagd: design design: W, H, t, t_n"),
        (["design", "show", "absent.yaml"], "pagd: design absent.yaml: cannot be read"),
        (
            ["design", "check", json.dumps(GOOD), "--config", '{"limits": {"gap": 1}}'],
            "pagd: configuration: limits.gap is not a known key (did you mean gap_mm?)",
        ),
        (["repair", "--geometry", "absent", "--out", "out"], "pagd: absent: there is no such fold"),
        (["mesh", "--body", "b.stl", "--out", "out"], "pagd: --body and --base must be given toge"),
        (["mesh", "--out", "out"], "pagd: mesh needs a design, or --geometry and --repair, or "),
        (["mesh", "--size-mm", "nan", "--out", "out"], "pagd: command line: mesh.size_mm = nan mu"),
        (
            ["solve", "--mesh", "a", "--pressure-kPa", "inf", "--out", "out"],
            "pagd: command line: solve.maximum_pressure_kPa = inf must be finite.",
        ),
        (
            ["metrics", "--mesh", "a", "--solve", "b", "--sections", "1", "--out", "out"],
            "pagd: --sections = 1 must be at least 2.",
        ),
        (
            ["solve", "--mesh", "a", "--paper", "nope", "--out", "out"],
            "pagd: paper is 'nope', but must be one of paper (in ",
        ),
        (
            ["solve", "--mesh", "a", "--paper", '{"E": 1}', "--out", "out"],
            "pagd: paper: name is missing",
        ),
        (["mesh", "--size-mm", "-1", "--out", "out"], "pagd: command line: mesh.size_mm = -1.0 mu"),
        (["solve", "--mesh", "absent.msh", "--out", "out"], "pagd: absent.msh: there is no such"),
        (["solve", "--mesh", "a", "--threads", "0", "--out", "out"], "pagd: --threads = 0 must be"),
        (["solve", "--mesh", "a", "--material", "x", "--out", "out"], "pagd: material is 'x', but"),
        (
            ["dataset", "--size", "0", "--out", "out"],
            "pagd: command line: dataset.size = 0 must",
        ),
        (
            ["dataset", "--sampling", "grid", "--out", "out"],
            "pagd: command line: dataset.sampling",
        ),
        (
            ["embed", "--dataset", "absent", "--out", "out"],
            "pagd: absent: there is no such fold",
        ),
        (
            ["generate", "--generator", "x", "--out", "out"],
            "pagd: command line: generator.method",
        ),
        (
            ["generate", "--embedding", "a", "--out", "out"],
            "pagd: embedding = a needs the data",
        ),
        (["generate", "--threads", "0", "--out", "out"], "pagd: --threads = 0 must be at least 1."),
        (
            ["select", "--dataset", "a", "--generated", "b", "-n", "-1", "--out", "out"],
            "pagd: command line: selection.designs = -1 must be at least 0.",
        ),
    ],
)
def test_bad_input_is_one_sentence_and_code_2(
    arguments: list[str],
    sentence: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    told = capsys.readouterr().err
    assert told.startswith(sentence)
    assert told.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_fault_of_pagd_is_told_from_a_failed_design(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(options: object) -> int:
        raise ZeroDivisionError("out of order")

    monkeypatch.setattr("pagd.cli.commands.show_design", broken)
    assert main(["design", "show", json.dumps(GOOD)]) == 70
    told = capsys.readouterr().err
    assert told.startswith("Traceback")
    assert "ZeroDivisionError: out of order" in told
    assert told.endswith("please report it\n")


def test_a_failed_design_is_1_for_people_and_0_for_the_workflow(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["geometry", "--design", json.dumps(THIN), "--out", str(tmp_path / "geometry")]
    assert main(command) == 1
    assert "thin: invalid_geometry: The design cannot be built: t = 0.1" in capsys.readouterr().err
    assert main([*command, "--keep-going"]) == 0
    record = read_record(tmp_path / "geometry")
    assert record.status == "invalid_geometry"
    assert "t = 0.1" in str(record.reason)
    assert "t_ab = 0.2" in str(record.reason)
    assert sorted(p.name for p in (tmp_path / "geometry").iterdir()) == [
        "design.json",
        "record.json",
    ]


def test_a_design_that_is_not_finite_is_recorded(tmp_path: Path) -> None:
    design = json.dumps(GOOD | {"name": "odd", "H": float("nan")})
    out = tmp_path / "geometry"
    assert main(["geometry", "--design", design, "--out", str(out)]) == 1
    record = read_record(out)
    assert record.configuration["design"]["H"] == "nan"
    assert "H = nan" in str(record.reason)


def test_failures_are_passed_on_down_the_chain(tmp_path: Path) -> None:
    at = {s: str(tmp_path / s) for s in ("geometry", "repair", "mesh", "solve", "metrics")}
    chain = [
        ["geometry", "--design", json.dumps(THIN)],
        ["repair", "--geometry", at["geometry"]],
        ["mesh", "--geometry", at["geometry"], "--repair", at["repair"]],
        ["solve", "--mesh", at["mesh"]],
        ["metrics", *(word for s in list(at)[:4] for word in (f"--{s}", at[s]))],
    ]
    for command in chain:
        assert main([*command, "--keep-going", "--out", at[command[0]]]) == 0
    first, last = read_record(tmp_path / "geometry"), read_record(tmp_path / "metrics")
    assert (last.status, last.reason) == (first.status, first.reason)
    assert last.figures["name"] == "thin"
    assert last.figures["mode"] == "bending"
    assert last.figures["wall_s"] >= first.timings_s["wall"]
