"""First guesses of a whole actuator from the solved parts of its row."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.actuation import Actuation, Stop
from pagd.actuation.body import Body
from pagd.actuation.model import Model
from pagd.design import Channel, Design
from pagd.fem.assembly import State
from pagd.fem.contact import ContactLaw
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import Mesh
from pagd.metrics.first_contact import first_contact_pressure
from pagd.reduced.history import row_history
from pagd.reduced.solve import ReducedRow, solve_row
from pagd.reduced.transfer import guess

FloatArray = NDArray[np.float64]

# The step before the first contact, as a share of its pressure; a recorded pressure as near as this
# share does as well.
_BEFORE, _NEAR = 0.97, 0.02
_SAME = 1e-9

__all__ = ["RowGuide"]


class RowGuide:
    """Guesses by the cells and pieces of a row; see :class:`pagd.actuation.Guide`.

    Parameters
    ----------
    design, channel
        What the mesh is of.
    mesh
        The row in blocks.
    size
        Longest edge of a block, in mm.
    material, paper, actuation
        As of :func:`pagd.actuation.free_actuation`.
    stop
        Ends the guesses behind the first pressure at which it ends the analysis.

    Raises
    ------
    InputError
        Where the mesh is not that of the design, or the settings rule cells out.
    """

    def __init__(
        self,
        design: Design,
        channel: Channel,
        mesh: Mesh,
        size: float,
        material: Elastomer,
        paper: Sheet,
        actuation: Actuation,
        stop: Stop | None = None,
    ) -> None:
        self.reduced: ReducedRow = solve_row(
            design, channel, size, material, paper, actuation, mesh
        )
        self._row = self.reduced.row(mesh.points, channel)
        self._wanted = actuation.recorded_kPa()
        self._last = self._usable(stop)
        self._contact_kPa = self._before_contact()

    def _usable(self, stop: Stop | None) -> float:
        """The last pressure that the analysis can come to."""
        for pressure in self.reduced.pressure_kPa:
            moved = self.reduced.displacement(self._row, float(pressure))
            if stop is not None and stop(float(pressure), moved):
                return float(pressure)
        return float(self.reduced.pressure_kPa[-1])

    def _before_contact(self) -> float | None:
        """A pressure just below that of the first contact, unless a recorded one is near."""
        history = row_history(self.reduced, 0.0)
        contact = first_contact_pressure(
            history["pressure_kPa"], history["smallest_gap_mm"], ContactLaw().width
        )
        if contact is None or not contact * _BEFORE < self._last:
            return None
        wanted = contact * _BEFORE
        near = np.abs(self._wanted - wanted).min() < _NEAR * contact
        return None if near or wanted <= 0 else wanted

    @property
    def pressure_kPa(self) -> FloatArray:
        """Rising pressures (k,) that there are guesses for, the first recorded ones."""
        return self._wanted[self._wanted <= self._last * (1 + _SAME)]

    @property
    def between_kPa(self) -> FloatArray:
        """The pressure (1,) just below that of the first contact, for the sake of the latter."""
        return np.array([] if self._contact_kPa is None else [self._contact_kPa])

    def state(self, body: Model, pressure_kPa: float) -> State:
        """The guess at a pressure."""
        if not isinstance(body, Body):
            raise TypeError("only a whole actuator has guesses from its parts")
        return guess(body, self.reduced, self._row, pressure_kPa)
