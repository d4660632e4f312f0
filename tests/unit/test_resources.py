"""What jobs have taken, beside what their rules ask for."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from pagd.errors import Status
from pagd.record import Record, versions, write_record

ROOT = Path(__file__).parents[2]


def record(folder: Path, stage: str, memory_MB: float, wall_s: float) -> None:
    folder.mkdir(parents=True)
    write_record(
        Record(
            stage=stage,
            design_id="one",
            status=Status.ok,
            reason=None,
            figures={},
            configuration={},
            versions=versions(1),
            timings_s={"wall": wall_s, "cpu": wall_s},
            peak_memory_MB=memory_MB,
        ),
        folder,
    )


@pytest.fixture
def results(tmp_path: Path) -> Path:
    """A run of two designs, one of which is not solved yet."""
    for name in ("one", "two"):
        for stage, memory, seconds in (("geometry", 100, 6), ("repair", 300, 6), ("mesh", 200, 12)):
            record(tmp_path / "designs" / name / stage, stage, memory, seconds)
    record(tmp_path / "designs/one/solve", "solve", 1500, 90)
    for number in (1, 2, 3):
        place = tmp_path / f"screening/parts/training_{number}"
        record(place, "screening", 100 * number, 60 * number)
    record(tmp_path / "report/designs/one", "export", 400, 6)
    (tmp_path / "benchmarks").mkdir()
    (tmp_path / "benchmarks/selection.tsv").write_text("s\tmax_rss\n30\t100\n")
    (tmp_path / "benchmarks/screening").mkdir()
    (tmp_path / "benchmarks/screening/training.tsv").write_text("s\tmax_rss\n60\t200\n")
    (tmp_path / "benchmarks/screening/training_1.tsv").write_text("s\tmax_rss\n9\t9\n")
    (tmp_path / "benchmarks/fronts.tsv").write_text("s\tmax_rss\n0\t-\n")
    return tmp_path


def printed(*options: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "benchmarks/resources.py", *map(str, options)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_jobs_are_told_beside_what_their_rules_ask_for(results: Path) -> None:
    answer = printed(results)
    assert answer.returncode == 0, answer.stderr
    assert f"`python benchmarks/resources.py {results}`" in answer.stdout
    assert "Machines of which records tell nothing. pagd " in answer.stdout
    rows = [line.strip("| ").split(" | ") for line in answer.stdout.splitlines() if "`" in line]
    found = {row[0].strip("`"): row[1:] for row in rows if len(row) > 1}
    assert found == {
        "prepare": ["2", "300", "300", "2,000", "0.40", "0.40", "40"],
        "solve": ["1", "1,500", "1,500", "4,000", "1.50", "1.50", "120"],
        "export": ["1", "400", "400", "2,000", "0.10", "0.10", "20"],
        "screen_part": ["3", "200", "300", "2,000", "2.00", "3.00", "60"],
        "screened": ["1", "210", "210", "2,000", "1.00", "1.00", "10"],
        "select": ["1", "105", "105", "1,000", "0.50", "0.50", "10"],
    }


def test_a_folder_without_jobs_is_refused(tmp_path: Path) -> None:
    answer = printed(tmp_path)
    assert answer.returncode == 2
    assert "no job of a run is there" in answer.stderr


def test_every_rule_with_resources_is_known(results: Path) -> None:
    code = "import json; from resources import asked; print(json.dumps(list(asked())))"
    command = [sys.executable, "-c", code]
    answer = subprocess.run(
        command, cwd=ROOT / "benchmarks", capture_output=True, text=True, check=True
    )
    rules = (ROOT / "workflow/rules").glob("*.smk")
    count = sum(file.read_text().count("    resources:") for file in rules)
    assert len(json.loads(answer.stdout)) == count
