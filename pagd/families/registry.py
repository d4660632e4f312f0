"""Families of actuators by their names."""

from __future__ import annotations

from importlib import import_module
from inspect import isabstract
from typing import cast

from pagd.errors import InputError
from pagd.families.interface import Actuator
from pagd.families.names import FAMILIES

__all__ = ["family_named"]


def family_named(name: object) -> type[Actuator]:
    """Return the family of that name; one of one's own is named as ``module:class``.

    Raises
    ------
    InputError
        If there is none of that name.
    """
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


def _told(name: object) -> str:
    return (
        f"family = {name!r}: must be {' or '.join(FAMILIES)}, or a module:class that can be "
        "imported"
    )
