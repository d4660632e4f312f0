"""The generative half of the workflow: from training designs to simulated new ones."""

from __future__ import annotations

import csv
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from pagd.record import read_record
from pagd.tables import read_rows

from .conftest import GENERATIVE, ROOT, STRAIGHT, Project, undeclared_tables

STAGES = {
    "dataset": "dataset",
    "embedding": "embedding",
    "generated": "generate",
    "diversity": "diversity",
    "selection": "selection",
}


def selected(project: Project) -> dict[str, dict[str, str]]:
    """Return the rows of the selection by name."""
    with (project / "selection/designs.csv").open(newline="") as file:
        return {row["name"]: row for row in csv.DictReader(file)}


def jobs(answer: subprocess.CompletedProcess[str]) -> dict[str, int]:
    """Return the last table of jobs that Snakemake has printed."""
    found = (answer.stdout + answer.stderr).rpartition("Job stats:")[2]
    return {name: int(n) for name, n in re.findall(r"^(\w+) +(\d+)$", found, re.MULTILINE)}


def test_every_stage_leaves_its_record(generative: Project) -> None:
    for folder, stage in STAGES.items():
        record = read_record(generative / folder)
        assert (record.stage, record.design_id, record.status) == (stage, "all", "ok")
        section = "generator" if stage == "generate" else stage
        assert record.configuration[section]["seed"] == 1
        assert "numpy" in record.versions


def test_every_table_has_the_columns_of_the_data_dictionary(generative: Project) -> None:
    assert undeclared_tables(generative / "") == []


def test_training_and_generated_designs(generative: Project) -> None:
    training = read_rows(generative / "dataset/designs.parquet")
    assert len(training) == len({tuple(row.values())[1:] for row in training}) == 300
    assert {row["mode"] for row in training} == {"bending", "twisting"}
    generated = read_rows(generative / "generated/designs.parquet")
    assert len(generated) == 40
    assert sum(row["mode"] == "mixed" for row in generated) >= 4
    assert all(row["novelty"] > 0 and row["novelty_plane"] >= 0 for row in generated)
    mixture = json.loads((generative / "generated/mixture.json").read_text())
    assert set(mixture["bic"]) == {"1", "2", "3"}
    assert mixture["weights"][mixture["bridge"]] == pytest.approx(1 / 3, abs=1e-3)
    assert sum(row["component"] == mixture["bridge"] for row in generated) > 0


def test_every_generator_is_compared(generative: Project) -> None:
    path = generative / "summary/diversity.json"
    assert path.read_bytes() == (generative / "diversity/diversity.json").read_bytes()
    content = json.loads(path.read_text())
    assert content["generator"] == "gmm"
    values = {
        (row["generator"], row["space"], row["metric"]): row["value"]
        for row in content["rows"]
        if row["mode"] == "all"
    }
    for generator in ("gmm", "gmm_plain", "gmm_full", "kde", "random", "training"):
        assert values[generator, "encoded", "novelty"] > 0
        assert values[generator, "plane", "hull_ratio"] > 0
    assert values["resample", "encoded", "novelty"] == 0
    assert values["gmm", "plane_sample", "novelty"] > 0
    own = read_rows(generative / "generated/designs.parquet")
    mean = sum(row["novelty"] for row in own) / len(own)
    assert values["gmm", "encoded", "novelty"] == pytest.approx(mean)


def test_selected_designs_are_simulated_beside_the_others(generative: Project) -> None:
    chosen = selected(generative)
    rows = {r["design_id"]: r for r in read_rows(generative / "summary/performance.parquet")}
    assert set(rows) == {"straight", *chosen}
    assert {rows[name]["origin"] for name in chosen} == {"generated"}
    assert {rows[name]["mode"] for name in chosen} == {"bending", "twisting", "mixed"}
    assert {row["status"] for row in rows.values()} == {"ok"}
    known = {r["design_id"]: r for r in read_rows(generative / "generated/designs.parquet")}
    for name in chosen:
        assert rows[name]["novelty"] == pytest.approx(known[name]["novelty"])
    assert rows["straight"]["novelty"] > 0
    table = (generative / "summary/summary.csv").read_text()
    assert f"{rows['straight']['novelty']:.3f}" in table


def test_pictures_and_page(generative: Project) -> None:
    drawn = {path.stem for path in (generative / "figures/generative").glob("*.png")}
    assert drawn == {"embedding", "mixture", "hull", "comparison", "distributions"}
    simulated = {path.stem for path in (generative / "figures/simulated").glob("*.png")}
    assert simulated == {"bending_twist", "feasibility", "force_bending", "novelty_performance"}
    page = (generative / "report/index.html").read_text()
    for name in (*selected(generative), "Data set and embedding", "Novelty and diversity"):
        assert name in page
    # No pictures are drawn of single designs here, and yet each has a card.
    assert not list((generative / "designs").glob("*/figures"))
    for name in ("straight", *selected(generative)):
        assert (generative / f"report/designs/{name}/card.js").is_file()
        assert f'data-address="designs/{name}"' in page


