"""Contact pressures as quantities that are iterated beside the displacements.

The law p(g) of contact is much stiffer than the walls that touch, and its stiffness vanishes where
contact begins. Along its tangent a gap opens and closes to and fro, or takes an iteration for each
halving of the pressure. So each point of a slave face has a pressure p* of its own, and it is the
inverse law w − g = s(p), nearly linear beside walls so compliant, that is linearised::

    p′ = p* + k (w − g − s(p*)),   k = 1/s′(p*)

p′ acts in place of p(g), with the stiffness k, and a correction takes p* to p′ − k δg. Where it
has converged, p* = p′ = p(g). The turning of the normal is in the tangent with p* at most: with
the p′ of a first guess that is too deep the tangent would be indefinite.

It is what :mod:`pagd.fem.stress_kernels` does with stresses (mixed integration point Newton:
Magisano, Leonetti, Garcea, *Comput. Methods Appl. Mech. Eng.* 313 (2017) 986), and what a
primal-dual method does with contact pressures (Hüeber and Wohlmuth, *Comput. Methods Appl. Mech.
Eng.* 194 (2005) 3147).
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.contact_kernels import add_force, add_stiffness, gap_derivatives, pressure_law

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# After a correction a pressure is a tenth of what it was, at least, and so much in MPa.
_SHARE_LEFT, _NONE_LEFT = 0.1, 1e-6


@compiled
def inverse_law(pressure: float, stiffness: float, width: float) -> tuple[float, float]:
    """Closing w − g (mm) that a pressure (MPa) takes by :func:`pressure_law`; stiffness there."""
    if pressure >= stiffness * width:
        return width + pressure / stiffness, stiffness
    curvature = stiffness / (4 * width)
    closing = math.sqrt(pressure / curvature)
    return closing, 2 * curvature * closing


@compiled
def pressure_near(
    iterated: float, gap: float, stiffness: float, width: float, first: float
) -> tuple[float, float, float]:
    """The pressure p′ at a gap, its stiffness k and the p* it is made of; zero where open.

    A point that comes into contact, p* = 0, begins with the pressure of the law, ``first`` at most.
    """
    if gap >= width:
        return 0.0, 0.0, 0.0
    _, slope, curvature = pressure_law(gap, stiffness, width)
    if iterated <= 0.0:
        iterated = min(-slope, first)
    closing, inverse = inverse_law(iterated, stiffness, width)
    pressure = iterated + inverse * (width - gap - closing)
    if pressure > 0.0:
        return pressure, inverse, iterated
    # The pressure is far too large: that of the law.
    return -slope, curvature, -slope


@compiled
def _pressure(
    iterated: float,
    gap: float,
    known: float,
    stiffness: float,
    width: float,
    first: float,
) -> tuple[float, float, float]:
    """The same with a stiffness that is ``known`` from a state near by, if there is one."""
    if known > 0.0 and iterated > 0.0:
        closing = inverse_law(iterated, stiffness, width)[0]
        return max(iterated + known * (width - gap - closing), 0.0), known, iterated
    return pressure_near(iterated, gap, stiffness, width, first)


@compiled_parallel
def linearize_contact(
    positions: FloatArray,
    slaves: IntArray,
    masters: IntArray,
    values: FloatArray,
    areas: FloatArray,
    candidates: IntArray,
    pairs: IntArray,
    gaps: FloatArray,
    entries: IntArray,
    parameters: FloatArray,
    stiffness: float,
    width: float,
    first: float,
    iterated: FloatArray,
    keeps_slopes: bool,
    pressures: FloatArray,
    slopes: FloatArray,
    residual: FloatArray,
    tangent: FloatArray,
    energies: FloatArray,
) -> None:
    """Residuals (P, 36) and packed tangents (P, 666) of the pairs; energies (S,) by slave face.

    No tangents where there is no room for them, (0, 666).

    ``areas`` (S, Q) are the undeformed areas of the quadrature points and ``pairs`` the pair of
    each candidate, or −1. Also fills the pressures p′ (S, Q) from those iterated (S, Q), and the
    slopes k (S, Q), kept where known if ``keeps_slopes``.
    """
    for e in prange(slaves.shape[0]):
        normal, weights = np.zeros(3), np.empty(12)
        along, turning = np.empty((2, 36)), np.empty((2, 36))
        coefficients, work = np.empty((2, 2, 2)), np.empty((10, 6))
        energies[e] = 0.0
        for q in range(values.shape[0]):
            c, gap = entries[e, q], gaps[e, q]
            if c < 0 or pairs[c] < 0:
                pressures[e, q], slopes[e, q] = 0.0, 0.0
                continue
            energies[e] += areas[e, q] * pressure_law(gap, stiffness, width)[0]
            known = slopes[e, q] if keeps_slopes else 0.0
            pressures[e, q], slopes[e, q], turning_by = _pressure(
                iterated[e, q], gap, known, stiffness, width, first
            )
            if pressures[e, q] <= 0.0:
                continue
            gap_derivatives(
                positions,
                masters[candidates[c]],
                values[q],
                parameters[e, q],
                gap,
                normal,
                weights,
                along,
                turning,
                coefficients,
                work,
            )
            force = -areas[e, q] * pressures[e, q]
            add_force(force, normal, weights, residual[pairs[c]])
            if len(tangent) == 0:
                continue
            add_stiffness(
                areas[e, q] * slopes[e, q],
                -areas[e, q] * min(pressures[e, q], turning_by),
                gap,
                normal,
                weights,
                along,
                turning,
                coefficients,
                tangent[pairs[c]],
            )


@compiled_parallel
def advance_pressures(
    positions: FloatArray,
    correction: FloatArray,
    slaves: IntArray,
    masters: IntArray,
    values: FloatArray,
    candidates: IntArray,
    entries: IntArray,
    parameters: FloatArray,
    iterated: FloatArray,
    pressures: FloatArray,
    slopes: FloatArray,
    result: FloatArray,
) -> None:
    """Fill the pressures p′ − k δg (S, Q) after a correction, a tenth of p* at least."""
    for e in prange(slaves.shape[0]):
        normal, weights = np.zeros(3), np.empty(12)
        along, turning = np.empty((2, 36)), np.empty((2, 36))
        coefficients, work = np.empty((2, 2, 2)), np.empty((10, 6))
        for q in range(values.shape[0]):
            result[e, q] = 0.0
            if slopes[e, q] <= 0.0:
                continue
            face = masters[candidates[entries[e, q]]]
            gap_derivatives(
                positions,
                face,
                values[q],
                parameters[e, q],
                0.0,
                normal,
                weights,
                along,
                turning,
                coefficients,
                work,
            )
            change = 0.0
            for a in range(6):
                for i in range(3):
                    change += weights[a] * normal[i] * correction[3 * slaves[e, a] + i]
                    change += weights[6 + a] * normal[i] * correction[3 * face[a] + i]
            least = max(_SHARE_LEFT * iterated[e, q], _NONE_LEFT)
            result[e, q] = max(pressures[e, q] - slopes[e, q] * change, least)


@compiled
def energy_of(gaps: FloatArray, areas: FloatArray, stiffness: float, width: float) -> float:
    """Energy of gaps (S, Q) by the law, in mJ; ``areas`` (S, Q)."""
    total = 0.0
    for e in range(gaps.shape[0]):
        for q in range(gaps.shape[1]):
            if gaps[e, q] < width:
                total += areas[e, q] * pressure_law(gaps[e, q], stiffness, width)[0]
    return total
