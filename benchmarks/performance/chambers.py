"""Growth with the number of chambers: one design made longer and longer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pagd.catalogue import NamedDesign
from performance.cells import DASH, count, scaled, significant
from performance.fits import power
from performance.page import table, wrapped
from performance.parts import parts_of, per_iteration
from performance.runs import Measurement

__all__ = ["powers_of", "text_of", "with_chambers"]

#: By number of chambers, few to many.
Series = Mapping[int, Measurement]


def with_chambers(named: NamedDesign, chambers: int) -> NamedDesign:
    """Return a design with so many chambers, all else as it is."""
    return replace(named, name=f"{named.name}-{chambers}", design=replace(named.design, N=chambers))


def text_of(series: Series, design: str, size_mm: float, pressure_kPa: float) -> str:
    """Return the section without its first lines."""
    introduction = (
        f"The {design} example with more and fewer chambers, all else as it is; mesh size "
        f"{size_mm:g} mm, free actuation to {pressure_kPa:g} kPa, each in a process of its own "
        "with one thread. Times are core-ms: of the whole analysis by its iterations, so with all "
        "that is done once, and of one factorisation."
    )
    parts = [wrapped(introduction), _table(series)]
    powers = powers_of(series)
    if powers:
        told = ", ".join(f"{name} {value:.2f}" for name, value in powers.items())
        text = f"Power p of cost ∝ chambers to the p, by least squares of the logarithms: {told}."
        parts.append(wrapped(f"{text} 1 is linear."))
    lines = [f"- {number}: {one.trouble}" for number, one in series.items() if one.trouble]
    parts += ["\n".join(wrapped(line, "  ") for line in lines)] if lines else []
    return "\n\n".join(parts)


def powers_of(series: Series) -> dict[str, float]:
    """Return the power of each cost in the number of chambers, as far as it is known."""
    complete = {number: one.figures for number, one in series.items() if one.is_complete}
    costs = {
        "unknowns": [figures["unknowns"] for figures in complete.values()],
        "time of the analysis by iterations": [
            per_iteration(f)["free actuation"] for f in complete.values()
        ],
        "time of an assembly": [per_iteration(f)["assembly"] for f in complete.values()],
        "time of a factorisation": [per_iteration(f)["factorisation"] for f in complete.values()],
        "factor non-zeros": [figures.get("factor_nonzeros") for figures in complete.values()],
        "mesh": [parts_of(figures)["mesh"] for figures in complete.values()],
    }
    numbers = [float(number) for number in complete]
    found = dict[str, float]()
    for name, values in costs.items():
        known = [value for value in values if value]
        fitted = power(numbers, known) if len(known) == len(numbers) > 1 else None
        found |= {} if fitted is None else {name: fitted}
    return found


def _table(series: Series) -> str:
    headings = ["chambers", "elements", "unknowns", "iterations", "analysis / iterations, ms"]
    headings += ["factorisation, ms", "factor non-zeros, 10⁶", "per unknown", "memory, MB"]
    return table(headings, (_row(number, one) for number, one in series.items()))


def _row(number: int, one: Measurement) -> list[str]:
    figures = one.figures
    if not figures:
        return [str(number), *[DASH] * 8]
    each, nonzeros = per_iteration(figures), figures.get("factor_nonzeros")
    return [
        str(number),
        *(count(figures[key]) for key in ("elements", "unknowns", "newton_iterations")),
        significant(scaled(each["free actuation"], 1e3)),
        significant(scaled(each["factorisation"], 1e3)),
        significant(scaled(nonzeros, 1e-6)),
        count(scaled(nonzeros, 1 / figures["unknowns"]) if nonzeros else None),
        count(figures["peak_memory_MB"]),
    ]
