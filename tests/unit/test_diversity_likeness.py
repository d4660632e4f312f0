import numpy as np
import pytest

from pagd.diversity import fidelity, mmd_squared

LINE = np.array([[0.0], [1.0], [2.0], [10.0]])  # balls of one neighbour reach 1, 1, 1 and 8


def test_fidelity_on_a_line_by_hand() -> None:
    # 0.5 lies in the balls of 0 and 1; 4 in that of 10; -5 in none. The balls around the
    # generated points reach 3.5, 3.5 and 5.5.
    found = fidelity(LINE, np.array([[0.5], [4.0], [-5.0]]), neighbours=1)
    assert found.density == pytest.approx((2 + 1 + 0) / 3)
    assert found.coverage == pytest.approx(3 / 4)
    assert found.precision == pytest.approx(2 / 3)
    assert found.recall == pytest.approx(3 / 4)


def test_copies_are_faithful_and_cover_all() -> None:
    points = np.random.default_rng(1).normal(size=(30, 3))
    assert fidelity(points, points)[1:] == (1.0, 1.0, 1.0)
    # A design that the training designs have twice has a ball of radius 0.
    doubles = np.repeat(points, 2, axis=0)
    assert fidelity(doubles, doubles, 1).coverage == 1.0


def test_equal_distributions_have_the_expected_density_and_coverage() -> None:
    rng = np.random.default_rng(1)
    found = fidelity(rng.uniform(size=(1000, 2)), rng.uniform(size=(1000, 2)), 5)
    assert found.density == pytest.approx(1.0, abs=0.08)
    assert found.coverage == pytest.approx(1 - 2**-5, abs=0.02)


def test_points_far_away_are_neither_faithful_nor_cover_anything() -> None:
    assert fidelity(LINE, LINE + 1000.0, 2) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("neighbours", [0, 4])
def test_fidelity_needs_enough_neighbours(neighbours: int) -> None:
    with pytest.raises(ValueError, match="nearest others"):
        fidelity(LINE, LINE, neighbours)


def test_mmd_by_hand() -> None:
    first, second = np.array([[0.0], [1.0]]), np.array([[0.0], [2.0]])
    k1, k2 = np.exp(-0.5), np.exp(-2.0)  # distances 1 and 2 at length 1
    # Across: 0-0, 0-2, 1-0, 1-2.
    expected = k1 + k2 - 2 * (1 + k2 + k1 + k1) / 4
    assert mmd_squared(first, second, 1.0) == pytest.approx(expected)


def test_mmd_takes_the_median_distance_of_both_samples() -> None:
    rng = np.random.default_rng(1)
    first, second = rng.normal(size=(20, 2)), rng.normal(2.0, size=(30, 2))
    assert mmd_squared(3 * first, 3 * second) == pytest.approx(mmd_squared(first, second))
    assert mmd_squared(second, first) == pytest.approx(mmd_squared(first, second))


def test_mmd_tells_equal_distributions_from_different_ones() -> None:
    rng = np.random.default_rng(1)
    first, same, other = rng.normal(size=(3, 400, 2)) + np.array([0, 0, 1])[:, None, None]
    assert abs(mmd_squared(first, same)) < 0.005
    assert mmd_squared(first, other) > 0.1


def test_mmd_is_unbiased() -> None:
    rng = np.random.default_rng(2)
    found = [mmd_squared(*rng.normal(size=(2, 10, 1)), 1.0) for _ in range(2000)]
    assert abs(np.mean(found)) < 4 * np.std(found) / np.sqrt(len(found))
    assert min(found) < 0


def test_mmd_needs_two_points() -> None:
    with pytest.raises(ValueError, match="at least two"):
        mmd_squared(LINE, LINE[:1], 1.0)
