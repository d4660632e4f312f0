"""What an audit finds and removes, and what a look at a run tells."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pagd.audit import discard, findings, wanted_again
from pagd.cli import main
from pagd.errors import InputError, Status
from pagd.inventory import read_sound_record
from pagd.limits import Limits, under
from pagd.progress import progress_of
from pagd.record import Meter, read_record
from pagd.stages.stage import Outcome, run_stage

CHAIN = ("geometry", "repair", "mesh", "solve", "metrics")


def make(results: Path, name: str, *stages: str, status: Status = Status.ok) -> None:
    """Leave the folders of stages of a design, with a file each."""

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        (folder / "made.bin").write_bytes(b"0123456789")
        outcome.figures["wall_s"] = float(len(name))
        if status is not Status.ok:
            outcome.end(status, "Walls are too thin.")

    for stage in stages:
        folder = results / "designs" / name / stage
        run_stage(stage, folder, work, design_id=name, configuration={})


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """The folder of a run with three designs that are done."""
    for name in ("a", "bb", "ccc"):
        make(tmp_path / "results", name, *CHAIN)
    return tmp_path / "results"


def flip_a_bit(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[3] ^= 1
    path.write_bytes(content)


def test_a_sound_run_has_no_findings(results: Path) -> None:
    assert list(findings(results, thorough=True)) == []
    assert main(["audit", str(results)]) == 0


def test_every_damage_is_found(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    designs = results / "designs"
    os.truncate(designs / "a/mesh/made.bin", 4)
    flip_a_bit(designs / "bb/solve/made.bin")
    (designs / "ccc/metrics/record.json").write_text("")
    found = {str(f.folder.relative_to(designs)): f.why for f in findings(results, thorough=True)}
    assert set(found) == {"a/mesh", "bb/solve", "ccc/metrics"}
    assert "has 4 bytes, but was made with 10" in found["a/mesh"]
    assert "SHA-256" in found["bb/solve"]
    assert "not a readable record" in found["ccc/metrics"]
    quick = {f.folder.parent.name for f in findings(results, thorough=False)}
    assert quick == {"a", "ccc"}
    assert main(["audit", str(results)]) == 1
    assert "3 folders to make again" in capsys.readouterr().out


def test_what_is_discarded_takes_with_it_what_was_made_of_it(results: Path) -> None:
    designs = results / "designs"
    (designs / "bb/solve/made.bin").unlink()
    os.truncate(designs / "a/repair/made.bin", 0)
    assert main(["audit", str(results), "--discard"]) == 0
    left = {d.name: {s.name for s in d.iterdir()} for d in designs.iterdir()}
    assert left == {"a": set(), "bb": {"geometry", "repair", "mesh"}, "ccc": set(CHAIN)}
    assert list(findings(results, thorough=True)) == []


def test_damaged_exports_are_made_again_alone_and_with_their_design(
    results: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    exports = results / "report" / "designs"
    for name in ("a", "bb"):
        make(results, name, "export")
        exports.mkdir(parents=True, exist_ok=True)
        (results / "designs" / name / "export").rename(exports / name)
    flip_a_bit(exports / "a" / "made.bin")
    assert [found.folder for found in findings(results, thorough=True)] == [exports / "a"]
    assert main(["audit", str(results), "--discard"]) == 0
    assert {path.name for path in exports.iterdir()} == {"bb"}
    # What a card is made of, and how its design has ended, is no matter of the card.
    (results / "designs/bb/solve/made.bin").unlink()
    assert main(["audit", str(results), "--discard"]) == 0
    assert not (exports / "bb").exists()
    make(results, "bb", *CHAIN, status=Status.crashed)
    assert {found.folder.parent.name for found in wanted_again(results, [Status.crashed])} == {"bb"}


def test_a_damaged_data_set_takes_the_generative_half_with_it(tmp_path: Path) -> None:
    folders = {"generate": "generated"}
    for stage in ("dataset", "embedding", "generate", "selection"):
        folder = tmp_path / folders.get(stage, stage)
        run_stage(stage, folder, lambda *_: None, design_id="all", configuration={})
    for part in ("training_1", "training_2", "generated_1"):
        out = tmp_path / "screening/parts" / part
        run_stage("screening", out, lambda *_: None, design_id="all", configuration={})
    (tmp_path / "embedding/record.json").write_text("{")
    (tmp_path / "screening/parts/training_2/record.json").write_text("{")
    discard(tmp_path, list(findings(tmp_path, thorough=False)))
    left = {str(p.parent.relative_to(tmp_path)) for p in tmp_path.rglob("record.json")}
    assert left == {"dataset", "screening/parts/training_1", "screening/parts/generated_1"}


def test_designs_that_crashed_can_be_wanted_again(results: Path) -> None:
    make(results, "d", *CHAIN, status=Status.crashed)
    found = {f.folder.parent.name for f in wanted_again(results, {"crashed"})}
    assert found == {"d"}
    assert main(["audit", str(results), "--discard", "--again", "crashed"]) == 0
    assert list((results / "designs/d").iterdir()) == []


def test_what_killed_processes_left_is_removed(results: Path) -> None:
    script = f"""
