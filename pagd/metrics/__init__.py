"""What an actuator does under pressure.

:mod:`trajectory` (angles and how they are defined), :mod:`chambers`, :mod:`mode`, :mod:`energy`,
:mod:`strain`, :mod:`first_contact`; :mod:`table` gathers them, one row a recorded pressure.
"""

from pagd.metrics.chambers import Kind, chamber_columns, kinds_of
from pagd.metrics.energy import energy_balance, work_density, work_of_pressure
from pagd.metrics.first_contact import first_contact_pressure
from pagd.metrics.mode import MeasuredMode, Thresholds, is_still, measured_mode
from pagd.metrics.strain import strain_columns, strain_rate
from pagd.metrics.table import blocked_force_at, performance, recorded_rows
from pagd.metrics.trajectory import Trajectory, measure

__all__ = [
    "Kind",
    "MeasuredMode",
    "Thresholds",
    "Trajectory",
    "blocked_force_at",
    "chamber_columns",
    "energy_balance",
    "first_contact_pressure",
    "is_still",
    "kinds_of",
    "measure",
    "measured_mode",
    "performance",
    "recorded_rows",
    "strain_columns",
    "strain_rate",
    "work_density",
    "work_of_pressure",
]
