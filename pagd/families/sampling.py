"""Designs of any family drawn from its sampling box, and as a table."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from pagd.dataset.sampling import METHODS, Method, unit_points
from pagd.design import DECIMALS, GeometryRules
from pagd.errors import InputError
from pagd.families.interface import Actuator
from pagd.families.names import PNEUNET, name_of

__all__ = ["sample", "table_of"]

FloatArray = NDArray[np.float64]

# Fewer than one in so many, after a fair trial, is a fault of box or rules and no bad luck.
_LEAST_ONE_IN = 1_000
_FAIR_TRIAL = 10_000


def sample(
    family: type[Actuator],
    count: int,
    rules: GeometryRules,
    rng: np.random.Generator,
    method: Method = "random",
) -> list[Actuator]:
    """Draw valid designs of a family, uniformly within the valid part of its sampling box.

    Values are rounded to 0.01 of their unit; whole numbers are each as likely as the next.

    Parameters
    ----------
    family
        The family; the table of its parameters is the box.
    count
        How many.
    rules
        The rules of the geometry, which every design keeps to.
    rng, method
        As of :func:`pagd.dataset.sampling.sample_designs`.

    Raises
    ------
    InputError
        If the method is unknown, count is less than 1, or hardly any design of the box is valid.
    """
    if method not in METHODS:
        raise InputError(f"sampling = {method!r} must be one of {', '.join(METHODS)}.")
    if count < 1:
        raise InputError(f"designs = {count} must be at least 1.")
    points = unit_points(method, len(family.parameters()), rng)
    found: list[Actuator] = []
    drawn, broken = 0, Counter[str]()
    while (missing := count - len(found)) > 0:
        for design in _in_box(points(missing), family):
            faults = design.violations(rules)
            broken.update({fault.key for fault in faults})
            found += [] if faults else [design]
        drawn += missing
        if drawn >= _FAIR_TRIAL and len(found) * _LEAST_ONE_IN < drawn:
            key, times = broken.most_common(1)[0]
            raise InputError(
                f"family = {name_of(family)!r}: only {len(found):,} of {drawn:,} designs of the "
                f"sampling box can be built; {times:,} break a rule of {key}."
            )
    return found


def table_of(designs: Iterable[Actuator], prefix: str) -> str:
    """Return designs of one family as CSV text that :func:`pagd.catalogue.read_designs` reads.

    Their names are the prefix and a number, from 1.
    """
    rows = list(designs)
    text = io.StringIO()
    # repr of a float, which csv writes, is the shortest text that reads back as the same number.
    writer = csv.writer(text, lineterminator="\n")
    family = [] if not rows or rows[0].family == PNEUNET else [rows[0].family]
    heading = ["name", *(["family"] if family else []), *(rows[0].parameters() if rows else [])]
    writer.writerow(heading)
    digits = len(str(len(rows)))
    for number, design in enumerate(rows, start=1):
        name = f"{prefix}{number:0{digits}d}"
        writer.writerow([name, *family, *design.as_dict().values()])
    return text.getvalue()


def _in_box(points: FloatArray, family: type[Actuator]) -> list[Actuator]:
    """Return the designs at points (m, n) of the unit cube."""
    parameters = list(family.parameters().values())
    low, high = np.array([(p.low, p.high) for p in parameters], dtype=np.float64).T
    whole = np.array([p.whole for p in parameters])
    # Half a step beyond the bounds of whole numbers, so that the first and last are as likely.
    margin = np.where(whole, 0.5, 0.0)
    values = low - margin + points * (high - low + 2 * margin)
    values = np.where(whole, np.floor(values + 0.5), np.round(values, DECIMALS))
    symbols = [p.symbol for p in parameters]
    rows = np.clip(values, low, high).tolist()
    return [family.from_mapping(dict(zip(symbols, row, strict=True))) for row in rows]
