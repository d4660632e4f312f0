"""The time that a page takes to open is measured, of as many designs as are asked for."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from figure_samples import solved

ROOT = Path(__file__).parents[2]


def answer_of(*options: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "benchmarks/opening.py", *options]
    return subprocess.run(command, cwd=ROOT, env=os.environ, capture_output=True, text=True)


@pytest.mark.skipif(not shutil.which("chromium"), reason="needs: chromium")
def test_a_page_of_many_designs_is_opened(tmp_path: Path) -> None:
    solved(tmp_path / "designs" / "one")
    found = answer_of(str(tmp_path), "--designs", "200", "--times", "1")
    assert found.returncode == 0, found.stderr
    rows = [line.strip("| ").split(" | ") for line in found.stdout.splitlines()[-2:]]
    assert [row[0] for row in rows] == ["1", "200"]
    assert {row[1] for row in rows} == {"0"}
    sizes = [float(row[2]) for row in rows]
    assert 1.0 < sizes[0] < sizes[1]
    for row in rows:
        median, least, most = map(float, row[3:])
        assert 0.0 < least <= median <= most < 20.0


def test_a_folder_without_designs_is_refused(tmp_path: Path) -> None:
    found = answer_of(str(tmp_path))
    assert (found.returncode, found.stdout) == (2, "")
    assert "holds no simulated design" in found.stderr
