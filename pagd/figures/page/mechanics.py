"""Contact, blocked force and limit points of designs in words, as their records tell them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from pagd.figures.captions import SUPPORTS
from pagd.figures.groups import Entry
from pagd.figures.load import has_history, load_history, load_records
from pagd.figures.style import kilopascals, number
from pagd.figures.touching import touching_mm

__all__ = ["contact_note", "mechanics_of"]


def mechanics_of(entry: Entry) -> str:
    """Return sentences about contact, pressure and blocked force; none if never solved."""
    if not has_history(entry.folder):
        return ""
    solved = load_records(entry.folder)["solve"]
    settings: Mapping[str, Any] = solved.configuration.get("solve", {})
    sentences = [
        _contact(entry, solved.figures) if settings.get("contact") else _WITHOUT_CONTACT,
        _limits(solved.figures),
        _largest_pressure(solved.figures),
        _blocked(settings, solved.figures.get("blocked_force")),
    ]
    return " ".join(filter(None, sentences))


def contact_note(entries: Iterable[Entry]) -> str:
    """Return sentences about contact in all designs that were solved; none if none was."""
    solved = [load_records(e.folder)["solve"] for e in entries if has_history(e.folder)]
    on = [r.figures for r in solved if r.configuration.get("solve", {}).get("contact")]
    off = len(solved) - len(on)
    sentences = []
    if on:
        sentences.append(
            "Walls that face each other touch where the gap between them is below"
            f" {number(touching_mm(), 2)} mm: there the contact law begins to push them apart,"
            " without friction. First contact is the pressure at which they do in free actuation,"
            " and penetration how far they are pressed into each other, at the points of the faces"
            f" that the law acts at{_deepest(on)}."
        )
    if off:
        who = "all designs" if not on else f"{off} design{'s' if off > 1 else ''}"
        sentences.append(f"Contact was off for {who}: walls that balloon may overlap there.")
    return " ".join(sentences)


_WITHOUT_CONTACT = "Contact was off: walls that balloon may overlap."


def _contact(entry: Entry, figures: Mapping[str, Any]) -> str:
    gaps = load_history(entry.folder).smallest_gap_mm
    if not np.any(gaps < touching_mm()):
        return "No walls touched in free actuation."
    first = entry.figures.get("first_contact_pressure_kPa")
    told = "In free actuation walls " + (
        "touch" if first is None else f"first touch at {kilopascals(first)}"
    )
    depth = figures.get("deepest_penetration_mm")
    if depth is None:
        return f"{told}."
    if depth <= 0.0:
        return f"{told}, and nowhere overlap."
    return f"{told}, and overlap by at most {_depth(figures)}."


def _limits(figures: Mapping[str, Any]) -> str:
    count, start = figures.get("limit_points"), figures.get("volume_controlled_from_kPa")
    points = f"The pressure has {count} limit point{'s' if count != 1 else ''}." if count else ""
    control = "" if start is None else f"From {kilopascals(start)} on the volume was controlled."
    return " ".join(filter(None, (points, control)))


def _largest_pressure(figures: Mapping[str, Any]) -> str:
    """Return a sentence where the pressure did not end, by more than 1 %, at its largest."""
    largest, last = figures.get("largest_pressure_kPa"), figures.get("pressure_kPa")
    if largest is None or last is None or largest - last <= 0.01 * largest:
        return ""
    return f"The pressure went through {kilopascals(largest)} and ended at {kilopascals(last)}."


def _blocked(settings: Mapping[str, Any], ending: Mapping[str, Any] | None) -> str:
    if ending is None:
        return "No blocked force was asked for." if settings.get("blocked_force") == "none" else ""
    support = SUPPORTS.get(str(ending.get("variant")), str(ending.get("variant")))
    force, pressure = ending.get("blocked_force_N"), ending.get("pressure_kPa")
    told = f"Blocked force ({support})"
    if force is not None and pressure is not None:
        told += f": {number(force, 3)} N at {kilopascals(pressure)}"
    if ending.get("status") == "ok":
        return f"{told}."
    why = str(ending.get("status")).replace("_", " ")
    return f"{told}, where it ended: {why}. {ending.get('reason') or ''}".rstrip()


def _deepest(figures: Iterable[Mapping[str, Any]]) -> str:
    """Return the end of a sentence about the design whose walls overlap most by their gap."""
    known = [f for f in figures if f.get("deepest_penetration_mm") is not None]
    if not known:
        return ""
    worst = max(known, key=lambda f: (f.get("penetration_share") or 0.0, _overlap(f)))
    return f": by at most {_depth(worst)}" if _overlap(worst) > 0.0 else "; walls nowhere overlap"


def _overlap(figures: Mapping[str, Any]) -> float:
    return float(figures["deepest_penetration_mm"])


def _depth(figures: Mapping[str, Any]) -> str:
    """Return a penetration in words, with its share of the gap if that is known."""
    depth, share = _at_least(_overlap(figures), 3), figures.get("penetration_share")
    of_gap = "" if share is None else f", {_at_least(100.0 * share, 1)} % of the gap"
    return f"{depth} mm{of_gap}"


def _at_least(value: float, digits: int) -> str:
    """Return a positive number, or what it is less than where it would be rounded to nothing."""
    least = 10.0**-digits
    return number(value, digits) if value >= least else f"less than {number(least, digits)}"