def test_all_generated_designs_are_screened_and_compared(generative: Project) -> None:
    generated = read_rows(generative / "generated/designs.parquet")
    rows = read_rows(generative / "screening/generated/performance.parquet")
    assert {row["design_id"] for row in rows} == {row["design_id"] for row in generated}
    assert {row["fidelity"] for row in rows} == {"cells"}
    training = read_rows(generative / "screening/training/performance.parquet")
    assert len(training) == 10
    assert {row["mode"] for row in training} == {"bending", "twisting"}
    fronts = json.loads((generative / "summary/fronts.json").read_text())
    assert (fronts["training"], fronts["generated"]) == (10, 40)
    assert all(each["low"] <= each["ratio"] <= each["high"] for each in fronts["comparisons"])
    page = (generative / "report/index.html").read_text()
    assert "What the designs can do" in page
    drawn = {path.stem for path in (generative / "figures/screening").glob("*.png")}
    assert drawn == {"screened", "screened_novelty", "screened_beside_full"}


def test_more_training_designs_leave_the_parts_that_are_there(generative: Project) -> None:
    more = 'screening={"training_designs": 20, "designs_per_job": 10}'
    answer = generative.snakemake("--dry-run", "--config", more, "--", "screening")
    # One job more, and what is made of all.
    assert jobs(answer)["screen_part"] == 1
    assert {"screened", "fronts"} <= set(jobs(answer))
    none = 'screening={"training_designs": 0, "designs_per_job": 10}'
    answer = generative.snakemake("--dry-run", "--config", none, "--", "screening")
    assert (answer.returncode, jobs(answer).get("screen_part")) == (0, None)
    whole = ("--profile", str(ROOT / "profiles" / "screening"))
    planned = jobs(generative.snakemake(*whole, "--dry-run", "--", "screening"))
    assert planned["screen_part"] == 300 // 10 - 1


def test_the_report_has_captions(generative: Project, tmp_path: Path) -> None:
    answer = generative.snakemake("--report", str(tmp_path / "report.zip"))
    assert answer.returncode == 0, answer.stderr
    shutil.unpack_archive(tmp_path / "report.zip", tmp_path / "unpacked")
    text = "".join(
        path.read_text(errors="replace")
        for path in (tmp_path / "unpacked").rglob("*")
        if path.suffix in (".html", ".js")
    )
    for caption in ("Fig. 4a of the paper", "Convex hulls of random", "by its novelty"):
        assert caption in text


def test_a_second_run_does_nothing(generative: Project) -> None:
    assert generative.pending() == set()
    assert "Nothing to be done" in generative.snakemake().stderr


def test_the_data_set_is_the_same_bytes_again(generative: Project, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pagd", "dataset", "--size", "300", "--out", "again"]
    subprocess.run(command, cwd=tmp_path, check=True)
    again = (tmp_path / "again/designs.parquet").read_bytes()
    assert again == (generative / "dataset/designs.parquet").read_bytes()


def test_another_measure_runs_the_comparison_only(copied: Project) -> None:
    changed = GENERATIVE["diversity"] | {"hull_repeats": 12}
    copied.write(STRAIGHT, **GENERATIVE | {"diversity": changed})
    assert copied.pending() == {
        "diversity", "summary/diversity.json", "figures/generative", "report/index.html",
        "ro-crate-metadata.json", "provenance"
    }  # fmt: skip


def test_one_more_selected_design_runs_that_one_only(copied: Project) -> None:
    before = selected(copied)
    answer = copied.snakemake("summary", "--config", 'selection={"designs": 4}')
    assert answer.returncode == 0, answer.stderr
    after = selected(copied)
    (new,) = set(after) - set(before)
    assert {name: after[name] for name in before} == before
    ran = set(re.findall(r"Solve design (\w+) under", answer.stdout + answer.stderr))
    assert ran == {new}
    rows = read_rows(copied / "summary/performance.parquet")
    assert {row["design_id"] for row in rows} == {"straight", *after}


def test_another_seed_runs_the_designs_whose_rows_change(copied: Project) -> None:
    before = selected(copied)
    seed = ("--config", 'generator={"seed": 2}')
    planned = jobs(copied.snakemake("--dry-run", *seed))
    assert {"generate", "diversity", "select"} <= set(planned)
    assert not {"dataset", "embedding", "prepare"} & set(planned)
    assert copied.snakemake("results/selection", *seed).returncode == 0
    after = selected(copied)
    changed = [name for name in after if after[name] != before.get(name)]
    assert changed
    assert jobs(copied.snakemake("--dry-run", *seed))["solve"] == len(changed)


def test_the_sweep_takes_all_and_leaves_what_is_done(copied: Project) -> None:
    def sweep(*arguments: str) -> subprocess.CompletedProcess[str]:
        return copied.snakemake("--profile", str(ROOT / "profiles" / "sweep"), *arguments)

    before = selected(copied)
    assert sweep("--", "results/selection").returncode == 0
    new = selected(copied).keys() - before.keys()
    assert len(new) + len(before) == GENERATIVE["generator"]["designs"]
    planned = jobs(sweep("--dry-run", "--", "summary"))
    for rule in ("prepare", "solve", "metrics"):
        assert planned[rule] == len(new)

    # The default profile has nothing to add to what the sweep has made.
    target = f"results/designs/{min(new)}/metrics"
    assert sweep("--", target).returncode == 0
    everything = ("--config", 'selection={"designs": 1000000}')
    assert "Nothing to be done" in copied.snakemake(*everything, "--", target).stderr


def test_a_generated_design_alone(copied: Project) -> None:
    name = next(iter(selected(copied)))
    answer = copied.snakemake("--dry-run", "--force", f"results/designs/{name}/metrics")
    assert jobs(answer) == {"metrics": 1, "total": 1}
    answer = copied.snakemake("--dry-run", "results/designs/g9999/metrics")
    assert answer.returncode != 0
    assert "No design is named 'g9999'" in answer.stdout + answer.stderr
