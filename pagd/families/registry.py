"""The families of actuators by name."""

from __future__ import annotations

from importlib import import_module
from inspect import isabstract
from typing import TYPE_CHECKING, cast

from pagd.errors import InputError

if TYPE_CHECKING:
    from pagd.families.interface import Actuator

__all__ = ["FAMILIES", "PNEUNET", "family_named", "name_of"]

#: The family of a design that names none.
PNEUNET = "pneunet"

#: Families by name, as module:class, so that only the one that is used is imported.
FAMILIES = {
    PNEUNET: "pagd.families.pneunet:PneuNet",
    "half_bellows": "pagd.families.half_bellows:HalfBellows",
}


def family_named(name: object) -> type[Actuator]:
    """Return the family of that name; one of one's own is named as ``module:class``.

    Raises
    ------
    InputError
        If there is none of that name.
    """
    from pagd.families.interface import Actuator

    try:
        module, _, attribute = FAMILIES.get(cast(str, name), cast(str, name)).partition(":")
        found = getattr(import_module(module), attribute)
    except Exception as error:  # a module of one's own may fail at anything
        raise InputError(f"{_told(name)} ({error}).") from error
    if not (isinstance(found, type) and issubclass(found, Actuator)):
        raise InputError(f"{_told(name)} (it is no class of pagd.families.Actuator).")
    if isabstract(found):
        lacking = ", ".join(sorted(found.__abstractmethods__))
        raise InputError(f"{_told(name)} (it lacks {lacking}).")
    return found


def name_of(family: type[Actuator]) -> str:
    """Return the name by which :func:`family_named` finds a family."""
    home = f"{family.__module__}:{family.__qualname__}"
    return next((name for name, place in FAMILIES.items() if place == home), home)


def _told(name: object) -> str:
    return (
        f"family = {name!r}: must be {' or '.join(FAMILIES)}, or a module:class that can be "
        "imported"
    )
