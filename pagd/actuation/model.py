"""What a path is followed of: a whole actuator, or one cell of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pagd.fem.contact import FaceContact
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.gravity import Gravity
from pagd.fem.solid import Solid
from pagd.fem.term import EnergyTerm
from pagd.materials import Elastomer
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]

__all__ = ["Model"]


class Model(Protocol):
    """A finite-element model under pressure; see :class:`pagd.actuation.Body`.

    ``nodes`` counts the rows of three unknowns that come first, which the tolerance is for.
    """

    mesh: Mesh
    material: Elastomer
    nodes: int
    copies: int
    element: str
    pressure: FollowerPressure
    gravity: Gravity | None
    contact: FaceContact | None
    initial_gap: float

    @property
    def solids(self) -> Sequence[Solid]:
        """The elastomer, by the kinds of its elements."""
        ...

    @property
    def terms(self) -> Sequence[EnergyTerm]:
        """All energy terms."""
        ...

    @property
    def solid_volume(self) -> float:
        """Volume of elastomer, in mm³."""
        ...

    def displacement(self, unknowns: FloatArray) -> FloatArray:
        """The rows (n, 3) of three unknowns, in mm."""
        ...

    def volume(self, unknowns: FloatArray) -> float:
        """Cavity volume, in mm³."""
        ...
