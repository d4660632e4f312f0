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
    "embedding": {"method": "pca", "dimensions": 2},
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


def test_all_principal_components_have_an_exact_way_back(study: Path, tmp_path: Path) -> None:
    """The default of pca, from the embedding to the selection."""
    data, plane, new = study / "dataset", tmp_path / "embedding", tmp_path / "generated"
    config = ("--config", json.dumps(SMALL | {"embedding": {"method": "pca"}}))
    made = ("--dataset", data, "--embedding", plane)
    steps: tuple[tuple[object, ...], ...] = (
        ("embed", "--dataset", data, "--out", plane),
        ("generate", *made, "--out", new),
        ("diversity", *made, "--generated", new, "--out", tmp_path / "diversity"),
        ("select", "--dataset", data, "--generated", new, "--out", tmp_path / "selection"),
    )
    for step in steps:
        assert main([*map(str, step), *config]) == 0
    figures = read_record(plane).figures
    assert figures["dimensions"] > 10
    assert figures["round_trip_error"] == 0
    assert read_record(new).figures["designs"] == 30


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


@pytest.mark.parametrize("command", ["select", "diversity"])
def test_generated_designs_must_be_those_of_the_data_set(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], command: str
) -> None:
    """Neither those of another data set nor the folder of another stage."""
    data, other = study / "dataset", tmp_path / "other"
    assert run("dataset", "--seed", 2, "--out", other) == 0
    assert run("embed", "--dataset", other, "--out", tmp_path / "embedding") == 0
    for dataset, plane, generated, words in (
        (other, tmp_path / "embedding", study / "generated", "but was made of another one."),
        (data, study / "embedding", data, "but is one of the stage dataset."),
    ):
        made = ("--dataset", dataset, "--generated", generated, "--out", tmp_path / "out")
        more = ("--embedding", plane) if command == "diversity" else ()
        assert run(command, *made, *more) == 2
        told = capsys.readouterr().err
        assert f"pagd: generated = {generated} must be " in told
        assert words in told
        assert not (tmp_path / "out").exists()


def test_designs_are_compared_in_the_plane_they_were_drawn_in(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data, other = study / "dataset", tmp_path / "other"
    wider = json.dumps({"embedding": {"method": "pca", "dimensions": 3}})
    embed = ("embed", "--dataset", data, "--out", other, "--config", wider)
    assert main([*map(str, embed)]) == 0
    made = ("--dataset", data, "--embedding", other, "--generated", study / "generated")
    assert run("diversity", *made, "--out", tmp_path / "out") == 2
    assert "must be drawn in the embedding" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_an_embedding_is_the_folder_of_its_stage(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = ("--dataset", study / "dataset", "--embedding", study / "generated")
    assert run("generate", *made, "--out", tmp_path / "g") == 2
    assert "but is one of the stage generate." in capsys.readouterr().err


@pytest.mark.parametrize("absent", ["dataset", "embedding", "generated"])
def test_folders_that_are_not_there(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], absent: str
) -> None:
    folders = {name: study / name for name in ("dataset", "embedding", "generated")}
    folders[absent] = tmp_path / "nope"
    given = [word for name, folder in folders.items() for word in (f"--{name}", folder)]
    assert run("diversity", *given, "--out", tmp_path / "out") == 2
    assert capsys.readouterr().err == f"pagd: {tmp_path / 'nope'}: there is no such folder.\n"
    folders[absent].mkdir()
    assert run("diversity", *given, "--out", tmp_path / "out") == 2
    assert capsys.readouterr().err.endswith(": there is no such file.\n")


def test_the_modes_of_a_selection_are_told_in_order(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = ("--dataset", study / "dataset", "--generated", study / "generated")
    for count, words in (
        (5, "5 of 30 designs (2 bending, 2 twisting, 1 mixed) in "),
        (3, "3 of 30 designs (1 bending, 1 twisting, 1 mixed) in "),
        (0, "0 of 30 designs in "),
    ):
        assert run("select", *made, "-n", count, "--out", tmp_path / "s") == 0
        assert capsys.readouterr().out.startswith(words)


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
    assert run("diversity", *made, "--generated", tmp_path / "g", "--out", tmp_path / "d") == 0
    found = read_record(tmp_path / "d").figures
    assert found["novelty_plane"]["random"] > 0
    assert found["novelty_plane_sample"]["random"] > 0
    assert found["mode_share"]["random"].keys() == {"bending", "twisting"}


def test_the_comparison_goes_by_what_made_the_designs(study: Path, tmp_path: Path) -> None:
    """Method, parameters and limits are those of the record, not of the configuration given."""
    made = ("--dataset", study / "dataset", "--embedding", study / "embedding")
    given = {"method": "gmm_full", "components": 4, "seed": 5, "designs": 20}
    config = json.dumps(SMALL | {"generator": given, "limits": {"theta_deg": 40.0}})
    first = ("generate", *made, "--out", tmp_path / "g", "--config", config)
    assert main([str(word) for word in first]) == 0
    assert run("diversity", *made, "--generated", tmp_path / "g", "--out", tmp_path / "d") == 0
    record, by = read_record(tmp_path / "d"), read_record(tmp_path / "g").configuration
    assert {key: record.configuration[key] for key in by if key != "mode"} == {
        key: value for key, value in by.items() if key != "mode"
    }
    assert record.figures["generator"] == "gmm_full"
    assert record.figures["reports"].keys() == {"gmm", "gmm_plain", "kde", "random", "resample"}
    assert {report["designs"] for report in record.figures["reports"].values()} == {20}
    table = read_rows(tmp_path / "d/comparison.parquet")
    assert table[0]["generator"] == "gmm_full"
    assert {row["generator"] for row in table if row["space"] == "plane_sample"} >= {"gmm_full"}


def test_the_plane_of_a_few_designs_has_room_for_the_mixture(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = ("--dataset", study / "dataset", "--embedding", study / "embedding")
    config = json.dumps({"generator": {"components": 41, "designs": 5, "largest_components": 2}})
    first = ("generate", *made, "--out", tmp_path / "g", "--config", config)
    assert main([str(word) for word in first]) == 0
    assert run("diversity", *made, "--generated", tmp_path / "g", "--out", tmp_path / "d") == 2
    told = capsys.readouterr().err
    assert "diversity.plane_designs = 40 must be at least generator.components = 41, " in told


def test_designs_of_one_mode_alone_are_not_compared(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = ("--dataset", study / "dataset", "--embedding", study / "embedding")
    assert run("generate", *made, "-n", 5, "--mode", "mixed", "--out", tmp_path / "g") == 0
    assert run("diversity", *made, "--generated", tmp_path / "g", "--out", tmp_path / "d") == 2
    assert "but has only those of mode = mixed." in capsys.readouterr().err


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
