"""How the cost grows: fits, parts of the time, kept runs, throughput, and the command itself."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pagd import config as configuration
from pagd.errors import InputError

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

import growth  # noqa: E402
from performance import chambers, cores, runs, unknowns  # noqa: E402
from performance.cores import Crew, Throughput, crews_of  # noqa: E402
from performance.fits import extrapolated, power, relative_distance, seconds_at  # noqa: E402
from performance.options import example_designs, free_config  # noqa: E402
from performance.parts import parts_of, per_iteration  # noqa: E402
from performance.runs import Measured, Measurement, Run  # noqa: E402
from robustness.processes import Ending, Task  # noqa: E402

BENDING = example_designs()["bending"]


def figures(unknowns: int = 1000, **differs: Any) -> dict[str, Any]:
    """Figures of a run whose cost goes with the unknowns, and with their square for the factor."""
    n = unknowns / 1000
    plain = {
        **{"status": "ok", "reason": None, "free_status": "ok"},
        **{"elements": unknowns, "unknowns": unknowns, "newton_iterations": 10},
        "factorisations": 5,
        "factor_nonzeros": int(1e6 * n**1.5),
        "profile_s": {
            **{"assembly": n, "analysis": 0.5 * n, "factorisation": 2.0 * n**2},
            **{"solution": 0.1 * n, "output": 0.2},
        },
        "stages_cpu_s": {"geometry": 1.0, "mesh": 0.3 * n, "solve": 4.0 * n**2},
        "free_cpu_s": 3.0 * n**2,
        "blocked_cpu_s": None,
        "process_cpu_s": 7.0 * n**2,
        "peak_memory_MB": 300.0 * n,
        "tip_mm": [[0.0, 100.0, 0.0, -1.0], [10.0, 99.0, 0.0, -20.0]],
    }
    return plain | differs


def measurement(unknowns: int = 1000, **differs: Any) -> Measurement:
    return Measurement("finished", None, 9.0, "abc", figures(unknowns, **differs))


def crashed() -> Measurement:
    return Measurement("crashed", "The process was ended by SIGKILL.", 1.0, "abc", {})


def test_a_power_is_found_and_two_points_are_needed() -> None:
    assert power([1.0, 2.0, 4.0], [2.0, 2.0 * 2**1.5, 2.0 * 4**1.5]) == pytest.approx(1.5)
    assert power([2.0, 2.0], [1.0, 3.0]) is None
    assert power([1.0, 2.0], [0.0, 3.0]) is None


def test_a_limit_is_found_of_two_meshes_of_known_order() -> None:
    limit, slope = np.array([1.0, -2.0, 3.0]), np.array([0.4, 0.2, -0.1])
    at = {h: limit + slope * h**1.089 for h in (3.0, 2.0)}
    assert extrapolated(at[3.0], at[2.0], 1.5) == pytest.approx(limit)
    with pytest.raises(ValueError, match="coarse mesh"):
        extrapolated(at[3.0], at[2.0], 1.0)


def test_the_distance_of_a_tip_is_relative_to_the_limit() -> None:
    limit = np.array([0.0, 3.0, 4.0])
    assert relative_distance(limit + np.array([0.5, 0.0, 0.0]), limit) == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("points", "found"),
    [
        ([], None),
        ([(2.0, 0.01), (4.0, 0.005)], ("<", 2.0)),
        ([(2.0, 0.2), (4.0, 0.05)], (">", 4.0)),
        ([(16.0, 0.0075), (1.0, 0.12)], ("=", 4.0)),  # any order; half-way by logarithms
        ([(1.0, 0.12), (4.0, 0.03)], ("=", 4.0)),
    ],
)
def test_seconds_at_an_error(
    points: list[tuple[float, float]], found: tuple[str, float] | None
) -> None:
    result = seconds_at(0.03, points)
    if found is None:
        assert result is None
    else:
        assert result is not None
        assert (result[0], pytest.approx(result[1])) == found


def test_the_parts_of_a_run_add_up() -> None:
    parts = parts_of(figures())
    assert parts["all"] == 7.0
    assert parts["rest"] == pytest.approx(7.0 - 0.3 - 1.0 - 0.5 - 2.0 - 0.1)
    assert sum(value or 0 for name, value in parts.items() if name != "all") == pytest.approx(7.0)


def test_what_a_record_does_not_tell_is_none_and_counts_as_rest() -> None:
    parts = parts_of(figures(profile_s=None, process_cpu_s=None))
    assert (parts["assembly"], parts["factorisation"]) == (None, None)
    assert parts["all"] == pytest.approx(1.0 + 0.3 + 4.0)
    assert parts["rest"] == pytest.approx(5.0)


def test_factorisations_are_counted_by_themselves() -> None:
    each = per_iteration(figures())
    assert each["assembly"] == pytest.approx(0.1)
    assert each["factorisation"] == pytest.approx(2.0 / 5)
    assert each["free actuation"] == pytest.approx(0.3)
    assert per_iteration(figures(factorisations=None))["factorisation"] == pytest.approx(0.2)
    assert set(per_iteration(figures(newton_iterations=None)).values()) == {None}


def test_growth_with_unknowns_is_told_as_powers_and_troubles_are_named() -> None:
    series = {5.0: measurement(1000), 3.0: measurement(3000), 2.0: crashed()}
    text = unknowns.text_of(series, "bending", 10.0)
    assert "| factorisation, per iteration | 2.00 | 2.00 |" in text
    assert "| assembly, per iteration | 1.00 | 1.00 |" in text
    assert "| memory | 1.00 | 1.00 |" in text
    assert "| factor non-zeros | 1.50 | 1.50 |" in text
    assert "- 2 mm: The process was ended by SIGKILL." in text
    cells = {line[:5]: line.count("|") for line in text.split("Per Newton")[0].splitlines()}
    assert cells["| 2 |"] == cells["| 5 |"] == cells["| siz"]


def test_growth_with_chambers_is_told_as_powers() -> None:
    series = {n: measurement(1000 * n) for n in (6, 12, 24)}
    powers = chambers.powers_of(series)
    assert powers["unknowns"] == pytest.approx(1.0)
    assert powers["time of a factorisation"] == pytest.approx(2.0)
    stopped = measurement(9000, free_status="self_collision", reason="It touches itself.")
    text = chambers.text_of(series | {30: stopped}, "twisting", 5.0, 10.0)
    assert "time of a factorisation 2.00" in " ".join(text.split())
    assert "- 30: self_collision: It touches itself." in text
    assert chambers.powers_of({6: measurement()}) == {}


def test_only_the_number_of_chambers_differs() -> None:
    longer = chambers.with_chambers(BENDING, 20)
    assert replace(longer.design, N=BENDING.design.N) == BENDING.design
    assert (longer.design.N, longer.name) == (20, "bending-20")


def test_crews_fill_the_cores_and_two_threads_are_compared() -> None:
    assert crews_of(3) == [Crew(1), Crew(2), Crew(3), Crew(1, 2)]
    assert crews_of(1) == [Crew(1)]


def test_efficiency_is_throughput_by_cores() -> None:
    found = {
        Crew(1): Throughput(4, 40.0, 38.0, "a"),
        Crew(2): Throughput(8, 44.0, 80.0, "a"),
        Crew(1, 2): Throughput(4, 32.0, 44.0, "a"),
    }
    text = cores.text_of(found, "bending", configuration.completed({}))
    assert "| 1 | 1 | 4 | 40.0 | 9.50 | 360 | 100.0 % |" in text
    assert "| 2 | 1 | 8 | 44.0 | 10.00 | 655 | 90.9 % |" in text
    assert "| 1 | 2 | 4 | 32.0 | 11.00 | 450 | 62.5 % |" in text


def run(pressure: float = 1.0, halvings: int = 0) -> Run:
    config = free_config(None, size_mm=6.0, pressure_kPa=pressure)
    return Run("bending", BENDING, config, halvings)


class Processes:
    """Stands for processes: counts them, and ends each as it is told."""

    def __init__(self) -> None:
        self.tasks: list[dict[str, Any]] = []
        self.end = Ending("finished", None, 3.0)

    def __call__(self, tasks: list[Task], processes: int, limit_s: float, ended: Any) -> None:
        for task in tasks:
            self.tasks.append(json.loads(task.line))
            ended(task, self.end)


@pytest.fixture
def processes(monkeypatch: pytest.MonkeyPatch) -> Processes:
    made = Processes()
    monkeypatch.setattr(runs, "run_tasks", made)
    monkeypatch.setattr(runs, "figures_of", lambda folder: figures())
    return made


def test_a_run_is_kept_by_all_that_made_it(processes: Processes, tmp_path: Path) -> None:
    measured = Measured(tmp_path)
    first = measured.of([run()])["bending"]
    assert len(processes.tasks) == 2  # once coarse, so that all is compiled
    assert processes.tasks[0]["config"]["mesh"]["size_mm"] == 5.0
    assert processes.tasks[1]["config"]["mesh"]["size_mm"] == 6.0
    assert measured.of([run()])["bending"] == first
    assert len(processes.tasks) == 2
    assert measured.kept(run(2.0)) is None
    assert measured.kept(run(halvings=1)) is None
    Measured(tmp_path, anew=True).of([run()])
    assert len(processes.tasks) == 4
    assert [file.suffix for file in tmp_path.iterdir()] == [".json"]


def test_a_run_that_crashed_is_told_and_run_again(processes: Processes, tmp_path: Path) -> None:
    processes.end = Ending("crashed", "It fell.", 1.0)
    found = Measured(tmp_path).of([run()])["bending"]
    assert (found.trouble, found.is_complete) == ("It fell.", False)
    processes.end = Ending("finished", None, 1.0)
    assert Measured(tmp_path).of([run()])["bending"].is_complete


def test_a_broken_file_is_none(processes: Processes, tmp_path: Path) -> None:
    measured = Measured(tmp_path)
    measured.of([run()])
    for file in tmp_path.iterdir():
        file.write_text("{")
    assert measured.kept(run()) is None


def test_only_the_free_actuation_is_asked_for() -> None:
    config = free_config('{"solve": {"contact": false}}', size_mm=4.0, pressure_kPa=7.0)
    asked = ("maximum_pressure_kPa", "recorded_step_kPa", "blocked_force", "contact")
    assert [config["solve"][key] for key in asked] == [7.0, 7.0, "none", False]
    assert config["mesh"]["size_mm"] == 4.0


def command(monkeypatch: pytest.MonkeyPatch, *words: str) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT), prepend=os.pathsep)
    monkeypatch.setattr(sys, "argv", ["growth.py", *words])
    growth.main()


@pytest.mark.slow
def test_the_command_measures_draws_and_prints(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    words = ["unknowns", "--sizes", "5", "--pressure", "0.25", "--out", str(tmp_path)]
    command(monkeypatch, *words)
    printed = capsys.readouterr().out
    assert printed.startswith("`python benchmarks/growth.py unknowns --sizes 5 --pressure 0.25`\n")
    row = next(line for line in printed.splitlines() if line.startswith("| 5 | "))
    cells = [cell.strip().replace(",", "") for cell in row.strip("|").split("|")]
    assert int(cells[2]) > 5000
    *parts, whole = (0.0 if cell == "–" else float(cell) for cell in cells[4:11])
    assert sum(parts) == pytest.approx(whole, abs=0.05)
    assert (tmp_path / "growth-unknowns.png").stat().st_size > 1000
    command(monkeypatch, *words)  # from what is kept: the same to the last digit
    assert capsys.readouterr().out == printed


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["unknowns", "--sizes", "0"], "--sizes = 0 must be greater than 0"),
        (["chambers", "--pressure", "-1"], "--pressure = -1 must be greater than 0"),
        (["cores", "--each", "0"], "--each = 0 must be greater than 0"),
        (["cores", "--time-limit", "0"], "--time-limit = 0 must be greater than 0"),
        (["cores", "--page", "absent.md"], "absent.md: there is no such file"),
        (["unknowns", "--config", '{"mesh": {"sizes": 1}}'], "sizes"),
    ],
)
def test_bad_options_are_one_sentence(
    words: list[str],
    said: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    with pytest.raises(SystemExit) as ending:
        command(monkeypatch, *words, "--out", str(tmp_path / "out"))
    assert ending.value.code == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_throughput_is_kept_and_failures_are_errors(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    crews: list[tuple[int, int]] = []
    end = "finished"

    def pretend(
        tasks: list[Task], processes: int, limit_s: float, ended: Any, *, threads: int
    ) -> None:
        crews.append((len(tasks), threads))
        for task in tasks:
            ended(task, Ending(end, "It fell.", 1.0))

    monkeypatch.setattr(cores, "run_tasks", pretend)
    config = free_config(None, size_mm=6.0, pressure_kPa=1.0)
    arguments = (Crew(2), BENDING, config, 3, tmp_path)
    first = cores.throughput_of(*arguments, limit_s=9.0)
    assert first.designs == 6
    assert crews == [(1, 1), (6, 1)]  # the first one compiles
    assert cores.throughput_of(*arguments, limit_s=9.0) == first
    assert len(crews) == 2
    end = "crashed"
    with pytest.raises(InputError, match=r"design 000 did not come to its end: It fell\."):
        cores.throughput_of(*arguments, limit_s=9.0, anew=True)