import os, pathlib, signal
from pagd.files import replaced_folder
with replaced_folder(pathlib.Path({str(results / "designs/a/solve")!r}), "record.json") as folder:
    (folder / "half").touch()
    os.kill(os.getpid(), signal.SIGKILL)
"""
    subprocess.run([sys.executable, "-c", script], check=False)
    (left,) = (results / "designs/a").glob(".solve.*")
    assert main(["audit", str(results), "--discard"]) == 0
    assert not left.exists()
    assert (results / "designs/a/solve/made.bin").is_file()


def test_a_stage_refuses_damaged_files_of_another(results: Path) -> None:
    folder = results / "designs/a/mesh"
    assert read_sound_record(folder) == read_record(folder)
    flip_a_bit(folder / "made.bin")
    with pytest.raises(InputError, match=r"made\.bin is not what it was made as.*pagd audit"):
        read_sound_record(folder)


def test_in_a_workflow_damage_is_found_again_by_the_next_run(results: Path) -> None:
    folder = results / "designs/a/mesh"
    flip_a_bit(folder / "made.bin")
    assert list(findings(results, thorough=False)) == []
    with under(Limits(time_s=60, memory_MB=4000)), pytest.raises(InputError):
        read_sound_record(folder)
    assert main(["audit", str(results), "--quick", "--discard"]) == 0
    assert list((results / "designs/a").iterdir()) == []


@pytest.mark.parametrize("text", ["", "{}", "[]", "null", '{"status": "ok"}'])
def test_any_record_is_told_of(results: Path, text: str) -> None:
    (results / "designs/a/metrics/record.json").write_text(text)
    assert [f.folder.parent.name for f in findings(results, thorough=False)] == ["a"]
    assert main(["audit", str(results), "--again", "crashed"]) == 1
    assert progress_of(results, ["a", "bb"]).done == 1


def test_a_look_at_a_run_under_way(results: Path) -> None:
    make(results, "slow", "geometry", "repair", "mesh")
    (results / "designs/slow/.solve.elsewhere.123.abcdefgh").mkdir()
    make(results, "cut", "geometry", "repair")
    make(results, "thin", *CHAIN, status=Status.mesh_failed)
    log = results / "logs/mesh/cut.log"
    log.parent.mkdir(parents=True)
    log.write_text("one\npagd: the disk is full\n")
    hour_ago = time.time() - 1800
    for stage in ("a", "bb"):
        os.utime(results / "designs" / stage / "metrics/record.json", (hour_ago, hour_ago))
    names = ["a", "bb", "ccc", "slow", "cut", "thin", "later"]
    found = progress_of(results, names)
    assert (found.designs, found.done) == (7, 4)
    assert found.statuses == {"ok": 3, "mesh_failed": 1}
    assert found.at_work == ("slow",)
    assert found.without_result == {"cut": "mesh: pagd: the disk is full"}
    assert [(one.design_id, one.reason) for one in found.failed] == [
        ("thin", "Walls are too thin.")
    ]
    assert found.slowest[0].design_id == "thin"
    assert found.per_hour == pytest.approx(6.0, rel=0.01)
    assert found.hours_left == pytest.approx(0.5, rel=0.01)


def test_the_command_tells_it_to_people_and_machines(
    results: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "own.csv"
    values = "9.5,15,13,4,2,4,2,2.2,2,0,0"
    rows = [f"{name},{values}" for name in ("a", "bb", "ccc", "later")]
    table.write_text("\n".join(["name,L,W,H,t,t_n,t_h,t_ab,t_b,N,theta,alpha", *rows, ""]))
    config = json.dumps({"designs": {"own": str(table)}})
    assert main(["status", str(results), "--config", config]) == 0
    told = capsys.readouterr().out
    assert "3 of 4 designs are done (75 %): ok 3." in told
    assert main(["status", str(results), "--config", config, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["statuses"] == {"ok": 3}
    assert main(["status", str(tmp_path / "none")]) == 2
