import json

import numpy as np
import pytest

from pagd.dataset.frame import completed
from pagd.dataset.make import make_dataset
from pagd.diversity import (
    METRICS,
    SPACES,
    Candidate,
    Comparison,
    Settings,
    compare,
    hull_corners,
    places_of_mode,
)
from pagd.encoding import Encoder
from pagd.errors import InputError

SETTINGS = Settings(hull_designs=20, hull_repeats=15, sample=100, components=3)
NAMES = ["bending", "twisting"]


def _designs(seed: int, count: int, width: float = 1.0, plane: bool = True) -> Candidate:
    rng = np.random.default_rng(seed)
    vectors = width * rng.uniform(-1, 1, size=(count, 5))
    modes = np.array(NAMES)[(vectors[:, 0] > 0).astype(int)]
    return Candidate(encoded=vectors, modes=modes, plane=10 * vectors[:, :2] if plane else None)


TRAINING = _designs(1, 600)


def _compare(seed: int = 1, **candidates: Candidate) -> Comparison:
    return compare(candidates, TRAINING, SETTINGS, seed, mode_places=[0])


def test_copies_narrow_and_wide_designs_are_told_apart() -> None:
    copies = Candidate(
        encoded=TRAINING.encoded[:150], modes=TRAINING.modes[:150], plane=TRAINING.plane[:150]
    )
    found = _compare(copies=copies, narrow=_designs(2, 150, 0.3), wide=_designs(3, 150, 2.0))
    for space in ("plane", "encoded"):
        value = {
            (name, metric): found.row(name, metric, space)["value"]
            for name in ("training", "copies", "narrow", "wide")
            for metric in METRICS
            if metric != "mode_part"
        }
        assert value["copies", "novelty"] == 0.0
        assert value["wide", "novelty"] > value["training", "novelty"]
        assert value["narrow", "hull_ratio"] < 0.5 < 1.5 < value["wide", "hull_ratio"]
        assert value["training", "hull_ratio"] == pytest.approx(1.0, abs=0.15)
        for metric in ("mean_pairwise_distance", "dpp", "hull_size"):
            assert value["narrow", metric] < value["copies", metric] < value["wide", metric]
        assert value["narrow", "coverage"] < 0.8 < value["training", "coverage"]
        assert value["narrow", "mmd"] > 0.05 > abs(value["training", "mmd"])


def test_rows_are_whole_and_of_known_names() -> None:
    found = _compare(new=_designs(2, 150), no_plane=_designs(3, 150, plane=False))
    keys = {"generator", "space", "mode", "metric", "value", "low", "high", "count"}
    assert {frozenset(row) for row in found.rows} == {frozenset(keys)}
    assert {row["metric"] for row in found.rows} == set(METRICS)
    assert {row["space"] for row in found.rows} < set(SPACES)
    assert {row["mode"] for row in found.rows} == {"all", *NAMES}
    spaces = {(row["generator"], row["space"]) for row in found.rows}
    assert ("new", "plane") in spaces
    assert ("no_plane", "plane") not in spaces
    places = [tuple(row[k] for k in ("generator", "space", "mode", "metric")) for row in found.rows]
    assert len(set(places)) == len(places)
    for row in found.rows:
        assert row["low"] is None or row["low"] <= row["value"] <= row["high"]


def test_novelty_by_mode_and_the_part_of_the_mode_by_hand() -> None:
    # All training designs of either mode are alike but for the second place; mixed designs lie
    # between the modes, 0.5 from both in the first place and nothing in the others.
    first = np.repeat([0.0, 1.0], 20)
    training = Candidate(
        encoded=np.column_stack([first, np.tile(np.arange(20.0), 2)]), modes=np.repeat(NAMES, 20)
    )
    vectors = np.column_stack([np.repeat([0.5, 0.0], 10), np.tile(np.arange(10.0), 2)])
    vectors[10:, 1] += 0.25
    new = Candidate(encoded=vectors, modes=np.repeat(["mixed", "bending"], 10))
    found = compare({"new": new}, training, SETTINGS, mode_places=[0])
    assert found.row("new", "novelty", mode="mixed")["value"] == pytest.approx(0.5)
    assert found.row("new", "novelty", mode="bending")["value"] == pytest.approx(0.25)
    assert found.row("new", "novelty")["value"] == pytest.approx(0.375)
    assert found.row("new", "novelty", mode="mixed")["count"] == 10
    assert found.row("new", "mode_part", mode="mixed")["value"] == pytest.approx(1.0)
    assert found.row("new", "mode_part", mode="bending")["value"] == pytest.approx(0.0)
    assert found.row("new", "mode_part")["value"] == pytest.approx(0.25 / (0.25 + 0.0625))
    with pytest.raises(KeyError, match="plane"):
        found.row("new", "novelty", "plane")


