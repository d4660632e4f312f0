"""Geometry of six-node faces that terms on surfaces share."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.fem import shapes
from pagd.fem.quadrature import Quadrature

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def face_areas(points: FloatArray, faces: IntArray, rule: Quadrature) -> FloatArray:
    """Area (F, Q) in mm² that each quadrature point of each face (F, 6) stands for.

    Isoparametric, so that curved faces are right too.
    """
    slopes = shapes.triangle_derivatives(rule.points)
    tangents = np.einsum("qka,fki->fqai", slopes, points[faces])
    normals = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    # The reference triangle has area ½.
    return np.asarray(np.linalg.norm(normals, axis=-1) / 2 * rule.weights)
