"""The data set that a run leaves, and what its checks find in it."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from datetime import date
from pathlib import Path
from unittest.mock import Mock

import mlcroissant as mlc
import pandas as pd
import pytest
import yaml
from datacite import schema45

from pagd.archive.checks import CHECKS, check_tables
from pagd.archive.collecting import collected
from pagd.archive.packing import pack, unpacked
from pagd.archive.pictures import sample_of
from pagd.archive.reading import read_tables
from pagd.archive.splits import SPLITS, split_of
from pagd.archive.tables import TABLES
from pagd.archive.validating import faults_of_provenance
from pagd.archive.writing import differing, write_archive
from pagd.catalogue import read_designs
from pagd.cli import main
from pagd.design import identity
from pagd.errors import InputError
from pagd.machine import machine_class
from pagd.record import configuration_hash, read_record
from pagd.stages.geometry import read_design
from pagd.tables import read_rows

from .conftest import GENERATIVE, STRAIGHT, Project

#: Fewer generated designs than elsewhere.
FEWER = {
    "generator": {"designs": 12, "largest_components": 3},
    "diversity": GENERATIVE["diversity"] | {"hull_designs": 10},
}
PUBLISHED = date(2026, 1, 31)
#: So few training designs are screened in the project.
INCOMPLETE = "every training design has its result by a chamber"


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """A run without pictures and without the comparison of generators."""
    project = Project(tmp_path_factory.mktemp("simulated"))
    project.write(STRAIGHT, **GENERATIVE | FEWER)
    tables = ("screening/training", "screening/generated", "summary/performance.parquet")
    answer = project.snakemake("--", *(f"results/{table}" for table in tables))
    assert answer.returncode == 0, answer.stderr
    return project


@pytest.fixture(scope="module")
def archive(simulated: Project, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The data set of a run."""
    out = tmp_path_factory.mktemp("archive") / "set"
    found = write_archive(simulated / "", out, published=PUBLISHED, pictures=2)
    assert [(f.rule, f.broken) for f in found if f.broken] == [(INCOMPLETE, 290)]
    return out


@pytest.fixture(scope="module")
def frames(archive: Path) -> dict[str, pd.DataFrame]:
    """Its tables."""
    return read_tables(archive)


