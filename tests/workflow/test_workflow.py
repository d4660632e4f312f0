"""The workflow from the outside: what it would do, what it leaves, what it runs again."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from pagd.record import read_record
from pagd.tables import read_rows, units

from .conftest import HEAD, ROOT, SETTINGS, SLANTED, STRAIGHT, THIN, Project, undeclared_tables

STAGES = ("geometry", "repair", "mesh", "solve", "metrics", "figures")
DESIGN_RULES = ("prepare", "solve", "metrics", "figures")
GATHERED = {
    "summary/performance.parquet",
    "summary/by_pressure.parquet",
    "summary/chambers.parquet",
    "summary/trajectories.parquet",
    "summary/summary.csv",
    "figures/together",
    "figures/simulated",
    "report/index.html",
    "ro-crate-metadata.json",
    "provenance",
}


GENERATIVE_RULES = ("dataset", "embedding", "generate", "diversity", "diversity_table", "select")
KNOWN = [ROOT / "config" / f"{name}.csv" for name in ("table2", "published_designs")]


def of_design(name: str, stages: tuple[str, ...] = STAGES) -> set[str]:
    """What stages of a design leave, and its files beside the page, which are made of any."""
    return {f"designs/{name}/{stage}" for stage in stages} | {f"report/designs/{name}"}


def said(answer: subprocess.CompletedProcess[str]) -> str:
    """Return all output: a dry run speaks on stdout, a run on stderr."""
    return answer.stdout + answer.stderr


def pagd(folder: Path, *arguments: object) -> int:
    """Run the command line in a folder and return its exit code."""
    command = [sys.executable, "-m", "pagd", *map(str, arguments)]
    return subprocess.run(command, cwd=folder, check=False).returncode


@pytest.fixture
def changed(finished: Project) -> Iterator[Project]:
    """The finished project; its configuration is put back after the test."""
    before = {path: path.read_text() for path in (finished.folder / "config").iterdir()}
    yield finished
    for path, text in before.items():
        path.write_text(text)


def test_every_design_leaves_every_record(finished: Project) -> None:
    for name in ("straight", "slanted", "thin"):
        for stage in STAGES:
            record = read_record(finished / f"designs/{name}/{stage}")
            assert (record.design_id, record.stage) == (name, stage)
            assert record.status == ("invalid_geometry" if name == "thin" else "ok")
            assert (finished / f"logs/{stage}/{name}.log").is_file()
        for rule in DESIGN_RULES:
            assert (finished / f"benchmarks/{rule}/{name}.tsv").is_file()


def test_the_summary_holds_failed_designs_too(finished: Project) -> None:
    path = finished / "summary/performance.parquet"
    rows = {row["design_id"]: row for row in read_rows(path)}
    assert list(rows) == ["straight", "slanted", "thin"]
    assert rows["thin"]["status"] == "invalid_geometry"
    assert "t = 0.2" in rows["thin"]["reason"]
    assert "t_ab = 0.2" in rows["thin"]["reason"]
    assert rows["thin"]["bending_deg"] is None
    for name in ("straight", "slanted"):
        row = rows[name]
        assert (row["status"], row["reason"], row["origin"]) == ("ok", None, "own")
        assert row["pressure_kPa"] == 4.0
        assert row["bending_deg"] > 0.01
        assert row["tip_z_mm"] < 0
        assert row["energy_balance"] < 0.01
        assert row["wall_s"] > 0
        assert row["blocked_force_N"] > 0
        assert row["blocked_force_pressure_kPa"] == 4.0
        assert (row["blocked_force_variant"], row["blocked_force_status"]) == ("edge", "ok")
        # So little pressure brings no chambers together.
        assert row["first_contact_pressure_kPa"] is None
        assert row["deepest_penetration_mm"] == 0.0
        assert row["limit_points"] == 0
        assert row["strain_rate_per_kPa"] == pytest.approx(row["strain_p99"] / 4.0, rel=0.05)
        assert row["strain_rate_per_s"] is None
    assert abs(rows["slanted"]["twist_deg"]) > 10 * abs(rows["straight"]["twist_deg"])
    assert units(path)["work_density_kJ_m3"] == "kJ/m³"


def test_trajectories_hold_every_station_at_every_pressure(finished: Project) -> None:
    rows = read_rows(finished / "summary/trajectories.parquet")
    found = {(row["design_id"], row["pressure_kPa"], row["station"]) for row in rows}
    assert found == {
        (name, pressure, station)
        for name in ("straight", "slanted")
        for pressure in (0.0, 2.0, 4.0)
        for station in range(3)
    }


def test_every_pressure_and_chamber_of_all_designs(finished: Project) -> None:
    rows = read_rows(finished / "summary/by_pressure.parquet")
    found = [(row["design_id"], row["pressure_kPa"]) for row in rows]
    assert found == [(name, p) for name in ("straight", "slanted") for p in (0.0, 2.0, 4.0)]
    assert all(row["blocked_force_N"] > 0 for row in rows if row["pressure_kPa"] > 0)
    assert all(row["smallest_gap_mm"] > 1.5 for row in rows)
    chambers = read_rows(finished / "summary/chambers.parquet")
    assert [row["chamber"] for row in chambers] == [1, 2] * len(rows)
    assert {(row["design_id"], row["kind"]) for row in chambers} == {
        ("straight", "straight"), ("slanted", "helical")
    }  # fmt: skip
    for whole, *both in zip(rows, chambers[::2], chambers[1::2], strict=True):
        for angle in ("bending_deg", "twist_deg"):
            assert sum(row[angle] for row in both) == pytest.approx(whole[angle], abs=1e-9)


def test_every_table_has_the_columns_of_the_data_dictionary(finished: Project) -> None:
    assert undeclared_tables(finished / "") == []


def test_without_a_selection_there_is_no_generative_half(finished: Project) -> None:
    assert {path.name for path in (finished / "").iterdir()} == {
        "benchmarks", "designs", "figures", "logs", "provenance", "report",
        "ro-crate-metadata.json", "summary"
    }  # fmt: skip
    answer = finished.snakemake("--dry-run", "--forceall")
    assert not re.search(rf"^({'|'.join(GENERATIVE_RULES)}) ", said(answer), re.MULTILINE)
    rows = read_rows(finished / "summary/performance.parquet")
    assert {row["novelty"] for row in rows} == {None}


def test_a_straight_design_is_solved_as_a_half(finished: Project) -> None:
    volumes = {
        name: (
            read_record(finished / f"designs/{name}/geometry").figures["solid_volume_mm3"],
            read_record(finished / f"designs/{name}/solve").figures["solid_volume_mm3"],
        )
        for name in ("straight", "slanted")
    }
    for exact, solved in volumes.values():
        assert solved == pytest.approx(exact, rel=1e-4)
    assert (finished / "designs/straight/repair/body_half.stl").is_file()
    assert not (finished / "designs/slanted/repair/body_half.stl").exists()


def test_pictures_and_page(finished: Project) -> None:
    for name in ("straight", "slanted"):
        figures = {path.stem: path for path in (finished / f"designs/{name}/figures").glob("*.png")}
        assert set(figures) == {
            "geometry",
            "mesh",
            "deformed",
            "pressure_volume",
            "contact",
            "blocked_force",
        }
        assert all(path.read_bytes().startswith(b"\x89PNG") for path in figures.values())
    assert {path.name for path in (finished / "figures/together").glob("*.png")} == {
        "angles.png",
        "forces.png",
        "gallery.png",
        "trajectories.png",
    }
    page = (finished / "report/index.html").read_text()
    assert "straight" in page
    assert "t = 0.2" in page


def test_the_report_has_captions(finished: Project) -> None:
    answer = finished.snakemake("--report", "report.zip")
    assert answer.returncode == 0, answer.stderr
    shutil.unpack_archive(finished.folder / "report.zip", finished.folder / "unpacked")
    text = "".join(
        path.read_text(errors="replace")
        for path in (finished.folder / "unpacked").rglob("*")
        if path.suffix in (".html", ".js")
    )
    for caption in ("One row a design", "cut open, with its dimensions", "under rising pressure"):
        assert caption in text


def test_a_second_run_does_nothing(finished: Project) -> None:
    assert finished.pending() == set()
    answer = finished.snakemake()
    assert answer.returncode == 0
    assert "Nothing to be done" in said(answer)


def test_a_changed_parameter_runs_that_design_only(changed: Project) -> None:
    changed.write(STRAIGHT, SLANTED.replace(",20,1", ",25,1"), THIN)
    assert changed.pending() == of_design("slanted") | GATHERED


def test_another_order_or_a_new_design_runs_no_other(changed: Project) -> None:
    changed.write(SLANTED, THIN, STRAIGHT, STRAIGHT.replace("straight", "new"))
    assert changed.pending() == of_design("new") | GATHERED


def test_designs_of_another_family_join_and_run_no_other(changed: Project) -> None:
    """In one table, in which rows leave empty what their family does not have."""
    rows = [HEAD.replace("name,", "name,family,") + ",q,w,R,L_c,L_r,t_e,b_f"]
    rows += [row.replace(",", ",,", 1) + 7 * "," for row in (STRAIGHT, SLANTED, THIN)]
    rows += ["bellows,half_bellows,,,,2,,,,3,2,,,11,4,7,5,2,2,1"]
    table = changed.folder / "config" / "designs.csv"
    table.write_text("\n".join([*rows, ""]))
    assert changed.pending() == of_design("bellows") | GATHERED
    # And without any pneu-net beside them.
    table.write_text("\n".join([rows[0], rows[-1], ""]))
    answer = changed.snakemake("--dry-run")
    assert answer.returncode == 0, said(answer)
    assert re.search(r"^prepare +1$", said(answer), re.MULTILINE)


def test_another_family_has_no_place_among_known_designs(changed: Project) -> None:
    config, known = changed.folder / "config", "name,family,N,q,w,R,L_c,L_r,t,t_e,t_b,b_f"
    (config / "known.csv").write_text(f"{known}\nbellows,half_bellows,2,11,4,7,5,2,2,2,3,1\n")
    changed.write(STRAIGHT, dataset={"known": {"own": "config/known.csv"}})
    answer = changed.snakemake("--dry-run")
    assert answer.returncode != 0
    assert "design bellows: family = 'half_bellows' must be pneunet here" in said(answer)


def test_a_changed_picture_runs_pictures_only(changed: Project) -> None:
    changed.write(STRAIGHT, SLANTED, THIN, figures={"resolution_dpi": 70})
    drawn = {p for name in ("straight", "slanted", "thin") for p in of_design(name, ("figures",))}
    pictures = {"figures/together", "figures/simulated", "report/index.html"}
    told = {"ro-crate-metadata.json", "provenance"}
    assert changed.pending() == drawn | pictures | told


def test_a_changed_material_runs_from_the_solve_on(changed: Project) -> None:
    path = changed.folder / "config" / "materials.yaml"
    path.write_text(path.read_text().replace("C10: 0.11,", "C10: 0.12,"))
    later = ("solve", "metrics", "figures")
    expected = {p for name in ("straight", "slanted", "thin") for p in of_design(name, later)}
    assert changed.pending() == expected | GATHERED


def test_a_better_citation_runs_nothing(changed: Project) -> None:
    path = changed.folder / "config" / "materials.yaml"
    path.write_text(re.sub("source: .*", "source: somewhere else", path.read_text()))
    assert changed.pending() == set()


def test_a_changed_mesh_runs_from_the_geometry_on(changed: Project) -> None:
    """Geometry, repair and mesh are one job."""
    changed.write(STRAIGHT, SLANTED, THIN, mesh={"size_mm": 5.5})
    expected = {p for name in ("straight", "slanted", "thin") for p in of_design(name)}
    assert changed.pending() == expected | GATHERED


def test_a_mesher_out_of_time_is_recorded(project: Project) -> None:
    project.write(STRAIGHT, THIN, mesh={"time_limit_s": 0.001, "meshers": ["gmsh"]})
    answer = project.snakemake()
    assert answer.returncode == 0, answer.stderr
    rows = {row["name"]: row for row in read_rows(project / "summary/performance.parquet")}
    assert rows["straight"]["status"] == "mesh_failed"
    assert "0.001 s" in rows["straight"]["reason"]
    assert rows["thin"]["status"] == "invalid_geometry"
    assert rows["straight"]["mode"] == "bending"
    assert (project / "report/index.html").is_file()


def test_a_crash_is_not_hidden_and_leaves_nothing(project: Project) -> None:
    project.write(STRAIGHT, THIN)
    broken = project.folder / "openscad"
    broken.write_text("#!/bin/sh\necho out of order >&2\nexit 127\n")
    broken.chmod(0o755)
    path = f"{project.folder}:{os.environ['PATH']}"
    answer = project.snakemake(env=os.environ | {"PATH": path})
    assert answer.returncode != 0
    assert not (project / "designs/straight").exists()
    assert "out of order" in (project / "logs/geometry/straight.log").read_text()
    assert read_record(project / "designs/thin/figures").status == "invalid_geometry"
    # What is done is summed up all the same.
    rows = read_rows(project / "summary/performance.parquet")
    assert [(row["design_id"], row["status"]) for row in rows] == [("thin", "invalid_geometry")]

    # Those tables count as older than any design: without the one that failed, they are made again.
    project.write(THIN)
    answer = project.snakemake("--dry-run", "--", "summary")
    assert re.search(r"^summary_tables +1$", said(answer), re.MULTILINE), said(answer)


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        ({"mesh": {"size_mm": -1}}, "mesh.size_mm = -1 must be greater than 0."),
        ({"solv": {}}, "solv is not a known key (did you mean solve?)."),
        ({"material": "jelly"}, "material is 'jelly', but must be one of "),
        ({"designs": {"own": "config/absent.csv"}}, "table of designs config/absent.csv: cannot"),
        ({"dataset": {"size": 99}}, "plane_designs = 1000 must be at most dataset.size = 99."),
        ({"generator": {"components": "few"}}, "= 'few' must be a whole number or bic."),
    ],
)
def test_a_bad_configuration_is_told_in_one_sentence(
    project: Project, fault: dict[str, object], sentence: str
) -> None:
    project.write(STRAIGHT)
    path = project.folder / "config" / "config.yaml"
    path.write_text(yaml.safe_dump(yaml.safe_load(path.read_text()) | fault))
    answer = project.snakemake("--dry-run")
    assert answer.returncode != 0
    assert sentence in said(answer)
    assert "Traceback" not in said(answer)


def test_a_bad_table_is_told_by_row(project: Project) -> None:
    project.write(STRAIGHT, STRAIGHT)
    answer = project.snakemake("--dry-run")
    assert answer.returncode != 0
    assert "config/designs.csv, row 3: name = 'straight' must be unique" in said(answer)


def test_dry_run_of_the_repository(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "config", tmp_path / "config")
    answer = Project(tmp_path).snakemake("--dry-run")
    assert answer.returncode == 0, answer.stderr
    counts = dict(re.findall(r"^(\w+) +(\d+)$", said(answer), re.MULTILINE))
    # Known designs are there at once; generated ones join when they are selected.
    known = sum(len(path.read_text().splitlines()) - 1 for path in KNOWN)
    expected = dict.fromkeys(DESIGN_RULES[:-1], str(known)) | dict.fromkeys(GENERATIVE_RULES, "1")
    assert {rule: counts[rule] for rule in expected} == expected
    assert list(tmp_path.glob("results/*")) == []


def test_lint() -> None:
    command = [sys.executable, str(ROOT / ".ci" / "lint_workflow.py")]
    answer = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, said(answer)


@pytest.mark.parametrize("file", sorted((ROOT / "workflow" / "rules").glob("*.smk")), ids=str)
def test_every_rule_says_what_it_does_and_needs(file: Path) -> None:
    rules = re.split(r"^(?:rule|checkpoint) (\w+):\n", file.read_text(), flags=re.MULTILINE)[1:]
    for name, body in zip(rules[::2], rules[1::2], strict=True):
        if "output:" not in body:  # a target
            continue
        for directive in ("log:", "benchmark:", "message:", "resources:"):
            assert directive in body, f"{name} lacks {directive}"
        assert re.search(r"\bversions?=.*STAGE_VERSIONS", body), f"{name} lacks its version"
        assert not re.search(r"\b(run|lambda)\b.*:", body), name
        commands = re.search(r"shell:\n((?: +\".*\"\n)+)", body)
        for value in re.findall(r"{[^}]+}", commands[1] if commands else ""):
            number = value == "{threads}" or value.startswith("{resources.")
            assert value.endswith(":q}") or number, f"{name}: {value} is not quoted"


def test_a_mesh_of_ones_own_is_solved_alike(finished: Project, tmp_path: Path) -> None:
    """The chain's mesh, taken as anybody's .msh file, gives the chain's result."""
    mesh = finished / "designs/straight/mesh/mesh.msh"
    config = ("--config", finished.folder / "config" / "config.yaml")
    own_mesh = ("--mesh", mesh, *config)
    assert pagd(tmp_path, "solve", *own_mesh, "--out", "solve", "--vtu", "--name", "mine") == 0
    metrics = ("metrics", *own_mesh, "--solve", "solve", "--sections", 3, "--out", "metrics")
    assert pagd(tmp_path, *metrics) == 0
    own = read_record(tmp_path / "metrics")
    chain = read_record(finished / "designs/straight/metrics")
    assert own.design_id == "mine"
    for figure in ("tip_x_mm", "tip_z_mm", "work_mJ", "stored_energy_mJ", "strain_p99"):
        assert own.figures[figure] == pytest.approx(chain.figures[figure], rel=1e-6)
    assert len(list((tmp_path / "solve" / "vtu").glob("*.vtu"))) == 3


