"""``pagd view`` and ``pagd report``: what is on the page, what is not, what is not made twice."""

from __future__ import annotations

import dataclasses
import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from design_samples import TABLE2_BENDING
from figure_samples import solved

from pagd.catalogue import NamedDesign
from pagd.cli import main
from pagd.config import load
from pagd.errors import InputError
from pagd.figures.page import write_page
from pagd.record import RECORD_NAME, Record, read_record, write_record
from pagd.stages import export, geometry, repair

PNEUNET = NamedDesign(name="own", origin="own", design=replace(TABLE2_BENDING, N=2))


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A design that was drawn and never meshed."""
    folder = tmp_path_factory.mktemp("designs") / "drawn"
    geometry.run(PNEUNET, folder / "geometry", load(None))
    repair.run(folder / "geometry", folder / "repair", load(None))
    return folder


def exported(page: Path, name: str) -> Record:
    return read_record(page.with_name(f"{page.stem}_files") / name)


def report(page: Path, *folders: Path) -> int:
    return main(["report", *map(str, folders), "--out", str(page)])


def test_designs_of_one_name_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    one, other = solved(Path("a/d")), solved(Path("b/d"))
    sentence = "a/d and b/d have the same name: each design of a page needs its own."
    assert report(Path("p.html"), one, other) == 2
    assert capsys.readouterr().err == f"pagd: {sentence}\n"
    with pytest.raises(InputError, match=f"^{sentence}$"):
        write_page([one, other], Path("p.html"))
    # No card of either has been written on the way.
    assert sorted(path.name for path in Path().iterdir()) == ["a", "b"]


def test_without_openscad_there_is_a_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, page = solved(tmp_path / "done"), tmp_path / "p.html"
    monkeypatch.setenv("PATH", "")
    assert report(page, folder) == 0
    assert exported(page, "done").figures["left_out"] == {}


def test_without_openscad_moulds_are_left_out_until_it_is_there(
    drawn: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = tmp_path / "p.html"
    with monkeypatch.context() as without:
        without.setenv("PATH", "")
        assert report(page, drawn) == 0
    left_out = exported(page, "drawn").figures["left_out"]
    assert sorted(left_out) == ["mould_base.stl", "mould_core.stl", "mould_outside.stl"]
    assert all("install OpenSCAD" in reason for reason in left_out.values())
    assert "solids.step" in exported(page, "drawn").figures["files"]
    assert report(page, drawn) == 0
    assert exported(page, "drawn").figures["left_out"] == {}
    # Nor are they lost when it goes.
    with monkeypatch.context() as without:
        without.setenv("PATH", "")
        assert report(page, drawn) == 0
    assert "mould_core.stl" in exported(page, "drawn").figures["files"]


def test_pictures_alone_are_no_results(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, pictures = solved(tmp_path / "done"), tmp_path / "pictures" / "figures"
    pictures.mkdir(parents=True)
    shutil.copy(folder / "metrics" / RECORD_NAME, pictures)
    page = tmp_path / "p.html"
    assert report(page, folder, pictures.parent) == 0
    assert "1 of 2 designs have results" in capsys.readouterr().err
    assert report(page, pictures.parent) == 2
    assert "no results to show" in capsys.readouterr().err


def test_a_record_that_cannot_be_read_costs_one_design(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, torn = solved(tmp_path / "done"), solved(tmp_path / "torn")
    (torn / "metrics" / RECORD_NAME).write_text('{"schema')
    page = tmp_path / "p.html"
    assert report(page, folder, torn) == 0
    assert f"{torn} is not on the page" in capsys.readouterr().err
    assert report(page, torn) == 2
    assert "not a readable record" in capsys.readouterr().err


def test_a_table_that_cannot_be_read_is_left_out(tmp_path: Path) -> None:
    folder = solved(tmp_path / "done")
    (folder / "metrics" / "performance.parquet").write_text("no table")
    record = export.run(folder, tmp_path / "out", load(None))
    assert list(record.figures["left_out"]) == ["performance.csv"]
    assert "not a readable Parquet table" in record.figures["left_out"]["performance.csv"]
    assert "trajectory.csv" in record.figures["files"]
    assert (tmp_path / "out" / "card.js").is_file()


def test_a_design_without_a_card_is_not_on_the_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, torn = solved(tmp_path / "done"), solved(tmp_path / "torn")
    (torn / "metrics" / "trajectory.parquet").write_text("no table")
    page = tmp_path / "p.html"
    assert report(page, torn, folder) == 0
    assert f"{torn} is not on the page: {torn}/metrics/trajectory" in capsys.readouterr().err
    text = page.read_text(encoding="utf-8")
    assert 'id="design-done"' in text
    assert 'id="design-torn"' not in text
    assert report(page, torn) == 2
    # It is looked at again, and not taken for done.
    shutil.copy(folder / "metrics" / "trajectory.parquet", torn / "metrics")
    assert report(page, torn) == 0


def made_at(page: Path) -> int:
    return (page.with_name("p_files") / "done" / RECORD_NAME).stat().st_mtime_ns


def change_record(folder: Path) -> None:
    record = read_record(folder / "metrics")
    figures = {**record.figures, "bending_deg": 12.5}
    write_record(dataclasses.replace(record, figures=figures), folder / "metrics")


def add_pictures(folder: Path) -> None:
    (folder / "figures").mkdir()
    shutil.copy(folder / "metrics" / RECORD_NAME, folder / "figures")


def damage(folder: Path) -> None:
    card = folder.parent / "p_files" / "done" / "card.js"
    card.write_bytes(card.read_bytes().replace(b"34.4", b"43.4"))


def age(folder: Path) -> None:
    """Let it be of other sources."""
    path = folder.parent / "p_files" / "done" / RECORD_NAME
    content = json.loads(path.read_text())
    content["versions"]["sources"] = "0" * 16
    path.write_text(json.dumps(content))


@pytest.mark.parametrize("change", [change_record, add_pictures, damage, age])
def test_what_is_as_it_was_is_not_exported_again(change: object, tmp_path: Path) -> None:
    folder, page = solved(tmp_path / "done"), tmp_path / "p.html"
    assert report(page, folder) == 0
    before, card = made_at(page), (tmp_path / "p_files/done/card.js").read_bytes()
    assert report(page, folder) == 0
    assert made_at(page) == before
    assert callable(change)
    change(folder)
    between = made_at(page)
    assert report(page, folder) == 0
    assert made_at(page) > between
    now = (tmp_path / "p_files/done/card.js").read_bytes()
    assert (now != card) is (change is change_record)
