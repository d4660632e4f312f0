import os
import signal
import time
from dataclasses import replace
from pathlib import Path

import pytest
from mesh_samples import BLOCK_VOLUME, block_pair, box_surface
from misbehaving_meshers import CHILD_FILE

from pagd.errors import InputError, MachineError, StageFailure, Status
from pagd.mesh.run import MeshGate, MeshingResult, mesh_with_limits

PAIR = block_pair()


@pytest.fixture(autouse=True)
def _importable(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the child process find the meshers of this folder."""
    folders = [str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(filter(None, folders)))


def meshed(*names: str, time_limit_s: float = 60.0, gate: MeshGate | None = None) -> MeshingResult:
    return mesh_with_limits(PAIR, names, size=4.0, time_limit_s=time_limit_s, gate=gate)


def test_first_mesher_serves_where_it_succeeds() -> None:
    result = mesh_with_limits(PAIR, size=4.0, time_limit_s=60.0, exact_volume=BLOCK_VOLUME)
    assert result.mesher == "gmsh"
    assert len(result.attempts) == 1
    assert result.attempts[0].reason is None
    assert result.attempts[0].seconds > 0
    assert result.quality.volume_error == pytest.approx(0.0, abs=1e-12)
    assert result.quality.tets == len(result.mesh.tets)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("misbehaving_meshers:Crashing", "It crashed (SIGSEGV)."),
        ("misbehaving_meshers:Raising", "It ended with exit code 1 (MemoryError: all gone)."),
    ],
)
def test_second_mesher_steps_in_where_the_first_breaks(name: str, reason: str) -> None:
    result = meshed(name, "gmsh")
    assert result.mesher == "gmsh"
    assert [attempt.reason for attempt in result.attempts] == [reason, None]


def test_a_mesher_that_is_killed_from_outside_is_no_fault_of_the_design() -> None:
    with pytest.raises(MachineError, match="killed from outside"):
        meshed("misbehaving_meshers:Killed", "gmsh")


def test_mesh_of_something_else_counts_as_failure() -> None:
    result = meshed("misbehaving_meshers:Shrinking", "gmsh")
    reason = result.attempts[0].reason
    assert reason is not None
    assert reason.startswith("The volume is 1566.")
    assert result.mesher == "gmsh"


def test_hung_mesher_is_killed_with_all_it_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CHILD_FILE, str(tmp_path / "child"))
    start = time.perf_counter()
    with pytest.raises(StageFailure, match=r"did not finish within 4 s") as caught:
        meshed("misbehaving_meshers:Hanging", time_limit_s=4.0)
    assert caught.value.status is Status.mesh_failed
    assert time.perf_counter() - start < 8.0
    child = int((tmp_path / "child").read_text())
    assert _ends_soon(child)


def _ends_soon(process: int) -> bool:
    """Tell whether a process is gone, or dead and only waiting to be collected."""
    for _ in range(50):
        stat = Path(f"/proc/{process}/stat")
        if not stat.exists() or stat.read_text().rpartition(")")[2].split()[0] == "Z":
            return True
        time.sleep(0.1)
    os.kill(process, signal.SIGKILL)
    return False


def test_failure_of_all_names_every_reason() -> None:
    gate = MeshGate(smallest_scaled_jacobian=0.9)
    with pytest.raises(StageFailure) as caught:
        meshed("misbehaving_meshers:Crashing", "gmsh", gate=gate)
    assert caught.value.status is Status.mesh_failed
    assert "misbehaving_meshers:Crashing: It crashed" in caught.value.reason
    assert "gmsh: The smallest scaled Jacobian is" in caught.value.reason
    assert "must be at least 0.9" in caught.value.reason


def test_reason_of_a_mesher_comes_through() -> None:
    apart = replace(PAIR, base=box_surface((0, 0, -2), (20, 10, 0)))
    with pytest.raises(StageFailure, match="must meet in one horizontal paper plane"):
        mesh_with_limits(apart, ["gmsh"], size=4.0, time_limit_s=60.0)


def test_unusable_settings_are_refused_before_anything_runs() -> None:
    with pytest.raises(InputError, match="size = -1: must be greater than 0"):
        mesh_with_limits(PAIR, size=-1.0, time_limit_s=1.0)
    with pytest.raises(InputError, match="time_limit_s = nan"):
        mesh_with_limits(PAIR, size=1.0, time_limit_s=float("nan"))
    with pytest.raises(InputError, match="at least one"):
        mesh_with_limits(PAIR, [], size=1.0, time_limit_s=1.0)
    with pytest.raises(InputError, match="'tetgen'"):
        meshed("gmsh", "tetgen")
