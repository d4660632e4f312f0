"""The stage metrics on what a solve leaves, without a solver: a block bent to arcs."""

import dataclasses

import numpy as np
import pytest
from figure_samples import bent, block, record

from pagd.config import completed
from pagd.errors import Status
from pagd.fem.contact import ContactLaw
from pagd.mesh.msh import read_msh, write_msh
from pagd.record import read_record, write_record
from pagd.stages.mesh import identity
from pagd.stages.metrics import Folders, run
from pagd.states import States, write_states
from pagd.summary import performance_row
from pagd.tables import BLOCKED, CHAMBERS, HISTORY, MEASURES, read_rows, write_table

# The path passes a limit point at 35 kPa and ends at 25 kPa: states at 0, 10, 30 and 25 kPa.
STEPS = np.array([0.0, 10.0, 20.0, 30.0, 35.0, 25.0])
RECORDED = np.array([True, True, False, True, False, True])
ANGLES = np.array([0.0, 0.2, 0.6, 0.9])
HISTORY_COLUMNS = {
    "pressure_kPa": STEPS,
    "cavity_volume_mm3": 1000.0 + np.array([0.0, 10.0, 20.0, 30.0, 60.0, 100.0]),
    "stored_energy_mJ": np.array([0.0, 0.05, 0.2, 0.45, 1.4, 2.6]),
    "newton_iterations": np.arange(6, dtype=np.int32),
    "recorded": RECORDED,
    # Not measured at first; 0.1 mm are left at 20 kPa, and none would be at 22 kPa.
    "smallest_gap_mm": np.array([np.nan, 0.6, 0.1, 0.03, 0.01, -0.002]),
}
BLOCKED_COLUMNS = {
    "pressure_kPa": np.array([0.0, 10.0, 17.0]),
    "recorded": np.array([True, True, True]),
    "blocked_force_N": np.array([0.0, 0.4, 0.7]),
}
BLOCKED_ENDING = {
    "variant": "edge",
    "status": "not_converged",
    "reason": "Beyond 17 kPa no step of the pressure converged.",
    "pressure_kPa": 17.0,
    "blocked_force_N": 0.7,
    "newton_iterations": 23,
    "penetration_share": 0.004,
}


def solved(root, held=True):
    """Leave a mesh and what the stage solve leaves of it."""
    mesh_path, folder = root / "mesh.msh", root / "solve"
    folder.mkdir()
    write_msh(block(half=False), mesh_path)
    mesh = read_msh(mesh_path)
    moved = np.stack([bent(mesh, angle) for angle in ANGLES])
    states = States(
        pressure_kPa=STEPS[RECORDED], displacement=moved, strain=np.zeros(moved.shape[:2])
    )
    write_states(states, folder / "states.parquet")
    write_table(folder / "history.parquet", HISTORY, HISTORY_COLUMNS)
    figures = {
        "tets": len(mesh.tets),
        "unknowns": 3 * len(mesh.points),
        "newton_iterations": 15,
        "solid_volume_mm3": 400.0,
        "deepest_penetration_mm": 0.002,
        "penetration_share": 0.002 / 1.2,
        "limit_points": 1,
        "largest_pressure_kPa": 35.0,
        "initial_gap_mm": 1.2,
        "recorded": {
            "pressure_kPa": states.pressure_kPa.tolist(),
            "strain_max": [0.0, 0.1, 0.4, 0.8],
            "strain_p99": [0.0, 0.05, 0.15, 0.5],
        },
    }
    if held:
        write_table(folder / "blocked_force.parquet", BLOCKED, BLOCKED_COLUMNS)
        figures["blocked_force"] = BLOCKED_ENDING
    made = record("arc", "solve", Status.ok, None, figures | identity(mesh))
    made = dataclasses.replace(made, configuration={"material": {"name": "rubber"}})
    write_record(made, folder)
    return Folders(mesh=mesh_path, solve=folder)


def measured(root, held=True, **settings):
    """Run the stage; its record, and its rows of every pressure and of every chamber."""
    folders = solved(root, held)
    run(folders, root / "metrics", completed({"metrics": settings}), sections=5)
    out = root / "metrics"
    tables = (read_rows(out / f"{name}.parquet") for name in ("performance", "chambers"))
    return (read_record(out), *tables)


def test_one_tidy_row_a_recorded_state(tmp_path):
    _, rows, _ = measured(tmp_path)
    assert list(rows[0]) == [column.name for column in MEASURES]
    assert [row["design_id"] for row in rows] == ["arc"] * 4
    assert [row["pressure_kPa"] for row in rows] == [0.0, 10.0, 30.0, 25.0]
    found = [row["bending_deg"] for row in rows]
    np.testing.assert_allclose(found, np.degrees(ANGLES), rtol=5e-3, atol=1e-9)
    assert [row["stored_energy_mJ"] for row in rows] == [0.0, 0.05, 0.45, 2.6]
    assert [row["smallest_gap_mm"] for row in rows] == [None, 0.6, 0.03, -0.002]
    # By trapezoids along the path, 5, 15, 25, 32.5 and 30 kPa times 10, 10, 10, 30 and 40 mm³.
    work = [row["work_mJ"] for row in rows]
    assert work == pytest.approx([0.0, 0.05, 0.45, 2.625])
    assert rows[2]["work_density_kJ_m3"] == pytest.approx(0.45 / 400.0 * 1e3)


