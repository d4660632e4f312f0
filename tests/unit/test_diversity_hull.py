import itertools

import numpy as np
import pytest

from pagd.diversity import hull_comparison, hull_corners, hull_size

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def test_unit_square_has_area_one_whatever_lies_within() -> None:
    inside = np.random.default_rng(1).uniform(size=(20, 2))
    assert hull_size(SQUARE) == pytest.approx(1.0)
    assert hull_size(np.vstack([inside, SQUARE])) == pytest.approx(1.0)


def test_volume_of_a_box_in_four_dimensions() -> None:
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=4)))
    assert hull_size(corners * [1, 2, 3, 4]) == pytest.approx(24.0)


def test_triangle_moved_and_shuffled() -> None:
    triangle = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])
    assert hull_size(triangle[[2, 0, 1]] + 100.0) == pytest.approx(6.0)


@pytest.mark.parametrize(
    "flat",
    [
        np.array([[0.0, 0.0], [1.0, 1.0]]),
        np.array([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [5.0, 5.0]]),
        np.full((5, 2), 0.3),
        np.column_stack([np.random.default_rng(1).uniform(size=(9, 2)), np.full(9, 0.7)]),
    ],
    ids=["too few", "on a line", "one point", "in a plane"],
)
def test_flat_sets_have_no_size(flat: np.ndarray) -> None:
    assert hull_size(flat) == 0.0


def test_on_a_line_the_size_is_the_length() -> None:
    assert hull_size(np.array([[3.0], [1.0], [2.0]])) == pytest.approx(2.0)


def test_corners_run_counter_clockwise() -> None:
    points = np.vstack([[[0.5, 0.5]], SQUARE[[2, 0, 3, 1]]])
    corners = points[hull_corners(points)]
    x, y = corners.T
    assert len(corners) == 4
    assert (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2 == pytest.approx(1.0)
    assert hull_corners(SQUARE[:2]).size == 0


def test_comparison_of_a_square_with_one_twice_as_wide() -> None:
    found = hull_comparison(SQUARE, 2 * SQUARE, count=4, repeats=5, rng=np.random.default_rng(1))
    np.testing.assert_allclose(found.training_sizes, 1.0)
    np.testing.assert_allclose(found.ratio, [4.0, 4.0, 4.0])


def test_comparison_draws_the_same_training_sets_for_all() -> None:
    rng = np.random.default_rng(1)
    training, one, other = (rng.uniform(size=(n, 2)) for n in (80, 60, 300))
    first, second, again = (
        hull_comparison(training, new, 20, 30, rng=np.random.default_rng(4))
        for new in (one, other, one)
    )
    np.testing.assert_array_equal(first.training_sizes, second.training_sizes)
    np.testing.assert_array_equal(first.generated_sizes, again.generated_sizes)
    assert first.training_sizes[0] == hull_size(first.training_set)
    assert first.generated_sizes[0] == hull_size(first.generated_set)
    assert first.ratio.low < first.ratio.value < first.ratio.high


def test_a_set_cannot_be_larger_than_what_it_is_drawn_from() -> None:
    with pytest.raises(ValueError, match="larger"):
        hull_comparison(SQUARE, SQUARE, count=5, rng=np.random.default_rng(1))
