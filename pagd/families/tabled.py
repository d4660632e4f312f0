"""The base of a family that is three files: a class, a table of parameters, an OpenSCAD model."""

from __future__ import annotations

import hashlib
import inspect
import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pagd.design import GeometryRules, Parameter, Violation
from pagd.design.model import as_number
from pagd.errors import InputError
from pagd.families.interface import Actuator
from pagd.families.parameters import read_parameters
from pagd.files import must_exist

if TYPE_CHECKING:
    from typing import Any, Self

__all__ = ["TabledActuator"]


@dataclass(frozen=True, slots=True)
class TabledActuator(Actuator):
    """A design whose parameters a table lists, as a base class for families.

    The module of the class, NAME.py, has NAME.csv beside it, the table
    (:func:`pagd.families.parameters.read_parameters`), and NAME.scad, the model
    (:meth:`pagd.families.Actuator.model`). ``actuator["t"]`` is the value of the parameter t.
    """

    values: Mapping[str, float | int]

    @classmethod
    def parameters(cls) -> Mapping[str, Parameter]:
        """Return what the table beside the class says; InputError if it cannot be read."""
        return read_parameters(_beside(cls, ".csv"))

    @classmethod
    def from_mapping(cls, mapping: Mapping[str, Any]) -> Self:
        """Make a design from parameter values by symbol; numbers may be given as text.

        Raises
        ------
        InputError
            Naming every key that is unknown, missing, not a number, or not whole where it must be.
        """
        parameters = cls.parameters()
        problems = [f"{key} is not a design parameter" for key in mapping if key not in parameters]
        problems += [f"{symbol} is missing" for symbol in parameters if symbol not in mapping]
        values: dict[str, float | int] = {}
        for symbol in (symbol for symbol in parameters if symbol in mapping):
            number = as_number(mapping[symbol])
            if number is None:
                problems.append(f"{symbol} = {mapping[symbol]!r} is not a number")
            elif parameters[symbol].whole and not number.is_integer():
                problems.append(f"{symbol} = {number:g} is not a whole number")
            else:
                values[symbol] = int(number) if parameters[symbol].whole else number
        if problems:
            raise InputError("Unusable design: " + "; ".join(problems) + ".")
        return cls(values)

    @classmethod
    def digest(cls) -> str:
        """Return the first 16 hexadecimal digits of the SHA-256 of the three files."""
        files = (_beside(cls, ending) for ending in (".py", ".csv", ".scad"))
        found = hashlib.sha256()
        for file in files:
            must_exist(file)
            found.update(file.read_bytes())
        return found.hexdigest()[:16]

    def __getitem__(self, symbol: str) -> float:
        return self.values[symbol]

    def __hash__(self) -> int:
        return hash((type(self), *self.values.items()))

    def as_dict(self) -> dict[str, float | int]:
        """Return the values by symbol, in the order of the table."""
        return dict(self.values)

    def model(self) -> str:
        """Return the text of the model beside the class; InputError if it cannot be read."""
        path = _beside(type(self), ".scad")
        try:
            return path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"OpenSCAD model {path}: cannot be read ({error}).") from None

    def violations(self, rules: GeometryRules) -> tuple[Violation, ...]:
        """Return every rule that the design breaks.

        With a number that is not finite nothing else can be judged, and only those are reported.
        """
        odd = [(key, value) for key, value in self.values.items() if not math.isfinite(value)]
        if odd:
            return tuple(Violation(*pair, "must be a finite number") for pair in odd)
        return tuple(self.broken(rules))

    @abstractmethod
    def broken(self, rules: GeometryRules) -> Iterator[Violation]:
        """Yield every rule that a design of finite numbers breaks."""


def _beside(family: type[TabledActuator], ending: str) -> Path:
    return Path(inspect.getfile(family)).with_suffix(ending)
