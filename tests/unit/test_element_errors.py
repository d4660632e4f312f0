"""Errors of the tip: elements and mesh sizes side by side, random designs on finer meshes."""

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
from pagd.catalogue import NamedDesign
from pagd.design import Channel
from pagd.errors import Status
from pagd.mesh.blocks import check_blocks
from pagd.mesh.chamber_row import chamber_row
from pagd.mesh.checks import check_actuator
from pagd.mesh.types import FloatArray, Mesh, corner_volumes
from pagd.record import Record, write_record
from pagd.tables import MEASURES, write_table

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

import elements as command  # noqa: E402
from performance.element_page import Solved, text_of  # noqa: E402
from performance.elements import Case, order_of, points_of, reference_of, runs_of  # noqa: E402
from performance.halving import halved  # noqa: E402
from performance.options import example_designs  # noqa: E402
from performance.runs import Measurement  # noqa: E402
from robustness.costs import COST_KEYS, as_section  # noqa: E402
from robustness.drawing import drawn_designs  # noqa: E402
from robustness.errors import every_kth, finer_study, tip_error  # noqa: E402
from robustness.study import Study  # noqa: E402

ORDER = 1.089
CONFIG = configuration.completed({})
SIZES = {"tetrahedra": (4.0, 2.0), "element_pressure": (4.0,), "hexahedra": (8.0, 4.0, 2.0)}
LIMIT = np.array([-2.0, 0.0, -20.0])


HALVES = {"tetrahedra": 4.0, "hexahedra": 8.0}


def case(halves: dict[str, float] | None = None) -> Case:
    return Case(example_designs()["bending"], 10.0, SIZES, HALVES if halves is None else halves)


def measurement(size: float, slope: float, **differs: Any) -> Measurement:
    """A run whose tip is off by so much times size^ORDER, of so many unknowns as the size asks."""
    x, y, z = LIMIT * (1 - slope * size**ORDER)
    figures = {
        "free_status": "ok",
        "unknowns": round(64e6 / size**3),
        "free_cpu_s": 64 / size**3,
        "process_cpu_s": 2 + 64 / size**3,
        "stages_cpu_s": {},
        "tip_mm": [[0.0, 130.0, 0.0, -1.0], [10.0, 130.0 + x, y, z - 1.0]],
    }
    return Measurement("finished", None, 9.0, "abc", figures | differs)


def measured() -> dict[tuple[str, str], Measurement]:
    found = {("hexahedra", f"{h:g}"): measurement(h, 0.01) for h in (8.0, 4.0, 2.0)}
    found |= {("tetrahedra", f"{h:g}"): measurement(h, 0.03) for h in (4.0, 2.0)}
    found["tetrahedra", "4 halved"] = measurement(2.0, 0.03)
    found["hexahedra", "8 halved"] = measurement(4.0, 0.01)
    found["element_pressure", "4"] = measurement(4.0, -0.02)
    return found


def test_every_mesh_is_run_with_its_mesher_and_element_and_the_halved_one_whole_too() -> None:
    runs = runs_of(
        Case(example_designs()["bending"], 10.0, SIZES, {"tetrahedra": 3.0}), '{"paper": "paper"}'
    )
    made = {
        key: (run.config["mesh"], run.config["solve"], run.halvings) for key, run in runs.items()
    }
    mesh, solve, _ = made["hexahedra", "8"]
    assert (mesh["meshers"], mesh["block_mm"], solve["element"]) == (
        *(["structured"], 8.0, "hexahedron"),
    )
    mesh, solve, halvings = made["element_pressure", "4"]
    assert (mesh["meshers"], solve["element"], halvings) == (["gmsh"], "element_pressure", 0)
    assert made["tetrahedra", "3"][2] == 0
    assert made["tetrahedra", "3 halved"][2] == 1
    assert len({run.label for run in runs.values()}) == len(runs) == 8


def test_limits_are_exact_where_the_error_has_the_order() -> None:
    points = points_of(case(), measured(), ORDER)
    limits = [point for point in points if point.is_limit]
    assert [(point.family, point.name) for point in limits] == [
        *(("tetrahedra", "4 and 2"), ("tetrahedra", "4 and 4 halved")),
        *(("hexahedra", "8 and 4"), ("hexahedra", "4 and 2"), ("hexahedra", "8 and 8 halved")),
    ]
    for point in limits:
        assert point.tip == pytest.approx(LIMIT)
    assert limits[3].all_s == pytest.approx(2 + 1 + 2 + 8)
    for family in ("hexahedra", "tetrahedra"):
        reference = reference_of(case(), points, family, ORDER)
        assert reference is not None
        assert reference.tip == pytest.approx(LIMIT)
    assert reference.name == "4 and 4 halved"


