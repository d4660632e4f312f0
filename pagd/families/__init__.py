"""Families of actuators: what the stages ask of a design, and the families there are.

A family is a class of :class:`Actuator`, found by its name (:data:`FAMILIES`) or as
``module:class``. :class:`TabledActuator` makes one of three files.
"""

from pagd.design import Design
from pagd.families.interface import Actuator, Derived, Volumes
from pagd.families.names import FAMILIES, PNEUNET, name_of
from pagd.families.pneunet import PneuNet
from pagd.families.registry import family_named
from pagd.families.tabled import TabledActuator

__all__ = [
    "FAMILIES",
    "PNEUNET",
    "Actuator",
    "Derived",
    "PneuNet",
    "TabledActuator",
    "Volumes",
    "actuator_of",
    "family_named",
    "name_of",
]


def actuator_of(design: Design | Actuator) -> Actuator:
    """Return a design as the stages ask for it: a pneu-net's parameters as an actuator."""
    return PneuNet(design) if isinstance(design, Design) else design
