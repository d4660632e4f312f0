"""One contract for all generators, and what is special to each."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import pandas as pd
import pytest
from design_samples import plane, training
from scipy.spatial import KDTree

from pagd.dataset.frame import DEPENDENT, INDEPENDENT, designs_of
from pagd.design import GeometryRules, Limits, violations
from pagd.errors import InputError
from pagd.generators import GENERATORS, Generated, Generator, generate, make_generator
from pagd.generators.baselines import Resampling

SECTION = {"components": 3, "largest_components": 4, "bridge_share": 1 / 3, "bandwidth": None}
RULES = GeometryRules()
COUNT = 120


def made(method: str, **changes: object) -> Generator:
    return make_generator(SECTION | {"method": method} | changes, RULES).fit(plane(), seed=1)


def drawn(generator: Generator, seed: int = 1, **options: object) -> Generated:
    return generate(generator, COUNT, training=training(), rules=RULES, seed=seed, **options)


@pytest.fixture(scope="module", params=GENERATORS)
def generator(request: pytest.FixtureRequest) -> Generator:
    return made(request.param)


@pytest.fixture(scope="module")
def generated(generator: Generator) -> Generated:
    return drawn(generator)


def test_as_many_designs_as_asked_for(generated: Generated, generator: Generator) -> None:
    assert len(generated.designs) == generated.report["designs"] == COUNT
    assert generated.designs["design_id"].is_unique
    assert set(generated.designs["origin"]) == {"generated"}
    assert generator.name in GENERATORS


def test_all_are_valid_and_none_is_there_twice(generated: Generated) -> None:
    designs = designs_of(generated.designs)
    assert len(set(designs)) == COUNT
    assert not any(violations(design, RULES) for design in designs)


def test_none_is_a_copy_of_a_training_design(generated: Generated, generator: Generator) -> None:
    copies = set(designs_of(generated.designs)) & set(designs_of(training()))
    assert len(copies) == (COUNT if generator.copies_training else 0)


def test_dependent_parameters_follow_from_the_others(generated: Generated) -> None:
    for design, (_, row) in zip(
        designs_of(generated.designs), generated.designs.iterrows(), strict=True
    ):
        assert tuple(row[list(DEPENDENT)]) == (design.L_T, design.N1, design.N2)
        assert row["mode"] == design.mode


def test_the_same_seed_gives_the_same_designs(generator: Generator, generated: Generated) -> None:
    pd.testing.assert_frame_equal(drawn(generator).designs, generated.designs)
    other = drawn(generator, seed=2)
    assert designs_of(other.designs) != designs_of(generated.designs)


def test_places_and_gaussians_belong_to_the_designs(
    generated: Generated, generator: Generator
) -> None:
    if generated.components is not None:
        assert set(generated.components) <= {0, 1, 2}
        assert len(generated.components) == COUNT
    if generated.points is not None:
        assert generated.points.shape == (COUNT, 2)
        decoded = plane().decode(generated.points).parameters
        assert designs_of(decoded) == designs_of(generated.designs)


def test_none_is_next_to_a_training_design(generator: Generator, generated: Generated) -> None:
    encoder = plane().encoder
    tree = KDTree(encoder.transform(training()))
    usual = tree.query(encoder.transform(generated.designs))[0]
    least = float(np.median(usual))
    found = drawn(generator, least_novelty=least)
    distances = tree.query(encoder.transform(found.designs))[0]
    if generator.copies_training:
        assert distances.max() < 1e-9
    else:
        assert distances.min() >= least
        assert found.report["refused"]["copies_of_training"] > 0


def test_an_exact_copy_is_refused_without_any_least_novelty() -> None:
    class Copying(Resampling):
        copies_training = False

    with pytest.raises(InputError, match=r"but gave 0 in .* are copies of training designs\.$"):
        drawn(Copying().fit(plane()), least_novelty=0.0)


def test_corrections_are_those_of_designs_that_were_looked_at(generator: Generator) -> None:
    few, many = (
        generate(generator, n, training=training(), rules=RULES).report for n in (3, COUNT)
    )
    assert all(count <= few["proposed"] for count in few["corrections"].values())
    assert sum(few["corrections"].values()) <= sum(many["corrections"].values())
    assert few["redrawn_by_generator"] <= many["redrawn_by_generator"]


def test_limits_of_the_full_space_are_counted() -> None:
    assert drawn(made("gmm_full")).report["corrections"]["N"] > 0


def test_the_report_adds_up(generated: Generated) -> None:
    report = generated.report
    assert report["proposed"] == COUNT + sum(report["refused"].values())
    assert sum(report["mode_share"].values()) == pytest.approx(1)
    shares = generated.designs["mode"].value_counts(normalize=True)
    assert report["mode_share"]["twisting"] == pytest.approx(shares["twisting"])


def test_invalid_proposals_are_refused_and_counted(generator: Generator) -> None:
    rules = GeometryRules(limits=Limits(thickness=1.5))
    found = generate(generator, 40, training=training(), rules=rules, seed=1)
    assert min(found.designs[["t", "t_h", "t_ab", "t_b"]].min()) >= 1.5
    if generator.name != "random":  # which draws valid ones only
        assert found.report["refused"]["invalid"] > 0
        assert set(found.report["refused_by_parameter"]) <= {
            "t",
            "t_h",
            "t_ab",
            "t_b",
            "channel.roof",
        }


def test_a_mode_can_be_asked_for(generator: Generator) -> None:
    found = drawn(generator, mode="twisting")
    assert set(found.designs["mode"]) == {"twisting"}
    assert found.report["refused"]["other_mode"] > 0


@pytest.mark.parametrize("method", ["gmm", "gmm_full"])
def test_the_bridge_gives_the_mixed_mode(method: str) -> None:
    share = drawn(made(method)).report["mode_share"]
    assert share["mixed"] >= 0.1
    assert min(share.values()) >= 0.1


def test_mixed_designs_come_from_the_bridge() -> None:
    generator = made("gmm")
    found = drawn(generator)
    mixed = (found.designs["mode"] == "mixed").to_numpy()
    assert found.components is not None
    # A few come from the shores of the two islands, none of the bridge's is of one category.
    assert np.mean(found.components[mixed] == 2) > 0.8
    assert not (found.components[~mixed] == 2).any()
    assert found.report["redrawn_by_generator"] > 0
    assert found.designs.loc[mixed, "alpha"].nunique() > 5


@pytest.mark.parametrize("method", ["random", "resample"])
def test_baselines_have_the_two_modes_of_the_data_set(method: str) -> None:
    assert drawn(made(method)).report["mode_share"]["mixed"] == 0


def test_without_the_bridge_hardly_any_design_is_mixed() -> None:
    assert drawn(made("gmm_plain")).report["mode_share"]["mixed"] < 0.1


def test_a_bridge_without_a_gap_is_told() -> None:
    """Where alpha makes no difference between the islands, nothing lies between them."""

    class OneKind(type(plane())):  # type: ignore[misc]
        def decode(self, points: np.ndarray) -> object:
            found = super().decode(points)
            return dataclasses.replace(found, parameters=found.parameters.assign(alpha=1.0))

    one_kind = OneKind(perplexity=15).restore(training(), plane().points)
    generator = make_generator(SECTION | {"method": "gmm"}, RULES).fit(one_kind)
    with pytest.raises(InputError, match=r"^generator.bridge_share = 0\.333333 must be 0 for"):
        drawn(generator)


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        ({"components": 0}, "generator.components = 0 must be at least 1, or bic."),
        ({"components": 500}, "generator.components = 500 must be at most the number of training"),
        ({"bridge_share": 2.0}, "generator.bridge_share = 2.0 must be at least 0 and less than 1."),
    ],
)
def test_a_mixture_that_cannot_be_is_refused(fault: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=re.escape(sentence)):
        made("gmm", **fault)


def test_what_is_asked_for_must_make_sense() -> None:
    with pytest.raises(InputError, match=r"^generator.designs = 0 must be at least 1\.$"):
        generate(made("random"), 0, training=training())
    with pytest.raises(InputError, match=r"^mode = 'bent' must be one of bending, twisting, mix"):
        drawn(made("random"), mode="bent")


def test_what_cannot_be_had_is_told_in_one_sentence() -> None:
    with pytest.raises(InputError, match=r"^generator.method = resample must give 120 mixed des"):
        drawn(made("resample"), mode="mixed")


def test_more_copies_than_there_are_is_told() -> None:
    with pytest.raises(InputError, match=r"but gave 240 in .* are there already\.$"):
        generate(made("resample"), 241, training=training(), rules=RULES)


def test_random_designs_lie_in_the_sampling_box() -> None:
    from pagd.design import PARAMETERS

    designs = drawn(made("random")).designs
    for symbol in INDEPENDENT[:9]:
        assert designs[symbol].between(PARAMETERS[symbol].low, PARAMETERS[symbol].high).all()


def test_the_number_of_gaussians_by_criterion() -> None:
    generator = made("gmm", components="bic")
    best = min(generator.bic, key=generator.bic.get)
    assert len(generator.mixture.weights) == best + 1
    assert list(generator.bic) == [1, 2, 3, 4]


def test_a_wider_kernel_strays_farther() -> None:
    tree = KDTree(plane().points)
    near, far = (tree.query(drawn(made("kde", bandwidth=h)).points)[0].mean() for h in (0.1, 2.0))
    assert far > 3 * near
