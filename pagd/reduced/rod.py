"""A row as a chain of joints that are compliant to moments: its blocked force.

Each joint has the screw motion of its cell at rest, which the pressure makes, and turns further as
its cell answers a moment (:mod:`pagd.reduced.compliance`). With the tip's lower edge held at its
height on a frictionless support, forces at both ends of the edge are sought that keep them there;
the moments at the joints are those of these forces about them in the deformed row. Rotations are
finite; shear and stretch by forces are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pagd.reduced.compliance import Compliance
from pagd.reduced.rod_kernels import shape, unbalanced
from pagd.rigid import RigidMotion

FloatArray = NDArray[np.float64]
_Arrays = tuple[
    FloatArray,
    FloatArray,
    FloatArray,
    FloatArray,
    FloatArray,
    FloatArray,
    FloatArray,
    FloatArray,
]

__all__ = ["Rod", "held_force"]

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

    def with_joint_in_front(self, centre: FloatArray, compliance: Compliance) -> Rod:
        """The same with one joint more in the first cell, at (3,), where nothing turns at rest."""
        return replace(
            self,
            rotations=np.concatenate([np.eye(3)[None], self.rotations]),
            displacements=np.concatenate([np.zeros((1, 3)), self.displacements]),
            centres=np.concatenate([centre[None], self.centres]),
            compliances=[compliance, *self.compliances],
        )

    def lacking(self) -> Callable[[FloatArray], FloatArray]:
        """A function of the unknowns (s,): what they lack of equilibrium (s,).

        Unknowns are forces at the edge in N, then moments at the joints in N mm; what is lacking
        are heights of the edge in mm, then moments.
        """
        carried = self._carried()
        balance = np.empty((len(self.centres), 3))

        def lacking(unknowns: FloatArray) -> FloatArray:
            forces, moments = self._split(unknowns)
            _, cells, cuts, ends = carried(moments)
            unbalanced(cells, cuts, ends, forces, moments, balance)
            heights = ends[:, 2] - self.height
            if self.is_planar:
                return np.concatenate([heights[:1], balance[:, 1]])
            return np.concatenate([heights, balance.ravel()])

        return lacking

    def _carried(self) -> Callable[[FloatArray], tuple[FloatArray, ...]]:
        """A function of the moments (j, 3): what ``shape`` fills, in arrays used again."""
        arrays, joints = self._arrays(), len(self.centres)
        turned, cuts = np.empty((joints, 3)), np.empty((joints, 3))
        cells, ends = np.empty((joints, 3, 3)), np.empty((2, 3))

        def carried(moments: FloatArray) -> tuple[FloatArray, ...]:
            shape(*arrays, moments, turned, cells, cuts, ends)
            return turned, cells, cuts, ends

        return carried

    def _arrays(self) -> _Arrays:
        """What of the rod :func:`pagd.reduced.rod_kernels.shape` is given first."""
        moments = np.stack([each.moment for each in self.compliances])
        squares = (moments**2).sum(axis=1, keepdims=True)
        without = np.stack([each.without[:6] for each in self.compliances])
        loaded = np.stack([each.loaded[:6] for each in self.compliances])
        return (
            np.column_stack([self.base.rotation, self.base.displacement]),
            np.ascontiguousarray(self.rotations),
            np.ascontiguousarray(self.displacements),
            np.ascontiguousarray(self.centres),
            without,
            loaded - without,
            np.divide(moments, squares, out=np.zeros_like(moments), where=squares > 0),
            np.ascontiguousarray(self.edge),
        )

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

    def turned_most(self, unknowns: FloatArray) -> float:
        """The largest rotation of a joint by its moment, in radians."""
        turned, *_ = self._carried()(self.moments(unknowns))
        return float(np.linalg.norm(turned, axis=1).max())

    def force(self, unknowns: FloatArray) -> float:
        """The force on the support in N, positive towards −z."""
        return float(self._split(unknowns)[0].sum())


def held_force(rod: Rod, guess: FloatArray | None = None) -> tuple[float, FloatArray] | None:
    """The blocked force in N and the unknowns (s,) it comes with; none where none is found."""
    from scipy.optimize import root

    start = np.zeros(rod.size) if guess is None else guess
    lacking = rod.lacking()
    found = root(lacking, start, method="hybr", options={"xtol": 1e-9})
    heights = lacking(found.x)[: 1 if rod.is_planar else 2]
    if not found.success or np.abs(heights).max() > _HELD:
        return None
    return rod.force(found.x), found.x
