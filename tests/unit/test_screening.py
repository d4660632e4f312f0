"""Tests of the command that screens many designs by their cells."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from reduced_samples import SLANTED, STRAIGHT

from pagd.archive.provenance import of_screening
from pagd.cli import main
from pagd.errors import InputError
from pagd.machine import machine_class
from pagd.record import read_record
from pagd.reduced.blocked import Blocked
from pagd.reduced.solve import ReducedRow
from pagd.stages import gate, reduced, screening
from pagd.tables import read_rows

CONFIG = json.dumps(
    {
        "mesh": {"block_mm": 12.0},
        "solve": {"maximum_pressure_kPa": 10.0, "recorded_step_kPa": 5.0},
    }
)


@pytest.fixture
def table(tmp_path: Path) -> Path:
    """A straight row, a slanted one, and one that cannot be built."""
    rows = [STRAIGHT.as_dict(), SLANTED.as_dict(), STRAIGHT.as_dict() | {"H": 3}]
    names = ["straight", "slanted", "flat"]
    lines = [",".join(["name", *rows[0]])]
    lines += [
        ",".join([name, *map(str, row.values())]) for name, row in zip(names, rows, strict=True)
    ]
    file = tmp_path / "designs.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def screened(table: Path, out: Path, *more: str) -> int:
    return main(["screen", str(table), "--out", str(out), "--config", CONFIG, *more])


def test_every_design_has_a_row_and_what_was_measured(table: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert screened(table, out) == 0
    rows = {row["design_id"]: row for row in read_rows(out / "performance.parquet")}
    assert list(rows) == ["straight", "slanted", "flat"]
    assert {name: row["status"] for name, row in rows.items()} == {
        "straight": "ok",
        "slanted": "ok",
        "flat": "invalid_geometry",
    }
    assert "H = 3" in rows["flat"]["reason"]
    assert {row["fidelity"] for row in rows.values()} == {"cells"}
    assert rows["straight"]["twist_deg"] == pytest.approx(0, abs=1e-6)
    assert rows["slanted"]["twist_deg"] > 1
    assert rows["slanted"]["blocked_force_N"] > 0
    assert rows["slanted"]["energy_balance"] < 0.01
    by_pressure = read_rows(out / "by_pressure.parquet")
    assert [row["pressure_kPa"] for row in by_pressure] == [0, 5, 10] * 2
    assert len(read_rows(out / "trajectories.parquet")) == 2 * 3 * (STRAIGHT.N + 1)
    assert len(read_rows(out / "chambers.parquet")) == 2 * 3 * STRAIGHT.N
    record = read_record(out)
    assert record.figures["statuses"] == {"invalid_geometry": 1, "ok": 2}
    assert record.configuration["fidelity"] == "cells"


def test_pieces_change_the_tip_and_are_told(table: Path, tmp_path: Path) -> None:
    tips = []
    for name, more in (("cells", []), ("pieces", ["--fidelity", "pieces"])):
        assert screened(table, tmp_path / name, *more) == 0
        row = read_rows(tmp_path / name / "performance.parquet")[0]
        assert row["fidelity"] == name
        tips.append([row["tip_x_mm"], row["tip_z_mm"]])
    assert 0.001 < np.linalg.norm(np.subtract(*tips)) < 3


def test_what_is_done_is_not_done_again(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out, kept = tmp_path / "out", tmp_path / ".out.batches"

    def ended_early(*more: str) -> None:
        """As if it had been ended when the batches were done, and before they were removed."""
        with monkeypatch.context() as patched:
            patched.setattr(screening, "_discard", lambda _: None)
            assert screened(table, out, *more) == 0

    ended_early()
    first = (out / "performance.parquet").read_bytes()
    assert [folder.name for folder in kept.iterdir()] == ["000000"]
    assert screened(table, out, "-v") == 0
    assert "1 of 1 batches are done already" in capsys.readouterr().err
    assert (out / "performance.parquet").read_bytes() == first
    assert not kept.exists()
    # Of another configuration they are other designs' batches.
    ended_early()
    assert screened(table, out, "-v", "--pressure-kPa", "5") == 0
    assert "done already" not in capsys.readouterr().err


def test_no_processes_are_refused(
    table: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert screened(table, tmp_path / "out", "--processes", "0") == 2
    assert "--processes = 0 must be at least 1" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("solve", "why"),
    [
        ({"gravity_m_s2": [0, 0, -9.81]}, "solve.gravity_m_s2 = [0, 0, -9.81]: must be 0"),
        ({"element": "taylor_hood"}, "solve.element = 'taylor_hood': must be auto or hexahedron"),
    ],
)
def test_what_cells_cannot_is_refused(
    table: Path,
    tmp_path: Path,
    solve: dict[str, object],
    why: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    config = json.dumps({"solve": solve})
    out = tmp_path / "out"
    assert main(["screen", str(table), "--out", str(out), "--config", config]) == 2
    assert why in capsys.readouterr().err
    assert not out.exists()


def test_parts_share_a_table_and_are_gathered(table: Path, tmp_path: Path) -> None:
    parts = [tmp_path / f"part{k}" for k in (1, 2)]
    for number, part in enumerate(parts, 1):
        assert screened(table, part, "--part", f"{number}/2") == 0
    shared = [names_in(part) for part in parts]
    assert sorted(map(len, shared)) == [1, 2]
    record = screening.gather(parts, tmp_path / "all")
    assert names_in(tmp_path / "all") == [*shared[0], *shared[1]]
    assert set(names_in(tmp_path / "all")) == {"straight", "slanted", "flat"}
    with pytest.raises(InputError, match="in more than one"):
        screening.gather([parts[0], *parts], tmp_path / "twice")
    assert record.figures["statuses"] == {"invalid_geometry": 1, "ok": 2}
    assert record.configuration == read_record(parts[0]).configuration
    trajectories = read_rows(tmp_path / "all" / "trajectories.parquet")
    assert {row["design_id"] for row in trajectories} == {"straight", "slanted"}
    # Parts may be made on several machines, of which each is told.
    path = parts[1] / "record.json"
    content = json.loads(path.read_text())
    content["machine"]["processor"] = "Another"
    path.write_text(json.dumps(content))
    record = screening.gather(parts, tmp_path / "both")
    told = [one["machine"]["processor"] for one in record.figures["made_by"]]
    assert told == [machine_class()["processor"], "Another"]
    assert len(of_screening(tmp_path / "both")["machines"]) == 2
    assert len(of_screening(tmp_path / "all")["machines"]) == 1


def test_parts_of_another_configuration_are_refused(table: Path, tmp_path: Path) -> None:
    parts = [tmp_path / "one", tmp_path / "other"]
    for part, more in zip(parts, ([], ["--pressure-kPa", "5"]), strict=True):
        assert screened(table, part, "--part", "3/3", *more) == 0
    with pytest.raises(InputError, match="screened with another configuration"):
        screening.gather(parts, tmp_path / "all")
    assert not (tmp_path / "all").exists()


@pytest.mark.parametrize("part", ["0/2", "3/2", "2", "a/b"])
def test_what_is_no_part_is_refused(
    table: Path, tmp_path: Path, part: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert screened(table, tmp_path / "out", "--part", part) == 2
    assert f"'{part}'" in capsys.readouterr().err


def names_in(folder: Path) -> list[str]:
    return [str(row["design_id"]) for row in read_rows(folder / "performance.parquet")]


def test_where_cells_are_doubtful_the_next_better_analysis_is_run(
    table: Path, tmp_path: Path
) -> None:
    assert screened(table, tmp_path / "gated", "--fidelity", "gated") == 0
    rows = {row["design_id"]: row for row in read_rows(tmp_path / "gated" / "performance.parquet")}
    assert STRAIGHT.N < 6
    assert rows["straight"]["fidelity"] == "pieces"
    assert rows["straight"]["doubt"] == (
        f"Of {STRAIGHT.N} chambers the ends are too much for cells alone."
    )
    assert (rows["flat"]["fidelity"], rows["flat"]["doubt"]) == ("cells", None)


def test_a_design_that_pieces_cannot_is_run_in_full(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = "Too far from anything."
    monkeypatch.setattr(gate, "doubt_of", lambda row, *_: told if row["status"] == "ok" else None)
    assert screened(table, tmp_path / "out", "--fidelity", "gated") == 0
    rows = {row["design_id"]: row for row in read_rows(tmp_path / "out" / "performance.parquet")}
    assert rows["straight"]["fidelity"] == rows["slanted"]["fidelity"] == "full"
    assert rows["slanted"]["doubt"] == told
    assert rows["slanted"]["unknowns"] > 0
    by_pressure = read_rows(tmp_path / "out" / "by_pressure.parquet")
    assert {row["fidelity"] for row in by_pressure} == {"full"}
    assert read_record(tmp_path / "out").figures["fidelities"] == {"cells": 1, "full": 2}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({}, None),
        ({"status": "bending_limit"}, None),
        ({"status": "invalid_geometry"}, None),
        ({"status": "buckled"}, "ends as buckled"),
        ({"blocked_force_status": "not_converged"}, "No blocked force"),
        ({"blocked_force_status": "not_converged", "blocked_force_N": None}, "No blocked force"),
        ({"held_turn_deg": 16.2}, "turns a chamber by 16°"),
        ({"held_turn_deg": None, "blocked_force_N": None, "blocked_force_status": None}, None),
    ],
)
def test_what_makes_a_result_doubtful(changed: dict[str, object], words: str | None) -> None:
    row = {
        "status": "ok",
        "fidelity": "cells",
        "blocked_force_N": 0.1,
        "blocked_force_status": "ok",
        "held_turn_deg": 14.0,
    }
    told = gate.doubt_of(row | changed, replace(SLANTED, N=7))
    assert (told is None) if words is None else (told is not None and words in told)


def test_few_chambers_are_too_much_end_for_cells_alone() -> None:
    row = {"status": "ok", "fidelity": "cells"}
    for design, fewest in ((STRAIGHT, 6), (SLANTED, 7)):
        told = gate.doubt_of(row, replace(design, N=fewest - 1))
        assert told == f"Of {fewest - 1} chambers the ends are too much for cells alone."
        assert gate.doubt_of(row, replace(design, N=fewest)) is None
        assert gate.doubt_of(row | {"fidelity": "pieces"}, replace(design, N=3)) is None


def test_parts_of_a_plate_are_doubted() -> None:
    row = {"status": "ok", "fidelity": "pieces"}
    assert "no plate" in str(gate.doubt_of(row, SLANTED, "plate"))
    assert gate.doubt_of(row, SLANTED, "none") is None


def test_a_fault_of_the_better_analysis_leaves_the_simpler_one(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("no such thing")

    monkeypatch.setattr(
        gate, "doubt_of", lambda row, *_: "Never." if row["status"] == "ok" else None
    )
    monkeypatch.setattr(gate, "full_analysis", broken)
    assert screened(table, tmp_path / "out", "--fidelity", "gated") == 0
    rows = {row["design_id"]: row for row in read_rows(tmp_path / "out" / "performance.parquet")}
    assert (rows["straight"]["fidelity"], rows["straight"]["doubt"]) == ("pieces", "Never.")
    assert rows["straight"]["bending_deg"] > 1


def test_a_fault_of_a_design_is_told_and_the_others_go_on(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object, **__: object) -> None:
        raise RuntimeError("no such thing")

    monkeypatch.setattr(screening, "analyse", broken)
    assert screened(table, tmp_path / "out") == 0
    rows = read_rows(tmp_path / "out" / "performance.parquet")
    assert {row["status"] for row in rows} == {"not_converged"}
    assert all("RuntimeError: no such thing" in row["doubt"] for row in rows)
    assert read_record(tmp_path / "out").figures["cpu_s_median"] == 0.0


CRASHING = """
import os, signal, sys
from pagd.archive.provenance import of_screening
from pagd.cli import main
from pagd.stages import screening