def test_designs_of_other_families_are_left_out_and_told(
    simulated: Project, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    design = {"family": "half_bellows", "N": 2, "q": 11, "w": 4, "R": 7, "L_c": 5, "L_r": 2}
    design |= {"name": "bellows", "t": 2, "t_e": 2, "t_b": 3, "b_f": 1}
    for stage, name, text in (
        ("geometry", "design.json", json.dumps(design)),
        ("metrics", "record.json", "is not read"),
    ):
        (tmp_path / "bellows" / stage).mkdir(parents=True)
        (tmp_path / "bellows" / stage / name).write_text(text)
    found = collected(simulated / "", [tmp_path])
    assert list(found.folders.values()) == list(collected(simulated / "").folders.values())
    assert f"{tmp_path / 'bellows'}: left out, as a half_bellows" in caplog.text


def test_every_design_is_there_with_every_analysis(
    simulated: Project, frames: dict[str, pd.DataFrame]
) -> None:
    designs = frames["designs"].set_index("id")
    assert designs["set"].value_counts().to_dict() == {"training": 300, "generated": 12, "other": 1}
    performance = frames["performance"]
    rows = read_rows(simulated / "summary/performance.parquet")
    full = performance[performance["fidelity"] == "full"].set_index("design_id")
    assert set(full.index) == {row["design_id"] for row in rows}
    for row in rows:
        assert full.loc[row["design_id"], "bending_deg"] == row["bending_deg"]
    # A generated design that was simulated has both of its results under one id.
    both = performance.groupby("id")["fidelity"].agg(set)
    assert sum(found == {"cells", "full"} for found in both) == 3
    assert (performance["fidelity"] == "cells").sum() == 12 + 10


def test_ids_are_those_of_the_parameters_and_tell_the_split(
    simulated: Project, frames: dict[str, pd.DataFrame]
) -> None:
    designs = frames["designs"].set_index("design_id")
    table = read_designs({"generated": str(simulated / "generated/designs.parquet")})
    for name, named in table.items():
        assert designs.loc[name, "id"] == identity(named.design)
    for frame in frames.values():
        assert (frame["id"].map(split_of) == frame["split"]).all()


def folders_of_designs(simulated: Project) -> dict[str, Path]:
    """Folders of the simulated designs by id."""
    found = (simulated / "designs").iterdir()
    return {identity(read_design(folder / "geometry").design): folder for folder in found}


def test_checksums_tell_what_has_changed(simulated: Project, archive: Path) -> None:
    assert differing(archive) == []
    names = [line.split("  ")[1] for line in (archive / "SHA256SUMS").read_text().splitlines()]
    drawn = sample_of(folders_of_designs(simulated), 2)
    assert len(drawn) == 2
    assert set(names) == {
        "CHECKS.md", "COLUMNS.md", "README.md", "croissant.json", "datacite.json",
        "provenance.json", *(f"pictures/{one}.png" for one in ("sample", *drawn)),
        *(f"data/{table}/{split}.parquet" for table in TABLES for split in SPLITS)
    }  # fmt: skip


def test_the_same_run_gives_the_same_bytes(
    simulated: Project, archive: Path, tmp_path: Path
) -> None:
    write_archive(simulated / "", tmp_path / "again", published=PUBLISHED, pictures=2)
    again = (tmp_path / "again" / "SHA256SUMS").read_text()
    assert again == (archive / "SHA256SUMS").read_text()
    pack(archive, tmp_path / "one.zip")
    pack(tmp_path / "again", tmp_path / "two.zip")
    assert (tmp_path / "one.zip").read_bytes() == (tmp_path / "two.zip").read_bytes()


def test_the_file_of_a_data_set_holds_all_of_it(archive: Path, tmp_path: Path) -> None:
    pack(archive, tmp_path / "set.zip")
    with unpacked(tmp_path / "set.zip") as folder:
        assert folder.name == "pagd-pneu-nets-2026.1.31"
        assert differing(folder) == []
        assert (folder / "SHA256SUMS").read_bytes() == (archive / "SHA256SUMS").read_bytes()


def without_checksums(archive: Path, path: Path) -> None:
    with zipfile.ZipFile(path, "w") as packed:
        packed.writestr("some/file", "text")


def with_two_folders(archive: Path, path: Path) -> None:
    with zipfile.ZipFile(path, "w") as packed:
        packed.writestr("one/file", "text")
        packed.writestr("two/file", "text")


def with_a_changed_byte(archive: Path, path: Path) -> None:
    pack(archive, path)
    content = bytearray(path.read_bytes())
    content[200] ^= 0xFF
    path.write_bytes(content)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda archive, path: path.write_text("nothing"), "nor a ZIP file of one"),
        (lambda archive, path: None, "there is no such file"),
        (with_a_changed_byte, "nor a ZIP file of one"),
        (with_two_folders, "holds one folder, and no more"),
        (without_checksums, "SHA256SUMS: there is no such file"),
    ],
)
def test_files_that_are_no_data_set_are_told(
    archive: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    make: Callable[[Path, Path], object],
    words: str,
) -> None:
    make(archive, tmp_path / "some.zip")
    assert main(["check-archive", str(tmp_path / "some.zip")]) == 2
    told = capsys.readouterr().err
    assert words in told
    assert len(told.splitlines()) == 1


def test_a_file_larger_than_the_disk_is_not_unpacked(
    archive: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pack(archive, tmp_path / "set.zip")
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: Mock(free=1000))
    with pytest.raises(InputError, match="MB that are free"), unpacked(tmp_path / "set.zip"):
        pass


