"""Where a path will lose its stability, by the smallest stiffnesses of its last states.

The smallest eigenvalue λ of the tangent stiffness vanishes where the equilibrium becomes unstable:
with the square root of what is left of the load at a limit point, in proportion to it at a
bifurcation (Thompson and Hunt, *A General Theory of Elastic Stability*, Wiley 1973). λ²,
extrapolated linearly, is right for the one and too early for the other, the less so the shorter the
steps. Both happen under a load that is given; a limit point of the load is none where its conjugate
is given in its place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import State
from pagd.fem.linear_solver import SingularMatrixError
from pagd.fem.newton import Newton

FloatArray = NDArray[np.float64]
Flexibility = Callable[[FloatArray], FloatArray]

# Modes change places on the way: so many of the smallest are followed.
_MODES = 3
# Relative tolerance of the eigenvalues; vectors that ARPACK keeps, and its restarts at most.
_TOLERANCE, _VECTORS, _RESTARTS = 1e-2, 12, 20

# Stability is lost under the conjugate too if it is foretold so for no more than this load.
_ALIKE = 1.1


@dataclass(frozen=True, slots=True)
class Critical:
    """The load where stability is lost; whether it is so while the conjugate is given, too."""

    load: float
    under_conjugate: bool


class StabilityWatch:
    """Foretells where a path will lose its stability; keeps what it knows of the last states."""

    def __init__(self, newton: Newton) -> None:
        self._newton = newton
        self._known: list[tuple[State, FloatArray | None]] = []

    def critical_load(self, states: Sequence[State]) -> float | None:
        """Return where the path of the last two states loses its stability; none if it gains."""
        if len(states) < 2:
            return None
        self._known = [(state, self._stiffness(state)) for state in states[-2:]]
        return critical_load([s.load for s in states[-2:]], [found for _, found in self._known])

    def critical(self, states: Sequence[State]) -> Critical | None:
        """Return that, and whether a path by the conjugate of the load would be no better."""
        load = self.critical_load(states)
        if load is None:
            return None
        if self._newton.load_term is None:
            return Critical(load, under_conjugate=False)
        held = [smallest_stiffness(self._newton, s, under_conjugate=True) for s in states[-2:]]
        other = critical_load([s.load for s in states[-2:]], held)
        return Critical(load, other is not None and other <= _ALIKE * load)

    def _stiffness(self, state: State) -> FloatArray | None:
        for known, stiffness in self._known:
            if known is state:
                return stiffness
        return smallest_stiffness(self._newton, state)


def smallest_stiffness(
    newton: Newton, state: State, under_conjugate: bool = False
) -> FloatArray | None:
    """The smallest stiffnesses of an equilibrium, eigenvalues (modes,) in N/mm, smallest first.

    Three modes, or what a body has of them. None where they are not to be had or one of them
    is negative: what is unstable already has nothing to lose. Nodes have no masses here: from mesh
    to mesh the figures differ, and only their course along a path tells something.

    Parameters
    ----------
    newton
        Of the body; its factors are those of the state afterwards.
    state
        An equilibrium.
    under_conjugate
        Whether only directions count that leave the conjugate of the load as it is.
    """
    from scipy.sparse.linalg import ArpackError

    try:
        newton.linearise_at(state)
        flexibility, size = _flexibility(newton)
        if under_conjugate and newton.load_term is not None:
            gradient = newton.load_term.conjugate(state.unknowns)[1]
            gradient = newton.assembly.reduced(gradient, state.unknowns)
            slopes = gradient[newton.assembly.free[:size]]
            flexibility = _without_load(flexibility, slopes)
        found = _smallest(flexibility, size)
    except (ArpackError, SingularMatrixError):
        return None
    return found if len(found) and found[0] > 0 else None


def critical_load(loads: Sequence[float], stiffnesses: Sequence[FloatArray | None]) -> float | None:
    """The first load at which one of the stiffnesses (modes,) vanishes, by those at two loads.

    None where they rise, or are not known.
    """
    (load, last), (before, smaller) = loads, stiffnesses
    if before is None or smaller is None:
        return None
    fall = before**2 - smaller**2
    found = [
        float(last + (last - load) * rest / by)
        for rest, by in zip(smaller**2, fall, strict=True)
        if by > 0
    ]
    return min(found, default=None)


def _flexibility(newton: Newton) -> tuple[Flexibility, int]:
    """Free displacements (n,) by the forces on them, and n; multipliers take what values they do.

    With the factors of the matrix factorised last.
    """
    free = newton.assembly.free
    size = int((free < newton.displacements).sum())

    def displacements_by(forces: FloatArray) -> FloatArray:
        right = np.zeros(len(free))
        right[:size] = forces
        return newton.solver.solve_again(right)[:size]

    return displacements_by, size


def _without_load(flexibility: Flexibility, slopes: FloatArray) -> Flexibility:
    """A flexibility that keeps the conjugate, whose ``slopes`` (n,) these are."""
    by_load = flexibility(slopes)
    growth = float(slopes @ by_load)
    if not growth:
        # Nothing that is free changes the conjugate.
        return flexibility
    return lambda forces: flexibility(forces) - by_load * (float(by_load @ forces) / growth)


def _smallest(flexibility: Flexibility, size: int) -> FloatArray:
    """The smallest stiffnesses (modes,): the largest flexibilities, the other way up."""
    from scipy.sparse.linalg import LinearOperator, eigsh

    modes = min(_MODES, size - 1)
    if not modes:
        return np.zeros(0)
    flexibilities = eigsh(
        LinearOperator((size, size), matvec=flexibility, dtype=np.float64),
        k=modes,
        which="LM",
        ncv=min(_VECTORS, size),
        tol=_TOLERANCE,
        maxiter=_RESTARTS,
        v0=np.ones(size),
        return_eigenvectors=False,
    )
    return np.sort(1.0 / np.asarray(flexibilities, float))