def test_what_a_state_does_not_have_is_null(tmp_path):
    _, rows, _ = measured(tmp_path)
    # The held tip came to 17 kPa only; behind the limit point the pressure has fallen.
    assert [row["blocked_force_N"] for row in rows] == [0.0, 0.4, None, None]
    rates = [row["strain_rate_per_kPa"] for row in rows]
    assert rates == [pytest.approx(0.005)] * 3 + [None]
    assert [row["strain_rate_per_s"] for row in rows] == [None] * 4


def test_rate_in_time_follows_the_configured_ramp(tmp_path):
    _, rows, _ = measured(tmp_path, pressure_ramp_kPa_per_s=50.0)
    assert [row["strain_rate_per_s"] for row in rows] == [pytest.approx(0.25)] * 3 + [None]


def test_the_record_is_the_row_of_all_designs(tmp_path):
    made, _, _ = measured(tmp_path)
    expected = {
        "pressure_kPa": 25.0,
        "blocked_force_N": 0.7,
        "blocked_force_pressure_kPa": 17.0,
        "blocked_force_variant": "edge",
        "blocked_force_status": "not_converged",
        "blocked_force_iterations": 23,
        "largest_pressure_kPa": 35.0,
        "newton_iterations": 15,
        "first_contact_pressure_kPa": pytest.approx(22.0 - 20 * ContactLaw().width),
        "deepest_penetration_mm": 0.002,
        "penetration_share": 0.002 / 1.2,
        "blocked_penetration_share": 0.004,
        "limit_points": 1,
        "strain_p99": 0.5,
        "strain_rate_per_kPa": None,
        "work_mJ": pytest.approx(2.625),
        "material": "rubber",
    }
    assert {key: made.figures[key] for key in expected} == expected


def test_the_first_known_gap_is_that_of_the_unloaded_actuator(tmp_path, monkeypatch):
    """With a single open step besides it, the line goes through both."""
    gap = np.array([np.nan, 0.2, 0.03, 0.02, 0.01, 0.0])
    monkeypatch.setitem(HISTORY_COLUMNS, "smallest_gap_mm", gap)
    made, _, _ = measured(tmp_path)
    # From 1.2 mm at 0 kPa by 0.1 mm a kPa.
    assert made.figures["first_contact_pressure_kPa"] == pytest.approx(
        12.0 - 10 * ContactLaw().width
    )


def test_without_a_held_tip_there_is_no_blocked_force(tmp_path):
    made, rows, _ = measured(tmp_path, held=False)
    assert {row["blocked_force_N"] for row in rows} == {None}
    assert "blocked_force_pressure_kPa" not in made.figures
    assert performance_row(made)["blocked_force_iterations"] is None


def test_a_balance_that_is_infinite_is_null(tmp_path, monkeypatch):
    """Work of the pressure that nothing has stored."""
    monkeypatch.setitem(HISTORY_COLUMNS, "stored_energy_mJ", np.zeros(6))
    made, rows, _ = measured(tmp_path)
    assert rows[-1]["energy_balance"] == np.inf
    assert made.figures["energy_balance"] is None
    assert made.figures["work_mJ"] == pytest.approx(2.625)


def test_records_without_the_newer_figures_have_null_there(tmp_path, monkeypatch):
    monkeypatch.delitem(BLOCKED_ENDING, "newton_iterations")
    monkeypatch.delitem(BLOCKED_ENDING, "penetration_share")
    folders = solved(tmp_path)
    older = read_record(folders.solve)
    del older.figures["largest_pressure_kPa"]
    write_record(older, folders.solve)
    run(folders, tmp_path / "metrics", completed({}), sections=5)
    row = performance_row(read_record(tmp_path / "metrics"))
    assert (row["blocked_force_iterations"], row["largest_pressure_kPa"]) == (None, None)
    assert row["blocked_penetration_share"] is None
    assert row["blocked_force_status"] == "not_converged"


def test_sections_of_a_mesh_without_a_design_stand_for_its_chambers(tmp_path):
    _, rows, chambers = measured(tmp_path)
    assert list(chambers[0]) == [column.name for column in CHAMBERS]
    assert [row["chamber"] for row in chambers] == [1, 2, 3, 4] * 4
    assert {row["kind"] for row in chambers} == {None}
    for i, whole in enumerate(rows):
        parts = chambers[4 * i : 4 * i + 4]
        assert sum(row["bending_deg"] for row in parts) == pytest.approx(whole["bending_deg"])
        # An arc bends everywhere alike.
        for row in parts:
            assert row["bending_deg"] == pytest.approx(whole["bending_deg"] / 4, rel=0.1, abs=1e-9)
