"""An actuator held at one end, its cavity under rising pressure: free, or with its tip held.

Knows surfaces by name, nothing of chambers: ``fixed`` is held, ``cavity`` carries the follower
pressure, ``outer`` may touch itself, ``paper`` is a shell, ``symmetry`` a plane y = 0. The same
pressures are recorded for every design, so that designs can be compared.
"""

from pagd.actuation.blocked import blocked_force
from pagd.actuation.body import Body
from pagd.actuation.free import free_actuation
from pagd.actuation.result import ActuationResult, Guide, Progress, RecordedState, Stop
from pagd.actuation.settings import ELEMENTS, SUPPORTS, Actuation
from pagd.actuation.threads import threads_are_started, use_threads

__all__ = [
    "ELEMENTS",
    "SUPPORTS",
    "Actuation",
    "ActuationResult",
    "Body",
    "Guide",
    "Progress",
    "RecordedState",
    "Stop",
    "blocked_force",
    "free_actuation",
    "threads_are_started",
    "use_threads",
]
