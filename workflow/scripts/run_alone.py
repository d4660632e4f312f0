"""Run Snakemake as the only one in this folder, after clearing away what a killed run has left.

    python workflow/scripts/run_alone.py --profile profiles/default --cores 2

A run that was killed leaves Snakemake's lock, and a power cut may leave damaged files. A lock of
the system, which ends with whoever holds it, tells whether another run is still at work here: then
this one is refused; else the lock of Snakemake is taken away, and what is damaged by its size
removed, so that the run makes it again.
"""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
from pathlib import Path

import psutil

LOCK = Path(".snakemake") / "run.lock"
# Subcommands of pagd that change nothing.
_ONLY_LOOK = {"status", "--help", "--version"}
LOCKS_OF_SNAKEMAKE = Path(".snakemake") / "locks"


def main(arguments: list[str]) -> int:
    """Take the place of this process by Snakemake; an exit code where that is not to be."""
    if not _held(LOCK) or _others():
        print(f"pagd: another run is at work in {Path.cwd()}; wait for it.", file=sys.stderr)
        return 2
    if LOCKS_OF_SNAKEMAKE.is_dir() and any(LOCKS_OF_SNAKEMAKE.iterdir()):
        print("pagd: a run was cut off here; going on where it was.", file=sys.stderr)
        _unlock(arguments)
    if Path("results").is_dir():
        audit = subprocess.run(["pagd", "audit", "results", "--quick", "--discard"], check=False)
        if audit.returncode != 0:
            print("pagd: the audit of results/ has failed, see above.", file=sys.stderr)
            return audit.returncode
    # Jobs side by side must not ask for more memory than the machine has.
    memory = f"mem_mb={psutil.virtual_memory().total // 2**20}"
    os.execvp("snakemake", ["snakemake", "--resources", memory, *arguments])


def _unlock(arguments: list[str]) -> None:
    answer = subprocess.run(
        ["snakemake", "--unlock", *arguments], capture_output=True, text=True, check=False
    )
    if answer.returncode != 0:
        sys.exit(f"pagd: the lock of Snakemake could not be taken away: {answer.stderr.strip()}")


def _held(path: Path) -> bool:
    """Whether the lock is ours: it stays so until this process, or Snakemake in it, is gone."""
    path.parent.mkdir(exist_ok=True)
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    os.set_inheritable(descriptor, True)
    return True


def _others() -> list[int]:
    """Snakemake in this folder, started without this script, or work that a killed one has left."""
    here, found = Path.cwd(), []
    for process in psutil.process_iter(["cmdline", "cwd"]):
        words = process.info["cmdline"] or []
        if process.info["cwd"] == str(here) and process.pid != os.getpid() and _is_at_work(words):
            found.append(process.pid)
    return found


def _is_at_work(words: list[str]) -> bool:
    """Whether a command line is that of a program, or a module, that changes results."""
    programs = [Path(word).name for word in words[:2] if Path(word).is_file()]
    if "-m" in words[1:3]:
        place = words.index("-m") + 1
        programs += words[place : place + 1]
    return "snakemake" in programs or ("pagd" in programs and not _ONLY_LOOK & set(words))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
