"""Kernels and the compiler: whoever has to wait for it is told why, once."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

_OURS = """
import numpy as np
from pagd.self_collision import _cross, _dot
x, y, z = np.eye(3)
_cross(x, y, result := np.empty(3))
print(_dot(result, z))
"""
_THEIRS = """
import numba
import pagd.fem.compiled
print(numba.njit(lambda x: 1.0 * x)(1))
"""


def run(code: str, cache: Path) -> subprocess.CompletedProcess[str]:
    """Run code that logs, with kernels kept in a folder of its own."""
    log = "import logging\nlogging.basicConfig(level=logging.INFO, format='%(message)s')\n"
    return subprocess.run(
        [sys.executable, "-c", log + code],
        env={**os.environ, "NUMBA_CACHE_DIR": str(cache)},
        capture_output=True,
        text=True,
        check=True,
    )


def test_compiling_is_told_of_once_and_only_where_it_happens(tmp_path: Path) -> None:
    first, second = (run(_OURS, tmp_path) for _ in range(2))
    assert first.stdout == second.stdout == "1.0\n"
    assert first.stderr.count("compiling the solver") == 1
    assert second.stderr == ""


def test_kernels_of_others_are_not_told_of(tmp_path: Path) -> None:
    answer = run(_THEIRS, tmp_path)
    assert (answer.stdout, answer.stderr) == ("1.0\n", "")
