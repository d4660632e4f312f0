"""The pneu-net, as the stages that know of no family ask for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pagd.design import (
    PARAMETERS,
    Design,
    GeometryRules,
    Mode,
    Parameter,
    Violation,
    base_volume,
    body_volume,
    cavity_volume,
    violations,
)
from pagd.families.interface import Actuator, Derived, Volumes

if TYPE_CHECKING:
    from typing import Any, Self

    from pagd.mesh.types import Mesh
    from pagd.metrics import Kind
    from pagd.sections import Stations

__all__ = ["PneuNet"]


@dataclass(frozen=True, slots=True)
class PneuNet(Actuator):
    """A pneu-net: a row of chambers on a base, straight or slanted."""

    design: Design

    @classmethod
    def parameters(cls) -> Mapping[str, Parameter]:
        """Return the eleven parameters of the paper."""
        return PARAMETERS

    @classmethod
    def from_mapping(cls, mapping: Mapping[str, Any]) -> Self:
        """Make one as :meth:`pagd.design.Design.from_mapping` does."""
        return cls(Design.from_mapping(mapping))

    def as_dict(self) -> dict[str, float | int]:
        """Return the eleven parameters by symbol."""
        return self.design.as_dict()

    def violations(self, rules: GeometryRules) -> tuple[Violation, ...]:
        """Return every rule that it breaks: :func:`pagd.design.violations`."""
        return violations(self.design, rules)

    def model(self) -> str:
        """Return the text of ``pagd/scad/pneunet.scad``."""
        path = resources.files("pagd").joinpath("scad", "pneunet.scad")
        return path.read_text(encoding="utf-8")

    def settings(self, rules: GeometryRules) -> dict[str, str]:
        """Return parameters and air channel.

        Where gaps or base thicknesses differ along the row, they are written chamber by chamber.
        """
        return Actuator.settings(self, rules) | {
            "channel_width": repr(rules.channel.width),
            "channel_height": repr(rules.channel.height),
            "channel_roof": repr(rules.channel.roof),
            "t_n_each": _vector_unless_constant(self.design.gaps()),
            "t_b_each": _vector_unless_constant(self.design.base_thicknesses()),
        }

    @property
    def L_T(self) -> float:
        """Total length, mm."""
        return self.design.L_T

    @property
    def is_symmetric(self) -> bool:
        """Whether no chamber is slanted."""
        return self.design.is_straight

    @property
    def mode(self) -> Mode:
        """The deformation that the design is drawn for."""
        return self.design.mode

    def volumes(self, rules: GeometryRules) -> Volumes:
        """Return the exact volumes: :mod:`pagd.design.volumes`."""
        return Volumes(
            body=body_volume(self.design, rules),
            base=base_volume(self.design),
            cavity=cavity_volume(self.design, rules),
        )

    # What needs sections and meshes is imported there: compiled code, which takes a second that
    # nobody who checks a design has to wait for.

    def stations(self) -> Stations:
        """Return fixed end, chamber boundaries and tip: :func:`pagd.sections.stations_of`."""
        from pagd.sections import stations_of

        return stations_of(self.design)

    def kinds(self) -> list[Kind]:
        """Return whether each chamber is helical or straight."""
        from pagd.metrics import kinds_of

        return kinds_of(self.design)

    def blocks(self, rules: GeometryRules, size: float, *, half: bool) -> Mesh:
        """Divide the row into blocks: :func:`pagd.mesh.chamber_row.chamber_row`."""
        from pagd.mesh.chamber_row import chamber_row

        return chamber_row(self.design, rules.channel, size, half=half)

    def derived(self) -> tuple[Derived, ...]:
        """Return total length, numbers of chambers and mode."""
        return (
            *Actuator.derived(self),
            Derived("N1", self.design.N1, "1", "number of helical chambers, from the fixed end"),
            Derived("N2", self.design.N2, "1", "number of straight chambers, at the tip"),
            Derived("mode", self.mode, "", "deformation it is drawn for"),
        )

    def figures(self) -> dict[str, Any]:
        """Return total length, numbers of chambers, mode and cross-section."""
        design = self.design
        return {
            "L_T_mm": design.L_T,
            "N1": design.N1,
            "N2": design.N2,
            "mode": design.mode,
            "cross_section": design.cross_section,
        }


def _vector_unless_constant(values: NDArray[np.float64]) -> str:
    """Return the values as an OpenSCAD vector; empty where they are all the same."""
    if values.size == 0 or np.all(values == values[0]):
        return "[]"
    return str(values.tolist())
