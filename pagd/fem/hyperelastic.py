"""Isotropic hyperelastic laws: energy, Kirchhoff stress and spatial tangent.

A law is a function W of the isochoric stretch alone; the volumetric part is an
unknown of its own (see :mod:`pagd.fem.solid`). With b̄ = J^(−2/3) F Fᵀ, the
fictitious stress τ̄ and tangent c̄ come from the law, and the deviatoric
projection is the same for all (Holzapfel, *Nonlinear Solid Mechanics*, 2000,
section 6.6, eqs 6.91–6.103 and 6.168, in their spatial form)::

    τ = P : τ̄
    c = P : c̄ : P + ⅔ tr(τ̄) P − ⅔ (I ⊗ τ + τ ⊗ I),    P = 𝕀 − ⅓ I ⊗ I

Symmetric tensors are stored as (xx, yy, zz, xy, yz, zx); the columns of a
tangent act on engineering strains.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem.compiled import compiled
from pagd.fem.invariant_laws import (
    add_second_stress,
    add_second_tangent,
    invariant_law,
    invariant_stress,
    second_factor,
)
from pagd.fem.principal_laws import principal_law, principal_stress
from pagd.materials import GENT, OGDEN, POLYNOMIAL

FloatArray = NDArray[np.float64]


@compiled
def responses(
    law: int,
    parameters: FloatArray,
    b: FloatArray,
    energies: FloatArray,
    stress: FloatArray,
    tangent: FloatArray,
) -> None:
    """Energy densities (Q,) in MPa, stresses (Q, 6) and tangents (Q, 6, 6) of b̄ (Q, 3, 3).

    An energy is infinite where the law has reached its limit of stretch.
    """
    if law == OGDEN:
        for q in range(len(energies)):
            energies[q] = principal_law(parameters, b[q], stress[q], tangent[q])
        return
    for q in range(len(energies)):
        energies[q] = invariant_law(law, parameters, b, q, stress, tangent)
    factor = second_factor(law, parameters)
    if factor != 0.0:
        for q in range(len(energies)):
            add_second_stress(factor, b, q, stress)
            add_second_tangent(factor, b, q, tangent)


@compiled
def stresses(
    law: int, parameters: FloatArray, b: FloatArray, energies: FloatArray, stress: FloatArray
) -> None:
    """The same without the tangents."""
    if law == OGDEN:
        for q in range(len(energies)):
            energies[q] = principal_stress(parameters, b[q], stress[q])
        return
    for q in range(len(energies)):
        energies[q] = invariant_stress(law, parameters, b, q, stress)
    factor = second_factor(law, parameters)
    if factor != 0.0:
        for q in range(len(energies)):
            add_second_stress(factor, b, q, stress)


@compiled
def deviatoric_response(
    law: int, parameters: FloatArray, b: FloatArray, stress: FloatArray, tangent: FloatArray
) -> float:
    """Energy density (MPa); fills Kirchhoff stress (6,) and tangent (6, 6) of one b̄ (3, 3).

    The energy is infinite where the law has reached its limit of stretch.
    """
    if law == OGDEN:
        return principal_law(parameters, b, stress, tangent)
    left, six, moduli = b.reshape(1, 3, 3), stress.reshape(1, 6), tangent.reshape(1, 6, 6)
    energy = invariant_law(law, parameters, left, 0, six, moduli)
    factor = second_factor(law, parameters)
    if factor != 0.0:
        add_second_stress(factor, left, 0, six)
        add_second_tangent(factor, left, 0, moduli)
    return energy


__all__ = ["GENT", "OGDEN", "POLYNOMIAL", "deviatoric_response", "responses", "stresses"]
