import csv
from pathlib import Path
from typing import Any

import pytest

from pagd.actuation import ActuationResult
from pagd.cli import main
from pagd.errors import Status
from pagd.record import Record, versions, write_record
from pagd.stages.solve import _ending
from pagd.summary import GATHERED, write_gathered, write_summary
from pagd.tables import PERFORMANCE, read_rows, write_table

COST = {"cpu_s": 10.0, "wall_s": 6.0, "peak_memory_MB": 300.0}
MEASURED = COST | {
    "name": "good", "origin": "table2", "mode": "bending", "measured_mode": "bending",
    "pressure_kPa": 50.0, "bending_deg": 78.12, "twist_deg": 0.0, "tip_x_mm": 92.7,
    "tip_y_mm": -0.01, "tip_z_mm": -76.9, "work_density_kJ_m3": 2.1, "strain_p99": 0.2,
    "energy_balance": -4e-6, "tets": 5825, "unknowns": 34813, "newton_iterations": 34,
    "material": "elastosil_m4601", "size_mm": 5.0, "chord_deg": 39.3,
    "blocked_force_N": 1.23456, "first_contact_pressure_kPa": None, "limit_points": 0,
    "penetration_share": 0.012, "blocked_penetration_share": 0.015,
}  # fmt: skip


def folder(root: Path, name: str, figures: dict[str, Any], reason: str | None = None) -> Path:
    path = root / name
    path.mkdir()
    record = Record(
        stage="metrics",
        design_id=name,
        status=Status.mesh_failed if reason else Status.ok,
        reason=reason,
        figures=figures,
        configuration={},
        versions=versions(1),
        timings_s={"wall": 0.5, "cpu": 0.25},
        peak_memory_MB=100.0,
    )
    write_record(record, path)
    return path


@pytest.fixture
def folders(tmp_path: Path) -> list[Path]:
    """A design that was measured, one that could not be meshed, and a mesh without a design."""
    good = folder(tmp_path, "good", MEASURED)
    for _, own, columns in GATHERED:
        write_table(good / own, columns, {"design_id": ["good"], "pressure_kPa": [50.0]})
    failed = {"name": "bad", "origin": "own", "mode": "mixed"}
    own = {key: value for key, value in MEASURED.items() if key not in ("name", "origin", "mode")}
    return [
        folder(tmp_path, "bad", COST | failed, "The mesher gave up."),
        good,
        folder(tmp_path, "own", own),
    ]


def test_every_design_has_its_row_in_order(folders: list[Path], tmp_path: Path) -> None:
    write_summary(folders, tmp_path / "p.parquet", tmp_path / "s.csv")
    bad, good, own = read_rows(tmp_path / "p.parquet")
    assert list(good) == [column.name for column in PERFORMANCE]
    assert (bad["status"], bad["reason"]) == ("mesh_failed", "The mesher gave up.")
    assert (bad["origin"], bad["mode"], bad["bending_deg"]) == ("own", "mixed", None)
    assert good["bending_deg"] == 78.12
    assert (good["penetration_share"], good["blocked_penetration_share"]) == (0.012, 0.015)
    assert (bad["penetration_share"], bad["blocked_penetration_share"]) == (None, None)
    assert (own["name"], own["origin"], own["mode"]) == ("own", None, None)
    assert {row["fidelity"] for row in (bad, good, own)} == {"full"}


def test_cost_counts_the_stage_itself(folders: list[Path], tmp_path: Path) -> None:
    write_summary(folders, tmp_path / "p.parquet", tmp_path / "s.csv")
    for row in read_rows(tmp_path / "p.parquet"):
        assert (row["cpu_s"], row["wall_s"], row["peak_memory_MB"]) == (10.25, 6.5, 300.0)


def test_the_table_for_people(folders: list[Path], tmp_path: Path) -> None:
    write_summary(folders, tmp_path / "p.parquet", tmp_path / "s.csv")
    rows = {row["design"]: row for row in csv.DictReader((tmp_path / "s.csv").open())}
    assert rows["good"]["bending, °"] == "78.1"
    assert rows["good"]["tip y, mm"] == "0.0"
    assert rows["good"]["energy balance"] == "0.00000"
    assert rows["good"]["blocked force, N"] == "1.235"
    assert rows["good"]["first contact, kPa"] == ""
    assert {row["time, s"] for row in rows.values()} == {"6.5"}
    assert rows["good"]["mesh size, mm"] == "5"
    assert rows["good"]["material"] == "elastosil_m4601"
    assert rows["bad"]["bending, °"] == ""
    assert rows["bad"]["reason"] == "The mesher gave up."


def test_novelty_of_those_that_have_one(folders: list[Path], tmp_path: Path) -> None:
    write_summary(folders, tmp_path / "p.parquet", tmp_path / "s.csv", {"good": 0.71249})
    novelty = {row["design_id"]: row["novelty"] for row in read_rows(tmp_path / "p.parquet")}
    assert novelty == {"bad": None, "good": 0.71249, "own": None}
    rows = {row["design"]: row for row in csv.DictReader((tmp_path / "s.csv").open())}
    assert {name: row["novelty"] for name, row in rows.items()} == {
        "bad": "", "good": "0.712", "own": ""
    }  # fmt: skip
    assert {name: row["origin"] for name, row in rows.items()} == {
        "bad": "own", "good": "table2", "own": ""
    }  # fmt: skip


def test_what_was_measured_of_those_that_have_it(folders: list[Path], tmp_path: Path) -> None:
    write_gathered(folders, tmp_path / "all")
    assert len(GATHERED) == 3
    for name, own, columns in GATHERED:
        rows = read_rows(tmp_path / "all" / name)
        assert rows == read_rows(folders[1] / own)
        assert [row["design_id"] for row in rows] == ["good"]
        assert list(rows[0]) == [column.name for column in columns]


def test_nothing_gives_empty_tables(tmp_path: Path) -> None:
    write_summary([], tmp_path / "p.parquet", tmp_path / "s.csv")
    write_gathered([], tmp_path)
    for name in ("p.parquet", *(name for name, _, _ in GATHERED)):
        assert read_rows(tmp_path / name) == []


def test_the_command_line_writes_all_tables(folders: list[Path], tmp_path: Path) -> None:
    """Of the designs that came as far as the metrics; the folder of another is left out."""
    designs = tmp_path / "designs"
    for path in folders:
        (designs / path.name).mkdir(parents=True)
        path.rename(designs / path.name / "metrics")
    (designs / "unfinished").mkdir()
    named = sorted(map(str, designs.iterdir()))
    assert main(["summary", *named, "--out", str(tmp_path / "tables")]) == 0
    written = {path.name for path in (tmp_path / "tables").iterdir()}
    assert written == {"performance.parquet", "summary.csv", *(name for name, _, _ in GATHERED)}
    rows = read_rows(tmp_path / "tables" / "performance.parquet")
    assert [row["design_id"] for row in rows] == ["bad", "good", "own"]


def test_the_record_tells_the_penetration_of_the_held_tip_as_that_of_the_free_one() -> None:
    contact = {"deepest_penetration_mm": 0.015, "penetration_share": 0.015, "limit_points": 1}
    figures = contact | {"variant": "edge", "blocked_force_N": 0.7, "pressure_kPa": 17.0}
    held = ActuationResult(Status.buckled, "It snaps.", [], {}, figures | {"tets": 2000})
    assert _ending(held) == {"status": "buckled", "reason": "It snaps.", **figures}
