"""The comparison with other programs: what is read, kept, extrapolated, compared and told."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pagd.errors import InputError
from pagd.mesh.primitives import box
from pagd.mesh.types import Mesh

ROOT = Path(__file__).parents[2]
BENCHMARKS = ROOT / "benchmarks"
DRIVERS = BENCHMARKS / "peers" / "drivers"
sys.path.insert(0, str(BENCHMARKS))

from peers import child, kept, page  # noqa: E402
from peers.bodies import Body, tip_displacement  # noqa: E402
from peers.calculix import iterations_of, pressure_of  # noqa: E402
from peers.comparison import Ratio, compared, equal_error, median_of  # noqa: E402
from peers.converged import (  # noqa: E402
    ORDER,
    Converged,
    extrapolated,
    read_converged,
    write_converged,
)
from peers.environment import pinned  # noqa: E402
from peers.iteration import PROGRAMS, summarized  # noqa: E402
from peers.kept import Keeper  # noqa: E402
from peers.options import command_of, make_parser  # noqa: E402
from peers.solved import Load, Solved  # noqa: E402
from peers.studies import EqualErrorRow, SameMeshRow, Study  # noqa: E402

PAGD = Solved(
    program="pagd 1",
    status="ok",
    reason=None,
    pressure_kPa=10.0,
    wall_s=4.0,
    cpu_s=6.0,
    iterations=20,
    tets=1000,
    unknowns=6000,
    tips=[(5.0, (0.0, 0.0, -9.0)), (10.0, (0.0, 0.0, -19.0))],
    progress=[(1.0, 2.0), (2.0, 5.0), (3.0, 10.0)],
    commit="abc",
)
CCX = replace(
    PAGD,
    program="CalculiX 1",
    wall_s=400.0,
    tips=[(5.0, (0.0, 0.0, -8.0)), (10.0, (0.0, 0.0, -16.0))],
    progress=[(100.0, 5.0), (390.0, 10.0)],
)
LATE = replace(
    CCX,
    status="time_limit",
    reason="Too long.",
    pressure_kPa=7.0,
    tips=CCX.tips[:1],
    progress=[(90.0, 5.0)],
)
EXACT = Converged(
    design="bending",
    pressure_kPa=[5.0, 10.0],
    tip_mm=[(0.0, 0.0, -10.0), (0.0, 0.0, -20.0)],
    spread_mm=[0.0, 0.0],
    meshes=[],
)
BODY = Body("bending", "gmsh", 5.0)


class TestCalculix:
    def test_the_pressure_is_that_of_the_last_converged_increment(self) -> None:
        lines = [
            "SUMMARY OF JOB INFORMATION",
            "  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME",
            "     1          1     1     5  0.100000E+01  0.100000E+01  0.100000E+01",
            "     2          1     1     5  0.125000E+01  0.250000E+00  0.250000E+00",
            "     2          2    1U     9  0.150000E+01  0.500000E+00  0.250000E+00",
        ]
        assert pressure_of(lines, [4.0, 12.0]) == pytest.approx(4.0 + 0.25 * 8.0)
        assert pressure_of(lines[:2], [4.0, 12.0]) == 0.0

    def test_every_iteration_counts(self) -> None:
        lines = [
            "  STEP   INC  ATT   ITER",
            "",
            "   1   1   1   1   0  0.1E+06",
            "   1  1  2  1  0",
        ]
        assert iterations_of(lines) == 2


def test_the_tip_is_the_middle_of_the_lower_edge() -> None:
    solid = box((4.0, 3.0, 2.0), (2, 1, 1))
    solid = replace(solid, points=solid.points - [0.0, 1.3, 0.0])
    y = solid.points[:, 1]
    moved = np.column_stack((y**2, 1 + y, solid.points[:, 2] - 7))
    assert tip_displacement(solid, moved) == pytest.approx([0.0, 1.0, -7.0], abs=1e-12)


class TestKeeper:
    def test_a_run_is_made_once(self, tmp_path: Path) -> None:
        runs: list[int] = []
        run = self._counting(runs)
        keeper = Keeper(tmp_path)
        first = keeper.result("a", {"deck": 1}, run)
        assert keeper.result("a", {"deck": 1}, run) == first
        keeper.result("a", {"deck": 2}, run)
        assert len(runs) == 2
        Keeper(tmp_path, fresh=True).result("a", {"deck": 1}, run)
        assert len(runs) == 3

    def test_a_run_that_does_not_answer_is_made_again(self, tmp_path: Path) -> None:
        runs: list[int] = []
        for limit in (10.0, 10.0, 20.0):
            load = Load(time_limit_s=limit)
            run = self._counting(runs, status="time_limit", wall_s=limit)
            Keeper(tmp_path).result("a", {}, run, load.is_answered_by)
        assert len(runs) == 2

    def test_half_a_file_is_none(self, tmp_path: Path) -> None:
        runs: list[int] = []
        Keeper(tmp_path).result("a", {}, self._counting(runs))
        (file,) = tmp_path.glob("*.json")
        file.write_text(file.read_text("utf-8")[:20], "utf-8")
        Keeper(tmp_path).result("a", {}, self._counting(runs))
        assert len(runs) == 2

    def test_a_digest_is_of_the_content(self) -> None:
        assert kept.digest({"a": 1, "b": 2}) == kept.digest({"b": 2, "a": 1})
        assert kept.digest({"a": 1}) != kept.digest({"a": 2})

    @staticmethod
    def _counting(runs: list[int], **result: Any) -> Callable[[], dict[str, Any]]:
        def run() -> dict[str, Any]:
            runs.append(1)
            return {"number": len(runs), **result}

        return run


class TestChild:
    def test_time_and_code_and_progress(self, tmp_path: Path) -> None:
        program = (
            "import time; end = time.process_time() + 0.3\nwhile time.process_time() < end: pass"
        )
        seen = iter([1.0, 1.0, 3.0])
        command = [sys.executable, "-c", f"{program}\nraise SystemExit(3)"]
        ended = child.run_timed(command, tmp_path, 1, 60.0, lambda: next(seen, 3.0))
        assert ended.code == 3
        assert ended.wall_s > 0.3
        assert 0.3 <= ended.cpu_s < 10
        assert ended.progress[0][1] == 1.0
        assert sorted(ended.progress) == ended.progress

    def test_the_limit_ends_all_that_was_started(self, tmp_path: Path) -> None:
        script = f"sleep 60 & echo $! > {tmp_path / 'pid'}; wait"
        ended = child.run_timed(["bash", "-c", script], tmp_path, 1, 0.5, lambda: 0.0)
        assert ended.code is None
        assert ended.progress == []
        pid = (tmp_path / "pid").read_text().strip()
        for _ in range(100):
            if not Path(f"/proc/{pid}").exists() or "Z" in _state(pid):
                return
            time.sleep(0.05)
        pytest.fail("the child of the program still runs")

    def test_the_number_of_threads_is_told(self, tmp_path: Path) -> None:
        child.run_timed(["bash", "-c", "echo $OMP_NUM_THREADS"], tmp_path, 7, 60.0, lambda: 0.0)
        assert (tmp_path / "output.txt").read_text() == "7\n"


def _state(pid: str) -> str:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1]
    except OSError:
        return "Z"


class TestConverged:
    def test_the_order_is_the_one_that_is_given(self) -> None:
        runs = []
        for tets in (1000, 8000, 27000):
            h = tets ** (-1 / 3)
            tips = [(5.0, (1.0 + 2 * h**ORDER, 0.0, -10.0 + 30 * h**ORDER))]
            runs.append(replace(PAGD, tets=tets, tips=tips))
        limit = extrapolated("bending", [4, 2, 1], runs)
        assert limit.tip_mm[0] == pytest.approx([1.0, 0.0, -10.0], abs=1e-5)
        smooth = extrapolated("bending", [4, 2, 1], runs, order=2.0)
        apart = np.linalg.norm(np.subtract(limit.tip_mm[0], smooth.tip_mm[0]))
        assert limit.spread_mm[0] == pytest.approx(apart, abs=1e-5)
        assert [mesh["size_mm"] for mesh in limit.meshes] == [4, 2, 1]

    def test_the_spread_shows_meshes_that_do_not_follow(self) -> None:
        tips = (-9.0, -9.8, -9.7)
        runs = [
            replace(PAGD, tets=tets, tips=[(5.0, (0.0, 0.0, z))])
            for tets, z in zip((1000, 8000, 27000), tips, strict=True)
        ]
        # With the order 2 alone it would be 0.27.
        assert extrapolated("bending", [4, 2, 1], runs).spread_mm[0] > 0.6

    def test_a_mesh_and_its_halves_are_enough(self) -> None:
        tips = [[(5.0, (0.0, 0.0, z))] for z in (-9.0, -9.75)]
        runs = [replace(PAGD, tets=1000, tips=tips[0]), replace(PAGD, tets=8000, tips=tips[1])]
        limit = extrapolated("bending", [6, 3], runs, order=1.0)
        assert limit.tip_mm[0] == pytest.approx([0.0, 0.0, -10.5])
        # With the order 2 it would be a third of the difference away, and not all of it.
        assert limit.spread_mm[0] == pytest.approx(0.75 - 0.75 / 3)
        with pytest.raises(InputError, match="at least 2 meshes"):
            extrapolated("bending", [6], runs[:1])

    def test_sizes_that_give_the_same_mesh_count_once(self) -> None:
        with pytest.raises(InputError, match="6, 5, 4 mm give 1 different meshes"):
            extrapolated("bending", [6, 5, 4], [PAGD, PAGD, PAGD])

    def test_bodies_that_cannot_be_extrapolated_over_are_refused_at_once(
        self, tmp_path: Path
    ) -> None:
        meshers = [replace(BODY, mesher=name) for name in ("gmsh", "structured", "ftetwild")]
        for bodies, key in ((meshers, "--mesher"), ([BODY], "--sizes")):
            with pytest.raises(InputError, match=key):
                Study(folder=tmp_path, bodies=bodies, load=Load()).converge(ORDER)
        assert not any(tmp_path.iterdir())

    def test_tips_join_those_of_other_designs(self, tmp_path: Path) -> None:
        assert read_converged(tmp_path) == {}
        write_converged(tmp_path, {"bending": EXACT})
        file = write_converged(tmp_path, {"twisting": replace(EXACT, design="twisting")})
        found = read_converged(tmp_path)
        assert sorted(found) == ["bending", "twisting"]
        assert found["bending"].error(PAGD, 10.0) == pytest.approx(0.05)
        assert found["bending"].error(PAGD, 7.0) is None
        file.write_text("{", "utf-8")
        with pytest.raises(InputError, match="does not hold converged tips"):
            read_converged(tmp_path)


class TestComparison:
    def test_both_complete(self) -> None:
        found = compared(PAGD, CCX, EXACT)
        assert found.ratio == Ratio(100.0)
        assert found.pressure_kPa == 10.0
        assert found.errors == (pytest.approx(0.05), pytest.approx(0.2))

    def test_the_time_limit_gives_a_bound_and_a_ratio_to_where_it_came(self) -> None:
        found = compared(PAGD, LATE, EXACT)
        assert found.ratio == Ratio(100.0, at_least=True)
        assert str(found.ratio) == "more than 100"
        assert found.pressure_kPa == 5.0
        assert found.ratio_there == Ratio(90.0 / 2.0)

    def test_a_failure_bounds_nothing(self) -> None:
        failed = replace(LATE, status="not_converged")
        assert compared(PAGD, failed, None).ratio is None
        nothing = compared(PAGD, replace(failed, tips=[]), EXACT)
        assert (nothing.ratio, nothing.ratio_there) == (None, None)
        assert nothing.errors == (pytest.approx(0.05), None)

    def test_equal_error_takes_the_first_mesh_that_is_as_good(self) -> None:
        found = equal_error(4.0, 0.05, [(400.0, 0.2), (1000.0, 0.05), (4000.0, 0.01)])
        assert found.ratio == Ratio(250.0)
        assert found.estimate is None

    def test_equal_error_by_the_trend_where_no_mesh_is_as_good(self) -> None:
        found = equal_error(4.0, 0.05, [(400.0, 0.4), (1600.0, 0.2), (3600.0, None)])
        assert found.ratio == Ratio(900.0, at_least=True)
        # Half the error takes four times as long.
        assert found.estimate == pytest.approx(1600.0 * 16 / 4)

    def test_nothing_is_said_of_nothing(self) -> None:
        assert equal_error(4.0, 0.05, []).ratio is None

    def test_the_median_is_a_run(self) -> None:
        runs = [replace(PAGD, wall_s=s) for s in (5.0, 1.0, 3.0)]
        assert median_of(runs).wall_s == 3.0
        assert median_of(runs[:2]).wall_s == 5.0


class TestSections:
    def test_a_time_limit_is_a_row(self) -> None:
        row = SameMeshRow(BODY, PAGD, LATE, compared(PAGD, LATE, EXACT))
        text = page.same_mesh_text("command", [row], 2, {"bending": EXACT})
        line = next(line for line in text.splitlines() if line.startswith("| bending, 5 mm | Calc"))
        assert line.endswith("| 20.0 % | more than 100 |")
        assert "`time_limit` at 7 kPa. Too long. To 5 kPa" in text
        assert "no C3D10H" in text

    def test_unknown_errors_tell_how_to_know_them(self) -> None:
        row = SameMeshRow(BODY, PAGD, CCX, compared(PAGD, CCX, None))
        text = page.same_mesh_text("command", [row], 2, {})
        assert "python benchmarks/peers.py converged" in " ".join(text.split())

    def test_equal_error_needs_the_converged_tip(self, tmp_path: Path) -> None:
        study = Study(folder=tmp_path, bodies=[BODY], load=Load())
        with pytest.raises(InputError, match=r"peers\.py converged --maximum-pressure 50"):
            list(study.equal_error([3.0]))

    def test_equal_error_says_bound_and_trend(self) -> None:
        finer = [CCX, replace(CCX, wall_s=1600.0)]
        result = equal_error(4.0, 0.05, [(400.0, 0.4), (1600.0, 0.2)])
        bodies = [BODY, replace(BODY, size_mm=3.0)]
        tried = list(zip(bodies, finer, [0.4, 0.2], strict=True))
        row = EqualErrorRow(BODY, PAGD, 0.05, 10.0, tried, result)
        tip = replace(EXACT, spread_mm=[0.1, 0.2], meshes=2 * [{"size_mm": 6}])
        text = " ".join(page.equal_error_text("command", [row], 2, {"bending": tip}).split())
        assert "with another order of the error, it would be off by 1.0 % at most" in text
        more = {"bending": replace(tip, meshes=3 * [{"size_mm": 6}])}
        told = " ".join(page.equal_error_text("command", [row], 2, more).split())
        assert "with one of them left out, or another order of the error" in told
        assert "takes **more than 400 times** as long" in text
        assert "by the trend of its last two: 6,400 times" in text

    def test_the_command_is_said_again_with_what_changes_it(self) -> None:
        words = [
            "same-mesh",
            "--sizes",
            "7",
            "--no-half-model",
            "--fresh",
            "--mesher",
            "structured",
        ]
        options = make_parser("", {}).parse_args(words)
        expected = "python benchmarks/peers.py same-mesh --sizes 7 --mesher structured"
        assert command_of(options) == expected


class TestIteration:
    def test_medians_without_the_first_iteration(self) -> None:
        runs = {p.name: [self._run(2.0), self._run(2.0)] for p in PROGRAMS}
        runs["NGSolve"] = [self._run(6.0)] * 2
        rows = {row["program"]: row for row in summarized(runs, 2)}
        assert rows["pagd P2–P1"]["assembly_s"] == 2.0
        assert rows["pagd P2–P1"]["first_s"] == 150.0
        assert rows["NGSolve"]["assembly_s_ratio"] == 3.0
        assert rows["NGSolve"]["iteration_s_ratio"] == (6.0 + 4.0) / (2.0 + 4.0)
        assert rows["FElupe"]["assembly_s_ratio"] == 1.0

    @staticmethod
    def _run(assembly: float) -> dict[str, Any]:
        return {
            "assembly_s": [100.0, assembly, assembly],
            "solve_s": [50.0, 4.0, 4.0],
            "solver": "one",
            "unknowns": 10,
            "tip_mm": [0.0, 0.0, -1.0],
            "correction_mm": [1.0, 0.1],
        }

    def test_versions_are_pinned(self) -> None:
        versions = pinned()
        assert {"felupe", "ngsolve", "numpy", "pypardiso"} <= set(versions)
        assert all(versions.values())

    def test_every_program_has_its_driver_and_one_of_pagd_beside_it(self) -> None:
        ours = {program.name for program in PROGRAMS if program.is_ours}
        for program in PROGRAMS:
            assert (DRIVERS / f"{program.driver}.py").is_file()
            assert program.beside in ours

    def test_the_driver_of_pagd_iterates_to_equilibrium(self, tmp_path: Path) -> None:
        solid = _pressed_block()
        surfaces = {f"surface_{name}": faces for name, faces in solid.surfaces.items()}
        np.savez(tmp_path / "mesh.npz", points=solid.points, tets=solid.tets, **surfaces)
        rubber = {"law": "yeoh", "coefficients": {"C10": 0.11, "C20": 0.02}}
        sheet = {"youngs_modulus": 6500.0, "poisson_ratio": 0.2, "thickness": 0.1}
        job = {"paper": None, "pressure_MPa": 1e-3, "iterations": 5, "threads": 1}
        job |= {"element": "taylor_hood", "material": rubber, "sheet": sheet}
        (tmp_path / "job.json").write_text(json.dumps(job), "utf-8")
        command = [sys.executable, str(DRIVERS / "with_pagd.py"), "mesh.npz", "job.json"]
        env = os.environ | child.thread_settings(1)
        answer = subprocess.run(
            command, cwd=tmp_path, env=env, capture_output=True, text=True, check=False
        )
        assert answer.returncode == 0, answer.stderr
        told = json.loads(answer.stdout)
        assert len(told["assembly_s"]) == len(told["solve_s"]) == 5
        assert told["correction_mm"][-1] < 1e-9
        # The pressure on its upper side bends the block down.
        assert told["tip_mm"][2] < 0


def _pressed_block() -> Mesh:
    block = box((4.0, 3.0, 2.0), (2, 1, 1))
    return replace(block, surfaces={"fixed": block.surfaces["x0"], "cavity": block.surfaces["z1"]})