def test_the_order_is_that_with_which_both_kinds_have_one_limit() -> None:
    assert order_of(case(), measured()) == pytest.approx(ORDER, abs=0.01)
    assert order_of(case({"hexahedra": 8.0}), measured()) == pytest.approx(ORDER)
    apart = measured()
    # One mesh comes nearer to its limit than to the other's: no order brings these together.
    apart["tetrahedra", "4 halved"] = apart["tetrahedra", "4"]
    assert order_of(case(), apart) == pytest.approx(1.089)


def test_a_limit_needs_both_meshes_and_one_that_is_finer() -> None:
    lost = measured()
    lost["hexahedra", "2"] = Measurement("time_limit", "It took more than 1 s.", 1.0, None, {})
    same = measured()["hexahedra", "4"]
    for one in (lost, measured() | {("hexahedra", "2"): same}):
        points = points_of(case(), one, ORDER)
        limit = points[-2]
        assert (limit.name, limit.tip, bool(limit.trouble)) == ("4 and 2", None, True)
    points = points_of(case({}), measured(), ORDER)
    assert reference_of(case({}), points, "hexahedra", ORDER) is None
    lost["hexahedra", "8 halved"] = lost["hexahedra", "2"]
    points = points_of(case(), lost, ORDER)
    assert reference_of(case(), points, "hexahedra", ORDER) is None


def test_the_section_tells_errors_products_and_seconds_at_the_wanted_error() -> None:
    points = points_of(case(), measured(), ORDER)
    text = text_of({case(): Solved(points, ORDER)})
    error = 0.01 * 8**ORDER
    assert f"| hexahedra, 27 nodes | 8 | 125,000 | {20.0998 * (1 - error):.3f} |" in text
    assert f"| {100 * error:.2f} % | {100 * error:.2f} % | 0.12 | 2.12 |" in text
    assert "Order 1.09." in text
    assert "They differ by 0.0 %." in " ".join(text.split())
    summary = [row.split("|") for row in text.split("###")[0].splitlines() if row.startswith("| ")]
    rows = {row[1].strip(): row[2].strip() for row in summary}
    # 3 % lies between 4.5 % at 4 mm (3 s) and 2.1 % at 2 mm (10 s).
    assert 3.0 < float(rows["hexahedra, 27 nodes"]) < 10.0
    assert rows["tetrahedra P2–P1"] == "> 10.0"
    # The limit that errors are measured from has none: 8 and 4 mm are the cheapest with one.
    assert rows["hexahedra, 27 nodes, limits"] == "< 5.1"


def test_without_hexahedra_errors_are_to_the_limit_of_tetrahedra_and_the_reason_is_told() -> None:
    found = measured()
    for size in ("8", "4", "2", "8 halved"):
        found["hexahedra", size] = Measurement("crashed", "There is no such mesher.", 1.0, None, {})
    text = text_of({case(): Solved(points_of(case(), found, ORDER), ORDER)})
    assert "There is no limit by hexahedra." in text
    assert "- hexahedra, 27 nodes, 8 mm: There is no such mesher." in text
    assert "| tetrahedra P2–P1 | > 10.0 |" in text
    assert "| hexahedra, 27 nodes | – |" in text


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--tetrahedra", "0"], "--tetrahedra = 0 must be greater than 0"),
        (["--pressures", "-5"], "--pressures = -5 must be greater than 0"),
        (["--halved-hexahedra", "-1"], "--halved-hexahedra = -1 must be at least 0"),
        (["--page", "absent.md"], "absent.md: there is no such file"),
    ],
)
def test_bad_options_are_one_sentence(
    words: list[str],
    said: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    monkeypatch.setattr(sys, "argv", ["elements.py", *words, "--out", str(tmp_path / "out")])
    with pytest.raises(SystemExit) as ending:
        command.main()
    assert ending.value.code == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_a_mesh_and_its_halves_are_solved_and_the_halves_are_nearer(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT), prepend=os.pathsep)
    words = ["--designs", "bending", "--pressures", "0.5", "--tetrahedra", "5"]
    words += [
        "--halved-tetrahedra",
        "5",
        "--halved-hexahedra",
        "0",
        "--hexahedra",
        "--element-pressure",
        "--out",
        str(tmp_path),
    ]
    monkeypatch.setattr(sys, "argv", ["elements.py", *words])
    command.main()
    printed = capsys.readouterr().out
    lines = printed.splitlines()
    rows = [row.split("|") for row in lines if row.startswith("| tetrahedra P2–P1 | 5")]
    assert [row[2].strip() for row in rows] == ["5", "5 halved"]
    whole, halves = ((int(row[3].replace(",", "")), float(row[6].rstrip(" %"))) for row in rows)
    assert 5 < halves[0] / whole[0] < 9
    assert halves[1] < whole[1]


