"""Designs of other families through all stages, by the commands a user types."""

from __future__ import annotations

import csv
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from family_samples import BAR, BELLOWS, write_family
from figure_samples import solved

from pagd.catalogue import design_from
from pagd.cli import main
from pagd.design import GeometryRules
from pagd.figures.sections import sections_as_svg
from pagd.mesh.msh import read_msh
from pagd.record import Record, read_record
from pagd.tables import read_rows, read_table

#: A coarse mesh and little pressure, which moves the tip by a few degrees at most.
CONFIG: dict[str, Any] = {
    "material": "dragon_skin_30",
    "mesh": {"size_mm": 6.0},
    "solve": {"maximum_pressure_kPa": 4.0, "recorded_step_kPa": 2.0, "blocked_force": "none"},
    "metrics": {"still_deg": 0.01, "joint_deg": 0.001},
    "figures": {"resolution_dpi": 50},
}
STAGES = ("geometry", "repair", "mesh", "solve", "metrics", "figures")


def through_all_stages(design: dict[str, Any], out: Path) -> dict[str, Record]:
    folder = out / design["name"]
    command = ["run", json.dumps(design), "--config", json.dumps(CONFIG), "--out", str(folder)]
    assert main(command) == 0
    return {stage: read_record(folder / stage) for stage in STAGES}


@pytest.fixture(scope="module")
def bellows(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a half-bellows that has gone through all stages."""
    folder = tmp_path_factory.mktemp("designs")
    through_all_stages(BELLOWS, folder)
    return folder / "bellows"


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The family of a user's own, where Python imports from."""
    write_family(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield
    sys.modules.pop("hollow_bar", None)


def cavity_of(mesh: Path) -> float:
    """Volume of the cavity of a half model, by the divergence theorem."""
    read = read_msh(mesh)
    a, b, c = np.moveaxis(read.points[read.surfaces["cavity"][:, :3]], 1, 0)
    return -2.0 * float(np.sum(np.cross(a, b) * c)) / 6.0


def test_volumes_are_those_of_the_closed_form(bellows: Path, tmp_path: Path) -> None:
    """Elements cut the corners of facets that are smaller than they are: finer ones do less."""
    exact = design_from(json.dumps(BELLOWS)).actuator.volumes(GeometryRules())
    assert exact is not None
    record = read_record(bellows / "mesh")
    assert record.figures["half"] is True
    assert record.figures["volume_mm3"] == pytest.approx(exact.solid / 2, rel=0.01)
    solved_volume = read_table(bellows / "solve" / "history.parquet")["cavity_volume_mm3"]
    assert solved_volume[0] == pytest.approx(cavity_of(bellows / "mesh" / "mesh.msh"), rel=1e-6)
    assert np.all(np.diff(solved_volume) > 0)
    before = ["--geometry", str(bellows / "geometry"), "--repair", str(bellows / "repair")]
    assert main(["mesh", *before, "--size-mm", "1.5", "--out", str(tmp_path / "fine")]) == 0
    fine = cavity_of(tmp_path / "fine" / "mesh.msh")
    assert fine == pytest.approx(exact.cavity, rel=0.005)
    assert 2 * abs(fine - exact.cavity) < abs(solved_volume[0] - exact.cavity) < 0.04 * fine


def test_it_bends_towards_the_paper_in_its_plane(bellows: Path) -> None:
    figures = read_record(bellows / "metrics").figures
    assert figures["measured_mode"] == figures["mode"] == "bending"
    assert 0.5 < figures["bending_deg"] < 20.0
    assert figures["tip_z_mm"] < 0.0
    assert abs(figures["twist_deg"]) < 0.01
    assert figures["energy_balance"] < 0.01


def test_its_sections_are_the_roots_between_convolutions(bellows: Path) -> None:
    trajectory = read_table(bellows / "metrics" / "trajectory.parquet")
    last = trajectory["pressure_kPa"] == trajectory["pressure_kPa"].max()
    assert last.sum() == BELLOWS["N"] + 1
    joints = read_table(bellows / "metrics" / "chambers.parquet")
    last = joints["pressure_kPa"] == joints["pressure_kPa"].max()
    assert joints["bending_deg"][last].sum() == pytest.approx(
        read_record(bellows / "metrics").figures["bending_deg"]
    )
    assert set(joints["kind"]) == {None}


def test_both_families_are_in_one_table_and_on_one_page(bellows: Path, tmp_path: Path) -> None:
    pneunet = solved(tmp_path / "arc")
    folders = [str(bellows), str(pneunet)]
    assert main(["summary", *folders, "--out", str(tmp_path / "summary")]) == 0
    rows = read_rows(tmp_path / "summary" / "performance.parquet")
    assert [row["design_id"] for row in rows] == ["bellows", "arc"]
    with (tmp_path / "summary" / "summary.csv").open(newline="") as file:
        assert [row["mode drawn"] for row in csv.DictReader(file)] == ["bending", "bending"]
    page = tmp_path / "page.html"
    assert main(["view", *folders, "--no-browser", "--out", str(page)]) == 0
    for name in ("bellows", "arc"):
        assert f'id="design-{name}"' in page.read_text()


def test_all_pictures_are_drawn(bellows: Path) -> None:
    pictures = {"geometry", "mesh", "deformed", "pressure_volume", "contact"}
    assert {path.stem for path in (bellows / "figures").glob("*.png")} == pictures


def test_it_is_exported_for_other_programs(bellows: Path, tmp_path: Path) -> None:
    assert main(["export", str(bellows), "--out", str(tmp_path / "exported")]) == 0
    record = read_record(tmp_path / "exported")
    wanted = {"body.stl", "base.stl", "solids.step", "design.scad", "last_state.vtu"}
    assert wanted <= {path.name for path in (tmp_path / "exported").iterdir()}
    assert record.figures["left_out"] == {}


def test_a_notebook_shows_its_sections(bellows: Path) -> None:
    body, base = (pv.read(bellows / "repair" / f"{part}.stl") for part in ("body", "base"))
    picture = sections_as_svg(body, base, design_from(json.dumps(BELLOWS)).design)
    assert 'aria-label="sections of a bending design, half_bellows"' in picture
    assert "26" in picture


def test_a_family_of_ones_own_goes_through_all_stages(own: None, tmp_path: Path) -> None:
    records = through_all_stages(BAR, tmp_path)
    assert {record.status.value for record in records.values()} == {"ok"}
    assert records["geometry"].figures == {
        "family": "hollow_bar:HollowBar",
        "L_T_mm": 30.0,
        "mode": "bending",
    }
    attempts = records["mesh"].figures["attempts"]
    assert attempts[0]["reason"] == "The family hollow_bar:HollowBar has no mesher of its own."
    # No volumes of its own: the mesh is measured against its surfaces.
    assert records["mesh"].figures["volume_mm3"] == pytest.approx(
        0.5 * (8 * 8 * 30 - 4 * 4 * 26 + 8 * 2 * 30), rel=1e-4
    )
    assert records["metrics"].figures["tip_z_mm"] < 0.0
    trajectory = read_table(tmp_path / "bar" / "metrics" / "trajectory.parquet")
    assert len(set(trajectory["station"])) == 11
