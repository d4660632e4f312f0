"""Closed forms of incompressible bodies, and the heavy elastica by quadrature."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, minimize_scalar

#: The Yeoh coefficients C10 and C20 in MPa of the two materials that things are verified with.
NEO_HOOKE, YEOH = (0.11, 0.0), (0.11, 0.02)

Coefficients = tuple[float, float]


def _slope(
    material: Coefficients, stretches: Callable[[float], tuple[float, ...]]
) -> Callable[[float], float]:
    """dW/dλ of W = C10 (I₁ − 3) + C20 (I₁ − 3)², the principal stretches being functions of λ."""

    def first_invariant(stretch: float) -> float:
        return sum(s**2 for s in stretches(stretch))

    def slope(stretch: float) -> float:
        c10, c20 = material
        # I₁ is a sum of powers of λ: central differences err by 1e-10 of it.
        step = 1e-5
        rate = (first_invariant(stretch + step) - first_invariant(stretch - step)) / (2 * step)
        return (c10 + 2 * c20 * (first_invariant(stretch) - 3)) * rate

    return slope


def sphere_pressure(material: Coefficients, inner: float, outer: float, stretch: float) -> float:
    """Pressure (MPa) at which the inner radius of a thick sphere has the given stretch λa.

    p = ∫ W′(λ)/(λ³ − 1) dλ from λb to λa, with λb³ − 1 = (A/B)³ (λa³ − 1)
    (Ogden, *Non-Linear Elastic Deformations*, 1984, section 5.3.2).
    """
    slope = _slope(material, lambda s: (s, s, s**-2))
    outer_stretch = (1 + (inner / outer) ** 3 * (stretch**3 - 1)) ** (1 / 3)
    return float(quad(lambda s: slope(s) / (s**3 - 1), outer_stretch, stretch)[0])


def sphere_mean_stress(
    material: Coefficients, inner: float, outer: float, stretch: float, radius: float
) -> float:
    """Mean stress (MPa) at a radius of a thick sphere whose inner radius has the stretch λa.

    σ_r + ⅔ (σ_θ − σ_r), with σ_θ − σ_r = λ W′(λ)/2 and σ_r = −∫ W′(λ)/(λ³ − 1) dλ from λb to λ.
    """
    slope = _slope(material, lambda s: (s, s, s**-2))
    grown = inner**3 * (stretch**3 - 1)
    here, outside = ((1 + grown / r**3) ** (1 / 3) for r in (radius, outer))
    radial = -float(quad(lambda s: slope(s) / (s**3 - 1), outside, here)[0])
    return radial + here * slope(here) / 3


def limit_point(material: Coefficients, inner: float, outer: float) -> tuple[float, float]:
    """Stretch λa and pressure (MPa) at which the pressure of a thick sphere is largest."""
    found = minimize_scalar(
        lambda s: -sphere_pressure(material, inner, outer, s), bounds=(1.2, 2.5), method="bounded"
    )
    return float(found.x), float(-found.fun)


def cylinder_pressure(material: Coefficients, inner: float, outer: float, stretch: float) -> float:
    """Pressure (MPa) at which the inner radius of a thick cylinder has the stretch λa.

    Plane strain: p = ∫ W′(λ)/(λ² − 1) dλ from λb to λa, with λb² − 1 = (A/B)² (λa² − 1).
    """
    slope = _slope(material, lambda s: (s, 1 / s, 1.0))
    outer_stretch = (1 + (inner / outer) ** 2 * (stretch**2 - 1)) ** (1 / 2)
    return float(quad(lambda s: slope(s) / (s**2 - 1), outer_stretch, stretch)[0])


def closed_tube(
    material: Coefficients, inner: float, outer: float, stretch: float
) -> tuple[float, float]:
    """Pressure (MPa) and axial stretch λz of a thick tube with closed ends, inner stretch λa.

    p = ∫ W_λ/(λ²λz − 1) dλ from λb to λa, with λb²λz − 1 = (A/B)² (λa²λz − 1), and no axial force
    beyond that of the pressure on the ends: ∫ (2λz W_z − λ W_λ) λ/(λ²λz − 1)² dλ = 0
    (Haughton and Ogden, *J. Mech. Phys. Solids* 27 (1979) 489).
    """
    c10, c20 = material

    def slopes(hoop: float, axial: float) -> tuple[float, float]:
        first = hoop**2 + axial**2 + (hoop * axial) ** -2
        factor = c10 + 2 * c20 * (first - 3)
        by_hoop = 2 * hoop - 2 * hoop**-3 * axial**-2
        by_axial = 2 * axial - 2 * hoop**-2 * axial**-3
        return factor * by_hoop, factor * by_axial

    def between(axial: float, integrand: Callable[[float, float], float]) -> float:
        outside = ((1 + (inner / outer) ** 2 * (stretch**2 * axial - 1)) / axial) ** 0.5
        return float(quad(lambda s: integrand(s, axial), outside, stretch)[0])

    def force(hoop: float, axial: float) -> float:
        by_hoop, by_axial = slopes(hoop, axial)
        return (2 * axial * by_axial - hoop * by_hoop) * hoop / (hoop**2 * axial - 1) ** 2

    found = brentq(lambda axial: between(axial, force), 0.9, 1.2, xtol=1e-12)
    pressure = between(found, lambda s, axial: slopes(s, axial)[0] / (s**2 * axial - 1))
    return pressure, float(found)


def cylinder_mean_stress(
    material: Coefficients, inner: float, outer: float, stretch: float, radius: float
) -> float:
    """Mean stress (MPa) at a radius of a thick cylinder in plane strain; λa is that of the inner.

    σ_r + 2 W′(I₁) (I₁/3 − λ⁻²), with σ_r = −∫ W′(λ)/(λ² − 1) dλ from λb to λ.
    """
    slope = _slope(material, lambda s: (s, 1 / s, 1.0))
    grown = inner**2 * (stretch**2 - 1)
    here, outside = ((1 + grown / r**2) ** (1 / 2) for r in (radius, outer))
    radial = -float(quad(lambda s: slope(s) / (s**2 - 1), outside, here)[0])
    c10, c20 = material
    first = here**2 + here**-2 + 1
    return radial + 2 * (c10 + 2 * c20 * (first - 3)) * (first / 3 - here**-2)


def bent_block(height: float, length: float, angle: float) -> tuple[float, float, float]:
    """α = length/angle and the radii r_a, r_b of a block bent into an arc (Rivlin 1949)."""
    alpha = length / angle
    middle = np.hypot(alpha * height, alpha**2)
    return alpha, float(np.sqrt(middle - alpha * height)), float(np.sqrt(middle + alpha * height))


def bending_moment(modulus: float, height: float, length: float, angle: float) -> float:
    """Moment per width (N) of a neo-Hookean block bent in plane strain, its faces free."""
    alpha, a, b = bent_block(height, length, angle)
    return modulus / 2 * ((b**4 - a**4) / (4 * alpha**2) - alpha**2 * np.log(b / a))


def elastica_tip(load: float) -> tuple[float, float, float]:
    """Tip (x/L, z/L) and slope (rad) of a clamped elastica under a dead force across its axis.

    ``load`` is P L²/EI. EI θ″ = −P cos θ, θ(0) = 0, θ′(L) = 0, by shooting with θ′(0).
    """

    def end(curvature: float) -> np.ndarray:
        def rate(_: float, y: np.ndarray) -> list[float]:
            return [y[1], -load * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])]

        return solve_ivp(rate, (0, 1), [0, curvature, 0, 0], rtol=1e-10, atol=1e-12).y[:, -1]

    curvature = brentq(lambda c: end(c)[1], 0.0, load, xtol=1e-12)
    slope, _, x, z = end(curvature)
    return float(x), float(z), float(slope)
