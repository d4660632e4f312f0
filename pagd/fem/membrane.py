"""In-plane stiffness of an embedded sheet: six-node membrane faces.

St Venant–Kirchhoff in plane stress: the membrane forces N = C E of the
Green–Lagrange strain E. They are iterated as internal variables at the
integration points: only they enter the geometric stiffness, while the residual
uses C E(u). A step then does not begin with a spurious stretch of the nearly
inextensible sheet (mixed integration point Newton: Magisano, Leonetti, Garcea,
*Comput. Methods Appl. Mech. Eng.* 313 (2017) 986).
"""

from __future__ import annotations

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem import shapes
from pagd.fem.compiled import compiled, compiled_parallel
from pagd.fem.quadrature import triangle
from pagd.fem.term import ElementSystem, node_dofs
from pagd.materials import Sheet

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def surface_gradients(points: FloatArray, faces: IntArray) -> tuple[FloatArray, FloatArray]:
    """Gradients (E, Q, 6, 2) in a local orthonormal frame and areas (E, Q) of the points."""
    rule = triangle(4)
    derivatives = shapes.triangle_derivatives(rule.points)
    tangents = np.einsum("eai,qaj->eqji", points[faces], derivatives, optimize=True)
    first = tangents[:, :, 0] / np.linalg.norm(tangents[:, :, 0], axis=-1, keepdims=True)
    normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    area = np.linalg.norm(normal, axis=-1)
    second = np.cross(normal / area[:, :, None], first)
    local = np.stack([(tangents * e[:, :, None]).sum(-1) for e in (first, second)], axis=-1)
    gradients = np.einsum("qaj,eqkj->eqak", derivatives, np.linalg.inv(local), optimize=True)
    return np.ascontiguousarray(gradients), area * rule.weights / 2


@compiled
def _strain(first: FloatArray, second: FloatArray, strain: FloatArray) -> None:
    """Green–Lagrange strain (xx, yy, engineering xy) of the two deformed frame vectors."""
    strain[0] = 0.5 * (first @ first - 1.0)
    strain[1] = 0.5 * (second @ second - 1.0)
    strain[2] = first @ second


@compiled
def _forces(strain: FloatArray, stiffness: float, nu: float, forces: FloatArray) -> None:
    forces[0] = stiffness * (strain[0] + nu * strain[1])
    forces[1] = stiffness * (strain[1] + nu * strain[0])
    forces[2] = 0.5 * stiffness * (1.0 - nu) * strain[2]


@compiled
def _strain_rows(
    first: FloatArray, second: FloatArray, gradients: FloatArray, rows: FloatArray
) -> None:
    """Derivative (3, 18) of the strain."""
    for a in range(6):
        x, y = gradients[a, 0], gradients[a, 1]
        for i in range(3):
            rows[0, 3 * a + i] = first[i] * x
            rows[1, 3 * a + i] = second[i] * y
            rows[2, 3 * a + i] = first[i] * y + second[i] * x


@compiled
def _add_stiffness(
    rows: FloatArray,
    gradients: FloatArray,
    forces: FloatArray,
    stiffness: float,
    nu: float,
    weight: float,
    tangent: FloatArray,
) -> None:
    """Add the material part and the geometric part of the given ``forces``."""
    position = 0
    column = np.empty(3)
    for m in range(18):
        _forces(rows[:, m], stiffness, nu, column)
        a, i = m // 3, m % 3
        for n in range(m, 18):
            value = column[0] * rows[0, n] + column[1] * rows[1, n] + column[2] * rows[2, n]
            if n % 3 == i:
                b = n // 3
                value += forces[0] * gradients[a, 0] * gradients[b, 0]
                value += forces[1] * gradients[a, 1] * gradients[b, 1]
                value += forces[2] * (
                    gradients[a, 0] * gradients[b, 1] + gradients[a, 1] * gradients[b, 0]
                )
            tangent[position] += weight * value
            position += 1


@compiled_parallel
def _linearize(
    points: FloatArray,
    unknowns: FloatArray,
    faces: IntArray,
    gradients: FloatArray,
    areas: FloatArray,
    stiffness: float,
    nu: float,
    stored: FloatArray,
    residual: FloatArray,
    tangent: FloatArray,
    rows: FloatArray,
    forces: FloatArray,
) -> float:
    """Energy; fills residual (E, 18), tangent (E, 171), strain rows (E, Q, 3, 18), N (E, Q, 3)."""
    total = 0.0
    for e in prange(len(faces)):
        strain, first, second = np.empty(3), np.empty(3), np.empty(3)
        residual[e, :] = 0.0
        tangent[e, :] = 0.0
        for q in range(areas.shape[1]):
            weight = areas[e, q]
            first[:] = 0.0
            second[:] = 0.0
            for a in range(6):
                for i in range(3):
                    place = points[faces[e, a], i] + unknowns[3 * faces[e, a] + i]
                    first[i] += gradients[e, q, a, 0] * place
                    second[i] += gradients[e, q, a, 1] * place
            _strain(first, second, strain)
            _forces(strain, stiffness, nu, forces[e, q])
            _strain_rows(first, second, gradients[e, q], rows[e, q])
            for m in range(3):
                total += 0.5 * weight * forces[e, q, m] * strain[m]
                for n in range(18):
                    residual[e, n] += weight * forces[e, q, m] * rows[e, q, m, n]
            _add_stiffness(
                rows[e, q], gradients[e, q], stored[e, q], stiffness, nu, weight, tangent[e]
            )
    return total


class Membrane:
    """The membrane part of an embedded sheet.

    Parameters
    ----------
    points
        Reference coordinates (n, 3) in mm.
    faces
        Six-node faces (E, 6) of the sheet.
    sheet
        Its elastic constants.
    """

    name = "membrane"

    def __init__(self, points: FloatArray, faces: IntArray, sheet: Sheet) -> None:
        self._points = points
        self._faces = faces
        self._stiffness = sheet.membrane_stiffness
        self._nu = sheet.poisson_ratio
        self._gradients, self._areas = surface_gradients(points, faces)
        self.dofs = node_dofs(faces)
        self._rows = np.zeros((*self._areas.shape, 3, 18))
        self._forces = np.zeros((*self._areas.shape, 3))
        self._scratch = ElementSystem.of(self.dofs)

    def internal_at_rest(self) -> FloatArray:
        """Membrane forces (E, Q, 3) in N/mm, zero at rest."""
        return np.zeros_like(self._forces)

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        return _linearize(
            self._points,
            unknowns,
            self._faces,
            self._gradients,
            self._areas,
            self._stiffness,
            self._nu,
            internal,
            system.residual,
            system.tangent,
            self._rows,
            self._forces,
        )

    def advance(self, correction: FloatArray) -> FloatArray:
        """Membrane forces of the linearised strain, C (E(u) + E′(u) Δu)."""
        strain = np.einsum("eqmn,en->eqm", self._rows, correction[self.dofs], optimize=True)
        nu = self._nu
        law = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
        return np.asarray(self._forces + self._stiffness * strain @ law)

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Stored energy ½ ∫ N·E dA, in mJ."""
        return self.linearize(unknowns, self.internal_at_rest(), load, self._scratch)
