"""Forces that keep their direction and size: the potential −load · Σ f·u."""

from __future__ import annotations

from solving import FloatArray

from pagd.fem.term import NO_INTERNAL, ElementSystem, IntArray


class DeadLoad:
    """Nodal forces (elements, size) on the unknowns ``dofs`` (elements, size)."""

    name = "load"

    def __init__(self, dofs: IntArray, forces: FloatArray) -> None:
        self.dofs = dofs
        self._forces = forces

    def internal_at_rest(self) -> FloatArray:
        return NO_INTERNAL

    def advance(self, correction: FloatArray) -> FloatArray:
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        return float(-load * (self._forces * unknowns[self.dofs]).sum())

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        system.residual[:] = -load * self._forces
        system.tangent[:] = 0
        return self.energy(unknowns, load)
