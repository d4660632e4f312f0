"""What an analysis is told: pressures, element, tolerances, contact, support."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

ELEMENTS = ("auto", "hexahedron", "taylor_hood", "element_pressure")

#: What holds the tip while the blocked force is measured.
SUPPORTS = ("edge", "plate", "none")


@dataclass(frozen=True, slots=True, kw_only=True)
class Actuation:
    """What to do: pressures in kPa, element, tolerances.

    Attributes
    ----------
    element
        ``hexahedron`` (Q2–P−1, on blocks), ``taylor_hood`` (P2–P1), ``element_pressure``
        (P2–P0); ``auto`` takes the first on blocks and the second on other tetrahedra.
    maximum_pressure_kPa, recorded_step_kPa
        Pressure at the end; a state is recorded every so much, and at the end.
    first_step_kPa, smallest_step_kPa
        First step of the pressure; step below which the pressure is no longer controlled.
    tolerance_mm
        Largest correction of a node in the last iteration of a step.
    linear_solver
        ``auto``, ``pardiso`` or ``superlu``.
    contact
        Whether neighbouring chambers press each other apart where they touch, without friction.
    gravity_m_s2
        Acceleration (x, y, z) that acts on the elastomer before there is any pressure.
    blocked_force
        What holds the tip, one of :data:`SUPPORTS`: a frictionless support of its lower edge, a
        rigid plate under the base, or no analysis of the blocked force.
    plate_distance_mm
        Distance of the plate from the underside of the base.
    """

    element: str = "auto"
    maximum_pressure_kPa: float = 50.0
    recorded_step_kPa: float = 5.0
    first_step_kPa: float = 0.25
    smallest_step_kPa: float = 0.05
    tolerance_mm: float = 1e-2
    linear_solver: str = "auto"
    contact: bool = True
    gravity_m_s2: tuple[float, float, float] = (0.0, 0.0, 0.0)
    blocked_force: str = "edge"
    plate_distance_mm: float = 0.0

    def recorded_kPa(self) -> FloatArray:
        """The recorded pressures, in kPa."""
        count = int(np.floor(self.maximum_pressure_kPa / self.recorded_step_kPa + 1e-9))
        steps = self.recorded_step_kPa * np.arange(1, count + 1)
        if count and self.maximum_pressure_kPa - steps[-1] < 1e-9 * self.maximum_pressure_kPa:
            steps[-1] = self.maximum_pressure_kPa
            return np.asarray(steps)
        return np.append(steps, self.maximum_pressure_kPa)
