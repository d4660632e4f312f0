from pathlib import Path
from typing import Any

import pytest

from pagd.errors import StageFailure, Status
from pagd.record import Meter, Record, read_record
from pagd.stages.stage import Outcome, run_stage


def run(out: Path, work: Any, **options: Any) -> Record:
    return run_stage("mesh", out, work, design_id="d", configuration={"a": 1}, **options)


def good(folder: Path, outcome: Outcome, meter: Meter) -> None:
    (folder / "made").touch()
    with meter.part("making"):
        outcome.figures["tets"] = 5


def failing(folder: Path, outcome: Outcome, meter: Meter) -> None:
    good(folder, outcome, meter)
    raise StageFailure(Status.mesh_failed, "The mesher gave up.")


def crashing(folder: Path, outcome: Outcome, meter: Meter) -> None:
    good(folder, outcome, meter)
    raise RuntimeError


def never(folder: Path, outcome: Outcome, meter: Meter) -> None:
    raise AssertionError("must not be called")


def test_a_stage_leaves_its_files_and_its_record(tmp_path: Path) -> None:
    record = run(tmp_path / "mesh", good)
    assert read_record(tmp_path / "mesh") == record
    assert (record.status, record.reason, record.figures) == (Status.ok, None, {"tets": 5})
    assert record.configuration == {"a": 1}
    assert {"making", "wall", "cpu"} <= set(record.timings_s)
    assert (tmp_path / "mesh" / "made").exists()


def test_a_failure_is_recorded_with_what_came_before(tmp_path: Path) -> None:
    record = run(tmp_path / "mesh", failing)
    assert (record.status, record.reason) == (Status.mesh_failed, "The mesher gave up.")
    assert record.figures == {"tets": 5}


def test_a_crash_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError):
        run(tmp_path / "mesh", crashing)
    assert list(tmp_path.iterdir()) == []


def test_a_failure_before_is_passed_on_without_work(tmp_path: Path) -> None:
    before = run(tmp_path / "before", failing)
    fine = run(tmp_path / "fine", good)
    record = run(tmp_path / "mesh", never, upstream=[fine, before])
    assert (record.status, record.reason) == (before.status, before.reason)
    assert record.figures == {}


def test_a_stage_that_can_go_on_keeps_the_first_failure(tmp_path: Path) -> None:
    before = run(tmp_path / "before", failing)
    record = run(tmp_path / "mesh", good, upstream=[before], goes_on=True)
    assert record.figures == {"tets": 5}
    assert record.status is Status.mesh_failed
