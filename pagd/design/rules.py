"""What makes a design buildable: the air channel, the limits, and the rules they give."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import NamedTuple, TypeVar

from pagd.design.model import Design, as_number
from pagd.errors import InputError, StageFailure, Status

__all__ = [
    "Channel",
    "GeometryRules",
    "Limits",
    "Violation",
    "check",
    "refuse",
    "under",
    "violations",
]

# 3.76 - 2 * 0.88 is not 2 in floating point, and no reader would understand the refusal.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """The air channel through walls and gaps, from the first cavity to the last (mm)."""

    width: float = 2.0
    height: float = 2.0
    roof: float = 1.5

    @property
    def gap_floor(self) -> float:
        """Height z (mm) of the floor of the gaps: the channel and its roof, at full width."""
        return self.height + self.roof


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """The smallest sizes (mm) accepted, measured normal to walls, and the largest slant."""

    cavity: float = 1.0
    cavity_above_channel: float = 1.0
    thickness: float = 0.75
    paper_cover: float = 0.5
    gap: float = 0.5
    gap_depth: float = 0.5
    theta_deg: float = 45.0


_Section = TypeVar("_Section", Channel, Limits)


@dataclass(frozen=True, slots=True, kw_only=True)
class GeometryRules:
    """Everything about the geometry that is configuration and not a design parameter."""

    channel: Channel = field(default_factory=Channel)
    limits: Limits = field(default_factory=Limits)

    @classmethod
    def from_mapping(cls, mapping: Mapping[str, Mapping[str, object]]) -> GeometryRules:
        """Rules from the sections ``channel`` and ``limits``; what is left out keeps its default.

        Raises
        ------
        InputError
            Naming the first unknown section, or every unusable key of a section.
        """
        unknown = sorted(set(mapping) - {"channel", "limits"})
        if unknown:
            raise InputError(f"{unknown[0]} is not a section of the geometry rules.")
        return cls(
            channel=_section(Channel, "channel", mapping.get("channel", {})),
            limits=_section(Limits, "limits", mapping.get("limits", {})),
        )


class Violation(NamedTuple):
    """A broken rule: the parameter to change, its value, and the rule with its limit."""

    key: str
    value: float
    rule: str

    def __str__(self) -> str:
        return f"{self.key} = {self.value:g}: {self.rule}"


def violations(design: Design, rules: GeometryRules) -> tuple[Violation, ...]:
    """Every rule that the design breaks.

    With a number that is not finite nothing else can be judged, and only those are reported.
    """
    found = tuple(_not_finite(design))
    if found:
        return found
    return (
        *_row(design, rules.limits),
        *_thicknesses(design, rules.limits),
        *_cavity(design, rules),
        *_gap(design, rules),
    )


def check(design: Design, rules: GeometryRules) -> None:
    """Refuse an invalid design.

    Raises
    ------
    StageFailure
        With status ``invalid_geometry`` and every broken rule as the reason.
    """
    refuse(violations(design, rules))


def refuse(broken: Sequence[Violation]) -> None:
    """Refuse a design that breaks any rule; see :func:`check`."""
    if broken:
        reason = "; ".join(str(violation) for violation in broken)
        raise StageFailure(Status.invalid_geometry, f"The design cannot be built: {reason}.")


def under(size: float, limit: float) -> bool:
    """Tell whether a size is under its limit by more than rounding explains."""
    return size < limit - _ROUNDING


def _not_finite(design: Design) -> Iterator[Violation]:
    for key, value in design.as_dict().items():
        if not math.isfinite(value):
            yield Violation(key, value, "must be a finite number")


def _row(design: Design, limits: Limits) -> Iterator[Violation]:
    if design.N < 1 or int(design.N) != design.N:
        yield Violation("N", design.N, "must be a whole number of at least 1")
    if not 0 <= design.theta <= limits.theta_deg:
        rule = f"must lie between 0 and {limits.theta_deg:g} degrees"
        yield Violation("theta", design.theta, rule)
    if not 0 <= design.alpha <= 1:
        yield Violation("alpha", design.alpha, "must lie between 0 and 1")


def _thicknesses(design: Design, limits: Limits) -> Iterator[Violation]:
    parts = {"t": "side walls", "t_h": "roof", "t_ab": "walls between chambers", "t_b": "base"}
    for key, part in parts.items():
        value = getattr(design, key)
        if under(value, limits.thickness):
            yield Violation(key, value, f"the {part} must be at least {limits.thickness:g} mm")
    if under(design.t_b / 2, limits.paper_cover):
        rule = (
            f"the paper, at t_b / 2 = {design.t_b / 2:g} mm, must lie at least"
            f" {limits.paper_cover:g} mm from the faces of the base"
        )
        yield Violation("t_b", design.t_b, rule)


def _cavity(design: Design, rules: GeometryRules) -> Iterator[Violation]:
    limits, channel = rules.limits, rules.channel
    length = design.L * _slant_cosine(design, limits) - 2 * design.t_ab
    width = design.W - 2 * design.t
    height = design.H - design.t_h
    sizes = (
        ("L", design.L, "L cos(theta) - 2 t_ab", length, limits.cavity),
        ("W", design.W, "W - 2 t", width, limits.cavity),
        ("H", design.H, "H - t_h", height, limits.cavity),
    )
    for key, value, formula, size, limit in sizes:
        if under(size, limit):
            rule = f"the cavity, {formula} = {size:g} mm, must be at least {limit:g} mm"
            yield Violation(key, value, rule)
    if under(width, channel.width):
        rule = f"the cavity, W - 2 t = {width:g} mm, must be as wide as the channel, "
        yield Violation("W", design.W, f"{rule}{channel.width:g} mm")
    lowest = channel.height + limits.cavity_above_channel
    if under(height, lowest):
        rule = f"the cavity, H - t_h = {height:g} mm, must be at least {lowest:g} mm high:"
        rule += f" {limits.cavity_above_channel:g} mm above the channel"
        yield Violation("H", design.H, rule)


def _gap(design: Design, rules: GeometryRules) -> Iterator[Violation]:
    limits, channel = rules.limits, rules.channel
    width = design.t_n * _slant_cosine(design, limits)
    if under(width, limits.gap):
        rule = f"the gap, t_n cos(theta) = {width:g} mm, must be at least {limits.gap:g} mm"
        yield Violation("t_n", design.t_n, rule)
    if under(channel.roof, limits.thickness):
        rule = f"the roof of the channel must be at least {limits.thickness:g} mm"
        yield Violation("channel.roof", channel.roof, rule)
    lowest = channel.gap_floor + limits.gap_depth
    if under(design.H, lowest):
        rule = f"must be at least {lowest:g} mm, {limits.gap_depth:g} mm above the gap floor"
        yield Violation("H", design.H, rule)


def _slant_cosine(design: Design, limits: Limits) -> float:
    """cos(theta) of the chambers that decide; a slant that is itself refused is left out."""
    if design.N1 <= 0 or not 0 <= design.theta <= limits.theta_deg:
        return 1.0
    return math.cos(math.radians(design.theta))


def _section(section: type[_Section], name: str, mapping: Mapping[str, object]) -> _Section:
    """The section of the rules with the values given; all must be positive, finite numbers."""
    known = {entry.name for entry in fields(section)}
    problems = [f"{name}.{key} is unknown" for key in mapping if key not in known]
    values: dict[str, float] = {}
    for key in known & set(mapping):
        number = as_number(mapping[key])
        if number is None or not (math.isfinite(number) and number > 0):
            problems.append(f"{name}.{key} = {mapping[key]!r} must be a positive number")
        else:
            values[key] = number
    if problems:
        raise InputError("Unusable geometry rules: " + "; ".join(sorted(problems)) + ".")
    return section(**values)
