import numpy as np
import pytest

from pagd.diversity import (
    leave_one_out_distances,
    nearest_distances,
    novelty,
    plane_novelty_over_seeds,
    share_in_columns,
    unit_square,
)
from pagd.diversity.novelty import nearest_other

KNOWN = np.array([[0.0, 0.0], [3.0, 4.0], [10.0, 0.0]])


def test_nearest_distances_by_hand() -> None:
    points = np.array([[0.0, 1.0], [3.0, 4.0], [10.0, -2.0]])
    np.testing.assert_allclose(nearest_distances(points, KNOWN), [1.0, 0.0, 2.0])
    assert novelty(points, KNOWN) == pytest.approx(1.0)


def test_leave_one_out_by_hand() -> None:
    np.testing.assert_allclose(leave_one_out_distances(KNOWN), [5.0, 5.0, np.sqrt(65.0)])


def test_a_double_is_its_own_nearest_other() -> None:
    distances, rows = nearest_other(np.array([[1.0], [1.0], [4.0]]))
    assert list(distances) == [0.0, 0.0, 3.0]
    assert list(rows[:2]) == [1, 0]


def test_many_doubles_never_are_their_own_neighbour() -> None:
    _, rows = nearest_other(np.zeros((40, 2)))
    assert (rows != np.arange(40)).all()


def test_nothing_known_is_an_error() -> None:
    with pytest.raises(ValueError, match="no known point"):
        nearest_distances(KNOWN, np.zeros((0, 2)))
    with pytest.raises(ValueError, match="at least two"):
        leave_one_out_distances(KNOWN[:1])


def test_novelty_does_not_hang_on_order_shift_or_rotation() -> None:
    rng = np.random.default_rng(3)
    points, known = rng.normal(size=(20, 3)), rng.normal(size=(30, 3))
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    moved = [rng.permutation(p @ rotation + 7.0) for p in (points, known)]
    assert novelty(moved[0], moved[1]) == pytest.approx(novelty(points, known))
    assert novelty(5 * points, 5 * known) == pytest.approx(5 * novelty(points, known))


def test_unit_square_scales_each_axis_by_the_reference() -> None:
    reference = np.array([[2.0, -1.0], [4.0, 9.0], [3.0, 4.0]])
    np.testing.assert_allclose(unit_square(reference, reference), [[0, 0], [1, 1], [0.5, 0.5]])
    np.testing.assert_allclose(unit_square(np.array([[6.0, 0.0]]), reference), [[2.0, 0.1]])


def test_share_in_columns_by_hand() -> None:
    first, second = np.zeros((2, 3)), np.array([[1.0, 0.0, 2.0], [0.0, 1.0, 2.0]])
    assert share_in_columns(first, second, [2]) == pytest.approx(8 / 10)
    assert share_in_columns(first, second, [0, 1, 2]) == pytest.approx(1.0)
    assert np.isnan(share_in_columns(first, first, [0]))


def test_plane_novelty_over_seeds_by_hand() -> None:
    # A square of side s: scaled, its corners are 1 apart, and a point s / 10 outside is 0.1 off.
    def fit_and_sample(seed: int) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        corners = seed * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
        outside = seed * np.array([[-0.1 * seed, 0.0]])
        return corners, {"near": outside, "copy": corners[:2]}

    found = plane_novelty_over_seeds(fit_and_sample, [1, 3])
    np.testing.assert_allclose(found.values["near"], [0.1, 0.3])
    assert found.mean("training") == pytest.approx(1.0)
    assert found.mean("copy") == 0.0
    assert found.mean("near") == pytest.approx(0.2)
    assert found.spread("near") == pytest.approx(np.sqrt(2) / 10)
    row = next(row for row in found.rows() if row["generator"] == "near")
    assert row["low"] == pytest.approx(0.2 - np.sqrt(2) / 10)
    assert row["count"] == 2


def test_one_seed_has_no_spread() -> None:
    found = plane_novelty_over_seeds(lambda seed: (KNOWN, {"all": KNOWN}), [1])
    assert np.isnan(found.spread("all"))
    assert found.rows()[0]["low"] is None