def designs(count: int) -> list[NamedDesign]:
    return drawn_designs(count, 1, CONFIG)


@pytest.mark.parametrize(("of", "count"), [(200, 20), (60, 20), (7, 3), (3, 20), (40, 1)])
def test_designs_for_errors_are_spread_and_of_both_modes(of: int, count: int) -> None:
    drawn = designs(of)
    chosen = every_kth(drawn, count)
    places = [drawn.index(named) for named in chosen]
    assert len(places) == min(of, count)
    assert places == sorted(set(places))
    assert places[-1] >= (len(places) - 1) * (of // max(count, 1) or 1)
    if len(places) > 2:
        assert {named.design.mode for named in chosen} == {"bending", "twisting"}
    assert every_kth(drawn, 0) == []


def test_the_finer_study_has_halved_edges_and_no_blocked_force(tmp_path: Path) -> None:
    finer = finer_study(Study(tmp_path, designs(4), CONFIG), 2)
    assert finer.halvings == 1
    assert json.loads(finer.start(finer.designs[0]).line)["halvings"] == 1
    assert finer.config["mesh"] == CONFIG["mesh"]
    assert finer.config["solve"]["blocked_force"] == "none"
    assert CONFIG["solve"]["blocked_force"] != "none"
    assert finer.folder(finer.designs[0]).is_relative_to(tmp_path / "halved")


def leave(folder: Path, unknowns: int, tips: list[tuple[float, float]]) -> None:
    """Leave what the error is found from: unknowns, and height of the tip by pressure."""
    record = Record(
        stage="solve",
        design_id="r0001",
        status=Status.ok,
        reason=None,
        figures={"unknowns": unknowns},
        configuration={},
        versions={"pagd": "0", "stage": 1, "python": "3"},
        timings_s={"wall": 1.0, "cpu": 1.0},
        peak_memory_MB=1.0,
    )
    (folder / "solve").mkdir(parents=True)
    write_record(record, folder / "solve")
    (folder / "metrics").mkdir()
    numbers = np.array([(pressure, 130.0, 0.0, z) for pressure, z in tips]).T
    names = ("pressure_kPa", "tip_x_mm", "tip_y_mm", "tip_z_mm")
    columns = [column for column in MEASURES if column.name in names]
    data = dict(zip(names, numbers, strict=True))
    write_table(folder / "metrics" / "performance.parquet", columns, data)


def test_the_error_of_a_tip_is_at_the_last_pressure_of_both_meshes(tmp_path: Path) -> None:
    # Off by 8 % and by a quarter of it, of 10 mm at 20 kPa.
    fine = -1 - 10 * (1 - 0.08 / 4)
    leave(tmp_path / "a", 1000, [(0, -1), (10, -5.0), (20, -1 - 9.2), (25, -12.0)])
    leave(tmp_path / "b", 8000, [(0, -1), (10, -5.2), (20, fine), (24, -13.0)])
    found = tip_error(designs(1)[0], tmp_path / "a", tmp_path / "b")
    assert found is not None
    assert (found.pressure_kPa, found.unknowns, found.finer_unknowns) == (20.0, 1000, 8000)
    assert found.error == pytest.approx(0.08)
    assert found.difference == pytest.approx(0.06)
    largest = 0.06 / (1 - 2**-ORDER)
    assert found.largest_error == pytest.approx(largest / (1 - 0.08 + largest))


def test_there_is_no_error_without_a_common_pressure(tmp_path: Path) -> None:
    leave(tmp_path / "a", 1000, [(0, -1), (10, -5.0)])
    leave(tmp_path / "early", 8000, [(0, -1), (4, -2.0)])
    for other in ("early", "absent"):
        assert tip_error(designs(1)[0], tmp_path / "a", tmp_path / other) is None


def costs(**differs: float | None) -> dict[str, float | None]:
    plain: dict[str, float | None] = dict.fromkeys(COST_KEYS, 1.0)
    return plain | differs


def report(errors: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "study": {"size_mm": 5.0, "config": CONFIG},
        "machine": {"processes": 2},
        "summary": {
            "designs": {"done": 3, "asked": 4},
            "models": {"hexahedron by structured": 3},
            "spreads": {"unknowns": {"median": 12345.0}},
        },
        "tip_errors": errors,
    }


def test_costs_stand_beside_their_targets() -> None:
    given = [
        costs(without_blocked_cpu_s=9.0, peak_memory_MB=900.0, blocked_by_free=0.4),
        costs(without_blocked_cpu_s=7.0, peak_memory_MB=1100.0, blocked_by_free=0.6),
        costs(without_blocked_cpu_s=30.0, outside_cpu_s=4.0, blocked_by_free=None),
    ]
    text = as_section(report([]), given)
    rows = {row.split("|")[1].strip(): row for row in text.splitlines() if row.startswith("| ")}
    assert rows["free actuation with all around it, core-s"].endswith(
        "| 9.0 | 25.8 | 30.0 | median ≤ 8, 90 % ≤ 25 | no |"
    )
    assert rows["blocked force / free actuation"].endswith(
        "| 0.50 | 0.58 | 0.60 | median ≤ 0.5 | yes |"
    )
    assert rows["everything outside of both, core-s"].endswith("| each ≤ 3 | 66.7 % of designs |")
    assert rows["peak memory, MB"].endswith("| each ≤ 1,000 | 66.7 % of designs |")
    assert "hexahedron by structured (3); unknowns: median 12,345" in " ".join(text.split())
    assert "Discretisation error" not in text


def test_errors_of_tips_are_told_with_how_many_are_small_enough() -> None:
    errors = [
        {
            **{"design_id": f"r{n}", "mode": "bending", "pressure_kPa": 50.0, "unknowns": 1000},
            **{"finer_unknowns": 8000, "difference": error / 2, "error": error},
            "largest_error": 2 * error,
        }
        for n, error in enumerate((0.01, 0.02, 0.05))
    ]
    text = " ".join(as_section(report(errors), [costs()]).split())
    assert (
        "order 2 that the examples show the median is 2.0 %, the 90th percentile 4.4 %, "
        "the largest 5.0 %: at most 3 % in 2 of 3;" in text
    )
    assert "largest 10.0 %: at most 3 % in 1 of 3." in text
    assert "| r2 | bending | 50 | 1,000 | 8,000 | 2.50 % | 5.00 % | 10.00 % |" in text


@pytest.mark.parametrize("name", ["bending", "mixed"])
def test_halves_of_blocks_are_blocks_and_fill_the_same_space(name: str) -> None:
    channel = Channel(width=2.0, height=2.0, roof=1.5)
    design = replace(example_designs()[name].design, N=3)
    mesh = chamber_row(design, channel, 8.0, half=name == "bending")
    halves = halved(mesh)
    halves.check()
    check_blocks(halves)
    check_actuator(halves)
    assert (halves.hexahedra, halves.wedges) == (8 * mesh.hexahedra, 8 * mesh.wedges)
    volumes = [corner_volumes(one.points, one.tets) for one in (mesh, halves)]
    assert volumes[1].min() > 0
    assert volumes[1].sum() == pytest.approx(volumes[0].sum())
    for surface, faces in mesh.surfaces.items():
        assert len(halves.surfaces[surface]) == 4 * len(faces)
        assert areas(halves, surface).sum() == pytest.approx(areas(mesh, surface).sum())
    # Every node of the mesh is one of its halves: these refine it.
    places = {tuple(point) for point in halves.points.round(6).tolist()}
    assert {tuple(point) for point in mesh.points.round(6).tolist()} <= places


def areas(mesh: Mesh, surface: str) -> FloatArray:
    a, b, c = (mesh.points[mesh.surfaces[surface][:, k]] for k in range(3))
    return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)
