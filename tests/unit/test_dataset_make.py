import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pagd.catalogue import NamedDesign, read_designs
from pagd.dataset import INDEPENDENT, Dataset, designs_of, make_dataset, read_frame, write_frame
from pagd.design import GeometryRules, Limits, violations
from pagd.errors import InputError
from pagd.tables import DESIGNS, units

CONFIG = Path(__file__).parents[2] / "config"
TABLES = {
    "table2": str(CONFIG / "table2.csv"),
    "published": str(CONFIG / "published_designs.csv"),
}
KNOWN = list(read_designs(TABLES).values())
BENDING = next(n for n in KNOWN if n.name == "bending")


@pytest.fixture(scope="module")
def whole() -> Dataset:
    return make_dataset(published=KNOWN)


def test_the_paper_s_data_set(whole: Dataset) -> None:
    frame = whole.designs
    assert list(frame.columns) == [column.name for column in DESIGNS]
    assert len(frame) == 11_000
    assert not frame.duplicated(list(INDEPENDENT)).any()
    assert frame["mode"].value_counts().to_dict() == {"bending": 5500, "twisting": 5500}
    assert set(frame["alpha"]) == {0.0, 1.0}
    assert all(not violations(design, GeometryRules()) for design in designs_of(frame))


def test_counts_are_the_shares_asked(whole: Dataset) -> None:
    drawn_around = {"jitter": 275, "interpolation": 275}
    assert whole.report["counts"] == {
        "bending": {"random": 4946, "table2": 1, "published": 3, **drawn_around},
        "twisting": {"random": 4949, "table2": 1, **drawn_around},
    }
    counted = whole.designs.groupby(["mode", "origin"]).size()
    for mode, by_origin in whole.report["counts"].items():
        assert counted[mode].to_dict() == by_origin


def test_known_designs_are_rows_and_come_first(whole: Dataset) -> None:
    kept = [named for named in KNOWN if named.name != "mixed"]
    head = whole.designs.head(len(kept))
    assert designs_of(head) == [named.design for named in kept]
    assert list(head["origin"]) == [named.origin for named in kept]
    assert whole.report["left_out"] == {"mixed": "is mixed, which is no category of the data set"}


def test_order_and_ids_are_fixed(whole: Dataset) -> None:
    frame = whole.designs
    assert list(frame["design_id"][[0, 10_999]]) == ["d00001", "d11000"]
    rest = frame.iloc[5:]
    blocks = list(dict.fromkeys(zip(rest["mode"], rest["origin"], strict=True)))
    parts = ("random", "jitter", "interpolation")
    assert blocks == [(mode, part) for mode in ("bending", "twisting") for part in parts]
    changes = (rest[["mode", "origin"]] != rest[["mode", "origin"]].shift()).any(axis=1)
    assert changes.sum() == len(blocks)  # each is one block


def test_the_report_accounts_for_every_draw(whole: Dataset) -> None:
    report = json.loads(json.dumps(whole.report))
    for mode, by_origin in report["drawn"].items():
        for origin, drawn in by_origin.items():
            kept = report["counts"][mode][origin]
            rejected = report["rejected"][mode][origin]
            duplicates = report["duplicates"][mode][origin]
            assert report["acceptance"][mode][origin] == kept / drawn
            assert max(rejected.values(), default=0) <= drawn - kept - duplicates
            assert drawn - kept - duplicates <= sum(rejected.values())
    assert (report["size"], report["seed"], report["sampling"]) == (11_000, 1, "random")
    assert report["notes"] == []


def test_equal_seeds_are_equal_bytes_and_others_are_not(tmp_path: Path) -> None:
    for name, seed in (("a", 7), ("b", 7), ("c", 8)):
        write_frame(tmp_path / name, make_dataset(300, published=KNOWN, seed=seed).designs)
    a, b, c = ((tmp_path / name).read_bytes() for name in "abc")
    assert a == b != c
    assert units(tmp_path / "a")["theta"] == "deg"
    again = make_dataset(300, published=KNOWN, seed=7).designs
    assert read_frame(tmp_path / "a").equals(again)


