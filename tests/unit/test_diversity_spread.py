import numpy as np
import pytest

from pagd.diversity import dpp_score, mean_pairwise_distance, median_distance, rbf, unevenness


def test_mean_and_median_of_pairwise_distances_by_hand() -> None:
    points = np.array([[0.0], [1.0], [4.0]])  # distances 1, 3, 4
    assert mean_pairwise_distance(points) == pytest.approx(8 / 3)
    assert median_distance(points) == pytest.approx(3.0)


def test_kernel_by_hand() -> None:
    kernel = rbf(np.array([[0.0, 0.0]]), np.array([[3.0, 4.0], [0.0, 0.0]]), length=5.0)
    np.testing.assert_allclose(kernel, [[np.exp(-0.5), 1.0]])
    with pytest.raises(ValueError, match="length scale"):
        rbf(kernel, kernel, 0.0)


def test_dpp_of_two_points_by_hand() -> None:
    points = np.array([[0.0], [2.0]])  # k = exp(-2), det K = 1 - k²
    assert dpp_score(points, 1.0, jitter=0.0) == pytest.approx(np.log(1 - np.exp(-4)) / 2)
    assert dpp_score(points, 1.0, 0.5) == pytest.approx(np.log(1.5**2 - np.exp(-4)) / 2)


def test_dpp_of_doubles_is_finite_and_low() -> None:
    doubles = np.zeros((2, 1))  # eigenvalues 2 + ε and ε
    assert dpp_score(doubles, 1.0) == pytest.approx(np.log(2e-6) / 2, rel=1e-5)


def test_dpp_grows_with_the_distances_towards_zero() -> None:
    points = np.random.default_rng(1).normal(size=(12, 3))
    scores = [dpp_score(scale * points, 1.0) for scale in (0.1, 1.0, 10.0, 1000.0)]
    assert scores == sorted(scores)
    assert scores[-1] == pytest.approx(0.0, abs=1e-5)


def test_unevenness_by_hand() -> None:
    assert unevenness(np.array([[0.0], [1.0], [2.0], [3.0]])) == 0.0
    # Nearest others at 1, 1 and 3: mean 5/3, variance 8/9.
    uneven = np.array([[0.0], [1.0], [4.0]])
    assert unevenness(uneven) == pytest.approx(np.sqrt(8 / 9) / (5 / 3))
    assert np.isnan(unevenness(np.zeros((4, 2))))


def test_unevenness_of_independent_points_in_the_plane() -> None:
    points = np.random.default_rng(1).uniform(size=(4000, 2))
    assert unevenness(points) == pytest.approx(np.sqrt(4 / np.pi - 1), abs=0.03)


@pytest.mark.parametrize(
    "measure", [mean_pairwise_distance, median_distance, unevenness, lambda p: dpp_score(p, 1.0)]
)
def test_order_and_place_change_nothing(measure: object) -> None:
    assert callable(measure)
    rng = np.random.default_rng(2)
    points = rng.normal(size=(25, 4))
    assert measure(rng.permutation(points) - 3.0) == pytest.approx(measure(points))
