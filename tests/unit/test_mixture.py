from __future__ import annotations

import numpy as np
import pytest

from pagd.generators.mixture import Mixture, barycentre, bic_curve, fit_mixture


def islands(count: int = 1500) -> tuple[np.ndarray, np.ndarray]:
    """Return two far islands of different shape, and which points are of the second."""
    rng = np.random.default_rng(4)
    first = rng.multivariate_normal([0, 0], [[4, 1], [1, 1]], count)
    second = rng.multivariate_normal([30, 10], [[1, 0], [0, 9]], count)
    return np.vstack([first, second]), np.repeat([False, True], count)


def test_barycentre_of_gaussians_on_a_line() -> None:
    """In one dimension the mean standard deviation: (1 + 3) / 2 = 2."""
    mean, covariance = barycentre(
        (np.array([0.0]), np.array([[1.0]])), (np.array([8.0]), np.array([[9.0]]))
    )
    np.testing.assert_allclose(mean, [4.0])
    np.testing.assert_allclose(covariance, [[4.0]])


def test_barycentre_solves_its_equation() -> None:
    """S = ½ Σ (S^½ S_i S^½)^½ (Agueh and Carlier 2011, eq. 6.2)."""
    from scipy.linalg import sqrtm

    rng = np.random.default_rng(1)
    first, second = (a @ a.T + np.eye(4) for a in rng.standard_normal((2, 4, 4)))
    zero = np.zeros(4)
    _, found = barycentre((zero, first), (zero, second))
    root = sqrtm(found)
    expected = (sqrtm(root @ first @ root) + sqrtm(root @ second @ root)) / 2
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_barycentre_of_equal_gaussians_is_that_gaussian() -> None:
    one = np.array([1.0, 2.0]), np.array([[2.0, 0.5], [0.5, 1.0]])
    mean, covariance = barycentre(one, one)
    np.testing.assert_allclose(mean, one[0])
    np.testing.assert_allclose(covariance, one[1])


def test_the_third_gaussian_bridges_the_islands() -> None:
    points, slanted = islands()
    mixture = fit_mixture(points, slanted, 3, 0.25, seed=1)
    assert mixture.bridge == 2
    np.testing.assert_allclose(mixture.weights, [0.375, 0.375, 0.25], atol=1e-6)
    np.testing.assert_allclose(mixture.means[2], [15, 5], atol=0.3)
    # EM finds the islands, so that the barycentre is that of its two Gaussians.
    found = sorted(mixture.means[:2].tolist())
    np.testing.assert_allclose(found, [[0, 0], [30, 10]], atol=0.3)
    first, second = ((mixture.means[k], mixture.covariances[k]) for k in (0, 1))
    np.testing.assert_allclose(barycentre(first, second)[1], mixture.covariances[2], rtol=1e-3)


def test_plain_em_leaves_the_gap_empty() -> None:
    """Why the bridge is needed: a third Gaussian of EM only splits an island."""
    points, slanted = islands()
    plain = fit_mixture(points, slanted, 3, 0.0, seed=1)
    bridged = fit_mixture(points, slanted, 3, 1 / 3, seed=1)
    shares = []
    for mixture in (plain, bridged):
        drawn, _ = mixture.sample(2000, np.random.default_rng(0))
        shares.append(np.mean((drawn[:, 0] > 9) & (drawn[:, 0] < 24)))
    assert plain.bridge is None
    assert shares[0] == 0
    assert shares[1] > 0.3


def test_one_category_has_no_bridge() -> None:
    points, slanted = islands()
    assert fit_mixture(points[slanted], slanted[slanted], 3, 1 / 3).bridge is None


def test_samples_have_the_moments_of_their_gaussian() -> None:
    mixture = Mixture(
        weights=np.array([0.2, 0.8]),
        means=np.array([[0.0, 0.0], [5.0, -3.0]]),
        covariances=np.array([np.eye(2), [[4.0, 1.5], [1.5, 1.0]]]),
    )
    points, components = mixture.sample(40_000, np.random.default_rng(3))
    assert np.mean(components == 1) == pytest.approx(0.8, abs=0.01)
    second = points[components == 1]
    np.testing.assert_allclose(second.mean(axis=0), [5, -3], atol=0.05)
    np.testing.assert_allclose(np.cov(second.T), [[4, 1.5], [1.5, 1]], atol=0.1)


def test_the_criterion_finds_the_number_of_gaussians() -> None:
    points, _ = islands(400)
    curve = bic_curve(points, range(1, 6), seed=1)
    assert min(curve, key=lambda k: curve[k]) == 2


def test_a_direction_without_spread_is_no_trouble() -> None:
    points, slanted = islands(200)
    flat = np.c_[points, np.where(slanted, 1.0, -1.0)]
    mixture = fit_mixture(flat, slanted, 3, 1 / 3)
    drawn, components = mixture.sample(500, np.random.default_rng(0))
    assert np.isfinite(drawn).all()
    # Half-way between the two values, with next to no spread.
    np.testing.assert_allclose(drawn[components == 2, 2], 0.0, atol=0.05)
