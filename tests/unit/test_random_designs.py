"""The study of random designs: its statistics, what it runs again, and crashes that end nothing."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from pagd import config as configuration
from pagd.catalogue import NamedDesign
from pagd.design import GeometryRules, violations
from pagd.errors import InputError, Status
from pagd.record import Record, write_record
from pagd.stages import STAGE_VERSIONS

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

import random_designs  # noqa: E402
from robustness import study as studies  # noqa: E402
from robustness.drawing import drawn_designs, is_thin_walled  # noqa: E402
from robustness.page import as_markdown  # noqa: E402
from robustness.processes import Ending, Task, run_tasks  # noqa: E402
from robustness.results import Result, result_of  # noqa: E402
from robustness.study import STAGES, Study  # noqa: E402
from robustness.summary import spread, summarize  # noqa: E402

CONFIG = configuration.completed({})
FINISHED = Ending("finished", None, 30.0)

#: Figures of the stage solve for a design that passed both analyses.
SOLVED: dict[str, Any] = {
    "pressure_kPa": 50.0,
    "newton_iterations": 60,
    "steps": 20,
    "rejected_steps": 2,
    "tets": 2000,
    "unknowns": 12_000,
    "limit_points": 1,
    "smallest_gap_mm": -0.01,
    "penetration_share": 0.03,
    "initial_gap_mm": 1.0,
    "blocked_force": {
        "variant": "edge",
        "status": "not_converged",
        "reason": "No step beyond 12 kPa converged.",
        "pressure_kPa": 12.0,
        "newton_iterations": 40,
        "rejected_steps": 5,
        "deepest_penetration_mm": 0.01,
    },
}
MEASURED = {"energy_balance": -0.001, "first_contact_pressure_kPa": 31.0}


def designs(count: int = 4, seed: int = 1) -> list[NamedDesign]:
    return drawn_designs(count, seed, CONFIG)


def result(number: int = 1, **differs: Any) -> Result:
    plain = Result(
        design_id=f"r{number:04d}",
        mode="bending",
        thin_walled=False,
        status="ok",
        reason=None,
        seconds=float(number),
        commit="abc",
        stages_s={"starting": 1.0, "solve": 3.0},
        free_status="ok",
        pressure_kPa=50.0,
        free_iterations=10 * number,
    )
    return replace(plain, **differs)


def leave_records(
    folder: Path,
    named: NamedDesign,
    solved: dict[str, Any] | None = None,
    status: Status = Status.ok,
) -> None:
    """Write records of every stage, as a design leaves them."""
    figures = {"solve": SOLVED if solved is None else solved, "metrics": MEASURED}
    parts = {"solve": {"solve": 3.0, "blocked_force": 0.5}}
    for number, stage in enumerate(STAGES, start=1):
        record = Record(
            stage=stage,
            design_id=named.name,
            status=status,
            reason=None if status is Status.ok else "There is a reason.",
            figures=figures.get(stage, {}),
            configuration={},
            versions={"pagd": "0", "stage": STAGE_VERSIONS[stage], "python": "3"},
            timings_s={"wall": float(number), "cpu": 0.5, **parts.get(stage, {})},
            peak_memory_MB=100.0 * number,
        )
        (folder / stage).mkdir(parents=True, exist_ok=True)
        write_record(record, folder / stage)


def test_designs_are_valid_half_bend_half_twist_and_fewer_are_the_beginning_of_more() -> None:
    drawn = designs(20)
    assert [named.design.mode for named in drawn] == ["bending", "twisting"] * 10
    assert all(not violations(named.design, GeometryRules()) for named in drawn)
    assert drawn[:7] == designs(7)
    assert drawn != designs(20, seed=2)
    assert len({named.name for named in drawn}) == 20


def test_a_thin_wall_on_either_side_makes_a_design_thin_walled() -> None:
    thick = replace(designs(1)[0].design, t=1.5, t_ab=1.5)
    assert not is_thin_walled(thick)
    assert is_thin_walled(replace(thick, t=1.49))
    assert is_thin_walled(replace(thick, t_ab=1.49))


def test_spreads_know_only_known_values() -> None:
    found = spread([None, *range(1, 12)])
    assert found == {"count": 11, "median": 6.0, "p90": 10.0, "max": 11.0, "sum": 66.0}
    assert spread([None, None]) is None


def test_shares_count_physical_stops_and_leave_out_invalid_geometry() -> None:
    results = [
        result(1),
        result(2, status="no_actuation"),  # it reached its pressure and hardly moved
        result(3, status="bending_limit", free_status="bending_limit", mode="twisting"),
        result(4, status="overstretched", free_status="overstretched", thin_walled=True),
        result(5, status="self_collision", free_status="self_collision"),
        result(6, status="not_converged", free_status="not_converged", thin_walled=True),
        result(7, status="crashed", free_status=None, reason="It was ended by SIGSEGV."),
        result(8, status="invalid_geometry", free_status="invalid_geometry"),
    ]
    summary = summarize(results, 10)
    groups = summary["groups"]
    assert summary["designs"] == {"asked": 10, "done": 8}
    assert (groups["all"]["reached"], groups["all"]["valid"]) == (5, 7)
    assert groups["all"]["share"] == pytest.approx(5 / 7)
    assert groups["twisting"]["share"] == 1.0
    assert groups["thin-walled"]["share"] == 0.5
    assert groups["all"]["statuses"]["crashed"] == 1
    assert [case["design_id"] for case in summary["others"]] == ["r0006", "r0007", "r0008"]
    assert [case["design_id"] for case in summary["slowest"]] == [
        f"r000{n}" for n in (8, 7, 6, 5, 4)
    ]
    assert summary["spreads"]["newton_iterations_free"]["median"] == 45.0
    assert summary["spreads"]["newton_iterations_blocked"] is None


def test_shares_of_the_stages_add_up() -> None:
    stages = summarize([result(1), result(2)], 2)["stages"]
    assert {name: one["share"] for name, one in stages.items()} == {"starting": 0.25, "solve": 0.75}


def test_penetration_contact_and_limit_points_are_counted_where_they_are_known() -> None:
    results = [
        result(1, touched=True, penetration_share=0.021, limit_points=2),
        result(2, touched=True, penetration_share=0.02, limit_points=0),
        result(3, touched=False, blocked_penetration_share=0.03, limit_points=0),
        result(4),
    ]
    summary = summarize(results, 4)
    assert summary["contact"] == {"known": 3, "touched": 2, "over_limit": 2}
    assert summary["limit_points"] == {"known": 3, "designs": 1, "limit_points": 2}
    assert summary["spreads"]["penetration_share"]["max"] == 0.021


def test_a_result_separates_both_analyses(tmp_path: Path) -> None:
    named = designs(1)[0]
    leave_records(tmp_path, named)
    found = result_of(named, tmp_path, {"end": "finished", "seconds": 20.0, "commit": "c"})
    assert (found.status, found.free_status, found.blocked_status) == ("ok", "ok", "not_converged")
    assert (found.free_iterations, found.blocked_iterations, found.newton_iterations) == (
        60,
        40,
        100,
    )
    assert (found.free_s, found.blocked_s) == (3.0, 0.5)
    assert found.stages_s["starting"] == 20.0 - (1 + 2 + 3 + 4 + 5)
    assert (found.cpu_s, found.peak_memory_MB) == (2.5, 500.0)
    assert (found.penetration_share, found.blocked_penetration_share) == (0.03, 0.01)
    assert (found.touched, found.energy_balance) == (True, -0.001)
    assert found.goes_all_the_way


def test_a_result_does_without_blocked_force_and_contact(tmp_path: Path) -> None:
    named = designs(1)[0]
    kept = ("pressure_kPa", "newton_iterations", "steps", "rejected_steps", "tets", "unknowns")
    leave_records(tmp_path, named, {key: SOLVED[key] for key in kept})
    found = result_of(named, tmp_path, {"end": "finished", "seconds": 20.0})
    assert found.free_iterations == 60
    assert (found.blocked_status, found.blocked_iterations, found.penetration_share) == (None,) * 3
    assert (found.blocked_s, found.blocked_penetration_share) == (None, None)


def test_a_design_without_a_mesh_has_no_analysis(tmp_path: Path) -> None:
    named = designs(1)[0]
    leave_records(tmp_path, named, {}, Status.mesh_failed)
    found = result_of(named, tmp_path, {"end": "finished", "seconds": 20.0})
    assert (found.status, found.reason) == ("mesh_failed", "There is a reason.")
    assert found.free_iterations is None
    assert not found.goes_all_the_way


def test_a_crash_is_a_result(tmp_path: Path) -> None:
    named = designs(1)[0]
    run = {"end": "crashed", "cause": "The process was ended by SIGKILL.", "seconds": 3.0}
    found = result_of(named, tmp_path, run)
    assert (found.status, found.reason) == ("crashed", "The process was ended by SIGKILL.")
    assert not found.goes_all_the_way


def test_finished_designs_are_not_run_again(tmp_path: Path) -> None:
    study = Study(tmp_path, designs(4), CONFIG)
    done, crashed, interrupted, _ = study.designs
    for named in (done, crashed, interrupted):
        study.start(named)
    leave_records(study.folder(done), done)
    study.end(done, FINISHED)
    study.end(crashed, Ending("crashed", "It fell.", 3.0))
    assert study.unfinished() == list(study.designs[1:])
    run = study.run_of(crashed)
    assert run is not None
    assert (run["end"], run["cause"]) == ("crashed", "It fell.")
    assert study.run_of(interrupted) is None


def _other_configuration(study: Study, monkeypatch: pytest.MonkeyPatch) -> Study:
    return replace(study, config=configuration.completed({"solve": {"tolerance_mm": 0.02}}))


def _other_material(study: Study, monkeypatch: pytest.MonkeyPatch) -> Study:
    return replace(study, config=configuration.completed({"material": "dragon_skin_10"}))


def _other_design(study: Study, monkeypatch: pytest.MonkeyPatch) -> Study:
    return replace(study, designs=designs(1, seed=2))


def _other_stage(study: Study, monkeypatch: pytest.MonkeyPatch) -> Study:
    monkeypatch.setattr(studies, "STAGE_VERSIONS", STAGE_VERSIONS | {"solve": 1000})
    return study


def _lost_record(study: Study, monkeypatch: pytest.MonkeyPatch) -> Study:
    (study.folder(study.designs[0]) / "metrics" / "record.json").unlink()
    return study


def _broken_note(study: Study, monkeypatch: pytest.MonkeyPatch) -> Study:
    (study.folder(study.designs[0]) / "run.json").write_text("{")
    return study


Change = Callable[[Study, pytest.MonkeyPatch], Study]


@pytest.mark.parametrize(
    "change",
    [
        *(_other_configuration, _other_material, _other_design, _other_stage),
        *(_lost_record, _broken_note),
    ],
)
def test_what_is_of_something_else_is_run_again(
    change: Change, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study(tmp_path, designs(1), CONFIG)
    study.start(study.designs[0])
    leave_records(study.folder(study.designs[0]), study.designs[0])
    study.end(study.designs[0], FINISHED)
    assert study.unfinished() == []
    changed = change(study, monkeypatch)
    assert changed.unfinished() == list(changed.designs)


def test_figures_of_the_page_alone_run_nothing_again(tmp_path: Path) -> None:
    study = Study(tmp_path, designs(1), CONFIG)
    study.start(study.designs[0])
    leave_records(study.folder(study.designs[0]), study.designs[0])
    study.end(study.designs[0], FINISHED)
    other = configuration.completed({"figures": {"drawn_designs": 1}})
    assert replace(study, config=other).unfinished() == []


def test_a_process_that_leaves_too_little_has_crashed(tmp_path: Path) -> None:
    study = Study(tmp_path, designs(1), CONFIG)
    study.start(study.designs[0])
    assert study.end(study.designs[0], FINISHED)["end"] == "crashed"


def test_folders_of_others_are_not_replaced(tmp_path: Path) -> None:
    study = Study(tmp_path, designs(1), CONFIG)
    folder = study.folder(study.designs[0])
    folder.mkdir(parents=True)
    (folder / "thesis.tex").touch()
    with pytest.raises(InputError, match=r"holds no run\.json"):
        study.start(study.designs[0])
    assert (folder / "thesis.tex").is_file()


def ended(tmp_path: Path, programs: list[str], limit_s: float = 60.0) -> dict[str, Ending]:
    """Let Python do each of some programs, two at a time; how each ended."""
    program = (sys.executable, "-c", "import sys; exec(sys.stdin.readline())")
    tasks = [Task(str(n), line, tmp_path / f"{n}.txt") for n, line in enumerate(programs)]
    endings: dict[str, Ending] = {}

    def told(task: Task, ending: Ending) -> None:
        endings[task.name] = ending

    run_tasks(iter(tasks), 2, limit_s, told, program)
    return endings


def test_whatever_a_process_does_the_others_go_on(tmp_path: Path) -> None:
    programs = [
        "import os, signal; os.kill(os.getpid(), signal.SIGKILL)",
        "raise ValueError('no such wall')",
        "print('done')",
        "import os; assert os.environ['MKL_NUM_THREADS'] == os.environ['OMP_NUM_THREADS'] == '1'",
    ]
    endings = ended(tmp_path, programs)
    assert [endings[str(n)].end for n in range(4)] == ["crashed", "crashed", *["finished"] * 2]
    assert endings["0"].cause == "The process was ended by SIGKILL."
    assert endings["1"].cause == "The process ended with code 1: ValueError: no such wall"
    assert (tmp_path / "2.txt").read_text() == "done\n"


def test_what_takes_too_long_is_ended_with_all_it_has_started(tmp_path: Path) -> None:
    child = tmp_path / "child"
    program = (
        "import subprocess, time, pathlib; c = subprocess.Popen(['sleep', '60']);"
        f" pathlib.Path({str(child)!r}).write_text(str(c.pid)); time.sleep(60)"
    )
    endings = ended(tmp_path, [program], limit_s=1.5)
    assert endings["0"].end == "time_limit"
    assert endings["0"].seconds < 10
    assert is_gone(int(child.read_text()))


def is_gone(process: int) -> bool:
    """Whether a process is no more, or is at most waited for by nobody."""
    for _ in range(50):
        try:
            state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
        except FileNotFoundError:
            return True
        if state == "Z":
            return True
        time.sleep(0.1)
    return False


Command = Callable[..., str]


@pytest.fixture
def command(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Command:
    """The command with its options, in this process; what it printed."""
    monkeypatch.setenv("PYTHONPATH", str(ROOT), prepend=os.pathsep)

    def run(*options: str) -> str:
        monkeypatch.setattr(sys, "argv", ["random_designs.py", *options])
        random_designs.main()
        return capsys.readouterr().out

    return run


def test_the_command_runs_a_design_once_and_reports_it(command: Command, tmp_path: Path) -> None:
    config = {"solve": {"maximum_pressure_kPa": 0.25}}
    options = ["--designs", "1", "--size", "12", "--config", json.dumps(config)]
    options += ["--out", str(tmp_path / "out"), "--markdown", str(tmp_path / "page.md")]
    line, _, page = command(*options).partition("\n")
    assert line.split()[:4] == ["1/1", "r0001", "bending", "no_actuation"]
    assert "**1 of 1 valid designs (100.0 %)" in page
    written = (tmp_path / "page.md", tmp_path / "out" / "report.md")
    assert [file.read_text(encoding="utf-8") for file in written] == [page, page]
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert as_markdown(report) == page
    assert report["results"][0]["free_status"] == "ok"
    # Nothing is run again: there is no line of progress.
    assert command(*options) == page
    assert command(*options, "--report-only") == page


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--designs", "0"], "--designs must be greater than 0"),
        (["--seed", "-1"], "--seed must be at least 0"),
        (["--config", '{"solve": {"pressure": 1}}'], "pressure"),
        (["--report-only"], "none of the 200 designs is done"),
    ],
)
def test_bad_options_are_one_sentence(
    options: list[str],
    said: str,
    command: Command,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as ending:
        command(*options, "--out", str(tmp_path / "out"))
    assert ending.value.code == 2
    assert said in capsys.readouterr().err


def page_of(results: list[Result], asked: int) -> str:
    """The page of some results, of designs that were asked for."""
    report = {
        "study": {"size_mm": 5.0, "time_limit_s": 1800.0},
        "command": "python benchmarks/random_designs.py",
        "machine": {
            **{"processor": "A processor with quite a long name", "cores": 2, "memory_GB": 8.0},
            **{"system": "Linux", "processes": 2, "versions": {"numpy": "2.0", "scipy": "1.17"}},
        },
        "summary": summarize(results, asked),
    }
    return as_markdown(report)


def in_one_line(page: str) -> str:
    return " ".join(page.split())


def test_the_blocked_force_has_a_share_of_its_own_next_to_the_goal() -> None:
    results = [
        result(1, blocked_status="ok", blocked_iterations=9),
        result(2, blocked_status="self_collision", blocked_iterations=9),
        result(3, blocked_status="not_converged", blocked_iterations=9),
        result(4),  # crashed before it, say
        result(5, status="invalid_geometry", free_status="invalid_geometry"),
    ]
    group = summarize(results, 5)["groups"]["all"]
    assert (group["reached"], group["blocked_reached"], group["valid"]) == (4, 2, 4)
    assert (group["share"], group["blocked_share"]) == (1.0, 0.5)
    page = page_of(results, 5)
    assert (
        "the goal is 97 %. The analysis of the blocked force did so for **2 of 4 (50.0 %)**."
        in (in_one_line(page))
    )
    assert "| last pressure or physical stop, blocked | 50.0 % | 50.0 % | – | – |" in page


def test_that_all_went_well_is_said_of_the_free_actuation_alone() -> None:
    text = in_one_line(page_of([result(1, blocked_status="not_converged")], 1))
    heading = "## Free actuation that did not go all the way"
    assert f"{heading} None: every design went all the way in free actuation." in text
    assert "blocked force did so for **0 of 1 (0.0 %)**" in text


def test_without_blocked_force_the_page_has_no_share_of_it() -> None:
    results = [result(1), result(2)]
    assert summarize(results, 2)["groups"]["all"]["blocked_share"] is None
    assert "blocked" not in page_of(results, 2)


@pytest.mark.parametrize(
    ("options", "printed"),
    [
        ([], ""),
        (["--designs", "200", "--processes", "1", "--out", "elsewhere"], ""),
        (
            ["--designs", "20", "--seed", "7", "--size", "2.5", "--time-limit", "60"],
            " --designs 20 --seed 7 --size 2.5 --time-limit 60",
        ),
        (
            ["--config", '{"solve": {"contact": false}}', "--markdown", "my page.md"],
            """ --config '{"solve": {"contact": false}}' --markdown 'my page.md'""",
        ),
    ],
)
def test_the_printed_command_has_the_options_that_are_not_usual(
    options: list[str], printed: str
) -> None:
    command = random_designs._command(random_designs._parser().parse_args(options))
    found = in_one_line(command.replace("\\\n", " "))
    assert found == "python benchmarks/random_designs.py" + printed


def test_lines_of_text_are_no_longer_than_a_hundred() -> None:
    reason = "No step beyond 12.34 kPa converged (corrections in mm: " + "1.0e+00, " * 14 + ")."
    failed = result(1, status="not_converged", free_status="not_converged", reason=reason)
    page = page_of([failed, result(2, blocked_status="ok")], 200)
    assert max(map(len, page.split("\n"))) <= 100
    assert "- r0001 (bending): `not_converged` at 50 kPa. No step beyond 12.34 kPa" in page
    assert "**2 of 200 designs are done so far.**" in page


def test_a_held_tip_that_went_all_the_way_is_not_listed() -> None:
    endings = ("ok", "buckled", "not_converged", "overstretched", None)
    results = [
        result(n, blocked_status=status, blocked_iterations=9, blocked_pressure_kPa=10.0 * n)
        for n, status in enumerate(endings, start=1)
    ]
    page = page_of(results, len(results))
    listed = page.partition("## Blocked force that did not go all the way")[2]
    cases = [line for line in listed.partition("##")[0].splitlines() if line]
    assert cases == [
        "- r0002 (bending): `buckled` at 20 kPa.",
        "- r0003 (bending): `not_converged` at 30 kPa.",
    ]


def test_the_page_says_that_designs_are_of_more_than_one_commit() -> None:
    results = [result(n, commit=made) for n, made in enumerate(["a1", "b2", "b2", None], start=1)]
    text = in_one_line(page_of(results, 4))
    assert "**Designs of more than one commit: b2 (2), a1 (1), unknown (1).**" in text
    assert "more than one commit" not in page_of(results[1:3], 2)


def test_another_commit_alone_runs_nothing_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study(tmp_path, designs(2), CONFIG)
    for named, made in zip(study.designs, ("a1", "b2"), strict=True):
        monkeypatch.setattr(studies, "commit", lambda made=made: made)
        study.start(named)
        leave_records(study.folder(named), named)
        study.end(named, FINISHED)
    assert study.unfinished() == []
    runs = [study.run_of(named) for named in study.designs]
    assert [run["commit"] for run in runs if run] == ["a1", "b2"]