def test_a_damaged_data_set_is_not_looked_at_further(
    archive: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(archive, copy)
    (copy / "data/designs/train.parquet").write_bytes(b"PAR1")
    (copy / "more").write_text("of somebody else")
    assert main(["check-archive", str(copy)]) == 1
    told = capsys.readouterr().out.splitlines()
    assert told == [
        "data/designs/train.parquet is missing, or not what its checksum says.",
        "more is missing, or not what its checksum says.",
        f"{copy} is damaged: what it says is not looked at.",
    ]


@pytest.mark.parametrize(
    ("target", "words"),
    [
        ("folder", "is a folder, not a ZIP file"),
        ("set/all.zip", "must not lie in the data set itself"),
        ("notes.txt", "is there, and no ZIP file; it is not replaced"),
    ],
)
def test_what_the_zip_must_not_be_is_told_before_the_work(
    simulated: Project,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    target: str,
    words: str,
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "notes.txt").write_text("mine")
    command = ["archive", str(simulated / ""), "--out", str(tmp_path / "set")]
    assert main([*command, "--zip", str(tmp_path / target)]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "set").exists()
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_every_analysis_tells_what_made_it(
    simulated: Project, archive: Path, frames: dict[str, pd.DataFrame]
) -> None:
    told = json.loads((archive / "provenance.json").read_text())
    performance = frames["performance"]
    assert set(performance["provenance"]) == set(told)
    keys = performance.groupby("fidelity")["provenance"].agg(set)
    (cells,), (full,) = keys["cells"], keys["full"]
    for stage in ("geometry", "repair", "mesh", "solve", "metrics"):
        record = read_record(simulated / "designs/straight" / stage)
        made_of = {k: v for k, v in record.configuration.items() if k != "design"}
        assert told[full]["configuration"][stage] == made_of
        assert told[full]["versions"][stage] == [record.versions]
    screened = read_record(simulated / "screening/training")
    assert told[cells]["configuration"] == {"screening": screened.configuration}
    assert told[cells]["configuration_sha256"] == configuration_hash(told[cells]["configuration"])
    assert told[cells]["machines"] == told[full]["machines"] == [machine_class()]


def test_an_analysis_without_provenance_is_told(
    archive: Path, frames: dict[str, pd.DataFrame], tmp_path: Path
) -> None:
    assert faults_of_provenance(archive, frames["performance"]) == []
    told = json.loads((archive / "provenance.json").read_text())
    first, second = told
    (tmp_path / "provenance.json").write_text(json.dumps({first: told[second]}))
    assert faults_of_provenance(tmp_path, frames["performance"]) == [
        f"{first} is not the hash of what it names.",
        f"an analysis names {second}, which is not there.",
    ]


def test_the_metadata_of_a_doi_keep_to_their_schema(archive: Path) -> None:
    content = json.loads((archive / "datacite.json").read_text())
    assert list(schema45.validator.iter_errors(content)) == []
    assert content["publicationYear"] == "2026"
    own = ("SHA256SUMS", "datacite.json")
    files = [one for one in archive.rglob("*") if one.is_file() and one.name not in own]
    size = sum(file.stat().st_size for file in files)
    assert content["sizes"] == [f"{size} bytes", f"{len(files)} files"]
    assert content["version"] == "2026.1.31"


def test_designs_simulated_elsewhere_join(simulated: Project, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="Two simulated designs are named"):
        write_archive(simulated / "", tmp_path / "set", [simulated / "designs"])
    assert not (tmp_path / "set").exists()


def test_designs_of_another_material_are_refused(simulated: Project, tmp_path: Path) -> None:
    other = tmp_path / "designs" / "softer"
    shutil.copytree(simulated / "designs/straight", other)
    record = json.loads((other / "solve/record.json").read_text())
    record["configuration"]["material"]["name"] = "jelly"
    record["configuration_sha256"] = configuration_hash(record["configuration"])
    (other / "solve/record.json").write_text(json.dumps(record))
    with pytest.raises(InputError, match="softer: made with another 'material' than"):
        write_archive(simulated / "", tmp_path / "set", [other.parent])


def test_the_command_checks_what_it_has_written(
    archive: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(archive, copy)
    # The designs that are not screened: a rule is broken, and told.
    assert main(["check-archive", str(copy)]) == 1
    told = capsys.readouterr().out
    assert f"{INCOMPLETE}: broken by 290" in told
    assert "14 of 15 rules are kept" in told
    assert "croissant.json" not in told
    (copy / "COLUMNS.md").write_text("nothing")
    content = json.loads((copy / "croissant.json").read_text())
    content["recordSet"][0]["field"][0]["source"]["extract"]["column"] = "nobody"
    (copy / "croissant.json").write_text(json.dumps(content))
    assert main(["check-archive", str(copy)]) == 1
    told = capsys.readouterr().out
    assert "COLUMNS.md is missing, or not what its checksum says." in told
    assert "croissant.json: designs/train does not load what is in the file." in told


def test_the_official_validator_finds_nothing_and_the_records_load(archive: Path) -> None:
    command = [shutil.which("mlcroissant") or "mlcroissant", "validate"]
    answer = subprocess.run(
        [*command, "--jsonld", str(archive / "croissant.json")],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (answer.returncode, "Done." in answer.stderr) == (0, True), answer.stderr
    assert not re.search(r"error|warning", answer.stderr, re.IGNORECASE), answer.stderr
    loaded = mlc.Dataset(str(archive / "croissant.json")).records("designs/test")
    table = pd.read_parquet(archive / "data/designs/test.parquet")
    found = [row["designs/test/L"] for row in loaded]
    assert found == table["L"].tolist()


def test_the_examples_of_the_card_run(archive: Path, tmp_path: Path) -> None:
    text = (archive / "README.md").read_text()
    examples = re.findall(r"```python\n(.+?)```", text, re.DOTALL)
    libraries = {re.search(r"(?:import|from) (\w+)", example)[1] for example in examples}  # type: ignore[index]
    assert libraries == {"pandas", "polars", "datasets", "mlcroissant"}
    home = {"HF_HOME": str(tmp_path), "HF_HUB_OFFLINE": "1"}
    for example in examples:
        subprocess.run(
            [sys.executable, "-c", example], cwd=archive, env=os.environ | home, check=True
        )


def test_the_card_and_the_dictionary_tell_what_is_there(
    archive: Path, frames: dict[str, pd.DataFrame]
) -> None:
    card = (archive / "README.md").read_text()
    head = yaml.safe_load(card.split("---")[1])
    assert {config["config_name"] for config in head["configs"]} == set(TABLES)
    for config in head["configs"]:
        assert all((archive / file["path"]).is_file() for file in config["data_files"])
    assert f"| `trajectories` | {TABLES['trajectories'].row} |" in card
    assert f"{len(frames['trajectories']):,} |" in card
    columns = (archive / "COLUMNS.md").read_text()
    for table in TABLES.values():
        assert all(f"| `{column.name}` | {column.type} |" in columns for column in table.columns)


def set_to(table: str, column: str, value: object) -> Callable[[dict[str, pd.DataFrame]], None]:
    """Change the last row of a table."""

    def change(frames: dict[str, pd.DataFrame]) -> None:
        frame = frames[table]
        frame.loc[frame.index[-1], column] = value

    return change


def repeat(table: str) -> Callable[[dict[str, pd.DataFrame]], None]:
    """Have the last row of a table twice."""

    def change(frames: dict[str, pd.DataFrame]) -> None:
        frame = frames[table]
        frames[table] = pd.concat([frame, frame.tail(1)], ignore_index=True)
        frames[table].attrs = frame.attrs

    return change


def other_unit(frames: dict[str, pd.DataFrame]) -> None:
    frames["performance"].attrs["units"]["work_mJ"] = "J"


#: What breaks each check: a change of the tables, and words of the rule.
BROKEN = {
    "parameter": (set_to("designs", "t", 9.25), "hash of the parameters"),
    "design twice": (repeat("designs"), "every design is there once"),
    "analysis twice": (repeat("performance"), "every analysis is there once"),
    "unknown": (set_to("chambers", "id", "0" * 16), "of a design of the data set"),
    "split": (set_to("designs", "split", "elsewhere"), "in the split of their id"),
    "missing": (set_to("performance", "bending_deg", float("nan")), "no figure is missing"),
    "reason": (set_to("performance", "reason", "For fun."), "there is a reason where"),
    "pressure": (set_to("by_pressure", "pressure_kPa", -1.0), "not negative"),
    "volume": (set_to("by_pressure", "cavity_volume_mm3", 1.0), "the cavity grows"),
    "work": (set_to("by_pressure", "work_mJ", -1.0), "the work of the pressure grows"),
    "balance": (set_to("performance", "energy_balance", 0.5), "stored energy balance"),
    "tip": (set_to("trajectories", "x_mm", 1e3), "is the tip"),
    "chamber": (set_to("chambers", "bending_deg", 90.0), "adds up to that of the tip"),
    "unit": (other_unit, "has its unit"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_every_check_finds_what_it_is_for(name: str, frames: dict[str, pd.DataFrame]) -> None:
    change, words = BROKEN[name]
    changed = {table: frame.copy() for table, frame in frames.items()}
    for frame in changed.values():
        frame.attrs = {"units": dict(frame.attrs["units"])}
    change(changed)
    found = {f.rule: f for f in check_tables(changed)}
    (rule,) = [check.rule for check in CHECKS if words in check.rule]
    assert found[rule].broken > 0
    assert found[rule].first is not None


def test_every_check_can_fail() -> None:
    told = [words for _, words in BROKEN.values()]
    rules = [check.rule for check in CHECKS if check.rule != INCOMPLETE]
    assert all(any(words in rule for words in told) for rule in rules)
