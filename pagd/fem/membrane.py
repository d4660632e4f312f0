"""In-plane stiffness of an embedded sheet: six-node membrane faces that bend without locking.

St Venant–Kirchhoff in plane stress, ½ E:C:E of the Green–Lagrange strain E. Taken from the
quadratic positions as it is, E of a face that bends to a circle varies over the face, and the
sheet, a thousand times stiffer in plane than in bending, resists that: it locks. So the strain
is interpolated instead: nine fibres in the directions of the three edges, three fibres a
direction, two of them at the Gauss points of the edge, have the strains

    ε_t = ½ (|g_t|² − |G_t|²),    g_t = Σ_a N_a′ x_a along the fibre,

and each of the three natural components of E is linear between its three fibres (the six-node
triangle MITC6 of Lee, Bathe, *Comput. Struct.* 82 (2004) 945). For small strains of a flat
sheet that is the strain of the quadratic positions itself. The energy is ½ εᵀ H ε with a
constant 9 × 9 matrix H per face.

The fibre forces n = H ε are iterated as internal variables: only they enter the geometric
stiffness, while the residual uses H ε(u). A step then does not begin with a spurious stretch
of the nearly inextensible sheet (mixed integration point Newton: Magisano, Leonetti, Garcea,
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

# Places (r, s) of the fibres. On an edge they are its two Gauss points, where the strain of a
# parabola with equally spaced nodes is the same; the third lies half-way on a parallel.
_LOW, _HIGH, _FAR = 0.5 - 3**-0.5 / 2, 0.5 + 3**-0.5 / 2, 3**-0.5
_PLACES = np.array(
    [
        [(_LOW, 0.0), (_HIGH, 0.0), (_LOW, _FAR)],
        [(0.0, _LOW), (0.0, _HIGH), (_FAR, _LOW)],
        [(_LOW, _HIGH), (_HIGH, _LOW), (_LOW, _LOW)],
    ]
)
_DIRECTIONS = np.array([(1.0, 0.0), (0.0, 1.0), (-1.0, 1.0)])


def _fibre_slopes() -> FloatArray:
    """Derivatives (9, 6) of the shape functions along the fibres."""
    places = _PLACES.reshape(-1, 2)
    barycentric = np.column_stack([1 - places.sum(axis=1), places])
    derivatives = shapes.triangle_derivatives(barycentric)
    directions = np.repeat(_DIRECTIONS, 3, axis=0)
    return np.ascontiguousarray(np.einsum("tak,tk->ta", derivatives, directions))


def _natural_strains(points: FloatArray) -> FloatArray:
    """Natural components (Q, 2, 2, 9) of the strain at barycentric points, per fibre strain."""
    along = np.zeros((len(points), 3, 9))
    ones = np.ones((len(points), 1))
    for k, places in enumerate(_PLACES):
        linear = np.linalg.inv(np.column_stack([np.ones(3), places]))
        along[:, k, 3 * k : 3 * k + 3] = np.hstack([ones, points[:, 1:]]) @ linear
    # The strain along the third edge is e_rr + e_ss − 2 e_rs.
    shear = 0.5 * (along[:, 0] + along[:, 1] - along[:, 2])
    return np.stack([along[:, 0], shear, shear, along[:, 1]], axis=1).reshape(-1, 2, 2, 9)


def _local_frames(
    points: FloatArray, faces: IntArray, barycentric: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Derivatives (E, Q, 2, 2) d(reference)/d(orthonormal local axes) and areas (E, Q) · 2."""
    derivatives = shapes.triangle_derivatives(barycentric)
    tangents = np.einsum("eai,qaj->eqji", points[faces], derivatives, optimize=True)
    first = tangents[:, :, 0] / np.linalg.norm(tangents[:, :, 0], axis=-1, keepdims=True)
    normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    area = np.linalg.norm(normal, axis=-1)
    second = np.cross(normal / area[:, :, None], first)
    local = np.stack([(tangents * e[:, :, None]).sum(-1) for e in (first, second)], axis=-1)
    return np.asarray(np.linalg.inv(local)), np.asarray(area)


def _fibre_stiffness(points: FloatArray, faces: IntArray, sheet: Sheet) -> FloatArray:
    """The matrices H (E, 9, 9), in N·mm: ½ εᵀ H ε is the energy of a face."""
    rule = triangle(2)
    inverses, doubled_areas = _local_frames(points, faces, rule.points)
    natural = _natural_strains(rule.points)
    strain = np.einsum("eqik,qklt,eqjl->eqijt", inverses, natural, inverses, optimize=True)
    voigt = np.stack([strain[:, :, 0, 0], strain[:, :, 1, 1], 2 * strain[:, :, 0, 1]], axis=2)
    nu = sheet.poisson_ratio
    law = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    weights = sheet.membrane_stiffness * doubled_areas * rule.weights / 2
    return np.ascontiguousarray(
        np.einsum("eq,eqvt,vw,eqwu->etu", weights, voigt, law, voigt, optimize=True)
    )


@compiled
def _fibre(
    points: FloatArray,
    unknowns: FloatArray,
    nodes: IntArray,
    slopes: FloatArray,
    rows: FloatArray,
) -> float:
    """Fill the derivative (18,) of a fibre's strain; return the square of its vector."""
    squared = 0.0
    for i in range(3):
        component = 0.0
        for a in range(6):
            component += slopes[a] * (points[nodes[a], i] + unknowns[3 * nodes[a] + i])
        squared += component * component
        for a in range(6):
            rows[3 * a + i] = component * slopes[a]
    return squared


