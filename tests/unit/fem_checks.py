"""Derivatives of energy terms against central differences, on whole small bodies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from pagd.fem.term import ElementSystem, EnergyTerm
from pagd.materials import Elastomer, Sheet

FloatArray = NDArray[np.float64]

#: One material per branch of the laws.
LAWS = {
    "neo_hookean": {"C10": 0.11},
    "mooney_rivlin": {"C10": 0.26, "C01": 0.098, "C20": 0.0575},
    "yeoh": {"C10": 0.092, "C20": 0.009, "C30": -3.6e-4},
    "gent": {"mu": 0.2, "Jm": 12.0},
    "ogden": {"mu": [0.19, 0.022, 0.06], "alpha": [-3.8, 0.66, 4.2]},
}

# All but contact pressures are known after one.
_ROUNDS = 30

PAPER = Sheet(name="paper", youngs_modulus=6500.0, poisson_ratio=0.2, thickness=0.1)


def elastomer(law: str, poisson_ratio: float = 0.499, **coefficients: object) -> Elastomer:
    """The material of a law, with the coefficients of :data:`LAWS` unless others are given."""
    return Elastomer(
        name=law, law=law, coefficients=coefficients or LAWS[law], poisson_ratio=poisson_ratio
    )


def with_bulk_modulus(bulk_modulus: float, law: str, **coefficients: float) -> Elastomer:
    """The material of a law whose Poisson's ratio gives the wanted bulk modulus in MPa."""
    shear = elastomer(law, **coefficients).shear_modulus
    ratio = (3 * bulk_modulus - 2 * shear) / (6 * bulk_modulus + 2 * shear)
    return elastomer(law, ratio, **coefficients)


def consistent_internal(term: EnergyTerm, unknowns: FloatArray, load: float) -> FloatArray:
    """The internal variables that belong to the unknowns; contact pressures take some rounds."""
    internal, system = term.internal_at_rest(), ElementSystem.of(term.dofs)
    for _ in range(_ROUNDS):
        term.linearize(unknowns, internal, load, system)
        before, internal = internal, term.advance(np.zeros_like(unknowns))
        if np.allclose(before, internal, rtol=1e-15, atol=0):
            break
    return internal


def residual(term: EnergyTerm, unknowns: FloatArray, load: float = 0.0) -> FloatArray:
    """Residual (size,) at consistent internal variables."""
    system = ElementSystem.of(term.dofs)
    term.linearize(unknowns, consistent_internal(term, unknowns, load), load, system)
    result = np.zeros(unknowns.size)
    np.add.at(result, term.dofs, system.residual)
    return result


def linearized(
    term: EnergyTerm, unknowns: FloatArray, load: float = 0.0
) -> tuple[float, FloatArray, FloatArray]:
    """Energy, residual (size,) and full dense tangent (size, size) at consistent internals."""
    system = ElementSystem.of(term.dofs)
    internal = consistent_internal(term, unknowns, load)
    energy = term.linearize(unknowns, internal, load, system)
    forces, tangent = np.zeros(unknowns.size), np.zeros((unknowns.size, unknowns.size))
    np.add.at(forces, term.dofs, system.residual)
    rows, columns = np.triu_indices(term.dofs.shape[1])
    full = np.zeros((len(term.dofs), term.dofs.shape[1], term.dofs.shape[1]))
    full[:, rows, columns] = system.tangent
    full[:, columns, rows] = system.tangent
    np.add.at(tangent, (term.dofs[:, :, None], term.dofs[:, None, :]), full)
    return energy, forces, tangent


def check_derivatives(
    term: EnergyTerm, unknowns: FloatArray, load: float = 0.0, step: float = 1e-5
) -> None:
    """Residual = dE/du and tangent = dR/du by central differences, to 1e-6 of the largest entry.

    Central differences err by step²/6 times the third derivative and by round-off/step; with
    unknowns of order one both stay below 1e-8 of the entries here.
    """
    energy, forces, tangent = linearized(term, unknowns, load)
    np.testing.assert_allclose(energy, term.energy(unknowns, load), rtol=1e-12, atol=1e-14)
    slopes, columns = np.zeros_like(forces), np.zeros_like(tangent)
    for k in np.unique(term.dofs):
        offset = np.zeros_like(unknowns)
        offset[k] = step
        plus, minus = unknowns + offset, unknowns - offset
        slopes[k] = (term.energy(plus, load) - term.energy(minus, load)) / (2 * step)
        columns[:, k] = residual(term, plus, load) - residual(term, minus, load)
    columns /= 2 * step
    assert np.abs(forces).max() > 0
    assert np.abs(tangent).max() > 0
    np.testing.assert_allclose(forces, slopes, atol=1e-6 * np.abs(forces).max())
    np.testing.assert_allclose(tangent, columns, atol=1e-6 * np.abs(tangent).max())


ROTATION = Rotation.from_rotvec([0.7, -1.9, 1.1]).as_matrix()
SHIFT = np.array([3.0, -20.0, 7.0])


def moved(points: FloatArray, unknowns: FloatArray) -> FloatArray:
    """The unknowns after a large rigid motion of the deformed body; others are kept."""
    count = 3 * len(points)
    result = unknowns.copy()
    places = points + unknowns[:count].reshape(-1, 3)
    result[:count] = (places @ ROTATION.T + SHIFT - points).ravel()
    return result


def random_displacement(points: FloatArray, size: float, seed: int = 1) -> FloatArray:
    """A smooth random displacement plus some noise, as a vector of unknowns."""
    random = np.random.default_rng(seed)
    centred = (points - points.mean(axis=0)) / np.ptp(points)
    linear, quadratic = random.normal(size=(3, 3)), random.normal(size=(3, 3))
    field = centred @ linear + (centred**2) @ quadratic
    return np.asarray((size * (field + 0.05 * random.normal(size=points.shape))).ravel())
