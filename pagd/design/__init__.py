"""The design of a pneu-net: parameters, dependent ones, validity rules and exact volumes."""

from pagd.design.identity import identity
from pagd.design.model import MODES, CrossSection, Design, Mode
from pagd.design.parameters import DECIMALS, PARAMETERS, Parameter
from pagd.design.rules import Channel, GeometryRules, Limits, Violation, check, violations
from pagd.design.volumes import base_volume, body_volume, cavity_volume, solid_volume

__all__ = [
    "DECIMALS",
    "MODES",
    "PARAMETERS",
    "Channel",
    "CrossSection",
    "Design",
    "GeometryRules",
    "Limits",
    "Mode",
    "Parameter",
    "Violation",
    "base_volume",
    "body_volume",
    "cavity_volume",
    "check",
    "identity",
    "solid_volume",
    "violations",
]
