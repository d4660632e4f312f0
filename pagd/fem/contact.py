"""Frictionless contact between two sets of faces, as an energy of the gap between them.

The potential is ∫ ψ(g) dA over the undeformed slave faces, g the gap to the nearest master face
and ψ a penalty whose pressure begins without a kink (:func:`contact_kernels.pressure_law`): with
stiffness ε the pressure p presses the faces p/ε into each other. The residual is its derivative,
but for pressures that are iterated (:mod:`pagd.fem.contact_pressures`); the tangent, symmetric, is
that of the residual where these have converged.

Which faces are near changes along the path. The pairs of faces that the tangent couples are kept
in a set that only grows, and :meth:`FaceContact.update` tells when it has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from pagd.fem import contact_kernels as kernels
from pagd.fem import shapes
from pagd.fem.contact_pressures import advance_pressures, energy_of, linearize_contact
from pagd.fem.faces import face_areas
from pagd.fem.quadrature import divided, triangle
from pagd.fem.term import ElementSystem, node_dofs

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


# 27 points a face: between fewer, curved faces overlap unseen (with six on 5 mm faces by twice the
# depth at the points).
_RULE = divided(triangle(2), 3)

# How far faces may be apart, in mm, to face each other in the undeformed body; tried in turn.
_DISTANCES = (2.0, 10.0, 50.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactLaw:
    """How contact is enforced.

    Attributes
    ----------
    stiffness
        Pressure by penetration ε, in MPa/mm.
    width
        Pressure begins at this gap, in mm, and is linear in the penetration beyond it.
    trusted
        A trial state with a larger penetration than this, in mm, is not trusted.
    first_pressure
        A point that comes into contact begins with this pressure, in MPa, at most.
    reach
        Faces with a point nearer than this, in mm, must be coupled; where any are not, so are
        those within twice of it, since each search that finds more costs an analysis.
    deepest
        A face found farther behind another than this, in mm, is no penetration but the far side
        of it; one that was near it before has jumped through.
    """

    stiffness: float = 12.0
    width: float = 0.06
    trusted: float = 0.3
    first_pressure: float = 0.02
    reach: float = 0.5
    deepest: float = 0.75


class FaceContact:
    """Contact between slave and master faces.

    Parameters
    ----------
    points
        Reference coordinates (n, 3) in mm.
    slaves, masters
        Six-node faces (S, 6) and (M, 6), pointing out of the solid.
    law
        Penalty and distances.
    """

    name = "contact"

    def __init__(
        self, points: FloatArray, slaves: IntArray, masters: IntArray, law: ContactLaw | None = None
    ) -> None:
        self.law = law or ContactLaw()
        self._points = points
        self.slaves, self._masters = slaves, masters
        rule = _RULE
        self._values = shapes.triangle_values(rule.points)
        self._areas = face_areas(points, slaves, rule)
        self._pairs = np.zeros(0, np.int64)
        self._keys = np.zeros(0, np.int64)
        self._forget()
        self.dofs: IntArray = np.zeros((0, 36), np.int64)
        self._scratch = ElementSystem.of(self.dofs)
        # Of the state whose residual was evaluated last: places of the nodes; p*, p′ and k of the
        # points.
        self._last_positions = points
        self._iterated: FloatArray = np.zeros(0)
        self._pressures, self._slopes = np.zeros_like(self._areas), np.zeros_like(self._areas)

    def _forget(self) -> None:
        self._starts = np.zeros(len(self.slaves) + 1, np.int64)
        self._candidates = np.zeros(0, np.int64)
        self._found = _Found.room(len(self.slaves), len(self._values))

    def update(self, unknowns: FloatArray) -> bool:
        """Look for near faces at a state; whether ``dofs`` has grown by new pairs."""
        self.look(unknowns)
        if self.smallest_gap <= -self.law.deepest:
            return False
        grown = not np.isin(self._near_keys(self.law.reach), self._keys).all()
        if grown:
            self._keys = np.union1d(self._keys, self._near_keys(2 * self.law.reach))
            slave, master = np.divmod(self._keys, len(self._masters))
            self.dofs = node_dofs(np.hstack([self.slaves[slave], self._masters[master]]))
            self._pairs = self._numbers(self._candidate_keys())
        return grown

    def look(self, unknowns: FloatArray) -> None:
        """Look for near faces at a state; ``dofs`` stays as it is."""
        positions = self._positions(unknowns)
        self._project(positions, keeps=self.law.reach)
        if self.smallest_gap <= -self.law.deepest:
            # A step has jumped right through a wall; a search would not know it from its far side.
            return
        self._search(positions, self.law.reach)
        self._project(positions, keeps=-np.inf)
        self._pairs = self._numbers(self._candidate_keys())

    def gap_at_rest(self) -> float:
        """Smallest gap (mm) of the undeformed body; infinite where no two faces are near."""
        gap = np.inf
        for distance in _DISTANCES:
            self._search(self._points, distance)
            self._project(self._points, keeps=-np.inf)
            gaps = self._found.gaps
            gap = float(gaps[gaps > 0].min(initial=np.inf))
            if gap <= distance:
                break
        self._forget()
        return gap

    def internal_at_rest(self) -> FloatArray:
        """Iterated pressures (S, Q) in MPa: none."""
        return np.zeros_like(self._areas)

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        """Fill the element system; see :class:`pagd.fem.term.EnergyTerm`."""
        return self._linearize(unknowns, internal, system, keeps_slopes=False)

    def residual_near(
        self, unknowns: FloatArray, internal: FloatArray, load: float, residual: FloatArray
    ) -> float:
        """Fill the residual; see :class:`pagd.fem.term.CondensingTerm`."""
        system = self._room()
        energy = self._linearize(unknowns, internal, system, keeps_slopes=True)
        residual[:] = system.residual
        return energy

    def _linearize(
        self, unknowns: FloatArray, internal: FloatArray, system: ElementSystem, keeps_slopes: bool
    ) -> float:
        positions = self._last_positions = self._positions(unknowns)
        self._project(positions, keeps=self.law.reach)
        self._iterated = internal
        system.residual[:] = 0.0
        system.tangent[:] = 0.0
        found = self._found
        linearize_contact(
            positions,
            self.slaves,
            self._masters,
            self._values,
            self._areas,
            self._candidates,
            self._pairs,
            found.gaps,
            found.entries,
            found.parameters,
            self.law.stiffness,
            self.law.width,
            self.law.first_pressure,
            internal,
            keeps_slopes,
            self._pressures,
            self._slopes,
            system.residual,
            system.tangent,
            found.energies,
        )
        return float(found.energies.sum())

    def advance(self, correction: FloatArray) -> FloatArray:
        """The iterated pressures (S, Q)."""
        result = np.empty_like(self._pressures)
        advance_pressures(
            self._last_positions,
            correction,
            self.slaves,
            self._masters,
            self._values,
            self._candidates,
            self._found.entries,
            self._found.parameters,
            self._iterated,
            self._pressures,
            self._slopes,
            result,
        )
        return result

    def energy(self, unknowns: FloatArray, load: float) -> float:
        """Energy of the penetration, in mJ."""
        self._project(self._positions(unknowns), keeps=self.law.reach)
        return energy_of(self._found.gaps, self._areas, self.law.stiffness, self.law.width)

    def _room(self) -> ElementSystem:
        """Room for residuals without tangents."""
        if len(self._scratch.residual) != len(self.dofs):
            self._scratch = ElementSystem(np.zeros(self.dofs.shape), np.zeros((0, 666)))
        return self._scratch

    @property
    def smallest_gap(self) -> float:
        """Smallest gap (mm) at the state seen last; infinite where nothing is near."""
        return float(self._found.gaps.min(initial=np.inf))

    @property
    def excess(self) -> float:
        """How much deeper (mm) than can be trusted faces are pressed at the state seen last."""
        return max(-self.law.trusted - self.smallest_gap, 0.0)

    @property
    def touching(self) -> int:
        """How many points are in contact at the state seen last."""
        return int((self._found.gaps < self.law.width).sum())

    @property
    def is_complete(self) -> bool:
        """Whether every point in contact at the state seen last has its pair in ``dofs``."""
        found = self._found
        touching = (found.entries >= 0) & (found.gaps < self.law.width)
        return bool((self._pairs[found.entries[touching]] >= 0).all())

    def _positions(self, unknowns: FloatArray) -> FloatArray:
        count = self._points.size
        return self._points + unknowns[:count].reshape(-1, 3)

    def _search(self, positions: FloatArray, distance: float) -> None:
        """Candidates: masters whose ball meets that of a slave, widened by a distance in mm."""
        centres, radii = _balls(positions, self.slaves)
        others, sizes = _balls(positions, self._masters)
        largest = distance + sizes.max(initial=0.0)
        near = KDTree(others).query_ball_point(centres, radii + largest, return_sorted=True)
        counts = np.array([len(found) for found in near], np.int64)
        self._starts = np.concatenate([[0], np.cumsum(counts)])
        self._candidates = np.concatenate([*near, []]).astype(np.int64)

    def _project(self, positions: FloatArray, keeps: float) -> None:
        found = self._found
        kernels.find_gaps(
            positions,
            self.slaves,
            self._masters,
            self._values,
            self._starts,
            self._candidates,
            self.law.deepest,
            keeps,
            found.gaps,
            found.entries,
            found.parameters,
        )

    def _candidate_keys(self) -> IntArray:
        slaves = np.repeat(np.arange(len(self.slaves)), np.diff(self._starts))
        return np.asarray(slaves * len(self._masters) + self._candidates)

    def _near_keys(self, distance: float) -> IntArray:
        """Keys of the pairs with a point nearer than a distance in mm."""
        near = (self._found.entries >= 0) & (self._found.gaps < distance)
        return np.unique(self._candidate_keys()[self._found.entries[near]])

    def _numbers(self, keys: IntArray) -> IntArray:
        """Number of the pair of each key, −1 where it is none."""
        if len(self._keys) == 0:
            return np.full(len(keys), -1, np.int64)
        places = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        return np.where(self._keys[places] == keys, places, -1)


@dataclass(frozen=True, eq=False, slots=True)
class _Found:
    """What the projection has found for each slave point, and the energy of each slave face."""

    gaps: FloatArray
    entries: IntArray
    parameters: FloatArray
    energies: FloatArray

    @classmethod
    def room(cls, faces: int, points: int) -> _Found:
        shape = (faces, points)
        return cls(
            np.full(shape, np.inf), np.full(shape, -1), np.zeros((*shape, 2)), np.zeros(faces)
        )


def _balls(positions: FloatArray, faces: IntArray) -> tuple[FloatArray, FloatArray]:
    """Centres (F, 3) and radii (F,) of balls around the nodes of faces."""
    nodes = positions[faces]
    centres = nodes[:, :3].mean(axis=1)
    return centres, np.linalg.norm(nodes - centres[:, None], axis=2).max(axis=1)
