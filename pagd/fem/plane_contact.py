"""Frictionless contact of faces with a rigid plane, as an energy of the gap to it.

The potential is ∫ ψ(g) dA over the undeformed faces with the gap g = n · (x − x₀) and the penalty
ψ of :func:`contact_kernels.pressure_law`. The gap is linear in the positions, so that the tangent
is ψ″ n ⊗ n alone. The plane bounds a half-space: however deep a face has gone, it is pushed back.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.fem import shapes
from pagd.fem.compiled import compiled
from pagd.fem.contact import ContactLaw
from pagd.fem.contact_kernels import pressure_law, slave_point
from pagd.fem.faces import face_areas
from pagd.fem.quadrature import triangle
from pagd.fem.term import NO_INTERNAL, ElementSystem, node_dofs

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@compiled
def _add(
    values: FloatArray,
    normal: FloatArray,
    force: float,
    stiffness: float,
    residual: FloatArray,
    tangent: FloatArray,
) -> None:
    """Add one quadrature point to the residual (18,) and the packed tangent (171,) of a face."""
    entry = 0
    for i in range(18):
        gi = values[i // 3] * normal[i % 3]
        residual[i] += force * gi
        for j in range(i, 18):
            tangent[entry] += stiffness * gi * values[j // 3] * normal[j % 3]
            entry += 1


@compiled
def _linearize(
    positions: FloatArray,
    faces: IntArray,
    values: FloatArray,
    areas: FloatArray,
    origin: FloatArray,
    normal: FloatArray,
    stiffness: float,
    width: float,
    residual: FloatArray,
    tangent: FloatArray,
    gaps: FloatArray,
    energies: FloatArray,
) -> None:
    """Residuals (F, 18), packed tangents (F, 171), gaps (F, Q) and energies (F,) of the faces."""
    point = np.empty(3)
    for e in range(faces.shape[0]):
        residual[e, :], tangent[e, :], energies[e] = 0.0, 0.0, 0.0
        for q in range(values.shape[0]):
            slave_point(positions, faces[e], values[q], point)
            gap = 0.0
            for i in range(3):
                gap += normal[i] * (point[i] - origin[i])
            gaps[e, q] = gap
            if gap < width:
                energy, slope, curvature = pressure_law(gap, stiffness, width)
                area = areas[e, q]
                energies[e] += area * energy
                _add(values[q], normal, area * slope, area * curvature, residual[e], tangent[e])


class PlaneContact:
    """Contact of faces with a rigid plane that stands still.

    Parameters
    ----------
    points
        Reference coordinates (n, 3) in mm.
    faces
        Six-node faces (F, 6) that may touch the plane.
    origin
        A point (3,) of the plane, in mm.
    normal
        Direction (3,) that points to where the body may be; of any length but zero.
    law
        Penalty; ``reach``, ``deepest``, ``trusted`` and ``first_pressure`` have no meaning for a
        plane.

    Raises
    ------
    InputError
        Where the normal has no direction.
    """

    name = "plane_contact"

    def __init__(
        self,
        points: FloatArray,
        faces: IntArray,
        origin: FloatArray,
        normal: FloatArray,
        law: ContactLaw | None = None,
    ) -> None:
        self.law = law or ContactLaw()
        self.origin = np.asarray(origin, dtype=np.float64)
        self.normal = _unit(normal)
        self._points, self._faces = points, faces
        rule = triangle(4)
        self._values = shapes.triangle_values(rule.points)
        self._areas = face_areas(points, faces, rule)
        self._gaps = np.full(self._areas.shape, np.inf)
        self._energies = np.zeros(len(faces))
        self.dofs: IntArray = node_dofs(faces)
        self._scratch = ElementSystem.of(self.dofs)

    def internal_at_rest(self) -> FloatArray:
        """There are none."""
        return NO_INTERNAL

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        _linearize(
            self._points + unknowns[: self._points.size].reshape(-1, 3),
            self._faces,
            self._values,
            self._areas,
            self.origin,
            self.normal,
            self.law.stiffness,
            self.law.width,
            system.residual,
            system.tangent,
            self._gaps,
            self._energies,
        )
        return float(self._energies.sum())

    def advance(self, correction: FloatArray) -> FloatArray:
        """Nothing to advance."""
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Energy of the penetration, in mJ."""
        return self.linearize(unknowns, NO_INTERNAL, load, self._scratch)

    def force(self, unknowns: FloatArray) -> FloatArray:
        """Resultant (3,) in N that the plane exerts on the body; it points along the normal."""
        self.energy(unknowns, 0.0)
        return np.asarray(-self._scratch.residual.reshape(-1, 3).sum(axis=0))

    @property
    def smallest_gap(self) -> float:
        """Smallest gap (mm) at the state seen last; infinite before the first."""
        return float(self._gaps.min(initial=np.inf))

    @property
    def excess(self) -> float:
        """How much deeper (mm) than the law's width faces are pressed at the state seen last."""
        return max(-self.law.width - self.smallest_gap, 0.0)

    @property
    def touching(self) -> int:
        """How many points are in contact at the state seen last."""
        return int((self._gaps < self.law.width).sum())


def _unit(normal: FloatArray) -> FloatArray:
    direction = np.asarray(normal, dtype=np.float64)
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(length) and length > 0):
        raise InputError(f"The normal of the plane is {direction.tolist()}, but must not be zero.")
    return direction / length
