"""Designs drawn from the sampling box: at random, of a Sobol sequence, or of Latin hypercubes."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any, Final, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from pagd.dataset.category import CATEGORIES, Category, designs_from, free_parameters, in_box
from pagd.dataset.rejection import Sampled, draw
from pagd.design import Design, GeometryRules
from pagd.errors import InputError

__all__ = ["METHODS", "Method", "sample_designs", "unit_points"]

FloatArray = NDArray[np.float64]
Method = Literal["random", "sobol", "latin_hypercube"]
METHODS: Final[tuple[Method, ...]] = get_args(Method)

#: Gives the next so many points of the unit cube, shape (count, dimensions).
UnitPoints: TypeAlias = Callable[[int], FloatArray]


def sample_designs(
    count: int,
    mode: Category,
    rules: GeometryRules,
    rng: np.random.Generator,
    method: Method = "random",
    *,
    taken: set[Design] | None = None,
) -> Sampled:
    """Draw valid designs of one category, uniformly within the sampling box.

    Values are rounded to 0.01 mm and 0.01 degrees, as in Table 2 of the paper; N is a whole
    number, each as likely as the next. What breaks a rule is drawn again: within the box the
    designs are uniform over the part of it that is valid. With ``random`` and ``sobol`` fewer
    designs of an equal generator are the beginning of more.

    Parameters
    ----------
    count
        How many.
    mode
        bending (alpha 0, theta 0) or twisting (alpha 1, theta within its bounds).
    rules
        The rules of the geometry.
    rng
        Source of the randomness, also of the scrambling of the Sobol sequence.
    method
        Where the points come from: ``random``, ``sobol`` (scrambled; a rejected point is
        skipped) or ``latin_hypercube`` (a further hypercube for what was rejected).
    taken
        Designs that must not come again; the new ones are added.

    Returns
    -------
    Sampled
        The designs, and how many were drawn for them.

    Raises
    ------
    InputError
        If mode or method is unknown, or the rules leave next to nothing of the box.
    """
    for key, value, known in (("mode", mode, CATEGORIES), ("method", method, METHODS)):
        if value not in known:
            raise InputError(f"{key} = {value!r} must be one of {', '.join(known)}.")
    points = unit_points(method, len(free_parameters(mode)), rng)
    return draw(
        count,
        lambda missing: designs_from(in_box(points(missing), mode), mode),
        mode,
        rules,
        taken=taken,
    )


def unit_points(method: Method, dimensions: int, rng: np.random.Generator) -> UnitPoints:
    """Return a source of points in the unit cube; each call goes on where the last one ended.

    A Latin hypercube cannot go on: there each call returns a new one.
    """
    if method == "sobol":
        return functools.partial(_next_of_sequence, qmc.Sobol(dimensions, rng=rng))
    if method == "latin_hypercube":
        hypercubes: UnitPoints = qmc.LatinHypercube(dimensions, rng=rng).random
        return hypercubes
    return lambda count: rng.random((count, dimensions))


def _next_of_sequence(sequence: Any, count: int) -> FloatArray:
    with warnings.catch_warnings():
        # Rejection unbalances the sequence whatever the count; it stays far more even than chance.
        warnings.filterwarnings("ignore", "The balance properties", UserWarning)
        points: FloatArray = sequence.random(count)
    return points
