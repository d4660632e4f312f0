"""What a random design costs, beside the targets: a section of docs/performance.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from performance.cells import cell, count, percent
from performance.page import table, wrapped

from robustness.errors import ALLOWED_ERROR, USUAL_ORDER

__all__ = ["COST_KEYS", "as_section"]


@dataclass(frozen=True, slots=True)
class _Row:
    """A row of costs: heading, attribute of a result, digits, and largest values wanted.

    ``each``: what the value of every design is to stay below, where all are.
    """

    heading: str
    key: str
    digits: int = 1
    median: float | None = None
    p90: float | None = None
    each: float | None = None


_ROWS: Final = (
    _Row("free actuation with all around it, core-s", "without_blocked_cpu_s", median=8, p90=25),
    _Row("free actuation alone, core-s", "free_cpu_s"),
    _Row("iterations a step of the free actuation", "free_iterations_a_step", 2, median=3),
    _Row("blocked force alone, core-s", "blocked_cpu_s"),
    _Row("blocked force / free actuation", "blocked_by_free", 2, median=0.5),
    _Row("everything outside of both, core-s", "outside_cpu_s", each=3),
    _Row("peak memory, MB", "peak_memory_MB", 0, each=1000),
)

#: Attributes of a result that the rows are of.
COST_KEYS: Final = tuple(row.key for row in _ROWS)


def as_section(report: Mapping[str, Any], costs: Sequence[Mapping[str, float | None]]) -> str:
    """Return the section without its first lines.

    Parameters
    ----------
    report
        As ``random_designs.py`` writes it to JSON, with ``tip_errors``.
    costs
        A mapping a design, with :data:`COST_KEYS`.
    """
    parts = [wrapped(_introduction(report)), _costs(costs), *_errors(report)]
    return "\n\n".join(parts)


def _introduction(report: Mapping[str, Any]) -> str:
    study, summary = report["study"], report["summary"]
    done, asked = summary["designs"]["done"], summary["designs"]["asked"]
    models = ", ".join(f"{name} ({number})" for name, number in summary["models"].items())
    unknowns = summary["spreads"]["unknowns"]
    size = f"; unknowns: median {count(unknowns['median'])}" if unknowns else ""
    return (
        f"{done} of {asked} random designs, each through the whole chain in a process of its own "
        f"with one thread, {report['machine']['processes']} at a time; mesh size "
        f"{study['size_mm']:g} mm, to {study['config']['solve']['maximum_pressure_kPa']:g} kPa, "
        f"with contact. Elements and meshers: {models}{size}. How the designs end: "
        "[robustness.md](robustness.md)."
    )


def _costs(costs: Sequence[Mapping[str, float | None]]) -> str:
    rows = []
    for row in _ROWS:
        known = [value for one in costs if (value := one[row.key]) is not None]
        if not known:
            continue
        median, p90 = np.percentile(known, (50, 90))
        cells = [cell(float(value), row.digits) for value in (median, p90, max(known))]
        rows.append([row.heading, *cells, *_verdict(row, known, float(median), float(p90))])
    headings = ["per design", "median", "90th percentile", "largest", "target", "met"]
    return table(headings, rows)


def _verdict(row: _Row, known: Sequence[float], median: float, p90: float) -> tuple[str, str]:
    """The target in words, and whether it is met."""
    wanted, is_met = [], True
    for name, limit, found in (("median", row.median, median), ("90 %", row.p90, p90)):
        if limit is not None:
            wanted.append(f"{name} ≤ {limit:g}")
            is_met = is_met and found <= limit
    if row.each is not None:
        within = sum(value <= row.each for value in known)
        share = "yes" if within == len(known) else f"{percent(within / len(known))} of designs"
        return f"each ≤ {row.each:,.0f}", share
    if not wanted:
        return "–", "–"
    return ", ".join(wanted), "yes" if is_met else "no"


def _errors(report: Mapping[str, Any]) -> list[str]:
    errors = report.get("tip_errors") or []
    if not errors:
        return []
    by_order = {
        f"the order {USUAL_ORDER:g} that the examples show": [one["error"] for one in errors],
        "the order 1.09 of the inward edges of the cavity": [
            one["largest_error"] for one in errors
        ],
    }
    told = "; ".join(f"with {name} {_spread(found)}" for name, found in by_order.items())
    text = (
        f"Discretisation error of the tip, from {len(errors)} of the designs with every edge of "
        "the mesh halved too, at the last pressure that both meshes reach. From the difference, "
        f"{told}."
    )
    rows = [
        [
            one["design_id"],
            one["mode"],
            f"{one['pressure_kPa']:g}",
            count(one["unknowns"]),
            count(one["finer_unknowns"]),
            percent(one["difference"], 2),
            percent(one["error"], 2),
            percent(one["largest_error"], 2),
        ]
        for one in errors
    ]
    headings = ["design", "mode", "kPa", "unknowns", "halved", "difference", "error, order 2"]
    headings += ["error, order 1.09"]
    return [wrapped(text), table(headings, rows)]


def _spread(errors: Sequence[float]) -> str:
    median, p90 = np.percentile(errors, (50, 90))
    within = sum(error <= ALLOWED_ERROR for error in errors)
    return (
        f"the median is {percent(float(median))}, the 90th percentile {percent(float(p90))}, the "
        f"largest {percent(max(errors))}: at most {percent(ALLOWED_ERROR, 0)} in {within} of "
        f"{len(errors)}"
    )
