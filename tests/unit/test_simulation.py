"""One call from a design to its result, and results that are opened again."""

from __future__ import annotations

import dataclasses
import io
import math
import subprocess
import sys
from pathlib import Path

import figure_samples
import pytest
from design_samples import TABLE2_BENDING as BENDING
from IPython.core.formatters import DisplayFormatter
from PIL import Image

import pagd
from pagd.errors import InputError, Status

SMALL = dataclasses.replace(BENDING, N=2)
# It moves little, which is to count as moving.
QUICK = {
    "solve": {"blocked_force": "none", "recorded_step_kPa": 2.5},
    "metrics": {"still_deg": 0.5},
}


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> pagd.Result:
    """Two chambers at 5 kPa."""
    out = tmp_path_factory.mktemp("designs") / "two chambers"
    return pagd.simulate(SMALL, out, pressure_kPa=5, config=QUICK)


def test_a_design_becomes_a_result(result: pagd.Result) -> None:
    assert (result.status, result.reason, result.name) == (Status.ok, None, "two-chambers")
    assert result.bending_deg > 0.5
    assert result.twist_deg == pytest.approx(0.0, abs=1e-6)
    assert math.isnan(result.blocked_force_N)
    assert result.figures["pressure_kPa"] == 5.0
    assert result.design == SMALL


def test_its_folder_is_that_of_the_command(result: pagd.Result) -> None:
    stages = {"geometry", "repair", "mesh", "solve", "metrics", "figures"}
    assert {path.name for path in result.folder.iterdir()} == stages


def test_tables_are_data_frames(result: pagd.Result) -> None:
    assert result.performance["pressure_kPa"].tolist() == [0.0, 2.5, 5.0]
    assert result.performance["bending_deg"].iloc[-1] == result.bending_deg
    tip = result.trajectory.query("pressure_kPa == 5 and station == station.max()")
    assert tip["x_mm"].item() == pytest.approx(result.figures["tip_x_mm"])
    assert result.history["cavity_volume_mm3"].is_monotonic_increasing


def test_it_shows_itself_as_picture_and_table(result: pagd.Result) -> None:
    data, _ = DisplayFormatter().format(result)
    image = Image.open(io.BytesIO(data["image/png"]))
    assert image.size[0] > 800
    # The strain's colours, not a white sheet.
    assert len(image.convert("RGB").getcolors(1 << 24)) > 1000
    assert "data:image/png;base64," in data["text/html"]
    assert "<th" in data["text/html"]
    assert f"{result.bending_deg:.1f}°" in data["text/html"]
    assert "two-chambers: ok, bends by" in data["text/plain"]


def test_elsewhere_it_is_printed(result: pagd.Result, capsys: pytest.CaptureFixture[str]) -> None:
    result.show()
    lines = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert lines["status"] == "ok"
    assert lines["bending"] == f"{result.bending_deg:.1f}°"
    assert lines["folder"] == str(result.folder)


def test_a_folder_is_opened_again(result: pagd.Result) -> None:
    again = pagd.read_result(str(result.folder))
    assert again.record == result.record
    assert again.picture() == (result.folder / "figures/deformed.png").read_bytes()


def test_a_folder_without_pictures_gets_one(tmp_path: Path) -> None:
    from pagd.figures.result import picture_of

    figure_samples.solved(tmp_path / "one")
    picture = picture_of(tmp_path / "one")
    assert picture is not None
    assert len(Image.open(io.BytesIO(picture)).convert("RGB").getcolors(1 << 24)) > 500


def test_a_failure_is_a_result(tmp_path: Path) -> None:
    out = tmp_path / "too_thick"
    failed = pagd.simulate({**SMALL.as_dict(), "t_h": 20}, out)
    assert failed.status is Status.invalid_geometry
    assert "the cavity, H - t_h" in str(failed.reason)
    assert math.isnan(failed.bending_deg)
    assert failed.performance.empty
    assert "bending_deg" in failed.performance
    data, _ = DisplayFormatter().format(failed)
    assert "invalid_geometry" in data["text/html"]
    assert "image/png" not in data


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"pressure_kPa": -1}, "maximum_pressure_kPa = -1 must be greater than 0"),
        ({"material": "chewing_gum"}, "material is 'chewing_gum', but must be one of"),
        ({"material": {"law": "yeoh"}}, "name is missing"),
        ({"config": {"mesh": {"blck_mm": 3}}}, "mesh.blck_mm is not a known key"),
        ({"config": "absent.yaml"}, "configuration absent.yaml: cannot be read"),
        ({"threads": 0}, "threads = 0 must be at least 1"),
        ({"name": "a b"}, "name = 'a b' must consist of"),
        ({"out": Path(__file__)}, "cannot be made"),
        ({"design": {"L": 9}}, "W is missing"),
        ({"design": 3}, "design = 3 must be a design"),
        ({"design": "absent.yaml"}, "design absent.yaml: cannot be read"),
    ],
)
def test_bad_input_is_told_in_a_sentence(given: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        pagd.simulate(**{"design": SMALL, **given})


def test_no_folder_of_a_design_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="must be that of a design"):
        pagd.read_result(tmp_path)


class Terminal(io.StringIO):
    """Text that somebody looks at."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(("interactive", "progress"), [(True, None), (False, True)])
def test_a_terminal_has_bars_that_go_at_the_end(
    interactive: bool, progress: bool | None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("COLUMNS", "80")
    if interactive:
        monkeypatch.setattr(sys, "ps1", ">>> ", raising=False)
    pagd.simulate({**SMALL.as_dict(), "t_h": 20}, tmp_path / "too_thick", progress=progress)
    states = terminal.getvalue().split("\r")
    assert any("of 6 stages" in state for state in states)
    assert not "".join(states[-2:]).strip()


@pytest.mark.parametrize(("interactive", "progress"), [(False, None), (True, False)])
def test_a_program_shows_none_even_at_a_terminal(
    interactive: bool, progress: bool | None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    if interactive:
        monkeypatch.setattr(sys, "ps1", ">>> ", raising=False)
    pagd.simulate({**SMALL.as_dict(), "t_h": 20}, tmp_path / "too_thick", progress=progress)
    # Not even a character of one; what a log of others says there is no matter of it.
    assert "\r" not in terminal.getvalue()
    assert "of 6 stages" not in terminal.getvalue()


_SCRIPT = """
import pagd, pathlib
result = pagd.simulate({design}, config={{"limits": {{"thickness_mm": 4.5}}}})
print(result.folder.is_dir(), result.folder)
"""


def test_nothing_stays_of_a_temporary_result_and_no_bar_is_drawn() -> None:
    code = _SCRIPT.format(design=SMALL.as_dict())
    answer = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    was_there, folder = answer.stdout.split(maxsplit=1)
    assert was_there == "True"
    assert not Path(folder.strip()).exists()
    assert answer.stderr == ""
