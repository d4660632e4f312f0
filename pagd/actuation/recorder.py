"""Notes what a path leaves, and tells when it has to end."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.model import Model
from pagd.actuation.result import Progress, RecordedState, Stop
from pagd.errors import Status
from pagd.fem.assembly import State
from pagd.fem.clock import Clock
from pagd.fem.continuation import Step
from pagd.fem.fields import share_beyond, strains

FloatArray = NDArray[np.float64]

#: Share of the volume that may be stretched beyond the material's limit.
OVERSTRETCHED_SHARE = 0.01

# Growth of the cavity after which a state is recorded whatever its pressure.
_GROWTH = 1.25

_KPA = 1e-3  # MPa

#: The force in N on what holds the tip, at a converged state.
Force = Callable[[State], float]

_COLUMNS = (
    "pressure_kPa",
    "cavity_volume_mm3",
    "stored_energy_mJ",
    "newton_iterations",
    "smallest_gap_mm",
    "blocked_force_N",
)


@dataclass(slots=True)
class Recorder:
    """Collects the steps, interpolated states among them; called with each.

    Attributes
    ----------
    body
        The actuator.
    stop, progress
        See :func:`pagd.actuation.free_actuation`.
    force
        The force on what holds the tip, where something does.
    clock
        Processor time of the ``states``: their energies, stretches and records.
    states, ending
        The recorded states; why the analysis has to end, once it has.
    """

    body: Model
    stop: Stop | None = None
    progress: Progress | None = None
    force: Force | None = None
    clock: Clock = field(default_factory=Clock)
    states: list[RecordedState] = field(default_factory=list)
    ending: tuple[Status, str] | None = None
    _rows: list[tuple[float, ...]] = field(default_factory=list)
    _recorded: list[int] = field(default_factory=list)
    _last: State | None = None

    def __call__(self, step: Step) -> str | None:
        """Note a converged step; a reason to stop, if there is one."""
        with self.clock.part("states"):
            return self._note(step)

    def _note(self, step: Step) -> str | None:
        state = self._last = step.state
        pressure, body = state.load / _KPA, self.body
        energy = self._energy(state)
        gap = body.contact.smallest_gap if body.contact else math.inf
        volume = body.volume(state.unknowns)
        self._rows.append((pressure, volume, energy, step.iterations, gap, state.reaction))
        if step.wanted or self._has_grown():
            self.record_last()
        if self.progress:
            self.progress(pressure, step.iterations)
        self.ending = self._overstretched(state.unknowns)
        if self.ending is None and self.stop:
            self.ending = self.stop(pressure, body.displacement(state.unknowns))
        return self.ending[1] if self.ending else None

    def record_last(self) -> None:
        """Record the last converged state, unless it is recorded already."""
        row = len(self._rows) - 1
        if self._last is None or row in self._recorded:
            return
        unknowns = self._last.unknowns
        found = strains(self.body.solids, unknowns, self.body.nodes)
        displacement = self.body.displacement(unknowns)
        pressure = self._rows[row][0]
        self.states.append(
            RecordedState(pressure, displacement, found.nodes, found.largest, found.percentile_99)
        )
        self._recorded.append(row)

    def _has_grown(self) -> bool:
        """Whether the pressure has fallen, and the cavity has grown much since the last record.

        On a branch that falls no wanted pressure may come for long.
        """
        pressure, volume = self._rows[-1][:2]
        largest = max(row[0] for row in self._rows)
        return pressure < largest and volume > _GROWTH * self._rows[self._recorded[-1]][1]

    def history(self) -> dict[str, FloatArray]:
        """The columns of the history; see :class:`pagd.actuation.ActuationResult`."""
        columns = dict(zip(_COLUMNS, np.array(self._rows).T, strict=True))
        columns["stored_energy_mJ"] = columns["stored_energy_mJ"] - self._rows[0][2]
        gaps = columns["smallest_gap_mm"]
        columns["smallest_gap_mm"] = np.where(np.isfinite(gaps), gaps, np.nan)
        if self.force is None:
            del columns["blocked_force_N"]
        recorded = np.zeros(len(self._rows), np.bool_)
        recorded[self._recorded] = True
        return columns | {"recorded": recorded}

    def _energy(self, state: State) -> float:
        """All that the work of the pressure has become, in mJ; contact looks at the state."""
        terms = (term for term in self.body.terms if term is not self.body.pressure)
        return self.body.copies * sum(term.energy(state.unknowns, state.load) for term in terms)

    def _overstretched(self, unknowns: FloatArray) -> tuple[Status, str] | None:
        limit = self.body.material.largest_stretch
        share = share_beyond(self.body.solids, unknowns, limit)
        if share <= OVERSTRETCHED_SHARE:
            return None
        return Status.overstretched, (
            f"The stretch exceeds {limit:g}, the limit of {self.body.material.name}, in "
            f"{share:.1%} of the volume; {OVERSTRETCHED_SHARE:.0%} is allowed."
        )
