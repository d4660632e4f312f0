"""States between the steps of a path, by polynomials through states of equilibrium.

Dense output, as of solvers of differential equations (Hairer, Nørsett, Wanner, *Solving Ordinary
Differential Equations I*, Springer 1993, section II.6): where the path is smooth, its steps are
longer than the distances between the loads at which states are wanted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pagd.fem.assembly import State
from pagd.fem.newton import Newton

FloatArray = NDArray[np.float64]

# A polynomial of lower degree is taken where its error is no more than so many times the least.
_AS_GOOD = 3.0

# Two polynomials agree on a reaction up to this share of it, and up to this share of the largest
# one around it.
_REACTION = 5e-3, 1e-3

#: Fewer states tell nothing of the error.
FEWEST = 4


def lagrange_factors(places: Sequence[float], place: float) -> list[float]:
    """Values at ``place`` of the Lagrange polynomials of ``places``."""
    return [
        math.prod((place - b) / (a - b) for j, b in enumerate(places) if j != i)
        for i, a in enumerate(places)
    ]


def unknowns_at(
    unknowns: Sequence[FloatArray], places: Sequence[float], place: float
) -> FloatArray:
    """The Lagrange polynomial through ``unknowns``, each (size,), at ``place``."""
    factors = lagrange_factors(places, place)
    return sum((f * u for f, u in zip(factors, unknowns, strict=True)), np.zeros(1))


def interpolate(states: Sequence[State], places: Sequence[float], place: float) -> State:
    """The Lagrange polynomial through ``states`` at ``places``, the load included."""
    factors = lagrange_factors(places, place)
    unknowns = unknowns_at([s.unknowns for s in states], places, place)
    load = sum(f * s.load for f, s in zip(factors, states, strict=True))
    internal = tuple(
        np.asarray(sum(f * s.internal[k] for f, s in zip(factors, states, strict=True)))
        for k in range(len(states[0].internal))
    )
    reaction = sum(f * s.reaction for f, s in zip(factors, states, strict=True))
    return State(load, unknowns, internal, reaction)


def at_load(states: Sequence[State], load: float) -> State:
    """The Lagrange polynomial through ``states`` at ``load``, internal variables included."""
    return replace(interpolate(states, [s.load for s in states], load), load=load)


def states_to_use(
    newton: Newton, states: Sequence[State], places: Sequence[float], order: int
) -> int:
    """How many of the last states the next guess is best made of: two to ``order`` + 1.

    As many as would have foretold the last state well at its place, the load or its conjugate, from
    those before it; one more where that is the most that there were. On a smooth path these are
    many, but contact comes and goes with kinks, which a polynomial of a high degree amplifies.
    """
    most = min(len(states), order + 1)
    if most < FEWEST:
        return most
    last, errors = states[-1], {}
    for count in range(2, min(most, len(states) - 1) + 1):
        before = states[-count - 1 : -1]
        guess = unknowns_at([s.unknowns for s in before], places[-count - 1 : -1], places[-1])
        errors[count] = newton.largest_displacement(guess - last.unknowns)
    enough = _AS_GOOD * min(errors.values())
    best = next(count for count, error in errors.items() if error <= enough)
    return min(best + 1, most) if best == max(errors) else best


def state_between(newton: Newton, states: Sequence[State], load: float) -> State | None:
    """The state at a load between those of ``states``, if it is known well enough.

    It is where the polynomial through all of them and the one without the first differ by less
    than the tolerance of the displacements; the difference is the error of the latter, and that of
    the former, which is returned, is smaller as long as the path is smooth. So not where anything
    touches at the state, nor should it at the last of ``states``: contact begins with a kink.
    Reactions, where there are any, have to agree as well. They are interpolated as the states are:
    the reaction that an interpolated state has is far worse, since walls are stiff.
    """
    if len(states) < FEWEST:
        return None
    unknowns, loads = [s.unknowns for s in states], [s.load for s in states]
    coarser = unknowns_at(unknowns[1:], loads[1:], load)
    difference = newton.largest_displacement(unknowns_at(unknowns, loads, load) - coarser)
    if not difference < newton.settings.tolerance or not _reactions_agree(states, load):
        return None
    found = at_load(states, load)
    newton.assembly.settle(found.unknowns)
    return None if newton.assembly.touches(found) else found


def _reactions_agree(states: Sequence[State], load: float) -> bool:
    """Whether the polynomials of :func:`state_between` agree on the reaction, if there is any."""
    loads, reactions = [s.load for s in states], np.array([s.reaction for s in states])
    if not np.isfinite(reactions).all():
        return True
    found = float(lagrange_factors(loads, load) @ reactions)
    coarser = float(lagrange_factors(loads[1:], load) @ reactions[1:])
    share, share_of_largest = _REACTION
    largest = float(np.abs(reactions).max())
    return abs(found - coarser) <= max(share * abs(found), share_of_largest * largest)
