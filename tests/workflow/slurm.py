"""Slurm on one machine: munge, a controller and a node, all in a folder of their own."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import psutil

#: Where Slurm looks for its configuration. The plugin of Snakemake hands on no other place.
PLACE = Path("/etc/slurm/slurm.conf")

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel")

CONFIGURATION = """\
ClusterName=pagd
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
# Processes are followed without control groups, which a container may not have.
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
SchedulerType=sched/builtin
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def is_of_others() -> bool:
    """Whether this machine knows a cluster already, which is not of a test that was killed."""
    return PLACE.exists() and not PLACE.is_symlink()


@dataclass
class Slurm:
    """A cluster of one node, which must be the only one that this machine knows."""

    folder: Path
    processes: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def start(self) -> None:
        """Start all three services, and wait until the node is ready."""
        for name in ("munge", "state", "spool"):
            (self.folder / name).mkdir(mode=0o755)
        self._start_munge()
        host = socket.gethostname()
        text = CONFIGURATION.format(
            host=host,
            folder=self.folder,
            ports=_free_ports(),
            cpus=psutil.cpu_count(),
            memory=int(0.8 * psutil.virtual_memory().total / 2**20),
        )
        (self.folder / "slurm.conf").write_text(text)
        PLACE.parent.mkdir(exist_ok=True)
        PLACE.unlink(missing_ok=True)  # a link to the folder of a test that was killed
        PLACE.symlink_to(self.folder / "slurm.conf")
        self._start("slurmctld", "-D", "-i")
        self._start("slurmd", "-D", "-N", host)
        _wait_for(lambda: "idle" in self.ask("sinfo", "--noheader", "--format", "%T"))

    def _start_munge(self) -> None:
        folder = self.folder / "munge"
        key = folder / "key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        self._start(
            "munged", "--foreground", "--force", f"--key-file={key}",
            f"--socket={folder / 'socket'}", f"--pid-file={folder / 'pid'}",
            f"--log-file={folder / 'log'}", f"--seed-file={folder / 'seed'}",
        )  # fmt: skip
        _wait_for(lambda: (folder / "socket").exists())

    def _start(self, program: str, *words: str) -> None:
        with (self.folder / f"{program}.out").open("wb") as output:
            command = [shutil.which(program) or program, *words]
            self.processes.append(subprocess.Popen(command, stdout=output, stderr=output))

    def ask(self, *command: str) -> str:
        """Return what a command of Slurm prints."""
        answer = subprocess.run(command, capture_output=True, text=True, check=False)
        return answer.stdout

    def stop(self) -> None:
        """Cancel all jobs and end the services."""
        if not self.processes:
            return
        self.ask("scancel", "--user", "root")
        time.sleep(1)
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(timeout=10)
            except subprocess.TimeoutExpired:
                process.kill()
        PLACE.unlink(missing_ok=True)


def _free_ports() -> list[int]:
    sockets = [socket.socket() for _ in range(2)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


def _wait_for(condition: Callable[[], bool], seconds: float = 60.0) -> None:
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, "the cluster does not get ready"
        time.sleep(0.2)
