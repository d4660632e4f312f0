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

from pagd.fem.compiled import compiled_parallel
from pagd.fem.hyperelastic import responses
from pagd.fem.point_kernels import add_linearised, deform, fill_slopes, points_of, push_stresses
from pagd.fem.solid_kernels import CHUNK, chunks

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


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
        at, strain = points_of(nodes.shape[1], gradients.shape[1]), np.empty(6)
        for e in range(chunk * CHUNK, min((chunk + 1) * CHUNK, len(nodes))):
            if not deform(unknowns, nodes[e], gradients[e], at):
                result[e] = 0.0
                continue
            responses(law, parameters, at.left, at.energy, at.stress, at.tangent)
            fill_slopes(correction, nodes[e], gradients[e], at)
            add_linearised(at, strain)
            push_stresses(at.inverse, at.stress, result[e])