analyse = screening.analyse

def crashing(named, *arguments, **options):
    if named.name == "slanted":
        os.kill(os.getpid(), signal.SIGABRT)
    return analyse(named, *arguments, **options)

screening.analyse = crashing
sys.exit(main(sys.argv[1:]))
"""


def test_a_design_that_crashes_takes_no_other_with_it(table: Path, tmp_path: Path) -> None:
    # A process of its own: those of the tests have started threads, and cannot be forked.
    words = ["screen", str(table), "--out", str(tmp_path / "out"), "--config", CONFIG]
    subprocess.run([sys.executable, "-c", CRASHING, *words], check=True)
    rows = {row["design_id"]: row for row in read_rows(tmp_path / "out" / "performance.parquet")}
    statuses = {name: row["status"] for name, row in rows.items()}
    assert statuses == {"straight": "ok", "slanted": "crashed", "flat": "invalid_geometry"}
    assert "SIGABRT" in rows["slanted"]["doubt"]
    assert rows["straight"]["bending_deg"] > 1


def test_forces_that_none_were_found_of_are_told(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing(row: ReducedRow, *_: object) -> Blocked:
        return Blocked(*np.full((2, len(row.pressure_kPa)), np.nan))

    monkeypatch.setattr(reduced, "blocked_forces", nothing)
    assert screened(table, tmp_path / "out") == 0
    row = read_rows(tmp_path / "out" / "performance.parquet")[0]
    assert (row["blocked_force_N"], row["blocked_force_status"]) == (None, "not_converged")
    assert row["doubt"] is not None


def test_the_largest_turn_at_any_pressure_is_doubted(
    table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def looping(row: ReducedRow, *_: object) -> Blocked:
        pressures = row.pressure_kPa
        turned = np.where(pressures == pressures[1], 30.0, 5.0)
        return Blocked(0.01 * pressures, turned)

    monkeypatch.setattr(reduced, "blocked_forces", looping)
    assert screened(table, tmp_path / "out") == 0
    row = read_rows(tmp_path / "out" / "performance.parquet")[1]
    assert (row["held_turn_deg"], row["blocked_force_N"]) == (30.0, pytest.approx(0.1))
    assert row["doubt"] is not None


def test_gated_batches_are_those_of_their_full_analyses_too(table: Path, tmp_path: Path) -> None:
    assert screened(table, tmp_path / "out", "--fidelity", "gated") == 0
    assert {"geometry", "repair", "solve"} <= set(read_record(tmp_path / "out").configuration)
