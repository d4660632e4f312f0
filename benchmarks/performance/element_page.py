"""The section of elements and mesh sizes: a table a case, and one of seconds at equal error."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Final

import numpy as np

from performance.cells import cell, count, percent, significant
from performance.elements import FAMILIES, Case, Point, reference_of
from performance.fits import relative_distance, seconds_at
from performance.page import table, wrapped

__all__ = ["WANTED_ERROR", "text_of"]

#: Error of the tip that is asked for.
WANTED_ERROR: Final = 0.03

#: Families whose finest meshes give a limit; errors are to the first that is known.
_REFERENCES: Final = ("hexahedra", "tetrahedra")


def text_of(cases: Mapping[Case, Sequence[Point]], order: float) -> str:
    """Return the section without its first lines."""
    return "\n\n".join(
        [
            wrapped(_introduction(order)),
            wrapped(f"Core-seconds, of everything, at an error of {WANTED_ERROR:.0%}:"),
            _summary(cases, order),
            *(part for case, points in cases.items() for part in _case(case, points, order)),
        ]
    )


def _introduction(order: float) -> str:
    return (
        "Free actuation with contact, one thread. The error is the distance of the tip from its "
        "limit, by the limit's displacement. Limits are extrapolated (Richardson) with the order "
        f"{order:g}, that of the inward edges of the cavity, of a mesh and its halves: the same "
        "elements with every edge halved, eight times as many. The rows of two sizes are limits "
        "too, at the cost of both meshes; element sizes enter by the unknowns, number to the "
        "−1/3, since walls have at least one layer of elements whatever the size. A mesh that a "
        "limit is of has an error by construction: its distance from the other limit tells more."
    )


def _case(case: Case, points: Sequence[Point], order: float) -> list[str]:
    limits = _limits(case, points, order)
    rows = [_row(point, limits) for point in points]
    headings = ["elements", "size, mm", "unknowns", "tip displacement, mm"]
    headings += [f"error, by {name}" for name in _REFERENCES]
    headings += ["solve, core-s", "all, core-s", "error × seconds, % s"]
    return [f"### {case.title}", wrapped(_told(limits)), table(headings, rows), *_troubles(points)]


def _limits(case: Case, points: Sequence[Point], order: float) -> dict[str, Point | None]:
    return {name: reference_of(case, points, name, order) for name in _REFERENCES}


def _told(limits: Mapping[str, Point | None]) -> str:
    """The limits, and how far they are from each other."""
    sentences = []
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


def _summary(cases: Mapping[Case, Sequence[Point]], order: float) -> str:
    rows = []
    for key, family in FAMILIES.items():
        for is_limit in (False, True) if family.is_extrapolated else (False,):
            cells = []
            for case, points in cases.items():
                chosen = [p for p in points if p.family == key and p.is_limit == is_limit]
                cells.append(_seconds(chosen, _limits(case, points, order)))
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
