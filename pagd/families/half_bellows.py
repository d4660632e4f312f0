"""A half-bellows bending actuator: half of a bellows on a flat base with a sheet of paper inside.

The bellows is a tube with convolutions of a trapezoidal profile, cut along its axis. Pitch q,
height w and wall t of the convolutions have the symbols of the Standards of the Expansion Joint
Manufacturers Association. The half circle is a polygon of :data:`FACETS` equal sides, with its
corners on the radius.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from pagd.design import GeometryRules, Limits, Violation
from pagd.design.rules import under
from pagd.families.interface import Derived, Volumes
from pagd.families.tabled import TabledActuator

if TYPE_CHECKING:
    from pagd.sections import Stations

__all__ = ["FACETS", "HalfBellows"]

#: Sides of the polygon that stands for the half circle; even, so that a corner has y = 0.
FACETS = 16

Corner = tuple[float, float]


class HalfBellows(TabledActuator):
    """Half of a bellows on a base; it bends towards the paper."""

    @property
    def L_T(self) -> float:
        """Total length, mm: the convolutions and the walls at both ends."""
        return self["N"] * self["q"] + 2 * self["t_e"]

    @property
    def W(self) -> float:
        """Width of the base, mm: the crests and the flange on both sides."""
        return 2 * (self["R"] + self["w"] + self["b_f"])

    @property
    def is_symmetric(self) -> bool:
        """It always is."""
        return True

    @property
    def run(self) -> float:
        """Extent of a flank along the axis, mm."""
        return (self["q"] - self["L_c"] - self["L_r"]) / 2

    @property
    def shift(self) -> float:
        """How far the wall moves a corner of the profile along the axis, mm, towards the crest.

        Inside, crests are shorter by twice as much and roots longer: both lines that meet in a
        corner keep the distance t from those outside.
        """
        return self["t"] * math.tan(math.atan2(self["w"], self.run) / 2)

    def settings(self, rules: GeometryRules) -> dict[str, str]:
        """Return the parameters, and the number of facets."""
        return TabledActuator.settings(self, rules) | {"facets": repr(FACETS)}

    def broken(self, rules: GeometryRules) -> Iterator[Violation]:
        """Yield every rule that a design of finite numbers breaks."""
        if self["N"] < 1:
            yield Violation("N", self["N"], "must be at least 1")
        yield from self._thin(rules.limits)
        yield from self._tight(rules.limits)

    def _thin(self, limits: Limits) -> Iterator[Violation]:
        parts = {"t": "wall", "t_e": "end walls", "t_b": "base", "b_f": "flange"}
        for key, part in parts.items():
            if under(self[key], limits.thickness):
                rule = f"the {part} must be at least {limits.thickness:g} mm"
                yield Violation(key, self[key], rule)
        if under(self["t_b"] / 2, limits.paper_cover):
            rule = f"the paper, at t_b / 2, must lie {limits.paper_cover:g} mm from the faces"
            yield Violation("t_b", self["t_b"], rule)

    def _tight(self, limits: Limits) -> Iterator[Violation]:
        if under(self.run, 0.0):
            yield Violation("q", self["q"], "crest and root, L_c + L_r, must not be longer")
            return
        sizes = (
            ("w", "the height of the convolutions", self["w"], limits.gap_depth),
            ("L_r", "the gap between convolutions", self["L_r"], limits.gap),
            ("R", "the cavity at the roots, R - t", self["R"] - self["t"], limits.cavity),
            ("L_c", "the cavity in the crests", self["L_c"] - 2 * self.shift, limits.cavity),
        )
        for key, name, size, limit in sizes:
            if under(size, limit):
                rule = f"{name}, {size:.4g} mm, must be at least {limit:g} mm"
                yield Violation(key, self[key], rule)

    def volumes(self, rules: GeometryRules) -> Volumes:
        """Return the exact volumes of the faceted solid."""
        slab = self.L_T * self.W * self["t_b"] / 2
        outside = _volume(self.profile(0.0, self.L_T))
        wall, end = self["t"], self["t_e"]
        cavity = _volume(self.profile(end, self.L_T - end, wall, self.shift))
        return Volumes(body=slab + outside - cavity, base=slab, cavity=cavity)

    def profile(
        self, start: float, end: float, wall: float = 0.0, shift: float = 0.0
    ) -> list[Corner]:
        """Return the corners (x, radius) of the profile, outside or with the wall taken off."""
        low, high = self["R"] - wall, self["R"] + self["w"] - wall
        corners = [(start, low)]
        for begin in self["t_e"] + self["q"] * np.arange(self.values["N"]):
            x = float(begin)
            up, down = x + self["L_r"] / 2 + shift, x + self["q"] - self["L_r"] / 2 - shift
            corners += [(up, low), (up + self.run, high), (down - self.run, high), (down, low)]
        return [*corners, (end, low)]

    def stations(self) -> Stations:
        """Return fixed end, the middles of the roots between convolutions, and tip."""
        # Compiled code, which takes a second that nobody who checks a design has to wait for.
        from pagd.sections import Stations

        between = np.arange(1, self.values["N"])
        names = ("fixed end", *(f"convolution {i}|{i + 1}" for i in between), "tip")
        return Stations(np.array([0.0, *(self["t_e"] + self["q"] * between), self.L_T]), names)

    def derived(self) -> tuple[Derived, ...]:
        """Return total length and width of the base."""
        width = Derived("W", self.W, "mm", "width of the base")
        return (*TabledActuator.derived(self), width)


def _volume(profile: list[Corner]) -> float:
    """Return the volume (mm³) of half a turn of a profile about the x axis, in facets.

    Across x it is half of a polygon with 2 n corners on the radius r, of area n/2 r² sin(π/n); and
    r is linear between the corners of the profile.
    """
    x, r = np.array(profile).T
    squares = np.diff(x) * (r[1:] ** 2 + r[1:] * r[:-1] + r[:-1] ** 2) / 3
    return float(FACETS / 2 * math.sin(math.pi / FACETS) * squares.sum())
