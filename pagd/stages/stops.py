"""What ends an analysis before its last pressure: too much bending, an actuator in its own way."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.actuation import Stop
from pagd.errors import Status
from pagd.mesh.types import Mesh
from pagd.metrics import measure
from pagd.stages.sections import even_stations_of, sections_of

__all__ = ["bending_stop", "first_of"]

# Sections for the limit of bending: enough that no piece between two turns by 180°.
_SECTIONS = 13


def bending_stop(mesh: Mesh, limit_deg: float) -> Stop | None:
    """Return what ends the analysis where the tip has bent beyond the limit; None without paper."""
    if "paper" not in mesh.surfaces:
        return None
    sections = sections_of(mesh, even_stations_of(mesh, _SECTIONS))

    def stop(pressure_kPa: float, moved: NDArray[np.float64]) -> tuple[Status, str] | None:
        trajectory = measure(sections, np.array([pressure_kPa]), moved[None])
        bending = abs(float(trajectory.bending_deg[-1, -1]))
        if bending <= limit_deg:
            return None
        reason = f"At {pressure_kPa:.4g} kPa it bends by {bending:.1f}°, over {limit_deg:g}°."
        return Status.bending_limit, reason

    return stop


def first_of(*stops: Stop | None) -> Stop:
    """Return the stop that ends an analysis where one of ``stops`` does, asked in this order."""
    known = [stop for stop in stops if stop is not None]

    def stop(pressure_kPa: float, moved: NDArray[np.float64]) -> tuple[Status, str] | None:
        endings = (each(pressure_kPa, moved) for each in known)
        return next((ending for ending in endings if ending), None)

    return stop