def rows(dataset: Dataset, mode: str, origin: str) -> list[Any]:
    frame = dataset.designs
    return designs_of(frame[(frame["mode"] == mode) & (frame["origin"] == origin)])


def test_the_size_of_one_part_changes_no_other() -> None:
    one = make_dataset(400, published=KNOWN)
    other = make_dataset(400, published=KNOWN, augmented_share=0.3, interpolated_share=0.2)
    for mode in ("bending", "twisting"):
        for part in ("random", "jitter", "interpolation"):
            a, b = rows(one, mode, part), rows(other, mode, part)
            assert len(a) != len(b)
            assert all(x == y for x, y in zip(a, b, strict=False))
    assert rows(one, "bending", "random")[0].L != rows(one, "twisting", "random")[0].L


@pytest.mark.parametrize("sampling", ["sobol", "latin_hypercube"])
def test_other_samplings(sampling: Any) -> None:
    dataset = make_dataset(200, published=KNOWN, sampling=sampling)
    assert len(dataset.designs.drop_duplicates(list(INDEPENDENT))) == 200
    assert dataset.report["sampling"] == sampling
    plain = make_dataset(200, published=KNOWN)
    assert rows(dataset, "bending", "jitter") == rows(plain, "bending", "jitter")
    assert rows(dataset, "bending", "random") != rows(plain, "bending", "random")


@pytest.mark.parametrize(
    ("given", "counts"),
    [
        ({"twisting_share": 0.3}, {"bending": 70, "twisting": 30}),
        ({"twisting_share": 1.0}, {"twisting": 100}),
        ({"twisting_share": 0.0}, {"bending": 100}),
        ({"augmented_share": 0.0}, {"table2": 2, "published": 3, "random": 95}),
        (
            {"augmented_share": 1.0, "interpolated_share": 1.0},
            {"table2": 2, "published": 3, "interpolation": 95},
        ),
        (
            {"augmented_share": 0.5, "interpolated_share": 0.0},
            {"table2": 2, "published": 3, "random": 45, "jitter": 50},
        ),
    ],
)
def test_shares(given: Mapping[str, Any], counts: dict[str, int]) -> None:
    frame = make_dataset(100, published=KNOWN, **given).designs
    key = "mode" if "twisting_share" in given else "origin"
    assert frame[key].value_counts().to_dict() == counts


def test_without_known_designs_all_are_random_and_the_report_says_so() -> None:
    dataset = make_dataset(100, published=())
    assert dataset.report["counts"] == {"bending": {"random": 50}, "twisting": {"random": 50}}
    assert len(dataset.report["notes"]) == 2
    assert make_dataset(100, published=(), augmented_share=0).report["notes"] == []
    partly = make_dataset(100, published=[BENDING])
    assert partly.report["notes"] == [
        "No known design is a twisting one, so that all twisting designs are sampled at random."
    ]
    assert partly.report["counts"]["bending"] == {
        "table2": 1,
        "random": 44,
        "jitter": 2,
        "interpolation": 3,
    }
    assert partly.report["counts"]["twisting"] == {"random": 50}


def test_what_has_no_effect_is_set_as_in_the_rest_of_the_category() -> None:
    idle_slant = replace(BENDING, name="a", design=replace(BENDING.design, theta=20.0))
    nearly_all = replace(BENDING, name="b", design=replace(BENDING.design, theta=20.0, alpha=0.97))
    frame = make_dataset(100, published=[idle_slant, nearly_all]).designs
    assert list(frame["mode"][:2]) == ["bending", "twisting"]
    assert list(frame["theta"][:2]) == [0, 20]
    assert list(frame["alpha"][:2]) == [0, 1]


