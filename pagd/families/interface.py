"""What the stages ask of a design, of whatever family of actuators it is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from pagd.design import GeometryRules, Mode, Parameter, Violation
from pagd.design.rules import refuse
from pagd.errors import StageFailure, Status
from pagd.families.names import name_of

if TYPE_CHECKING:
    from typing import Any, Self

    from pagd.mesh.types import Mesh
    from pagd.metrics import Kind
    from pagd.sections import Stations

__all__ = ["Actuator", "Derived", "Volumes"]


class Volumes(NamedTuple):
    """Exact volumes of a design's parts in mm³: what its mesh is measured against."""

    body: float
    base: float
    cavity: float

    @property
    def solid(self) -> float:
        """Volume of the elastomer, mm³."""
        return self.body + self.base


class Derived(NamedTuple):
    """A size that follows from the parameters: for people, beside them."""

    symbol: str
    value: float | int | str
    unit: str
    description: str


class Actuator(ABC):
    """A design of a family of actuators.

    x runs along the actuator from the fixed end at x = 0, y across, z up. The paper lies in a plane
    normal to z: the body, which is hollow, above it, and the base below it. Lengths are in mm.
    Making one checks nothing: ask :meth:`violations` or :meth:`check`.
    """

    @classmethod
    @abstractmethod
    def parameters(cls) -> Mapping[str, Parameter]:
        """Return the independent parameters of the family by symbol, in the order of all lists."""

    @classmethod
    @abstractmethod
    def from_mapping(cls, mapping: Mapping[str, Any]) -> Self:
        """Make a design from parameter values by symbol; numbers may be given as text.

        Raises
        ------
        InputError
            Naming every key that is unknown, missing or of the wrong kind.
        """

    @abstractmethod
    def as_dict(self) -> dict[str, float | int]:
        """Return the independent parameters by symbol, in their order."""

    @abstractmethod
    def violations(self, rules: GeometryRules) -> tuple[Violation, ...]:
        """Return every rule that the design breaks; none if it can be built."""

    @abstractmethod
    def model(self) -> str:
        """Return the OpenSCAD model of the family, as text.

        It draws what its variable ``part`` says, "body", "base" or "cavity", and the half y ≥ 0 of
        it where ``half`` is true. Settings have a line each, ``name = value;``, and may end in a
        comment ``// [low:step:high]``, the range of a slider.
        """

    @property
    @abstractmethod
    def L_T(self) -> float:
        """Total length, mm."""

    @property
    @abstractmethod
    def is_symmetric(self) -> bool:
        """Whether the plane y = 0 is a plane of symmetry, so that half of it will do."""

    @property
    def family(self) -> str:
        """Name of the family, as a design's file has it."""
        return name_of(type(self))

    @property
    def mode(self) -> Mode:
        """The deformation that the design is drawn for.

        A symmetric one can only bend. Others twist as well, unless a family tells more of them.
        """
        return "bending" if self.is_symmetric else "twisting"

    @classmethod
    def digest(cls) -> str | None:
        """Return what changes with the family's files; None if pagd's own version tells."""
        return None

    def check(self, rules: GeometryRules) -> None:
        """Refuse a design that cannot be built.

        Raises
        ------
        StageFailure
            With status ``invalid_geometry`` and every broken rule as the reason.
        """
        refuse(self.violations(rules))

    def settings(self, rules: GeometryRules) -> dict[str, str]:
        """Return the values of the model's settings by name, as OpenSCAD writes them."""
        return {symbol: repr(value) for symbol, value in self.as_dict().items()}

    def volumes(self, rules: GeometryRules) -> Volumes | None:
        """Return the exact volumes; None if they are not known, and the surfaces' own count."""
        return None

    def stations(self) -> Stations | None:
        """Return where sections are followed; None for evenly spaced ones."""
        return None

    def kinds(self) -> list[Kind] | None:
        """Return the kind of each piece between two stations; None if there are no kinds."""
        return None

    def blocks(self, rules: GeometryRules, size: float, *, half: bool) -> Mesh:
        """Divide the design itself into blocks, with edges of at most ``size`` mm.

        Raises
        ------
        StageFailure
            ``mesh_failed`` if the family has no such mesher: the next one is tried.
        """
        reason = f"The family {self.family} has no mesher of its own."
        raise StageFailure(Status.mesh_failed, reason)

    def derived(self) -> tuple[Derived, ...]:
        """Return what follows from the parameters, for people."""
        return (Derived("L_T", self.L_T, "mm", "total length"),)

    def figures(self) -> dict[str, Any]:
        """Return what the record says of the design's shape, with units in the keys."""
        return {"family": self.family, "L_T_mm": self.L_T, "mode": self.mode}
