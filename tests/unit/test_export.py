"""A design for other programs: what its files hold, by closed forms and by other readers."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista
from design_samples import TABLE2_MIXED
from figure_samples import solved

from pagd.catalogue import NamedDesign
from pagd.config import load
from pagd.design import Design, GeometryRules, base_volume, body_volume, cavity_volume
from pagd.errors import InputError, StageFailure, Status
from pagd.export import write_step
from pagd.geometry import parts_of_model, render, write_design_scad
from pagd.mesh.facets import Facets
from pagd.mesh.gmsh_session import gmsh_session
from pagd.mesh.surfaces import Surface, read_stl
from pagd.mesh.topology import components, edge_neighbours, open_edges
from pagd.stages import export, geometry, repair
from pagd.tables import TRAJECTORY, read_table

RULES = GeometryRules()
SHORT = replace(TABLE2_MIXED, N=4)
# Settings of the model, mm.
WALL, PEG, PLAY = 6.0, 3.0, 0.4


@pytest.fixture(scope="module")
def design(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A design that was drawn and never meshed."""
    folder = tmp_path_factory.mktemp("designs") / "short"
    named = NamedDesign(name="short", origin="own", design=SHORT)
    geometry.run(named, folder / "geometry", load(None))
    repair.run(folder / "geometry", folder / "repair", load(None))
    return folder


