"""What an analysis leaves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.model import Model
from pagd.errors import Status
from pagd.fem.assembly import State

FloatArray = NDArray[np.float64]

#: Looks at the pressure (kPa) and the displacement (n, 3) of a converged step; may end the
#: analysis, with a status and a reason.
Stop = Callable[[float, FloatArray], tuple[Status, str] | None]

#: Numbers and words by name, units in the names.
Figures = dict[str, float | int | str | dict[str, float]]

#: Is told the pressure in kPa and the iterations of every converged step.
Progress = Callable[[float, int], None]


class Guide(Protocol):
    """First guesses of the free actuation that come from a cheaper model."""

    @property
    def pressure_kPa(self) -> FloatArray:
        """Rising pressures (k,) that there are guesses for, the first recorded ones."""
        ...

    @property
    def between_kPa(self) -> FloatArray:
        """Pressures (m,) between these at which steps are wanted for the sake of the history."""
        ...

    def state(self, body: Model, pressure_kPa: float) -> State:
        """The guess at a pressure."""
        ...


@dataclass(frozen=True, slots=True)
class RecordedState:
    """A state at a recorded pressure.

    ``displacement`` (n, 3) in mm, ``strain`` (n,) largest principal logarithmic strain at the
    nodes, ``strain_max`` and ``strain_p99`` its largest value and 99th percentile by volume.
    """

    pressure_kPa: float
    displacement: FloatArray
    strain: FloatArray
    strain_max: float
    strain_p99: float


@dataclass(frozen=True, slots=True)
class ActuationResult:
    """How the analysis ended, and everything up to there.

    Attributes
    ----------
    status, reason
        ``ok``, or why the last pressure was not reached.
    states
        The state without pressure first, then the recorded pressures that were reached, states
        after every quarter of growth of the cavity where the pressure falls, and last the state at
        which the analysis ended early, whatever its pressure.
    history
        One row a step, interpolated states among them, in the order of the path, the state without
        pressure first:
        ``pressure_kPa``, ``cavity_volume_mm3`` and ``stored_energy_mJ`` of the whole actuator
        (the latter since pressure zero, with the potential of gravity), ``newton_iterations``,
        ``recorded`` (the k-th true row is the k-th state), ``smallest_gap_mm`` between walls
        (not a number where none are near); where the tip is held ``blocked_force_N``.
    figures
        Counts: ``tets``, ``unknowns``, ``newton_iterations``, ``factorisations`` (those that tell
        of stability too), ``corrections`` (solutions), ``steps``, ``rejected_steps``; ``element``;
        ``profile_s``, processor time by part; ``pressure_kPa`` reached; ``solid_volume_mm3`` of the
        whole actuator; ``linear_solver``;
        ``largest_pressure_kPa`` and ``limit_points``, its maxima along the path, and
        ``volume_controlled_from_kPa`` where pressure control failed, ``guided_to_kPa`` where first
        guesses came from a cheaper model, ``critical_pressure_kPa``
        where stability is foretold to be lost; where walls face each
        other and contact is on ``initial_gap_mm`` of the undeformed body,
        ``deepest_penetration_mm`` (of all steps), ``penetration_share`` of the initial gap and,
        where any come near, ``smallest_gap_mm`` (of the last step with such; negative for a
        penetration); where the tip is held ``variant`` and ``blocked_force_N``.
    """

    status: Status
    reason: str | None
    states: list[RecordedState]
    history: dict[str, FloatArray]
    figures: Figures
