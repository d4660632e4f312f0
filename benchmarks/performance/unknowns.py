"""Growth with the number of unknowns: one design on ever finer meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from performance.cells import DASH, cell, count, scaled, significant
from performance.fits import power
from performance.page import table, wrapped
from performance.parts import PARTS, parts_of, per_iteration
from performance.runs import Measurement

__all__ = ["text_of"]

#: By size in mm, coarse to fine.
Series = Mapping[float, Measurement]

_PER_ITERATION = ("assembly", "factorisation", "solution", "free actuation")


def text_of(series: Series, design: str, pressure_kPa: float) -> str:
    """Return the section without its first lines."""
    complete = {size: one for size, one in series.items() if one.is_complete}
    introduction = (
        f"The {design} example, free actuation to {pressure_kPa:g} kPa, each mesh in a process of "
        "its own with one thread. Core-seconds of the whole process; rest: imports, geometry, "
        "repair, output and whatever else is not named."
    )
    parts = [wrapped(introduction), _totals(series), "Per Newton iteration, in core-ms:"]
    parts += [_iterations(complete), *_growth(complete), *_troubles(series)]
    return "\n\n".join(parts)


def _totals(series: Series) -> str:
    rows = []
    for size, one in series.items():
        figures = one.figures
        if not figures:
            rows.append([f"{size:g}", *[DASH] * (len(PARTS) + 4)])
            continue
        parts = parts_of(figures)
        sizes = [count(figures[key]) for key in ("elements", "unknowns", "newton_iterations")]
        seconds = [cell(parts[part], 2) for part in PARTS]
        rows.append([f"{size:g}", *sizes, *seconds, count(figures["peak_memory_MB"])])
    headings = ["size, mm", "elements", "unknowns", "iterations"]
    return table([*headings, *(f"{part}, s" for part in PARTS), "memory, MB"], rows)


def _iterations(series: Series) -> str:
    rows = []
    for size, one in series.items():
        found = per_iteration(one.figures)
        cells = [significant(scaled(found[part], 1e3)) for part in _PER_ITERATION]
        nonzeros = one.figures.get("factor_nonzeros")
        rows.append(
            [
                f"{size:g}",
                count(one.figures["unknowns"]),
                *cells,
                significant(scaled(nonzeros, 1e-6)),
            ]
        )
    headings = ["size, mm", "unknowns", *_PER_ITERATION, "factor non-zeros, 10⁶"]
    return table(headings, rows)


def _growth(series: Series) -> list[str]:
    """Powers p of cost ∝ unknownsᵖ: of all meshes, and of the two finest."""
    if len(series) < 2:
        return []
    figures = [one.figures for one in series.values()]
    unknowns = [float(one["unknowns"]) for one in figures]
    costs: dict[str, list[float | None]] = {
        f"{part}, per iteration": [per_iteration(one)[part] for one in figures]
        for part in _PER_ITERATION
    }
    costs |= {
        "mesh": [parts_of(one)["mesh"] for one in figures],
        "all": [parts_of(one)["all"] for one in figures],
        "memory": [one["peak_memory_MB"] for one in figures],
        "factor non-zeros": [one.get("factor_nonzeros") for one in figures],
    }
    rows = [
        [name, *(cell(_power(unknowns[first:], values[first:]), 2) for first in (0, -2))]
        for name, values in costs.items()
    ]
    text = "Power p of cost ∝ unknowns to the p, by least squares of the logarithms:"
    return [wrapped(text), table(["cost", "all meshes", "the two finest"], rows)]


def _power(x: Sequence[float], y: Sequence[float | None]) -> float | None:
    known = [value for value in y if value]
    return power(x, known) if len(known) == len(x) else None


def _troubles(series: Series) -> list[str]:
    lines = [f"- {size:g} mm: {one.trouble}" for size, one in series.items() if one.trouble]
    return ["\n".join(wrapped(line, "  ") for line in lines)] if lines else []