@pytest.fixture(scope="module")
def exported(design: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the stage leaves of it."""
    out = tmp_path_factory.mktemp("exported") / "short"
    record = export.run(design, out, load(None))
    assert (record.status, record.figures["left_out"]) == (Status.ok, {})
    return out


def of_cylinders(diameter: float, length: float) -> float:
    """Volume of four of them, which have 48 sides."""
    return 4 * length * 48 / 2 * (diameter / 2) ** 2 * float(np.sin(2 * np.pi / 48))


def solids_in(path: Path) -> list[tuple[float, int]]:
    """Volume and number of faces of the solids in a STEP file, as OpenCASCADE reads it."""
    with gmsh_session() as gmsh:
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        return [
            (gmsh.model.occ.getMass(3, tag), len(gmsh.model.getBoundary([(3, tag)])))
            for _, tag in gmsh.model.getEntities(3)
        ]


def test_solids_have_plane_faces_and_their_exact_volumes(exported: Path) -> None:
    (body, faces), (base, sides) = solids_in(exported / "solids.step")
    assert body == pytest.approx(body_volume(SHORT, RULES), rel=1e-6)
    assert base == pytest.approx(base_volume(SHORT), rel=1e-6)
    assert sides == 6
    # Not the hundreds of triangles of the surface.
    triangles = len(read_stl(exported / "body.stl").triangles)
    assert faces < triangles / 3


def test_the_same_solids_give_the_same_file(exported: Path, tmp_path: Path) -> None:
    surfaces = [read_stl(exported / f"{part}.stl") for part in ("body", "base")]
    write_step(surfaces, tmp_path / "again.step")
    assert (tmp_path / "again.step").read_bytes() == (exported / "solids.step").read_bytes()
    assert b"FILE_NAME('Open CASCADE Shape Model',''," in (exported / "solids.step").read_bytes()


def test_what_does_not_close_is_no_solid(exported: Path, tmp_path: Path) -> None:
    whole = read_stl(exported / "base.stl")
    with pytest.raises(StageFailure, match="is not closed"):
        write_step([Surface(whole.points, whole.triangles[:-1])], tmp_path / "open.step")
    assert not list(tmp_path.iterdir())


def test_writing_solids_says_nothing(exported: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_step([read_stl(exported / "base.stl")], exported.parent / "silent.step")
    assert capfd.readouterr().out == ""


def test_moulds_leave_what_is_cast(exported: Path) -> None:
    outside, core, tray = (
        read_stl(exported / f"mould_{part}.stl") for part in ("outside", "core", "base")
    )
    for surface in (outside, core, tray):
        assert len(open_edges(surface.triangles)) == 0
        pairs = edge_neighbours(surface.triangles, np.zeros(len(surface.triangles), dtype=int))
        assert components(pairs, len(surface.triangles)).max() == 0  # in one piece
    area = (SHORT.L_T + 2 * WALL) * (SHORT.W + 2 * WALL)
    cavity = cavity_volume(SHORT, RULES)
    # The chambers above the base, with the air in them.
    chambers = body_volume(SHORT, RULES) + cavity - SHORT.L_T * SHORT.W * SHORT.t_b / 2
    holes, pegs = of_cylinders(PEG + PLAY, WALL), of_cylinders(PEG, WALL - 1)
    assert outside.volume() == pytest.approx(area * (SHORT.H + WALL) - chambers - holes, rel=1e-5)
    assert core.volume() == pytest.approx(area * WALL + cavity + pegs, rel=1e-5)
    base = 2 * base_volume(SHORT)
    assert tray.volume() == pytest.approx(area * (SHORT.t_b + WALL) - base, rel=1e-5)


def test_core_and_outer_mould_meet_at_the_rim(exported: Path) -> None:
    outside, core = (read_stl(exported / f"mould_{part}.stl") for part in ("outside", "core"))
    assert outside.points[:, 2].min() == core.points[core.points[:, 2] <= 0][:, 2].max() == 0.0
    # Pegs end before their holes do, and what leaves the air before the roof of the chambers.
    assert core.points[:, 2].max() == pytest.approx(SHORT.H - SHORT.t_h)
    assert core.points[:, 2].max() > WALL - 1


@pytest.mark.parametrize("slant", [0.0, 1.0])
def test_solids_of_straight_and_slanted_rows(slant: float, tmp_path: Path) -> None:
    row: Design = replace(SHORT, alpha=slant, theta=27.2 * slant, N=3)
    for part in ("body", "base"):
        render(row, RULES, part, tmp_path / f"{part}.stl")
    volumes = write_step(
        [read_stl(tmp_path / f"{part}.stl") for part in ("body", "base")], tmp_path / "row.step"
    )
    assert volumes == pytest.approx([body_volume(row, RULES), base_volume(row)], rel=1e-6)


def test_the_model_lists_its_parts(tmp_path: Path) -> None:
    write_design_scad(SHORT, RULES, tmp_path / "design.scad")
    moulds = ("mould_outside", "mould_core", "mould_base")
    assert parts_of_model(tmp_path / "design.scad") == (
        "assembly",
        "body",
        "base",
        "cavity",
        *moulds,
    )
    (tmp_path / "own.scad").write_text("cube(1);\n")
    assert parts_of_model(tmp_path / "own.scad") == ()


def test_a_model_without_moulds_gives_none(design: Path, tmp_path: Path) -> None:
    copy = tmp_path / "older"
    for stage in ("geometry", "repair"):
        (copy / stage).mkdir(parents=True)
        for file in (design / stage).iterdir():
            (copy / stage / file.name).write_bytes(file.read_bytes())
    model = copy / "geometry" / "design.scad"
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace(", mould_outside, mould_core, mould_base]", "]"))
    record = export.run(copy, tmp_path / "out", load(None))
    assert record.figures["files"] == ["base.stl", "body.stl", "design.scad", "solids.step"]


def test_a_file_that_cannot_be_made_is_told_and_the_others_are_there(
    design: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(surfaces: list[Surface], path: Path) -> Facets:
        raise StageFailure(Status.invalid_geometry, "No solid.")

    monkeypatch.setattr(export, "write_step", refuse)
    record = export.run(design, tmp_path / "out", load(None))
    assert record.status is Status.ok
    assert record.figures["left_out"] == {"solids.step": "No solid."}
    assert "mould_core.stl" in record.figures["files"]
    card = (tmp_path / "out" / "card.js").read_text(encoding="utf-8")
    assert "mould_core.stl" in card
    assert "solids.step" not in card


def test_results_come_as_tables_and_for_paraview(tmp_path: Path) -> None:
    folder = solved(tmp_path / "done")
    record = export.run(folder, tmp_path / "out", load(None))
    wanted = ["blocked_force.csv", "free_actuation.csv", "last_state.vtu", "trajectory.csv"]
    assert record.figures["files"] == wanted
    table = read_table(folder / "metrics" / "trajectory.parquet")
    with (tmp_path / "out" / "trajectory.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == [column.name for column in TRAJECTORY]
    last = [float(row["z_mm"]) for row in rows]
    np.testing.assert_allclose(last, table["z_mm"], rtol=1e-8)
    grid = pyvista.read(tmp_path / "out" / "last_state.vtu")
    states = read_table(folder / "solve" / "states.parquet")
    at_last = states["pressure_kPa"] == states["pressure_kPa"][-1]
    np.testing.assert_allclose(grid.point_data["displacement"][:, 2], states["uz"][at_last])


def test_a_failed_design_has_a_card_and_says_why(tmp_path: Path) -> None:
    thin = NamedDesign(name="thin", origin="own", design=replace(SHORT, t=0.1))
    geometry.run(thin, tmp_path / "thin" / "geometry", load(None))
    record = export.run(tmp_path / "thin", tmp_path / "out", load(None))
    assert record.status is Status.invalid_geometry
    text = (tmp_path / "out" / "card.js").read_text(encoding="utf-8")
    content = json.loads(text.removeprefix("takeCard(").removesuffix(");\n"))
    assert "t = 0.1: the side walls" in content["markup"]


def test_a_folder_of_nothing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"holds no folder of a stage"):
        export.run(tmp_path, tmp_path / "out", load(None))
    assert not (tmp_path / "out").exists()
