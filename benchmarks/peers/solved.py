"""What a program made of a body under pressure: the common form of all results."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Load", "Solved"]

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """Pressure at the end (kPa), threads, time limit of one run (s)."""

    maximum_kPa: float = 50.0
    threads: int = 2
    time_limit_s: float = 3600.0

    def is_answered_by(self, result: Mapping[str, Any]) -> bool:
        """Whether a kept result is of as long a time limit, if it is one that came to it."""
        return bool(result["status"] != "time_limit" or result["wall_s"] >= self.time_limit_s)


@dataclass(frozen=True, slots=True, kw_only=True)
class Solved:
    """One run of one program.

    Attributes
    ----------
    program
        Its name and version.
    status, reason
        ``ok``, ``time_limit``, or how it failed.
    pressure_kPa
        Pressure it reached.
    wall_s, cpu_s
        Seconds of the whole process, and of all its threads and children.
    iterations
        Systems solved, rejected steps included.
    tets, unknowns
        Size of the mesh and of the system.
    tips
        Displacement (3,) in mm of the tip at each recorded pressure (kPa) that was reached.
    progress
        Seconds at which each pressure (kPa) was seen to be reached.
    commit
        Of the repository.
    """

    program: str
    status: str
    reason: str | None
    pressure_kPa: float
    wall_s: float
    cpu_s: float
    iterations: int
    tets: int
    unknowns: int
    tips: Sequence[tuple[float, Sequence[float]]]
    progress: Sequence[tuple[float, float]]
    commit: str | None = None

    @classmethod
    def of(cls, result: Mapping[str, Any]) -> Solved:
        """Make one of what is kept."""
        return cls(**result)

    def as_dict(self) -> dict[str, Any]:
        """Return what is kept."""
        return asdict(self)

    @property
    def is_complete(self) -> bool:
        """Whether it reached the last pressure."""
        return self.status == "ok"

    def tip(self, pressure_kPa: float) -> FloatArray | None:
        """Displacement (3,) of the tip at a recorded pressure; None if it was not reached."""
        for known, tip in self.tips:
            if abs(known - pressure_kPa) < 1e-6:
                return np.array(tip)
        return None

    def last_recorded(self) -> float:
        """Return the last recorded pressure that was reached; 0 if none was."""
        return max((pressure for pressure, _ in self.tips), default=0.0)

    def seconds_to(self, pressure_kPa: float) -> float:
        """Return the seconds until a pressure that was reached; to the very end if it is the last.

        They are as exact as the files of the run are looked at: a quarter of a second.
        """
        if self.is_complete and pressure_kPa >= self.pressure_kPa - 1e-6:
            return self.wall_s
        later = [s for s, reached in self.progress if reached >= pressure_kPa - 1e-6]
        return min(later, default=self.wall_s)

    def seconds_an_iteration(self) -> float:
        """Return the wall time of an iteration, all of the process counted."""
        return self.wall_s / max(self.iterations, 1)