def test_interval_of_a_mean_is_two_standard_errors_wide() -> None:
    found = _compare(new=_designs(2, 150))
    row = found.row("new", "novelty")
    distances = np.array(
        [np.linalg.norm(TRAINING.encoded - v, axis=1).min() for v in _designs(2, 150).encoded]
    )
    assert row["value"] == pytest.approx(distances.mean())
    error = distances.std(ddof=1) / np.sqrt(150)
    assert row["high"] - row["value"] == pytest.approx(1.96 * error)


def test_equal_seeds_give_equal_numbers_and_others_do_not() -> None:
    first, again, other = (_compare(seed, new=_designs(2, 150)) for seed in (1, 1, 2))
    assert json.dumps(first.as_dict()) == json.dumps(again.as_dict())
    assert first.rows != other.rows


def test_figures_of_a_generator_do_not_hang_on_the_others() -> None:
    alone = _compare(new=_designs(2, 150))
    beside = _compare(more=_designs(3, 400), new=_designs(2, 150))
    assert [row for row in beside.rows if row["generator"] != "more"] == alone.rows


def test_counts_are_those_of_the_smallest() -> None:
    found = compare({"few": _designs(2, 12), "many": _designs(3, 500)}, TRAINING, SETTINGS)
    assert found.facts["sample"] == 12
    assert found.row("many", "hull_ratio")["count"] == 12
    assert found.row("many", "coverage")["count"] == 12
    assert found.row("many", "novelty")["count"] == 500


def test_hull_points_are_those_of_the_first_sets() -> None:
    found = _compare(new=_designs(2, 150))
    rows = [row for row in found.hull_points() if row["set"] == "generated"]
    points = np.array([[row["z1"], row["z2"]] for row in rows])
    corners = sorted((row["corner"], i) for i, row in enumerate(rows) if row["corner"] is not None)
    assert len(found.hull_points()) == 2 * SETTINGS.hull_designs
    np.testing.assert_array_equal([i for _, i in corners], hull_corners(points))
    areas = found.hull_areas()
    assert len(areas) == SETTINGS.hull_repeats
    assert areas[0]["generated"] == found.hulls["new"].generated_sizes[0]


def test_too_few_designs_are_refused_with_the_key() -> None:
    with pytest.raises(InputError, match=r"diversity\.neighbours = 5: .* 4 \(few\)"):
        compare({"few": _designs(2, 4)}, TRAINING, SETTINGS)
    with pytest.raises(InputError, match="half of the training designs"):
        compare({"many": _designs(2, 90)}, _designs(1, 8), SETTINGS)


def test_misuse_is_refused() -> None:
    with pytest.raises(ValueError, match="yardstick"):
        compare({"training": TRAINING}, TRAINING)
    with pytest.raises(ValueError, match="length"):
        Candidate(encoded=np.zeros((3, 2)), modes=["bending"])


def test_what_is_not_a_number_is_null_in_the_file() -> None:
    same = Candidate(encoded=np.zeros((30, 5)), modes=["bending"] * 30)
    found = _compare(same=same)
    assert found.row("same", "unevenness")["value"] is None
    json.dumps(found.as_dict(), allow_nan=False)


def test_resampled_designs_are_among_those_they_are_compared_with() -> None:
    """As the descriptions say: they look more faithful than training designs held out."""
    settings = Settings(hull_designs=20, hull_repeats=2, sample=300, components=3)
    found = compare({"resample": TRAINING}, TRAINING, settings, 1)
    for metric in ("density", "coverage"):
        value = {name: found.row(name, metric)["value"] for name in ("resample", "training")}
        assert value["resample"] > value["training"]
        assert "Resampled designs" in METRICS[metric].description


def test_places_of_mode_in_encoded_designs() -> None:
    designs = make_dataset(40, seed=1).designs
    names = Encoder().fit(designs).get_feature_names_out()
    assert {names[place] for place in places_of_mode(names)} == {
        *("alpha", "N1", "N2", "mode_bending", "mode_twisting")
    }


def test_mixed_designs_are_far_from_training_designs_by_their_mode() -> None:
    designs = make_dataset(200, seed=1).designs
    twisting = designs[designs["mode"] == "twisting"]
    half = twisting.assign(alpha=0.5)
    mixed = completed(half, half["design_id"], "generated")
    encoder = Encoder().fit(designs)
    training, new = (
        Candidate(encoded=encoder.transform(frame), modes=frame["mode"].to_numpy())
        for frame in (designs, mixed)
    )
    places = places_of_mode(encoder.get_feature_names_out())
    found = compare({"half": new}, training, SETTINGS, mode_places=places)
    assert set(new.modes) == {"mixed"}
    assert found.row("half", "mode_part")["value"] > 0.3
    assert found.row("training", "mode_part")["value"] < 0.1
    assert found.row("half", "novelty")["value"] > 1.0
