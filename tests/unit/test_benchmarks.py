"""The commands behind the figures in docs/method.md run, here on small data sets."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def printed(name: str, *options: str) -> list[str]:
    command = [sys.executable, f"benchmarks/{name}.py", *options]
    # Threads of several tests side by side would wait for each other.
    env = os.environ | {"OMP_NUM_THREADS": "1"}
    answer = subprocess.run(command, cwd=ROOT, env=env, capture_output=True, text=True, check=False)
    assert answer.returncode == 0, answer.stderr
    return answer.stdout.splitlines()


def test_both_libraries_are_timed() -> None:
    lines = printed("embedding", "--size", "150", "--threads", "1")
    assert lines[0].startswith("150 designs, 1 threads")
    assert [line.split()[0] for line in lines[2:4]] == ["openTSNE", "scikit-learn"]
    assert lines[4].startswith("scikit-learn / openTSNE: ")
    assert lines[5].endswith("difference 0")


def test_every_way_to_a_mixed_mode_is_measured() -> None:
    heading, *rows = printed("bridge", "--size", "300", "--designs", "400")
    share = {line[:30].strip(): float(line[30:].split()[0]) for line in rows}
    assert heading.split()[:2] == ["way", "mixed"]
    assert len(share) == 7
    assert share["EM and barycentre"] > 2 * share["EM, K = 3"]
    assert share["EM and barycentre"] > share["EM and whole path"]
    assert share["EM and barycentre, drawn again"] > 30
