"""The stages of the generative half on a small data set, through the command line."""

import json
from pathlib import Path

import pytest

from pagd.catalogue import design_from, read_designs
from pagd.cli import main
from pagd.design import PARAMETERS
from pagd.files import write_text
from pagd.record import read_record
from pagd.stages.geometry import DESIGN_NAME
from pagd.stages.novelty import novelty_of
from pagd.tables import read_rows, units

SMALL = {
    "dataset": {"size": 120},
    "embedding": {"method": "pca"},
    "generator": {"designs": 30, "largest_components": 2},
    "diversity": {
        "plane_designs": 40,
        "plane_seeds": 2,
        "hull_designs": 10,
        "hull_repeats": 5,
        "neighbours": 3,
        "sample": 30,
    },
    "selection": {"designs": 6},
}
CONFIG = ("--config", json.dumps(SMALL))


def run(*arguments: object) -> int:
    return main([*map(str, arguments), *CONFIG])


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folders of all five stages."""
    root = tmp_path_factory.mktemp("study")
    data, plane, new = root / "dataset", root / "embedding", root / "generated"
    assert run("dataset", "--out", data) == 0
    assert run("embed", "--dataset", data, "--out", plane) == 0
    made = ("--dataset", data, "--embedding", plane)
    assert run("generate", *made, "--out", new) == 0
    assert run("diversity", *made, "--generated", new, "--out", root / "diversity") == 0
    selection = ("--dataset", data, "--generated", new, "--out", root / "selection")
    assert run("select", *selection) == 0
    return root


def test_points_are_those_of_the_data_set(study: Path) -> None:
    designs = read_rows(study / "dataset/designs.parquet")
    points = read_rows(study / "embedding/points.parquet")
    assert [row["design_id"] for row in points] == [row["design_id"] for row in designs]
    assert list(points[0]) == ["design_id", "z1", "z2"]
    assert units(study / "embedding/points.parquet")["z1"] == "1"


def test_a_design_is_generated_once_and_never_copied(study: Path) -> None:
    parameters = ("L", "W", "H", "t", "t_n", "t_h", "t_ab", "t_b", "N", "theta", "alpha")
    training, generated = (
        {tuple(row[key] for key in parameters) for row in read_rows(study / name)}
        for name in ("dataset/designs.parquet", "generated/designs.parquet")
    )
    assert len(generated) == 30
    assert not training & generated


def test_selected_designs_read_back_as_they_were_generated(study: Path) -> None:
    chosen = read_designs({"generated": str(study / "selection/designs.csv")})
    assert len(chosen) == 6
    known = {row["design_id"]: row for row in read_rows(study / "generated/designs.parquet")}
    for name, named in chosen.items():
        found = {key: known[name][key] for key in named.design.as_dict()}
        assert named.design.as_dict() == found
    assert read_record(study / "selection").figures["modes"] == {
        "bending": 2, "mixed": 2, "twisting": 2
    }  # fmt: skip


def test_the_comparison_says_what_its_measures_are(study: Path) -> None:
    content = json.loads((study / "diversity/diversity.json").read_text())
    assert {row["metric"] for row in content["rows"]} <= set(content["metrics"])
    assert {row["space"] for row in content["rows"]} == set(content["spaces"])
    table = read_rows(study / "diversity/comparison.parquet")
    assert len(table) == len(content["rows"])
    assert (table[0]["generator"], table[-1]["generator"]) == ("gmm", "training")
    assert len(read_rows(study / "diversity/hull.parquet")) == 5
    assert len(read_rows(study / "diversity/hull_points.parquet")) == 20


def test_another_data_set_is_refused(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("dataset", "--seed", 2, "--out", tmp_path / "other") == 0
    made = ("--dataset", tmp_path / "other", "--embedding", study / "embedding")
    assert run("generate", *made, "--out", tmp_path / "generated") == 2
    assert "was made of another one." in capsys.readouterr().err
    assert not (tmp_path / "generated").exists()


def test_too_large_a_perplexity_is_refused(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ("--method", "tsne", "--perplexity", 41)
    assert run("embed", "--dataset", study / "dataset", *options, "--out", tmp_path / "e") == 2
    told = capsys.readouterr().err
    assert "perplexity = 41 must be at most a third of the number of designs, 120." in told


def test_without_a_data_set_it_is_made(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "mixed"
    assert run("generate", "-n", 5, "--mode", "mixed", "--out", out) == 0
    told = capsys.readouterr().out
    assert "No --dataset is given: 120 designs are drawn" in told
    assert "No --embedding is given: it is made by pca" in told
    assert {row["mode"] for row in read_rows(out / "designs.parquet")} == {"mixed"}
    made, known = (folder / "dataset/designs.parquet" for folder in (out, study))
    assert made.read_bytes() == known.read_bytes()


@pytest.mark.parametrize("method", ["random", "resample", "gmm_full"])
def test_generators_without_a_place_or_a_mixture(study: Path, tmp_path: Path, method: str) -> None:
    made = ("--dataset", study / "dataset", "--embedding", study / "embedding")
    assert run("generate", *made, "--generator", method, "--out", tmp_path / "g") == 0
    rows = read_rows(tmp_path / "g/designs.parquet")
    assert (rows[0]["z1"] is None) == (method != "resample")
    assert (rows[0]["component"] is None) == (method != "gmm_full")
    assert (tmp_path / "g/mixture.json").is_file() == (method == "gmm_full")
    assert all((row["novelty"] == 0) == (method == "resample") for row in rows)


def test_a_generator_without_places_is_compared_in_the_plane(study: Path, tmp_path: Path) -> None:
    made = ("--dataset", study / "dataset", "--embedding", study / "embedding")
    assert run("generate", *made, "--generator", "random", "--out", tmp_path / "g") == 0
    config = json.dumps(SMALL | {"generator": SMALL["generator"] | {"method": "random"}})
    out = ("--generated", tmp_path / "g", "--out", tmp_path / "d")
    assert main(["diversity", *map(str, (*made, *out)), "--config", config]) == 0
    found = read_record(tmp_path / "d").figures
    assert found["generator"] == "random"
    assert found["novelty_plane"]["random"] > 0
    assert found["mode_share"]["random"].keys() == {"bending", "twisting"}


def test_novelty_of_simulated_designs(study: Path, tmp_path: Path) -> None:
    """That of a training design is nothing; what is no vector of numbers has none."""
    row = read_rows(study / "dataset/designs.parquet")[0]
    design = {symbol: row[symbol] for symbol in PARAMETERS}
    thin = design | {"t_b": 0.1}
    for name, given in {"same": design, "thin": thin, "odd": thin | {"H": float("nan")}}.items():
        named = design_from(json.dumps({"name": name, **given}))
        write_text(tmp_path / name / DESIGN_NAME, named.as_json())
    folders = [tmp_path / name for name in ("same", "thin", "odd", "absent")]
    found = novelty_of(folders, study / "dataset")
    assert set(found) == {"same", "thin"}
    assert found["same"] == pytest.approx(0.0, abs=1e-12)
    assert found["thin"] > 0.1
