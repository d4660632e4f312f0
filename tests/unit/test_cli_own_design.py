"""A design of one's own, from a YAML file to a solution, by one command."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from test_cli_bars import at_terminal

from pagd.catalogue import design_from
from pagd.cli import main
from pagd.record import read_record

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "config/examples/my_actuator.yaml"
COARSE = ["--block-mm", "6", "--pressure-kPa", "1", "--blocked-force", "none"]


@pytest.fixture(scope="module")
def solved(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Any, str]:
    """The example, solved at a terminal: its folder, the document, what is for people."""
    folder = tmp_path_factory.mktemp("own")
    words = ["solve", str(EXAMPLE), "--out", "out", *COARSE, "--json"]
    code, out, told = at_terminal(folder, *words)
    assert code == 0, told
    return folder / "out", json.loads(out), told


def test_the_example_is_short_and_can_be_built(capsys: pytest.CaptureFixture[str]) -> None:
    lines = [line for line in EXAMPLE.read_text().splitlines() if not line.startswith("#")]
    assert len(lines) == 11
    assert all("#" in line for line in lines)
    assert design_from(str(EXAMPLE)).name == "my_actuator"
    assert main(["design", "check", str(EXAMPLE)]) == 0
    assert "my_actuator: can be built" in capsys.readouterr().out


def test_the_documents_show_the_example() -> None:
    text = (ROOT / "docs/command-line.md").read_text()
    assert f"```yaml\n{EXAMPLE.read_text()}```" in text
    assert EXAMPLE.relative_to(ROOT).as_posix() in (ROOT / "README.md").read_text()


def test_a_file_is_solved(solved: tuple[Path, Any, str]) -> None:
    out, record, told = solved
    assert sorted(path.name for path in out.iterdir()) == ["geometry", "mesh", "repair", "solve"]
    assert (record["stage"], record["design_id"], record["status"]) == (
        "solve",
        "my_actuator",
        "ok",
    )
    assert record["folder"] == "out/solve"
    assert record["figures"]["recorded"]["pressure_kPa"][-1] == 1.0
    assert read_record(out / "mesh").configuration["mesh"]["block_mm"] == 6.0
    assert "free actuation: 100 % |" in told
    assert "1 of 1 kPa" in told
    # The bar tells every step, so that the log need not.
    assert "iterations" not in told


def test_a_stage_before_does_not_go_beneath_one_behind(
    solved: tuple[Path, Any, str], capsys: pytest.CaptureFixture[str]
) -> None:
    out, _, _ = solved
    before = (out / "mesh" / "record.json").read_bytes()
    assert main(["mesh", str(EXAMPLE), "--out", str(out), "--block-mm", "5"]) == 2
    assert "holds the stage solve of an earlier run" in capsys.readouterr().err
    assert (out / "mesh" / "record.json").read_bytes() == before


def test_the_mesh_alone(tmp_path: Path) -> None:
    assert main(["mesh", str(EXAMPLE), "--out", str(tmp_path), "--block-mm", "6"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["geometry", "mesh", "repair"]


def test_a_design_may_be_an_argument_or_an_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for words in ([str(EXAMPLE)], ["--design", str(EXAMPLE)]):
        assert main(["geometry", *words, "--out", str(tmp_path / words[0].strip("-")[-6:])]) == 0
    one, other = sorted(tmp_path.iterdir())
    assert (one / "body.stl").read_bytes() == (other / "body.stl").read_bytes()
    capsys.readouterr()
    for words in ([], [str(EXAMPLE), "--design", str(EXAMPLE)]):
        assert main(["geometry", *words, "--out", str(tmp_path / "none")]) == 2
        assert "a design must be given once" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["solve"], "solve needs a design, as a YAML file, or a mesh: --mesh."),
        (["solve", "a.yaml", "--mesh", "b"], "--mesh has no meaning beside a design."),
        (["solve", "a.yaml", "--name", "b"], "--name has no meaning beside a design."),
        (["solve", "--mesh", "a", "--block-mm", "5"], "--block-mm has no meaning beside --mesh."),
        (["mesh", "a.yaml", "--half"], "--half has no meaning beside a design."),
        (["mesh", "a.yaml", "--geometry", "b"], "--geometry has no meaning beside a design."),
        (["solve", "absent.yaml"], "design absent.yaml: cannot be read"),
    ],
)
def test_what_does_not_go_together_is_refused(
    words: list[str],
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([*words, "--out", "out"]) == 2
    assert capsys.readouterr().err.startswith(f"pagd: {sentence}")
    assert list(tmp_path.iterdir()) == []
