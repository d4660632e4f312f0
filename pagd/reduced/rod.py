"""A row as a chain of joints that are compliant to moments: its blocked force.

Each joint has the screw motion of its cell at rest, which the pressure makes, and turns further as
its cell answers a moment (:mod:`pagd.reduced.compliance`). With the tip's lower edge held at its
height on a frictionless support, forces at both ends of the edge are sought that keep them there;
the moments at the joints are those of these forces about them in the deformed row. Rotations are
finite; shear and stretch by forces are left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.reduced.compliance import Compliance
from pagd.rigid import RigidMotion
from pagd.rotations import rotation_matrix

FloatArray = NDArray[np.float64]

__all__ = ["Rod", "held_force"]

_UP = np.array([0.0, 0.0, 1.0])
# mm that the edge may be off its height.
_HELD = 1e-6


@dataclass(frozen=True, eq=False, slots=True)
class Rod:
    """A row under a pressure.

    base: place of the first cell. joints: (j,) motions from cell to cell at rest, rotations
    (j, 3, 3) and displacements (j, 3). centres: (j, 3) centres of the cuts between, in the
    coordinates of the cell before. compliances: (j,) of the joints.
    edge: (2, 3) both ends of the tip's lower edge, in coordinates of the last cell.
    height: z (mm) at which they are held. is_planar: whether both ends are one, since the row
    bends in its plane of symmetry.
    """

    base: RigidMotion
    rotations: FloatArray
    displacements: FloatArray
    centres: FloatArray
    compliances: Sequence[Compliance]
    edge: FloatArray
    height: float
    is_planar: bool

    def shape(self, moments: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Rotations (j, 3, 3) of the cells, centres (j, 3) of the cuts and the edge (2, 3).

        By moments (j, 3) in N mm in the coordinates of the cell before each joint.
        """
        turned, aside = self._answers(moments)
        further = rotation_matrix(turned)
        rotations = further @ self.rotations
        arms = self.displacements - self.centres
        displacements = np.einsum("jab,jb->ja", further, arms) + self.centres + aside
        place, cells, cuts = self.base, [], []
        for rotation, displacement, centre in zip(
            rotations, displacements, self.centres, strict=True
        ):
            cells.append(place.rotation)
            cuts.append(place(centre))
            place = place @ RigidMotion(rotation, displacement)
        return np.stack(cells), np.stack(cuts), place(self.edge)

    def _answers(self, moments: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rotation vectors and displacements (j, 3) of the joints by their moments."""
        turned, aside = np.zeros_like(moments), np.zeros_like(moments)
        for compliance in {id(one): one for one in self.compliances}.values():
            mine = np.array([one is compliance for one in self.compliances])
            turned[mine], aside[mine] = compliance.answers(moments[mine])
        return turned, aside

    def lacking(self, unknowns: FloatArray) -> FloatArray:
        """What forces at the edge, then moments at the joints, lack of equilibrium.

        Heights of the edge in mm for its forces in N, and moments in N mm.
        """
        forces, moments = self._split(unknowns)
        cells, cuts, edge = self.shape(moments)
        acting = sum(np.cross(end - cuts, f * _UP) for end, f in zip(edge, forces, strict=True))
        balance = moments - np.einsum("jba,jb->ja", cells, acting)
        heights = edge[:, 2] - self.height
        if self.is_planar:
            return np.concatenate([heights[:1], balance[:, 1]])
        return np.concatenate([heights, balance.ravel()])

    def _split(self, unknowns: FloatArray) -> tuple[FloatArray, FloatArray]:
        if self.is_planar:
            moments = np.zeros((len(self.centres), 3))
            moments[:, 1] = unknowns[1:]
            return np.full(2, unknowns[0] / 2), moments
        return unknowns[:2], unknowns[2:].reshape(-1, 3)

    @property
    def size(self) -> int:
        """Number of unknowns: forces at the edge, moments at the joints."""
        joints = len(self.centres)
        return 1 + joints if self.is_planar else 2 + 3 * joints

    def moments(self, unknowns: FloatArray) -> FloatArray:
        """The moments (j, 3) at the joints in N mm."""
        return self._split(unknowns)[1]

    def force(self, unknowns: FloatArray) -> float:
        """The force on the support in N, positive towards −z."""
        return float(self._split(unknowns)[0].sum())


def held_force(rod: Rod, guess: FloatArray | None = None) -> tuple[float, FloatArray] | None:
    """The blocked force in N and the unknowns (s,) it comes with; none where none is found."""
    from scipy.optimize import root

    start = np.zeros(rod.size) if guess is None else guess
    found = root(rod.lacking, start, method="hybr", options={"xtol": 1e-9})
    heights = rod.lacking(found.x)[: 1 if rod.is_planar else 2]
    if not found.success or np.abs(heights).max() > _HELD:
        return None
    return rod.force(found.x), found.x
