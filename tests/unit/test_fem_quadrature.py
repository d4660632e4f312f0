"""Quadrature rules integrate polynomials up to their degree, and not beyond."""

from __future__ import annotations

from itertools import product
from math import factorial, prod

import numpy as np
import pytest

from pagd.fem.quadrature import Quadrature, divided, tetrahedron, triangle

RULES = [(tetrahedron(), 2), (triangle(2), 2), (triangle(4), 4)]


def errors(rule: Quadrature, degree: int) -> list[float]:
    """Errors of the means of all monomials of a degree in the barycentric coordinates."""
    corners = rule.points.shape[1]
    found = []
    for powers in product(range(degree + 1), repeat=corners):
        if sum(powers) == degree:
            # ∫ Π l_i^p_i dV / V = d! Π p_i! / (d + Σ p_i)!, d the dimension.
            exact = factorial(corners - 1) * prod(factorial(p) for p in powers)
            exact /= factorial(corners - 1 + degree)
            mean = (rule.weights * np.prod(rule.points ** np.array(powers), axis=1)).sum()
            found.append(abs(mean - exact))
    return found


@pytest.mark.parametrize(("rule", "degree"), RULES)
def test_exact_up_to_the_degree(rule: Quadrature, degree: int) -> None:
    for lower in range(degree + 1):
        assert max(errors(rule, lower)) < 1e-14


@pytest.mark.parametrize(("rule", "degree"), RULES)
def test_not_exact_beyond_the_degree(rule: Quadrature, degree: int) -> None:
    assert max(errors(rule, degree + 1)) > 1e-5


@pytest.mark.parametrize(("rule", "degree"), RULES)
def test_points_inside_and_weights_positive(rule: Quadrature, degree: int) -> None:
    np.testing.assert_allclose(rule.points.sum(axis=1), 1.0, rtol=1e-14)
    assert (rule.points > 0).all()
    assert (rule.weights > 0).all()
    assert rule.weights.sum() == pytest.approx(1.0, abs=1e-14)


@pytest.mark.parametrize("parts", [1, 2, 3])
def test_a_divided_triangle_has_the_degree_and_a_smaller_error(parts: int) -> None:
    rule = divided(triangle(2), parts)
    assert len(rule.weights) == 3 * parts**2
    test_points_inside_and_weights_positive(rule, 2)
    test_exact_up_to_the_degree(rule, 2)
    assert max(errors(rule, 3)) < 1.01 * max(errors(triangle(2), 3)) / parts**3


def test_other_degrees_are_refused() -> None:
    with pytest.raises(ValueError, match="degree 3"):
        triangle(3)
