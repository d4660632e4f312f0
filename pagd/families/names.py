"""Names of the families of actuators, and where each is."""

from __future__ import annotations

__all__ = ["FAMILIES", "PNEUNET", "name_of"]

#: The family of a design that names none.
PNEUNET = "pneunet"

#: Families by name, as module:class, so that only the one that is used is imported.
FAMILIES = {
    PNEUNET: "pagd.families.pneunet:PneuNet",
    "half_bellows": "pagd.families.half_bellows:HalfBellows",
}


def name_of(family: type) -> str:
    """Return the name by which :func:`pagd.families.family_named` finds a family."""
    home = f"{family.__module__}:{family.__qualname__}"
    return next((name for name, place in FAMILIES.items() if place == home), home)
