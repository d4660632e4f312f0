"""The section of elements and mesh sizes: a table a case, and one of seconds at equal error."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from performance.cells import cell, count, percent, significant
from performance.elements import FAMILIES, REFERENCES, Case, Point, reference_of
from performance.fits import relative_distance, seconds_at
from performance.page import table, wrapped

__all__ = ["WANTED_ERROR", "Solved", "text_of"]

#: Error of the tip that is asked for.
WANTED_ERROR: Final = 0.03


@dataclass(frozen=True, slots=True)
class Solved:
    """The points of a case, and the order that its limits are extrapolated with."""

    points: Sequence[Point]
    order: float


def text_of(cases: Mapping[Case, Solved], *, is_given: bool = False) -> str:
    """Return the section without its first lines; ``is_given``: the order was not looked for."""
    return "\n\n".join(
        [
            wrapped(_introduction(is_given)),
            f"Core-seconds, of everything, at an error of {percent(WANTED_ERROR, 0)}:",
            _summary(cases),
            *(part for case, solved in cases.items() for part in _case(case, solved)),
        ]
    )


def _introduction(is_given: bool) -> str:
    order = (
        "a given order"
        if is_given
        else "the order with which both kinds of elements have the same limit, as nearly as they "
        "can (that of the inward edges of the cavity, 1.09, where there is none)"
    )
    return (
        "Free actuation with contact, one thread. The error is the distance of the tip from its "
        "limit, by the limit's displacement. Limits are extrapolated (Richardson) from a mesh and "
        "its halves, the same elements with every edge halved, eight times as many; with "
        f"{order}. The rows of two sizes are limits too, at the cost of both meshes; element "
        "sizes enter by the unknowns, number to the −1/3, since walls have at least one layer of "
        "elements whatever the size. A mesh that a limit is of has an error by construction: its "
        "distance from the other limit tells more."
    )


def _case(case: Case, solved: Solved) -> list[str]:
    limits = _limits(case, solved)
    rows = [_row(point, limits) for point in solved.points]
    headings = ["elements", "size, mm", "unknowns", "tip displacement, mm"]
    headings += [f"error, by {name}" for name in REFERENCES]
    headings += ["solve, core-s", "all, core-s", "error × seconds, % s"]
    told = wrapped(_told(limits, solved.order))
    return [f"### {case.title}", told, table(headings, rows), *_troubles(solved.points)]


def _limits(case: Case, solved: Solved) -> dict[str, Point | None]:
    return {name: reference_of(case, solved.points, name, solved.order) for name in REFERENCES}


def _told(limits: Mapping[str, Point | None], order: float) -> str:
    """The order and the limits, and how far these are from each other."""
    sentences = [f"Order {order:.2f}."]
    for name, limit in limits.items():
        if limit is None or limit.tip is None:
            sentences.append(f"There is no limit by {name}.")
            continue
        x, y, z = (cell(round(float(value), 3) + 0.0, 3) for value in limit.tip)
        sentences.append(f"Limit by {name} ({limit.name} mm): the tip moves by {x}, {y}, {z} mm.")
    tips = [limit.tip for limit in limits.values() if limit and limit.tip is not None]
    if len(tips) == 2:
        sentences.append(f"They differ by {percent(relative_distance(tips[1], tips[0]))}.")
    return " ".join(sentences)


def _row(point: Point, limits: Mapping[str, Point | None]) -> list[str]:
    error = _error(point, limits)
    product = None if error is None or point.all_s is None else 100 * error * point.all_s
    moved = None if point.tip is None else float(np.linalg.norm(point.tip))
    return [
        FAMILIES[point.family].name + (", limit" if point.is_limit else ""),
        point.name,
        count(point.unknowns),
        cell(moved, 3),
        *(percent(_distance(point, limit), 2) for limit in limits.values()),
        cell(point.solve_s, 2),
        cell(point.all_s, 2),
        significant(product),
    ]


def _distance(point: Point, limit: Point | None) -> float | None:
    if point.tip is None or limit is None or limit.tip is None:
        return None
    return relative_distance(point.tip, limit.tip)


def _error(point: Point, limits: Mapping[str, Point | None]) -> float | None:
    """Distance to the first limit that is known; none where it is of this very pair of meshes."""
    first = next((limit for limit in limits.values() if limit), None)
    if first and (point.family, point.name) == (first.family, first.name):
        return None
    return _distance(point, first)


def _summary(cases: Mapping[Case, Solved]) -> str:
    rows = []
    for key, family in FAMILIES.items():
        for is_limit in (False, True) if family.is_extrapolated else (False,):
            cells = []
            for case, solved in cases.items():
                chosen = [p for p in solved.points if (p.family, p.is_limit) == (key, is_limit)]
                cells.append(_seconds(chosen, _limits(case, solved)))
            rows.append([family.name + (", limits" if is_limit else ""), *cells])
    return table(["elements", *(case.title for case in cases)], rows)


def _seconds(points: Iterable[Point], limits: Mapping[str, Point | None]) -> str:
    known = [
        (point.all_s, error)
        for point in points
        if point.all_s is not None and (error := _error(point, limits)) is not None
    ]
    found = seconds_at(WANTED_ERROR, known)
    if found is None:
        return "–"
    sign, seconds = found
    return cell(seconds) if sign == "=" else f"{sign} {cell(seconds)}"


def _troubles(points: Iterable[Point]) -> list[str]:
    lines = [
        f"- {FAMILIES[point.family].name}, {point.name} mm: {point.trouble}"
        for point in points
        if point.trouble and not point.is_limit
    ]
    return ["\n".join(wrapped(line, "  ") for line in lines)] if lines else []
