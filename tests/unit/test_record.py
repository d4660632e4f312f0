import hashlib
import json
import platform
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pagd import __version__
from pagd.errors import InputError, Status
from pagd.machine import machine_class
from pagd.record import (
    RECORD_NAME,
    Meter,
    Record,
    configuration_hash,
    read_record,
    stage_folder,
    versions,
    write_record,
)


@pytest.fixture
def record() -> Record:
    return Record(
        stage="mesh",
        design_id="bending-1",
        status=Status.mesh_failed,
        reason="The mesher ran out of time.",
        figures={"tets": np.int64(5), "volume_mm3": np.float64(1.5), "sizes": np.arange(2)},
        configuration={"size_mm": 3.0},
        versions=versions(2, ("numpy",)),
        timings_s={"wall": 1.0, "cpu": 0.5},
        peak_memory_MB=12.5,
    )


def test_record_round_trip(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path)
    read = read_record(tmp_path)
    assert read == replace(record, figures={"tets": 5, "volume_mm3": 1.5, "sizes": [0, 1]})
    assert read.status is Status.mesh_failed


def test_a_record_tells_machine_and_configuration(record: Record, tmp_path: Path) -> None:
    write_record(replace(record, machine=machine_class()), tmp_path)
    content = json.loads((tmp_path / RECORD_NAME).read_text())
    text = json.dumps(record.configuration, sort_keys=True, separators=(",", ":"))
    assert content["configuration_sha256"] == hashlib.sha256(text.encode()).hexdigest()
    assert set(content["machine"]) == {"processor", "cores", "memory_GB", "system"}
    assert platform.node() not in json.dumps(content["machine"])
    assert read_record(tmp_path).machine == content["machine"]


def test_a_configuration_that_was_changed_is_refused(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path)
    path = tmp_path / RECORD_NAME
    path.write_text(path.read_text().replace('"size_mm": 3.0', '"size_mm": 2.0'))
    with pytest.raises(InputError, match="is not the one it was made by"):
        read_record(tmp_path)


def test_an_older_record_is_read(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path)
    content = json.loads((tmp_path / RECORD_NAME).read_text())
    for key in ("machine", "configuration_sha256", "files"):
        del content[key]
    (tmp_path / RECORD_NAME).write_text(json.dumps(content))
    assert read_record(tmp_path).machine == {}


def test_the_order_of_a_configuration_does_not_change_its_hash() -> None:
    assert configuration_hash({"a": 1, "b": 0.5}) == configuration_hash({"b": 0.5, "a": 1})
    assert configuration_hash({"a": 1}) != configuration_hash({"a": 2})


@pytest.mark.parametrize(
    "change",
    [
        {"reason": None},
        {"status": Status.ok},
        {"design_id": "two words"},
        {"timings_s": {"wall": 1.0}},
        {"peak_memory_MB": -1.0},
        {"versions": {"pagd": "1"}},
        {"figures": {"bending_deg": float("nan")}},
    ],
)
def test_a_record_that_breaks_the_rules_is_not_written(
    record: Record, tmp_path: Path, change: dict[str, object]
) -> None:
    with pytest.raises(ValueError, match=r"record of stage 'mesh'|not JSON compliant"):
        write_record(replace(record, **change), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_reading_checks_the_schema(record: Record, tmp_path: Path) -> None:
    write_record(record, tmp_path)
    content = json.loads((tmp_path / RECORD_NAME).read_text())
    for fault in ({"schema": 2}, {"status": "fine"}, {"extra": 1}):
        (tmp_path / RECORD_NAME).write_text(json.dumps(content | fault))
        with pytest.raises(InputError, match=r"not a record"):
            read_record(tmp_path)


def test_a_missing_record_is_an_input_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"record\.json"):
        read_record(tmp_path)


def test_stage_folder_replaces_only_a_stage(record: Record, tmp_path: Path) -> None:
    with stage_folder(tmp_path / "mesh") as folder:
        write_record(record, folder)
    with stage_folder(tmp_path / "mesh") as folder:
        write_record(replace(record, design_id="second"), folder)
    assert read_record(tmp_path / "mesh").design_id == "second"


def test_versions_name_pagd_python_and_libraries() -> None:
    found = versions(3, ("numpy", "no-such-package"))
    assert found["pagd"] == __version__
    assert found["stage"] == 3
    assert found["numpy"] == np.__version__
    assert found["no-such-package"] is None


def test_meter_counts_children_and_parts() -> None:
    meter = Meter()
    busy = "sum(range(3_000_000))"
    with meter.part("child"):
        subprocess.run([sys.executable, "-c", busy], check=True)
    timings = meter.timings_s()
    assert 0 < timings["child"] <= timings["wall"]
    assert timings["cpu"] > 0.02


def test_peak_memory_sees_what_was_allocated() -> None:
    code = (
        "import numpy; from pagd.record import Meter; a = Meter.peak_memory_MB();"
        "b = numpy.ones(25_000_000); print(Meter.peak_memory_MB() - a)"
    )
    grown = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert float(grown.stdout) == pytest.approx(200, abs=20)
