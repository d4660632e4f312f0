"""Contact, blocked force and limit points of designs in words, as their records tell them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from pagd.figures.captions import SUPPORTS
from pagd.figures.groups import Entry
from pagd.figures.load import has_history, load_records
from pagd.figures.style import kilopascals, number

__all__ = ["contact_note", "mechanics_of"]


def mechanics_of(entry: Entry) -> str:
    """Return sentences about contact, limit points and blocked force; none if never solved."""
    if not has_history(entry.folder):
        return ""
    solved = load_records(entry.folder)["solve"]
    settings: Mapping[str, Any] = solved.configuration.get("solve", {})
    first = entry.figures.get("first_contact_pressure_kPa")
    sentences = [
        _contact(first, solved.figures) if settings.get("contact") else _WITHOUT_CONTACT,
        _limits(solved.figures),
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
            "Walls that face each other push each other apart without friction as soon as they"
            " touch. First contact is the pressure at which they do in free actuation, and"
            " penetration how far the contact law lets them into each other"
            f"{_largest_share(on)}."
        )
    if off:
        who = "all designs" if not on else f"{off} design{'s' if off > 1 else ''}"
        sentences.append(f"Contact was off for {who}: walls that balloon may overlap there.")
    return " ".join(sentences)


_WITHOUT_CONTACT = "Contact was off: walls that balloon may overlap."


def _contact(first_kPa: float | None, figures: Mapping[str, Any]) -> str:
    if first_kPa is None:
        return "No walls touched in free actuation."
    depth, share = figures.get("deepest_penetration_mm"), figures.get("penetration_share")
    told = f"In free actuation walls first touch at {kilopascals(first_kPa)}"
    if depth is not None and depth <= 0.0:
        told += " and do not penetrate"
    elif depth is not None:
        told += f" and penetrate by at most {number(depth, 3)} mm"
        told += "" if share is None else f", {_percent(share)} of the gap between them"
    return f"{told}."


def _limits(figures: Mapping[str, Any]) -> str:
    count, start = figures.get("limit_points"), figures.get("volume_controlled_from_kPa")
    points = f"The pressure has {count} limit point{'s' if count != 1 else ''}." if count else ""
    control = "" if start is None else f"From {kilopascals(start)} on the volume was controlled."
    return " ".join(filter(None, (points, control)))


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


def _largest_share(figures: Iterable[Mapping[str, Any]]) -> str:
    shares = [f["penetration_share"] for f in figures if f.get("penetration_share") is not None]
    return f", by {_percent(max(shares))} of the gap where it is deepest" if shares else ""


def _percent(share: float) -> str:
    least = 0.001
    told = f"{number(100.0 * max(share, least), 1)} %"
    return told if share >= least else f"less than {told}"
