"""What a run says of itself to machines."""

from __future__ import annotations

import json
import shutil
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from rocrate.rocrate import ROCrate
from rocrate_validator import services
from rocrate_validator.models import Severity, ValidationSettings
from rocrate_validator.utils import document_loader

from pagd.machine import machine_class
from pagd.record import configuration_hash, read_record
from pagd.run_crate import write_run_crate

from .conftest import ROOT, STRAIGHT, THIN, Project

#: Checks that ask the network for what the test has at hand.
BY_NETWORK = ["ro-crate-1.1_3.1", "ro-crate-1.1_3.2"]


@pytest.fixture(scope="module")
def described(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """A run without pictures that has described itself; one of its two designs has failed."""
    project = Project(tmp_path_factory.mktemp("described"))
    project.write(STRAIGHT, THIN, figures={"drawn_designs": 0, "resolution_dpi": 60})
    answer = project.snakemake("--", "results/ro-crate-metadata.json")
    assert answer.returncode == 0, answer.stderr
    return project


@pytest.fixture
def offline(monkeypatch: pytest.MonkeyPatch) -> None:
    """The terms of RO-Crate, from a library instead of the network."""
    text = (files("rocrate") / "data" / "ro-crate.jsonld").read_text()
    # Bioschemas has moved since RO-Crate 1.1; the library has the terms of a later version.
    terms = json.loads(text.replace("https://bioschemas.org/terms/", "https://bioschemas.org/"))

    def fetched(url: str) -> Any:
        assert url == "https://w3id.org/ro/crate/1.1/context"
        return terms

    monkeypatch.setattr(document_loader, "_fetch_json_ld", fetched)


def faults(crate: Path) -> list[str]:
    """What the official validator finds that the profile requires."""
    settings = ValidationSettings(
        rocrate_uri=str(crate),
        profile_identifier="workflow-run-crate",
        requirement_severity=Severity.REQUIRED,
        skip_checks=BY_NETWORK,
    )
    return [str(issue.message) for issue in services.validate(settings).get_issues()]


@pytest.mark.usefixtures("offline")
def test_it_is_a_workflow_run_crate_by_the_official_validator(described: Project) -> None:
    assert faults(described / "") == []


@pytest.mark.usefixtures("offline")
@pytest.mark.parametrize("broken", ["instrument", "mainEntity"])
def test_the_validator_finds_what_is_missing(
    described: Project, tmp_path: Path, broken: str
) -> None:
    crate = tmp_path / "crate"
    shutil.copytree(described / "", crate)
    content = json.loads((crate / "ro-crate-metadata.json").read_text())
    for entity in content["@graph"]:
        entity.pop(broken, None)
    (crate / "ro-crate-metadata.json").write_text(json.dumps(content))
    assert faults(crate)


def test_it_tells_what_made_the_run(described: Project) -> None:
    crate = ROCrate(described / "")
    configuration = json.loads((described / "provenance/configuration.json").read_text())
    assert configuration["solve"]["maximum_pressure_kPa"] == 4.0
    assert configuration_hash(configuration) in crate.description
    (action,) = [one for one in crate.get_entities() if one.type == "CreateAction"]
    assert action["instrument"] == crate.mainEntity
    assert machine_class()["processor"] in action["description"]
    assert "ok 1, invalid_geometry 1" in action["description"]
    begun, ended = action["startTime"], action["endTime"]
    assert begun < ended
    software = {one["name"]: one for one in crate.mainEntity["softwareRequirements"]}
    solved = read_record(described / "designs/straight/solve")
    for name in ("numpy", "numba", "pypardiso"):
        assert software[name]["softwareVersion"] == solved.versions[name]


def test_all_that_it_names_is_there(described: Project) -> None:
    crate = ROCrate(described / "")
    named = [one.id for one in crate.data_entities]
    assert {"designs/", "summary/performance.parquet", "report/index.html"} <= set(named)
    assert [name for name in named if not (described / name).exists()] == []
    inputs = {path.name for path in (described / "provenance/inputs").iterdir()}
    assert inputs == {"designs.csv", "materials.yaml"}
    copied = described / "provenance/workflow/rules/design.smk"
    assert copied.read_bytes() == (ROOT / "workflow/rules/design.smk").read_bytes()


def test_tables_of_one_name_are_both_kept(tmp_path: Path) -> None:
    names = ("a/1-designs.csv", "b/designs.csv", "c/designs.csv")
    tables = [tmp_path / name for name in names]
    for table in tables:
        table.parent.mkdir()
        table.write_text(table.parent.name)
    write_run_crate(tmp_path / "results", ROOT, {}, [*tables, tables[0]])
    kept = (tmp_path / "results/provenance/inputs").iterdir()
    assert {path.name: path.read_text() for path in kept} == {
        "1-designs.csv": "a", "designs.csv": "b", "2-designs.csv": "c"
    }  # fmt: skip


def test_designs_of_an_earlier_run_are_not_counted(described: Project, tmp_path: Path) -> None:
    shutil.copytree(described / "", tmp_path / "results")
    earlier = tmp_path / "results/designs/earlier"
    shutil.copytree(tmp_path / "results/designs/straight", earlier)
    write_run_crate(tmp_path / "results", ROOT, {}, [])
    (action,) = [
        one for one in ROCrate(tmp_path / "results").get_entities() if one.type == "CreateAction"
    ]
    assert "ok 1, invalid_geometry 1." in action["description"]


def test_records_without_a_machine_are_described_too(described: Project, tmp_path: Path) -> None:
    shutil.copytree(described / "", tmp_path / "results")
    for path in (tmp_path / "results/designs").rglob("record.json"):
        content = json.loads(path.read_text())
        del content["machine"], content["configuration_sha256"]
        path.write_text(json.dumps(content))
    write_run_crate(tmp_path / "results", ROOT, {}, [])
    text = (tmp_path / "results/ro-crate-metadata.json").read_text()
    assert "Machines: not known." in text
