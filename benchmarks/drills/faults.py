"""The faults: each is done to a sweep, which is then started again."""

from __future__ import annotations

import array
import fcntl
import os
import re
import signal
import subprocess
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from drills.project import Sweep, mounted, wait_for

__all__ = ["FAULTS", "Drill", "Needs"]


class Needs(Exception):
    """What a fault needs is not to be had here."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Drill:
    """A fault, and what may be different after it.

    ``what``: one sentence for people. ``inflict``: does it to the sweep in a folder, starts it
    again, and returns the sweep as it is then, and the designs that were done before the fault.
    ``failing``: the status that slanted designs end with, where the fault is theirs.
    ``again``: how many designs that were done may be computed again.
    """

    name: str
    what: str
    inflict: Callable[[Path, int], tuple[Sweep, dict[str, float]]]
    failing: str | None = None
    again: int = 0


def _job_killed(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    sweep = Sweep(folder, designs)
    with sweep.start() as run:
        wait_for(lambda: len(sweep.done()) > 0 and _kill_one(sweep, "solve"))
        before = sweep.done()
        run.wait()
    return sweep, before


def _kill_one(sweep: Sweep, stage: str) -> bool:
    """Kill a process that makes a stage; whether there was one."""
    for process in _writers(sweep, stage):
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
            return True
    return False


def _writers(sweep: Sweep, stage: str) -> list[int]:
    """Processes that make a stage of a design now: temporary names tell them."""
    designs = sweep.folder / "results" / "designs"
    named = designs.glob(f"*/.{stage}.*")
    return [int(found[1]) for p in named if (found := re.search(r"\.(\d+)\.\w{8}$", p.name))]


def _run_killed(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    sweep = Sweep(folder, designs)
    with sweep.start() as run:
        wait_for(lambda: len(sweep.noted()) >= designs // 3)
        os.killpg(run.pid, signal.SIGKILL)
    before = sweep.noted()
    sweep.go_on()
    return sweep, before


def _disk_full(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    _must_be_root("to mount a small disk")
    disk = folder / "disk"
    with mounted(disk, "-t", "tmpfs", "-o", "size=3m", "none"):
        sweep = Sweep(disk / "sweep", designs)
        code = sweep.run()
        assert code != 0, "the disk was not small enough"
        before = sweep.done()
        halves = sweep.leftovers()
        assert not halves, f"left on the full disk: {halves}"
        subprocess.run(["mount", "-o", "remount,size=500m", str(disk)], check=True)
        sweep.go_on()
        return _brought_home(sweep, folder), before


def _power_cut(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    _must_be_root("to make and mount a file system")
    image, disk = folder / "image", folder / "disk"
    folder.mkdir()
    with image.open("wb") as file:
        file.truncate(600 << 20)
    subprocess.run(["mkfs.ext4", "-q", str(image)], check=True)
    with mounted(disk, "-o", "loop", str(image)):
        sweep = Sweep(disk / "sweep", designs)
        os.sync()  # tables and configuration have long been there
        with sweep.start() as run:
            wait_for(lambda: len(sweep.noted()) >= designs // 3)
            before = sweep.noted()
            _shut_down(disk)
            with suppress(ProcessLookupError):
                os.killpg(run.pid, signal.SIGKILL)
        time.sleep(1)
    with mounted(disk, "-o", "loop", str(image)):
        sweep.go_on()
        return _brought_home(sweep, folder), before


# What is not on the disk by then is lost, as by a power cut: EXT4_IOC_SHUTDOWN without a flush of
# the journal (include/uapi/linux/ext4.h).
_EXT4_IOC_SHUTDOWN, _WITHOUT_JOURNAL = 0x8004587D, 2


def _shut_down(disk: Path) -> None:
    descriptor = os.open(disk, os.O_RDONLY)
    try:
        fcntl.ioctl(descriptor, _EXT4_IOC_SHUTDOWN, array.array("I", [_WITHOUT_JOURNAL]))
    except OSError as error:
        raise Needs(f"a file system that can be shut down ({error})") from None
    finally:
        os.close(descriptor)


def _brought_home(sweep: Sweep, folder: Path) -> Sweep:
    """A copy of the sweep that stays when its disk is gone; times of files are kept."""
    home = folder / "sweep"
    subprocess.run(["cp", "-a", str(sweep.folder), str(home)], check=True)
    return Sweep(home, sweep.designs, sweep.settings)


def _mesher_hangs(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    return _with_mesher("Hanging", folder, designs)


def _memory_eaten(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    return _with_mesher("Swelling", folder, designs, "--set-resources", "prepare:mem_mb=1000")


def _with_mesher(
    name: str, folder: Path, designs: int, *more: str
) -> tuple[Sweep, dict[str, float]]:
    meshers = [f"drills.faulty_meshers:{name}"]
    limit = 6.0 if name == "Hanging" else 600.0
    settings = {"mesh": {"meshers": meshers, "time_limit_s": limit, "half_model": False}}
    own = str(Path(__file__).parents[1])
    path = {"PYTHONPATH": os.pathsep.join([own, *filter(None, [os.environ.get("PYTHONPATH")])])}
    sweep = Sweep(folder, designs, settings, path)
    sweep.go_on(*more)
    before = sweep.done()
    sweep.go_on(*more)
    return sweep, before


def _files_damaged(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    sweep = Sweep(folder, designs)
    sweep.go_on()
    stages = sweep.folder / "results" / "designs"
    damaged = sweep.names[:4]
    mesh = stages / damaged[0] / "mesh" / "mesh.msh"
    os.truncate(mesh, mesh.stat().st_size // 2)
    states = stages / damaged[1] / "solve" / "states.parquet"
    content = bytearray(states.read_bytes())
    content[len(content) // 2] ^= 0xFF
    states.write_bytes(content)
    os.truncate(sweep.record(damaged[2], "solve"), 0)
    (stages / damaged[3] / "metrics" / "trajectory.parquet").unlink()
    before = {name: time for name, time in sweep.done().items() if name not in damaged}
    found = sweep.pagd("audit", "--discard")
    assert found.returncode == 0, found.stderr
    named = [name for name in damaged if f"designs/{name}/" in found.stdout]
    assert named == damaged, found.stdout
    sweep.go_on()
    return sweep, before


def _two_runs(folder: Path, designs: int) -> tuple[Sweep, dict[str, float]]:
    sweep = Sweep(folder, designs)
    with sweep.start() as first, sweep.start() as second:
        codes = sorted([first.wait(), second.wait()])
    assert codes == [0, 2], f"exit codes {codes}"
    assert "another run is at work" in (folder / "output.txt").read_text(encoding="utf-8")
    before = sweep.done()
    sweep.go_on()
    return sweep, before


def _must_be_root(why: str) -> None:
    if os.geteuid() != 0:
        raise Needs(f"root, {why}")


FAULTS = (
    Drill(name="a job killed", what="A worker is killed while it solves.", inflict=_job_killed),
    Drill(
        name="the run killed",
        what="Snakemake and all it has started are killed (SIGKILL).",
        inflict=_run_killed,
    ),
    Drill(
        name="a full disk",
        what="The run is on a disk of 3 MB, which is then made larger.",
        inflict=_disk_full,
    ),
    Drill(
        name="a power cut",
        what="An ext4 file system is shut down in the middle; what was not flushed is lost, and "
        "with it Snakemake's note of the last job of either core.",
        inflict=_power_cut,
        again=2,
    ),
    Drill(
        name="a hung mesher",
        what="The mesher never comes back from slanted designs.",
        inflict=_mesher_hangs,
        failing="mesh_failed",
    ),
    Drill(
        name="memory eaten",
        what="The mesher takes 1 GB a second on slanted designs, of 1 GB allotted.",
        inflict=_memory_eaten,
        failing="out_of_memory",
    ),
    Drill(
        name="files damaged",
        what="Of four designs a file is cut, changed by a bit, emptied or removed.",
        inflict=_files_damaged,
    ),
    Drill(
        name="two runs",
        what="Two runs are started in one folder at once.",
        inflict=_two_runs,
    ),
)
