"""Stresses at the quadrature points as quantities that are iterated beside the displacements.

The tangent of a solid has a material and a geometric part. In the geometric part stands not the
stress S(u) of the displacements but one of its own, S*, which a correction δu takes to
S(u) + C : E′(u) δu: the linearised stress. A slender body turns much while it stretches little;
its displacements are then first corrected along the tangent of the turn, which would stretch it,
and the geometric part of the stress of that stretch would spoil the next correction (mixed
integration point Newton: Magisano, Leonetti, Garcea, *Comput. Methods Appl. Mech. Eng.* 313
(2017) 986). The residual is that of S(u), so the solution is the same.
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.hyperelastic import deviatoric_response
from pagd.fem.solid_kernels import (
    CHUNK,
    FIRST,
    SECOND,
    SMALLEST_VOLUME_RATIO,
    chunks,
    deformation_gradient,
    inverse,
    isochoric_left_stretch,
    push_stress,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@compiled
def _strain_of(
    correction: FloatArray,
    nodes: IntArray,
    gradients: FloatArray,
    inverted: FloatArray,
    slope: FloatArray,
    strain: FloatArray,
) -> None:
    """Fill the engineering strain (6,) of a correction on the deformed body."""
    deformation_gradient(correction, nodes, gradients, slope)
    for i in range(3):
        slope[i, i] -= 1.0
    for m in range(6):
        i, j = FIRST[m], SECOND[m]
        strain[m] = 0.0
        for k in range(3):
            strain[m] += slope[i, k] * inverted[k, j]
            if m >= 3:
                strain[m] += slope[j, k] * inverted[k, i]


@compiled_parallel
def advance_stresses(
    unknowns: FloatArray,
    correction: FloatArray,
    nodes: IntArray,
    gradients: FloatArray,
    law: int,
    parameters: FloatArray,
    result: FloatArray,
) -> None:
    """Fill the linearised deviatoric stresses S(u) + C : E′(u) δu (E, Q, 6).

    Of the second Piola–Kirchhoff kind; zero where an element is inverted at ``unknowns``.
    Shapes: nodes (E, n), gradients (E, Q, 3, n).
    """
    for chunk in prange(chunks(len(nodes))):
        gradient, inverted = np.empty((3, 3)), np.empty((3, 3))
        b, slope = np.empty((3, 3)), np.empty((3, 3))
        stress, tangent, strain = np.empty(6), np.empty((6, 6)), np.empty(6)
        for e in range(chunk * CHUNK, min((chunk + 1) * CHUNK, len(nodes))):
            for q in range(gradients.shape[1]):
                result[e, q, :] = 0.0
                deformation_gradient(unknowns, nodes[e], gradients[e, q], gradient)
                ratio = inverse(gradient, inverted)
                if not ratio > SMALLEST_VOLUME_RATIO:
                    continue
                isochoric_left_stretch(gradient, ratio, b)
                deviatoric_response(law, parameters, b, stress, tangent)
                _strain_of(correction, nodes[e], gradients[e, q], inverted, slope, strain)
                for m in range(6):
                    for n in range(6):
                        stress[m] += tangent[m, n] * strain[n]
                push_stress(inverted, stress, result[e, q])