def test_another_mesh_than_the_solved_one_is_refused(
    finished: Project, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    solved, other = (finished / f"designs/{name}" for name in ("straight", "slanted"))
    folders = ("--mesh", other / "mesh", "--solve", solved / "solve")
    assert pagd(tmp_path, "metrics", *folders, "--out", "metrics") == 2
    told = capfd.readouterr().err
    assert re.search(r"^pagd: mesh = .* must be the mesh that was solved in .*\.$", told)
    assert list(tmp_path.iterdir()) == []


def test_a_pair_of_surfaces_is_meshed_alike(finished: Project, tmp_path: Path) -> None:
    design = finished / "designs/slanted"
    folders = ("--geometry", design / "geometry", "--repair", design / "repair")
    pair = ("--body", design / "repair/body.stl", "--base", design / "repair/base.stl")
    settings = ("--size-mm", 6, "--meshers", "gmsh")
    assert pagd(tmp_path, "mesh", *folders, *settings, "--out", "chain") == 0
    assert pagd(tmp_path, "mesh", *pair, *settings, "--out", "mesh") == 0
    own, chain = read_record(tmp_path / "mesh"), read_record(tmp_path / "chain")
    assert own.design_id == "body"
    assert own.figures["tets"] == chain.figures["tets"]
    assert own.figures["volume_mm3"] == pytest.approx(chain.figures["volume_mm3"])


def test_a_run_that_ends_early_is_measured_as_far_as_it_came(
    finished: Project, tmp_path: Path
) -> None:
    design = finished / "designs/straight"
    half_way = read_rows(design / "metrics/performance.parquet")[1]
    # Beyond the bending at 2 kPa, short of that at 4 kPa.
    limit = 1.3 * half_way["bending_deg"]
    settings = SETTINGS["solve"] | {"bending_limit_deg": limit}
    config = ("--config", json.dumps({"solve": settings, "metrics": SETTINGS["metrics"]}))
    before = ("--geometry", design / "geometry", "--mesh", design / "mesh")
    assert pagd(tmp_path, "solve", *before[2:], *config, "--out", "solve") == 1
    assert pagd(tmp_path, "metrics", *before, "--solve", "solve", *config, "--out", "metrics") == 1
    record = read_record(tmp_path / "metrics")
    assert record.status == "bending_limit"
    assert "it bends by" in str(record.reason)
    # The state at which it ended is the last one measured.
    assert 2.0 < record.figures["pressure_kPa"] <= 4.0
    assert record.figures["bending_deg"] > limit
    reached = read_rows(tmp_path / "metrics/performance.parquet")
    assert [row["pressure_kPa"] for row in reached[:-1]] == [0.0, 2.0]
    assert reached[1]["bending_deg"] == pytest.approx(half_way["bending_deg"], rel=1e-3)


def test_an_actuator_that_hardly_moves_is_recorded(finished: Project, tmp_path: Path) -> None:
    design = finished / "designs/straight"
    folders = [word for s in ("geometry", "mesh", "solve") for word in (f"--{s}", design / s)]
    assert pagd(tmp_path, "metrics", *folders, "--out", "metrics") == 1
    record = read_record(tmp_path / "metrics")
    assert record.status == "no_actuation"
    assert "both less than 5°" in str(record.reason)
    assert record.figures["tets"] > 0
