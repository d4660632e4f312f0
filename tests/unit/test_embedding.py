"""Contract of all embeddings, and what is special to each."""

from __future__ import annotations

import numpy as np
import pytest
from design_samples import TABLE2_MIXED, plane, training

from pagd.dataset.frame import designs_of, frame_of
from pagd.design import GeometryRules, violations
from pagd.embedding import EMBEDDINGS, Embedding, make_embedding
from pagd.embedding.decoder import NeighbourDecoder
from pagd.embedding.linear import PrincipalComponents
from pagd.embedding.quality import quality_of
from pagd.embedding.tsne import TSNE
from pagd.errors import InputError

SECTION = {"perplexity": 15.0, "neighbours": 5, "dimensions": None}


def made(method: str) -> Embedding:
    return make_embedding(SECTION | {"method": method}, threads=1)


@pytest.fixture(scope="module", params=EMBEDDINGS)
def embedding(request: pytest.FixtureRequest) -> Embedding:
    if request.param == "tsne":
        return plane()
    return made(request.param).fit(training())


def test_every_training_design_has_a_place(embedding: Embedding) -> None:
    assert embedding.designs is training()
    assert embedding.points.shape[0] == len(training())
    assert np.isfinite(embedding.points).all()
    assert EMBEDDINGS.keys() >= {embedding.name}


def test_the_place_of_a_training_design_decodes_to_it(embedding: Embedding) -> None:
    decoded = embedding.decode(embedding.points)
    assert designs_of(decoded.parameters) == designs_of(training())
    assert decoded.corrections == {}


def test_new_designs_have_places_too(embedding: Embedding) -> None:
    new = frame_of([TABLE2_MIXED, *designs_of(training())[:3]], "abcd", "own")
    points = embedding.transform(new)
    assert points.shape == (4, embedding.points.shape[1])
    gaps = np.linalg.norm(points[1:] - embedding.points[:3], axis=1)
    spread = np.linalg.norm(embedding.points.std(axis=0))
    assert gaps.max() < 0.3 * spread
    np.testing.assert_array_equal(points, embedding.transform(new))


def test_the_same_seed_gives_the_same_points(embedding: Embedding) -> None:
    again = made(embedding.name).fit(training(), seed=3)
    np.testing.assert_array_equal(again.points, embedding.points)


def test_points_of_an_earlier_fit_are_taken_up(embedding: Embedding) -> None:
    again = made(embedding.name)
    again.restore(training(), embedding.points)
    somewhere = embedding.points[:20] + 0.3
    left, right = (e.decode(somewhere).parameters for e in (embedding, again))
    assert designs_of(left) == designs_of(right)
    new = frame_of([TABLE2_MIXED], ["m"], "own")
    np.testing.assert_allclose(again.transform(new), embedding.transform(new), rtol=1e-9)


def test_what_is_decoded_anywhere_has_whole_chambers_and_limits(embedding: Embedding) -> None:
    rng = np.random.default_rng(2)
    spread = 2 * embedding.points.std(axis=0)
    somewhere = embedding.points.mean(axis=0) + spread * rng.standard_normal(
        (300, embedding.points.shape[1])
    )
    decoded = embedding.decode(somewhere).parameters
    for design in designs_of(decoded):
        assert abs(design.alpha * design.N - design.N1) < 1e-3
        assert (design.theta > 0) == (design.N1 > 0)
    low, high = training()["L"].min(), training()["L"].max()
    assert decoded["L"].between(low, high).all()


def test_principal_components_can_be_fewer() -> None:
    embedding = PrincipalComponents(2).fit(training())
    assert embedding.points.shape == (240, 2)
    quality = quality_of(embedding)
    assert quality.round_trip_error > 0.3
    assert quality.trustworthiness < 0.999


