"""Quadrature rules on the reference cells.

Points are given in barycentric coordinates, those of the wedge with the height in [0, 1]
behind; those of the hexahedron in [0, 1]³, of the quadrilateral in [0, 1]². Weights add up
to one: they are shares of the element's volume or area. Sources: Keast, *Comput. Methods
Appl. Mech. Eng.* 55 (1986) 339, rule of degree 2; Dunavant, *Int. J. Numer. Methods Eng.*
21 (1985) 1129, rules of degree 2 and 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Quadrature:
    """Points (n, coordinates) and weights (n,) that add up to one."""

    points: NDArray[np.float64]
    weights: NDArray[np.float64]


def _orbit(*coordinates: float) -> list[tuple[float, ...]]:
    """All distinct permutations of one point, in a fixed order."""
    return sorted(set(permutations(coordinates)))


def tetrahedron() -> Quadrature:
    """Four points, degree 2: the rule of quadratic tetrahedra."""
    near, far = (5 + 3 * 5**0.5) / 20, (5 - 5**0.5) / 20
    return Quadrature(np.array(_orbit(near, far, far, far))[::-1].copy(), np.full(4, 0.25))


def triangle(degree: int) -> Quadrature:
    """Three points (degree 2) or six points (degree 4).

    Raises ``ValueError`` for any other degree.
    """
    if degree == 2:
        return Quadrature(np.array(_orbit(2 / 3, 1 / 6, 1 / 6)), np.full(3, 1 / 3))
    if degree != 4:
        raise ValueError(f"no triangle rule of degree {degree}; there are 2 and 4")
    inner, outer = 0.445948490915965, 0.091576213509771
    points = _orbit(1 - 2 * inner, inner, inner) + _orbit(1 - 2 * outer, outer, outer)
    weights = np.repeat([0.223381589678011, 0.109951743655322], 3)
    return Quadrature(np.array(points), weights / weights.sum())


def divided(rule: Quadrature, parts: int) -> Quadrature:
    """The rule of a triangle on each of parts² equal triangles that it is divided into."""
    points, weights = [], []
    for i in range(parts):
        for j in range(parts - i):
            upright = [(i, j), (i + 1, j), (i, j + 1)]
            upside_down = [(i + 1, j + 1), (i, j + 1), (i + 1, j)]
            for corners in [upright, upside_down][: 1 if i + j == parts - 1 else 2]:
                places = rule.points @ np.array(corners) / parts
                points.append(np.column_stack([1 - places.sum(axis=1), places]))
                weights.append(rule.weights / parts**2)
    return Quadrature(np.vstack(points), np.concatenate(weights))


def _line() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gauss's three points on [0, 1], degree 5, and their weights."""
    places, weights = np.polynomial.legendre.leggauss(3)
    return (places + 1) / 2, weights / 2


def quadrilateral() -> Quadrature:
    """Nine points on the unit square, degree 5 along each axis."""
    places, weights = _line()
    points = np.stack(np.meshgrid(places, places, indexing="ij"), axis=-1)
    return Quadrature(points.reshape(-1, 2), np.outer(weights, weights).ravel())


def hexahedron() -> Quadrature:
    """27 points, degree 5 along each axis: Gauss's rule of triquadratic hexahedra."""
    places, weights = _line()
    points = np.stack(np.meshgrid(places, places, places, indexing="ij"), axis=-1)
    return Quadrature(
        points.reshape(-1, 3), np.einsum("i,j,k->ijk", weights, weights, weights).ravel()
    )


def wedge() -> Quadrature:
    """18 points: six on the triangle (degree 4) at each of three heights (degree 5)."""
    places, weights = _line()
    flat = triangle(4)
    points = [np.column_stack([flat.points, np.full(len(flat.weights), z)]) for z in places]
    return Quadrature(np.vstack(points), np.outer(weights, flat.weights).ravel())
