"""Work under limits: what it returns and raises comes through, and nothing outlives a limit."""

from __future__ import annotations

import contextlib
import faulthandler
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from pagd.errors import InputError, MachineError, StageFailure, Status
from pagd.limits import Limits, in_force, run_apart, under
from pagd.record import Meter, read_record
from pagd.stages.stage import Outcome, run_stage

ENOUGH = Limits(time_s=60, memory_MB=4000)


def assert_gone(process: int) -> None:
    """Wait until a process has ended; one that nobody has asked after has, too."""
    deadline = time.monotonic() + 10
    while psutil.pid_exists(process):
        with contextlib.suppress(psutil.NoSuchProcess):
            if psutil.Process(process).status() == psutil.STATUS_ZOMBIE:
                return
        assert time.monotonic() < deadline
        time.sleep(0.05)


def failure_of(work: object, limits: Limits = ENOUGH) -> StageFailure:
    """The failure that a function ends with under limits."""
    assert callable(work)
    with pytest.raises(StageFailure) as caught:
        run_apart(work, limits)
    return caught.value


def test_a_result_and_an_error_come_through() -> None:
    assert run_apart(lambda: {"pid": os.getpid()}, ENOUGH)["pid"] != os.getpid()

    def refuse() -> None:
        raise InputError("wall = 0: must be greater than 0.")

    with pytest.raises(InputError, match=r"^wall = 0: must be greater"):
        run_apart(refuse, ENOUGH)


def test_what_takes_too_long_is_ended_with_all_it_has_started(tmp_path: Path) -> None:
    note = tmp_path / "child"

    def hang() -> None:
        child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
        note.write_text(str(child.pid))
        time.sleep(600)

    begun = time.monotonic()
    failure = failure_of(hang, Limits(time_s=2, memory_MB=4000))
    assert (failure.status, str(failure)) == (Status.timed_out, "It took more than 2 s.")
    assert time.monotonic() - begun < 30
    child = int(note.read_text())
    assert_gone(child)


def test_what_takes_too_much_memory_is_ended() -> None:
    own = psutil.Process().memory_info().rss / 1e6

    def swell() -> None:
        held = []
        while True:
            held.append(bytearray(os.urandom(1 << 20)) * 20)
            time.sleep(0.02)

    failure = failure_of(swell, Limits(time_s=60, memory_MB=own + 300))
    assert failure.status is Status.out_of_memory


def test_a_limit_that_is_not_the_last_one_may_be_raised() -> None:
    with pytest.raises(MachineError, match="took more than 1 s"):
        run_apart(lambda: time.sleep(60), Limits(time_s=1, memory_MB=4000, final=False))


def test_a_crash_is_told_from_a_kill() -> None:
    def crash() -> None:
        faulthandler.disable()  # pytest would print the stack of all its own calls
        os.kill(os.getpid(), signal.SIGSEGV)

    end = failure_of(crash)
    assert (end.status, "SIGSEGV" in str(end)) == (Status.crashed, True)
    fault = failure_of(lambda: 1 / 0)
    assert fault.status is Status.crashed
    assert "ZeroDivisionError" in str(fault)
    with pytest.raises(MachineError, match="killed from outside"):
        run_apart(lambda: os.kill(os.getpid(), signal.SIGKILL), ENOUGH)


def test_the_work_ends_with_whoever_has_started_it(tmp_path: Path) -> None:
    note = tmp_path / "worker"
    script = f"""
import os, pathlib, time
from pagd.limits import Limits, run_apart
def work():
    pathlib.Path({str(note)!r}).write_text(str(os.getpid()))
    time.sleep(600)
run_apart(work, Limits(time_s=600, memory_MB=4000))
"""
    with subprocess.Popen([sys.executable, "-c", script]) as process:
        while not (note.is_file() and note.read_text()):
            time.sleep(0.05)
        process.kill()
    worker = int(note.read_text())
    assert_gone(worker)


def test_memory_that_is_refused_is_memory_that_is_lacking() -> None:
    def swell() -> None:
        raise MemoryError

    assert failure_of(swell).status is Status.out_of_memory
    with pytest.raises(MachineError):
        run_apart(swell, Limits(time_s=60, memory_MB=4000, final=False))


def test_a_fork_that_cannot_tell_does_not_run_on(tmp_path: Path) -> None:
    """Its output has no room, and what it raises then must not unwind what is the parent's."""
    script = f"""
import sys
from pathlib import Path
from pagd.limits import Limits, run_apart
def work():
    print("x" * 100_000)
    raise RuntimeError
try:
    run_apart(work, Limits(time_s=60, memory_MB=4000))
finally:
    with Path({str(tmp_path / "ran")!r}).open("a") as file:
        file.write("once ")
"""
    with Path("/dev/full").open("w") as full:
        subprocess.run([sys.executable, "-c", script], stdout=full, stderr=full, check=False)
    assert (tmp_path / "ran").read_text() == "once "


def test_limits_are_in_force_within_the_block_only() -> None:
    assert in_force() is None
    with under(ENOUGH):
        assert in_force() is ENOUGH
    assert in_force() is None


def test_a_stage_beyond_its_limits_leaves_a_record_and_no_halves(tmp_path: Path) -> None:
    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        (folder / "half").write_text("half of ")
        time.sleep(60)

    with under(Limits(time_s=1, memory_MB=4000)):
        run_stage("solve", tmp_path / "solve", work, design_id="d", configuration={})
    record = read_record(tmp_path / "solve")
    assert (record.status, record.reason) == ("timed_out", "It took more than 1 s.")
    assert [path.name for path in (tmp_path / "solve").iterdir()] == ["record.json"]


def test_a_stage_within_its_limits_is_as_without(tmp_path: Path) -> None:
    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        with meter.part("write"):
            (folder / "made").write_text("all of it")
        outcome.figures["bending_deg"] = 12.5
        raise StageFailure(Status.not_converged, "No step from 3 kPa on.")

    records = []
    for name, limits in (("with", ENOUGH), ("without", None)):
        with under(limits):
            run_stage("solve", tmp_path / name, work, design_id="d", configuration={})
        record = read_record(tmp_path / name)
        assert "write" in record.timings_s
        records.append((record.status, record.reason, record.figures, record.files))
    assert records[0] == records[1]
    assert records[0][0] == "not_converged"
    assert set(records[0][3]) == {"made"}
