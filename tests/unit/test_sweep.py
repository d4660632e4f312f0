"""The measure of the sweep: costs from records, overhead from runs, the sample, the dry run."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pagd import config as configuration
from pagd.errors import InputError, Status
from pagd.record import RECORD_NAME, Record, write_record

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))

from robustness.drawing import drawn_designs  # noqa: E402
from sweep.costs import STAGES, costs_of, done_of, hours_for, inside_s, overhead_of  # noqa: E402
from sweep.page import as_markdown  # noqa: E402
from sweep.project import DryRun, Project  # noqa: E402
from sweep.sample import Run, Sample  # noqa: E402

#: Each stage of a design takes so long; that of the analyses has parts.
SECONDS = {"geometry": 0.5, "repair": 0.25, "mesh": 0.25, "solve": 8.0, "metrics": 1.0}


def write_design(results: Path, name: str, end: float = 100.0, **differs: Any) -> None:
    """Write the records of a design whose stages all end at ``end``, side by side."""
    for stage, seconds in SECONDS.items():
        folder = results / "designs" / name / stage
        folder.mkdir(parents=True)
        parts = {"solve": 4.0, "blocked_force": 2.0} if stage == "solve" else {}
        write_record(
            Record(
                stage=stage,
                design_id=name,
                status=Status.ok,
                reason=None,
                figures={},
                configuration={},
                versions={"pagd": "0", "stage": 1, "python": "3"},
                timings_s={"wall": seconds, "cpu": seconds / 2, **parts},
                peak_memory_MB=100.0,
                **differs,
            ),
            folder,
        )
        os.utime(folder / RECORD_NAME, (end, end))


def run(start: float, end: float) -> Run:
    return Run(start=start, end=end, cores=2, commit=None)


def test_costs_are_those_of_the_records(tmp_path: Path) -> None:
    write_design(tmp_path, "whole")
    write_design(tmp_path, "half")
    (tmp_path / "designs/half/metrics" / RECORD_NAME).unlink()
    assert [folder.name for folder in done_of(tmp_path, ["whole", "half", "none"])] == ["whole"]
    (cost,) = costs_of(tmp_path, ["whole", "half", "none"])
    assert cost.design_id == "whole"
    assert tuple(cost.stages_s) == STAGES
    assert cost.core_s == pytest.approx(5.0)
    # Half of the stage's wall time was processor time, and so it was of its parts.
    assert cost.analyses_s == pytest.approx(3.0)
    assert cost.outside_s == pytest.approx(2.0)
    assert cost.wall_s == pytest.approx(10.0)


def test_overhead_is_what_no_stage_has_had(tmp_path: Path) -> None:
    write_design(tmp_path, "early", end=100.0)
    write_design(tmp_path, "late", end=1000.0)
    costs = costs_of(tmp_path, ["early", "late"])
    overhead = overhead_of([run(92.0, 102.0)], costs)
    assert (overhead.whole_s, overhead.inside_s) == (20.0, pytest.approx(10.0))
    assert overhead.share == pytest.approx(0.5)
    # A run in which nothing was left to do says nothing of the overhead.
    again = [run(92.0, 102.0), run(200.0, 300.0), run(990.0, 1000.0)]
    assert [inside_s(one, costs) for one in again] == pytest.approx([10.0, 0.0, 10.0])
    assert overhead_of(again, costs).whole_s == 40.0
    assert np.isnan(overhead_of([], costs).share)


def test_hours_for_all_designs(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_design(tmp_path, name)
    costs = costs_of(tmp_path, ["a", "b"])
    hours, error = hours_for(720, costs, overhead_of([run(90.0, 102.5)], costs), 2)
    # Ten seconds of stages and two and a half of workflow a design, on two cores.
    assert hours == pytest.approx(720 * 12.5 / 2 / 3600)
    assert error == pytest.approx(0.0)
    assert np.isnan(hours_for(720, costs[:1], overhead_of([run(90.0, 102.5)], costs), 2)[1])


def test_the_section_tells_figures_and_targets(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_design(tmp_path, name)
    costs = costs_of(tmp_path, ["a", "b"])
    overhead = overhead_of([run(90.0, 102.5)], costs)
    text = as_markdown(costs, 3, overhead, 2, [DryRun(11000, 55002, 31.6, 80.2)])
    assert "2 of them are done so far" in text
    assert "| both analyses | 3.00 | 3.00 | 3.00 |" in text
    # Two core-seconds of the stages and two and a half of the workflow.
    assert "| outside the analyses, with workflow | 4.50 | 4.50 | 4.50 |" in text
    assert "| workflow, share of wall time × cores | 20.0% | 10% |" in text
    assert "| 1,000 designs on 2 cores, extrapolated | 1.74 ± 0.00 h | 4 h |" in text
    assert "| 11,000 | 55,002 | 31.6 s | 80.2 s |" in text
    assert all(len(line) <= 100 for line in text.splitlines())
    assert "dry run" not in as_markdown(costs, 2, overhead, 2, [])


@pytest.fixture
def generated(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Snakemake "make" a selection of ten designs."""

    def must_run(self: Project, cores: int, targets: object) -> None:
        folder = self.results / "selection"
        folder.mkdir(parents=True, exist_ok=True)
        rows = [f"g{number:04d}" for number in range(10)]
        (folder / "designs.csv").write_text("\n".join(["name", *rows, ""]))

    monkeypatch.setattr(Project, "must_run", must_run)


@pytest.mark.usefixtures("generated")
def test_a_sample_is_drawn_once_and_made_of_one_thing(tmp_path: Path) -> None:
    config = configuration.load(None)
    sample = Sample(Project(tmp_path), config, 4, 1)
    names = sample.prepare(1)
    assert len(set(names)) == 4
    assert names == sorted(names)
    write_design(sample.project.results, names[0])
    assert sample.prepare(1) == names
    assert [cost.design_id for cost in sample.costs(names)] == names[:1]

    other = config | {"solve": config["solve"] | {"maximum_pressure_kPa": 5.0}}
    assert Sample(sample.project, other, 4, 1).prepare(1) == names
    assert sample.costs(names) == []
    assert Sample(sample.project, config, 4, 2).prepare(1) != names
    with pytest.raises(InputError, match="--designs = 11 must be at most 10, as many as"):
        Sample(sample.project, config, 11, 1).prepare(1)


@pytest.mark.usefixtures("generated")
def test_every_run_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def ending(self: Project, cores: int, targets: list[str], look: Any) -> int:
        look()
        assert targets == [f"results/designs/{name}/metrics" for name in names]
        return 1

    monkeypatch.setattr(Project, "run", ending)
    sample = Sample(Project(tmp_path), configuration.load(None), 2, 1)
    names = sample.prepare(1)
    assert sample.runs() == []
    assert not sample.simulate(names, 2)
    assert not sample.simulate(names, 3)
    assert [one.cores for one in sample.runs()] == [2, 3]
    assert all(one.start <= one.end for one in sample.runs())
    sample.prepare(1)
    assert len(sample.runs()) == 2


def test_a_dry_run_counts_the_jobs_of_its_table(tmp_path: Path) -> None:
    config = configuration.load(None)
    project = Project(tmp_path / "dry_run")
    project.write_table_alone(drawn_designs(3, 1, config), config)
    found = project.dry_run(3)
    assert (found.designs, found.jobs) == (3, 3 * 3 + 2)
    assert 0 < found.table_s <= found.all_s
    (project.folder / "config" / "designs.csv").write_text("name\nbare\n")
    with pytest.raises(InputError, match=r"The dry run has failed; .*snakemake\.log tells why\."):
        project.dry_run(3)
