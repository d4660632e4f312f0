"""Processor seconds of one run by part, from its kept figures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

__all__ = ["PARTS", "parts_of", "per_iteration"]

#: Parts of the time of a run: name in a table, and which of ``profile_s`` they are the sum of.
_OF_THE_PROFILE: Mapping[str, tuple[str, ...]] = {
    "assembly": ("assembly",),
    "analysis": ("analysis",),
    "factorisation": ("factorisation",),
    "solution": ("solution",),
}

#: All parts, in the order of the tables.
PARTS = ("mesh", *_OF_THE_PROFILE, "rest", "all")

#: Parts that every Newton iteration has.
_OF_AN_ITERATION = ("assembly", "factorisation", "solution")


def parts_of(figures: Mapping[str, Any]) -> dict[str, float | None]:
    """Return processor seconds by part; None for parts that the record of solve does not tell.

    ``mesh`` is the stage; ``rest`` is what is left of ``all``, the process with its imports.
    """
    profile = figures.get("profile_s") or {}
    found = {
        part: sum(profile[key] for key in keys) if all(key in profile for key in keys) else None
        for part, keys in _OF_THE_PROFILE.items()
    }
    mesh, whole = figures["stages_cpu_s"]["mesh"], _whole(figures)
    rest = whole - mesh - sum(seconds for seconds in found.values() if seconds)
    return {"mesh": mesh, **found, "rest": rest, "all": whole}


def per_iteration(figures: Mapping[str, Any]) -> dict[str, float | None]:
    """Return processor seconds a Newton iteration, by part; ``free actuation`` is all of it.

    Factorisations are counted by themselves where the record tells how many there were.
    """
    iterations = figures["newton_iterations"]
    if not iterations:
        return dict.fromkeys((*_OF_AN_ITERATION, "free actuation"))
    parts = parts_of(figures)
    found = {part: _divided(parts[part], iterations) for part in _OF_AN_ITERATION}
    factorisations = figures.get("factorisations") or iterations
    found["factorisation"] = _divided(parts["factorisation"], factorisations)
    return found | {"free actuation": _divided(figures["free_cpu_s"], iterations)}


def _whole(figures: Mapping[str, Any]) -> float:
    whole = figures.get("process_cpu_s")
    return float(sum(figures["stages_cpu_s"].values()) if whole is None else whole)


def _divided(seconds: float | None, number: int) -> float | None:
    return None if seconds is None else seconds / number