def test_the_plane_keeps_neighbours_and_splits_the_categories() -> None:
    embedding = plane()
    quality = quality_of(embedding)
    assert quality.trustworthiness > 0.8
    assert quality.round_trip_error == 0.0
    # Better than the mean of the kind, which is off by spread_of_kind / sqrt(2).
    assert quality.left_out_error is not None
    assert quality.left_out_error < 0.95 * quality.spread_of_kind / np.sqrt(2)
    slanted = (training()["N1"] > 0).to_numpy()
    inside = np.linalg.norm(embedding.points[slanted] - embedding.points[slanted].mean(0), axis=1)
    across = np.linalg.norm(embedding.points[~slanted] - embedding.points[slanted].mean(0), axis=1)
    assert across.min() > np.percentile(inside, 95)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"neighbours": 0}, r"^embedding.neighbours = 0 must be at least 1\.$"),
        ({"perplexity": 81.0}, r"^embedding.perplexity = 81 must be .* of designs, 80\.$"),
    ],
)
def test_a_plane_that_cannot_be_is_refused(options: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        TSNE(**options).fit(training())


def test_the_plane_does_not_hang_on_the_threads() -> None:
    two = TSNE(perplexity=15, threads=2).fit(training(), seed=3)
    np.testing.assert_array_equal(two.points, plane().points)


# The decoder, on four designs in a row: two straight ones at x = 0 and 1, two slanted at 9 and 10.


def row_of_four() -> tuple[NeighbourDecoder, list[float]]:
    table = training()
    rows = [0, 1, 120, 121]
    points = np.array([[0.0, 0.0], [1.0, 0.0], [9.0, 0.0], [10.0, 0.0]])
    four = table.iloc[rows].reset_index(drop=True).assign(N=10)
    return NeighbourDecoder(four, points, neighbours=1), list(four["theta"])


def test_between_the_kinds_alpha_is_the_share_of_closeness() -> None:
    decoder, thetas = row_of_four()
    decoded = decoder.decode(np.array([[5.0, 0.0], [3.0, 0.0], [7.0, 0.0]])).parameters
    # At 3 the nearest straight design is 2 away, the nearest slanted one 6: 1/36 of 1/4 + 1/36.
    assert list(decoded["alpha"]) == [0.5, 0.1, 0.9]
    # The slant is that of the slanted design, however small its share.
    assert list(decoded["theta"]) == [thetas[2]] * 3


def test_other_parameters_go_with_the_share_of_chambers() -> None:
    decoder, _ = row_of_four()
    width = training()["W"].to_numpy()
    middle, left = decoder.decode(np.array([[5.0, 0.0], [3.0, 0.0]])).parameters["W"]
    assert middle == pytest.approx((width[1] + width[120]) / 2, abs=0.0051)
    assert left == pytest.approx(0.9 * width[1] + 0.1 * width[120], abs=0.0051)


def test_within_an_island_the_other_kind_has_no_say() -> None:
    decoder, _ = row_of_four()
    decoded = decoder.decode(np.array([[0.1, 0.0], [9.8, 0.0]])).parameters
    assert list(decoded["W"]) == [training()["W"][0], training()["W"][121]]
    assert list(decoded["alpha"]) == [0.0, 1.0]
    assert decoded["theta"][0] == 0.0


def test_a_design_that_is_left_out_is_decoded_from_the_others() -> None:
    decoder, _ = row_of_four()
    points = np.array([[0.0, 0.0], [10.0, 0.0]])
    decoded = decoder.decode_left_out(np.array([0, 3]), points).parameters
    # The nearest of the others are 1 away, those of the other kind 9: too far for a chamber.
    assert list(decoded["alpha"]) == [0.0, 1.0]
    assert list(decoded["W"]) == [training()["W"][1], training()["W"][120]]


def test_one_kind_alone_can_be_decoded() -> None:
    bending = training().query("mode == 'bending'")
    points = plane().points[: len(bending)]
    decoded = NeighbourDecoder(bending, points).decode(points + 0.1).parameters
    assert (decoded["alpha"] == 0).all()
    rules = GeometryRules()
    assert sum(bool(violations(design, rules)) for design in designs_of(decoded)) < 12