def test_known_designs_that_do_not_fit_are_left_out_with_the_reason() -> None:
    again = replace(BENDING, name="again")
    thin = replace(BENDING, name="thin", design=replace(BENDING.design, t_b=0.5))
    report = make_dataset(100, published=[BENDING, again, thin]).report
    assert report["left_out"]["again"] == "is the same design as bending"
    assert report["left_out"]["thin"].startswith("t_b = 0.5: the base must be at least 0.75 mm")
    assert report["counts"]["bending"]["table2"] == 1
    report = make_dataset(100, published=[BENDING], twisting_share=1.0).report
    assert report["left_out"] == {"bending": "the data set has no bending designs"}


def test_the_rules_are_those_given() -> None:
    rules = GeometryRules(limits=Limits(cavity=4.0, theta_deg=30.0))
    frame = make_dataset(200, published=KNOWN, rules=rules).designs
    assert frame["theta"].max() <= 30
    assert ((frame["W"] - 2 * frame["t"]) >= 4).all()
    cosines = np.cos(np.radians(frame["theta"]))
    assert (frame["L"] * cosines - 2 * frame["t_ab"] >= 4 - 1e-9).all()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"size": 0}, r"dataset\.size = 0 must be a whole number of at least 1"),
        ({"size": "x"}, r"dataset\.size = 'x' must be a number\.$"),
        ({"seed": None}, r"dataset\.seed = None must be a number\.$"),
        ({"jitter": "0.1"}, r"dataset\.jitter = '0\.1' must be a number\.$"),
        ({"twisting_share": True}, r"dataset\.twisting_share = True must be a number\.$"),
        ({"size": 10.5}, r"dataset\.size = 10\.5 must be a whole number"),
        ({"seed": -1}, r"dataset\.seed = -1 must be a whole number of at least 0"),
        ({"jitter": 0.0}, r"dataset\.jitter = 0\.0 must be a finite number greater than 0"),
        ({"jitter": float("nan")}, r"dataset\.jitter = nan must be a finite"),
        ({"twisting_share": 1.2}, r"dataset\.twisting_share = 1\.2 must lie between 0 and 1"),
        ({"augmented_share": -0.1}, r"dataset\.augmented_share = -0\.1 must lie"),
        ({"interpolated_share": float("nan")}, r"dataset\.interpolated_share = nan must lie"),
        ({"sampling": "halton"}, r"dataset\.sampling = 'halton' must be one of random, sobol"),
        ({"size": 6}, r"dataset\.size .* room for 3 bending designs, .* at least the 4"),
    ],
)
def test_what_cannot_be_is_refused(given: dict[str, Any], words: str) -> None:
    arguments: dict[str, Any] = {"size": 500, "published": KNOWN} | given
    with pytest.raises(InputError, match=words):
        make_dataset(**arguments)


def test_known_designs_come_with_pagd(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever is in the current folder."""
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "table2.csv").write_text("name\n")
    monkeypatch.chdir(tmp_path)
    dataset = make_dataset(100)
    assert dataset.designs.equals(make_dataset(100, published=KNOWN).designs)
    assert set(dataset.designs["origin"]) >= {"table2", "published", "jitter", "interpolation"}


@pytest.mark.parametrize(("share", "absent"), [(0.0, "twisting"), (1.0, "bending")])
def test_no_note_on_a_category_that_is_not_wanted(share: float, absent: str) -> None:
    dataset = make_dataset(50, twisting_share=share)
    assert absent not in set(dataset.designs["mode"])
    assert dataset.report["notes"] == []


def test_whole_numbers_may_come_as_floats() -> None:
    size: Any = 1e2
    report = make_dataset(size, seed=2).report
    assert json.dumps([report["size"], report["seed"]]) == "[100, 2]"


def test_a_generated_table_serves_as_known_designs(tmp_path: Path) -> None:
    write_frame(tmp_path / "d.parquet", make_dataset(20, published=(), seed=3).designs)
    known: list[NamedDesign] = list(read_designs({"own": str(tmp_path / "d.parquet")}).values())
    frame = make_dataset(100, published=known).designs
    assert designs_of(frame.head(20)) == [named.design for named in known]
