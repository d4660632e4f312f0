"""One design: the independent parameters and what follows from them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any, Final, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError

__all__ = ["MODES", "CrossSection", "Design", "Mode", "as_number"]

Mode = Literal["bending", "twisting", "mixed"]
#: All modes, in the order of every list of them.
MODES: Final[tuple[Mode, ...]] = get_args(Mode)
CrossSection = Literal["rectangular"]
FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """The independent parameters of a pneu-net (mm, degrees) and the dependent ones.

    x runs along the actuator from the fixed end, y across, z up; z = 0 is the top of the
    base. L, W and H are outer sizes of a chamber. A helical chamber is a straight one sheared
    in x by y tan(theta). Making a ``Design`` checks nothing: ask :func:`pagd.design.check`.

    Chambers that are helical by number (``alpha`` > 0) but have ``theta`` = 0 are straight,
    and ``theta`` has no effect where no chamber is helical: both designs have mode "bending".
    """

    L: float
    W: float
    H: float
    t: float
    t_n: float
    t_h: float
    t_ab: float
    t_b: float
    N: int
    theta: float
    alpha: float

    @classmethod
    def from_mapping(cls, mapping: Mapping[str, object]) -> Design:
        """Make a design from parameter values by symbol; numbers may be given as text.

        Raises
        ------
        InputError
            Naming every key that is unknown, missing, or not a number, and N if not whole.
        """
        symbols = [field.name for field in fields(cls)]
        problems = [f"{key} is not a design parameter" for key in mapping if key not in symbols]
        problems += [f"{symbol} is missing" for symbol in symbols if symbol not in mapping]
        values: dict[str, Any] = {}
        for symbol in symbols:
            if symbol in mapping:
                values[symbol] = number = as_number(mapping[symbol])
                if number is None:
                    problems.append(f"{symbol} = {mapping[symbol]!r} is not a number")
        count = values.get("N")
        if count is not None and not float(count).is_integer():
            problems.append(f"N = {count:g} is not a whole number")
        if problems:
            raise InputError("Unusable design: " + "; ".join(problems) + ".")
        return cls(**(values | {"N": int(values["N"])}))

    def as_dict(self) -> dict[str, float | int]:
        """The eleven independent parameters by symbol, in the order of Table 2."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def N1(self) -> int:
        """Number of helical chambers, from the fixed end: alpha N rounded, halves upwards."""
        return math.floor(self.alpha * self.N + 0.5)

    @property
    def N2(self) -> int:
        """Number of straight chambers, at the tip."""
        return self.N - self.N1

    @property
    def mode(self) -> Mode:
        """The deformation the design is drawn for, from the chambers that are really slanted."""
        if self.N1 == 0 or self.theta == 0:
            return "bending"
        return "twisting" if self.N2 == 0 else "mixed"

    @property
    def cross_section(self) -> CrossSection:
        """Shape of a chamber across x; the only one so far."""
        return "rectangular"

    @property
    def is_straight(self) -> bool:
        """No chamber is slanted, so that the plane y = 0 is a plane of symmetry."""
        return self.mode == "bending"

    @property
    def skew(self) -> float:
        """Shear dx/dy = tan(theta) of the helical chambers; 0 where there are none."""
        return math.tan(math.radians(self.theta)) if self.N1 > 0 else 0.0

    @property
    def half_skew(self) -> float:
        """x-distance (mm) by which a helical chamber's corner runs ahead of its middle."""
        return self.W / 2 * self.skew

    @property
    def pitch(self) -> float:
        """Distance (mm) from chamber to chamber along x."""
        return self.L + self.t_n

    @property
    def L_T(self) -> float:
        """Total length (mm), with two half-skews where there is any helical chamber."""
        return float(self.N * self.L + self.gaps().sum() + 2 * self.half_skew)

    def gaps(self) -> FloatArray:
        """Gap (mm, along x) behind each chamber but the last, shape (N - 1,)."""
        return np.full(self.N - 1, self.t_n, dtype=np.float64)

    def base_thicknesses(self) -> FloatArray:
        """Thickness of the base (mm) under each chamber, shape (N,)."""
        return np.full(self.N, self.t_b, dtype=np.float64)

    def chamber_skews(self) -> FloatArray:
        """Shear dx/dy of each chamber, shape (N,)."""
        return np.where(np.arange(self.N) < self.N1, self.skew, 0.0)

    def chamber_starts(self) -> FloatArray:
        """Positions x (mm) where each chamber begins at y = 0, shape (N,).

        The row begins half a skew in; where helical chambers give way to straight ones,
        another half-skew keeps the last helical corner t_n away from the first straight wall.
        """
        steps = np.concatenate(([0.0], np.cumsum(self.L + self.gaps())))
        after_change = (np.arange(self.N) >= self.N1) & (self.N1 > 0)
        return self.half_skew + steps + np.where(after_change, self.half_skew, 0.0)

    def end_wall_lengths(self) -> FloatArray:
        """x-extent (mm) of the walls of thickness t_ab of each chamber, shape (N,)."""
        # t_ab is normal to the wall, and 1 / cos(theta) = hypot(1, tan(theta)).
        return self.t_ab * np.hypot(1.0, self.chamber_skews())


def as_number(value: object) -> float | None:
    """The value as a float, from a number or the text of one; ``None`` for anything else."""
    if isinstance(value, bool) or not isinstance(value, (Real, str)):
        return None
    try:
        return float(value)
    except ValueError:
        return None
