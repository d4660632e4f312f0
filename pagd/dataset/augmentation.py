"""Designs around known ones: jittered, and interpolated between designs of one category.

Both may leave the sampling box, since published actuators do, but not the rules.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from pagd.dataset.category import (
    Category,
    designs_from,
    free_parameters,
    in_box,
    rounded,
    values_of,
)
from pagd.dataset.rejection import Sampled, draw
from pagd.design import Design, GeometryRules

__all__ = ["interpolated_designs", "jittered_designs"]

FloatArray = NDArray[np.float64]


def jittered_designs(
    count: int,
    around: Sequence[Design],
    mode: Category,
    rules: GeometryRules,
    rng: np.random.Generator,
    *,
    jitter: float = 0.05,
    taken: set[Design] | None = None,
) -> Sampled:
    """Draw valid designs, each a known one with normal noise on all parameters free in its mode.

    Parameters
    ----------
    count
        How many.
    around
        The known designs, all of ``mode``; each is as likely as the next.
    mode
        bending (no theta, alpha 0) or twisting (alpha 1).
    rules
        The rules of the geometry.
    rng
        Source of the randomness.
    jitter
        Standard deviation of the noise, as a share of the width of the sampling box.
    taken
        Designs that must not come again; the new ones are added.

    Raises
    ------
    InputError
        If next to nothing that is drawn is valid and new.
    """
    known = values_of(around, mode)
    free = free_parameters(mode)
    deviations = jitter * np.array([parameter.high - parameter.low for parameter in free])

    def propose(missing: int) -> list[Design]:
        # One row of uniform numbers a design: fewer designs are the beginning of more.
        uniform = rng.random((missing, 1 + len(free)))
        noise = ndtri(uniform[:, 1:]) * deviations
        return designs_from(rounded(known[_choice(uniform[:, 0], len(known))] + noise, mode), mode)

    return draw(count, propose, mode, rules, taken=taken, origin=f"jitter of {jitter:g}")


def interpolated_designs(
    count: int,
    around: Sequence[Design],
    mode: Category,
    rules: GeometryRules,
    rng: np.random.Generator,
    *,
    taken: set[Design] | None = None,
) -> Sampled:
    """Draw valid designs on straight lines from a known design to another one of its mode.

    The other end is one of the other known designs or a random design of the sampling box,
    each as likely as the next: lines among a handful of designs alone would cover next to
    nothing, and with one known design there would be none. The place on the line is uniform.

    Parameters and errors are those of :func:`jittered_designs`.
    """
    known = values_of(around, mode)
    free = free_parameters(mode)

    def propose(missing: int) -> list[Design]:
        uniform = rng.random((missing, 3 + len(free)))
        first = _choice(uniform[:, 0], len(known))
        share = uniform[:, 2:3]
        ends = _other_ends(known, first, uniform[:, 1], in_box(uniform[:, 3:], mode))
        return designs_from(rounded((1 - share) * known[first] + share * ends, mode), mode)

    return draw(count, propose, mode, rules, taken=taken, origin="interpolation")


def _other_ends(
    known: FloatArray, first: NDArray[np.intp], uniform: FloatArray, sampled: FloatArray
) -> FloatArray:
    """Return the second end of each line: of ``len(known)`` steps on, the last leads to a sample.

    Going 1 … len(known) - 1 steps round from the first design leads to each of the others.
    """
    steps = 1 + _choice(uniform, len(known))
    others = known[(first + steps) % len(known)]
    return np.where((steps == len(known))[:, None], sampled, others)


def _choice(uniform: FloatArray, count: int) -> NDArray[np.intp]:
    """Return indices below ``count``, equally likely, of uniform numbers in [0, 1)."""
    return np.minimum((uniform * count).astype(np.intp), count - 1)