@compiled
def _add_stiffness(
    rows: FloatArray,
    slopes: FloatArray,
    forces: FloatArray,
    stiffness: FloatArray,
    tangent: FloatArray,
) -> None:
    """Fill the packed tangent (171,): material part, and geometric part of ``forces``."""
    product = np.empty((9, 18))
    for t in range(9):
        for n in range(18):
            product[t, n] = 0.0
            for u in range(9):
                product[t, n] += stiffness[t, u] * rows[u, n]
    position = 0
    for m in range(18):
        for n in range(m, 18):
            value = 0.0
            for t in range(9):
                value += rows[t, m] * product[t, n]
            if n % 3 == m % 3:
                for t in range(9):
                    value += forces[t] * slopes[t, m // 3] * slopes[t, n // 3]
            tangent[position] = value
            position += 1


@compiled_parallel
def _linearize(
    points: FloatArray,
    unknowns: FloatArray,
    faces: IntArray,
    slopes: FloatArray,
    squares: FloatArray,
    stiffness: FloatArray,
    stored: FloatArray,
    residual: FloatArray,
    tangent: FloatArray,
    rows: FloatArray,
    forces: FloatArray,
) -> float:
    """Energy; fills residual (E, 18), tangent (E, 171), strain rows (E, 9, 18), n (E, 9)."""
    total = 0.0
    for e in prange(len(faces)):
        strain = np.empty(9)
        for t in range(9):
            squared = _fibre(points, unknowns, faces[e], slopes[t], rows[e, t])
            strain[t] = 0.5 * (squared - squares[e, t])
        residual[e, :] = 0.0
        for t in range(9):
            forces[e, t] = 0.0
            for u in range(9):
                forces[e, t] += stiffness[e, t, u] * strain[u]
            total += 0.5 * forces[e, t] * strain[t]
            for n in range(18):
                residual[e, n] += forces[e, t] * rows[e, t, n]
        _add_stiffness(rows[e], slopes, stored[e], stiffness[e], tangent[e])
    return total


@compiled_parallel
def _residual_near(
    points: FloatArray,
    unknowns: FloatArray,
    faces: IntArray,
    slopes: FloatArray,
    squares: FloatArray,
    stiffness: FloatArray,
    stored: FloatArray,
    residual: FloatArray,
    rows: FloatArray,
    forces: FloatArray,
) -> float:
    """Energy; fills ε′ᵀ n (E, 18) with the stored n, and H ε − n by the rows known; H ε (E, 9)."""
    total = 0.0
    for e in prange(len(faces)):
        strain, here = np.empty(9), np.empty((9, 18))
        for t in range(9):
            squared = _fibre(points, unknowns, faces[e], slopes[t], here[t])
            strain[t] = 0.5 * (squared - squares[e, t])
        residual[e, :] = 0.0
        for t in range(9):
            forces[e, t] = 0.0
            for u in range(9):
                forces[e, t] += stiffness[e, t, u] * strain[u]
            total += 0.5 * forces[e, t] * strain[t]
            lacking = forces[e, t] - stored[e, t]
            for n in range(18):
                residual[e, n] += stored[e, t] * here[t, n] + lacking * rows[e, t, n]
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
        self.faces = faces
        self._slopes = _fibre_slopes()
        self._squares = (np.einsum("ta,eai->eti", self._slopes, points[faces]) ** 2).sum(axis=-1)
        self._stiffness = _fibre_stiffness(points, faces, sheet)
        self.dofs = node_dofs(faces)
        self._rows = np.zeros((len(faces), 9, 18))
        self._forces = np.zeros((len(faces), 9))
        self._scratch = ElementSystem.of(self.dofs)

    def internal_at_rest(self) -> FloatArray:
        """Fibre forces (E, 9) in N·mm, zero at rest."""
        return np.zeros_like(self._forces)

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        return _linearize(
            self._points,
            unknowns,
            self.faces,
            self._slopes,
            self._squares,
            self._stiffness,
            internal,
            system.residual,
            system.tangent,
            self._rows,
            self._forces,
        )

    def residual_near(
        self, unknowns: FloatArray, internal: FloatArray, load: float, residual: FloatArray
    ) -> float:
        """Fill the residual; see :class:`pagd.fem.term.CondensingTerm`."""
        return _residual_near(
            self._points,
            unknowns,
            self.faces,
            self._slopes,
            self._squares,
            self._stiffness,
            internal,
            residual,
            self._rows,
            self._forces,
        )

    def lagging(self, internal: FloatArray, elements: IntArray) -> FloatArray:
        """What the stored fibre forces lack; see :class:`pagd.fem.term.LaggingTerm`."""
        lack = self._forces[elements] - internal[elements]
        return np.asarray(np.einsum("et,etn->en", lack, self._rows[elements]))

    def advance(self, correction: FloatArray) -> FloatArray:
        """Fibre forces of the linearised strain, H (ε(u) + ε′(u) Δu)."""
        strain = np.einsum("etn,en->et", self._rows, correction[self.dofs], optimize=True)
        return np.asarray(self._forces + np.einsum("etu,eu->et", self._stiffness, strain))

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Stored energy ½ ∫ E:C:E dA, in mJ."""
        return self.linearize(unknowns, self.internal_at_rest(), load, self._scratch)
