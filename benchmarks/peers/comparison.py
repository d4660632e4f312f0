"""How many times longer another program takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log

from peers.converged import Converged
from peers.solved import Solved

__all__ = ["Comparison", "EqualError", "Ratio", "compared", "equal_error", "median_of"]


@dataclass(frozen=True, slots=True)
class Ratio:
    """How many times longer; ``at_least`` where the other did not come to the end."""

    value: float
    at_least: bool = False

    def __str__(self) -> str:
        digits = 0 if self.value >= 20 else 1
        return f"{'more than ' if self.at_least else ''}{self.value:.{digits}f}"


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two runs on one mesh.

    Attributes
    ----------
    pressure_kPa
        Last recorded pressure that both reached, at which tips are compared; the last one of
        pagd where there is none.
    errors
        Of the tips at that pressure, pagd's first; None where they or the converged tip are not
        known.
    ratio
        Of the times of the whole processes; None where pagd itself did not come to the end.
    ratio_there
        Of the times to that pressure; None where there is none.
    """

    pressure_kPa: float
    errors: tuple[float | None, float | None]
    ratio: Ratio | None
    ratio_there: Ratio | None


def compared(ours: Solved, theirs: Solved, exact: Converged | None) -> Comparison:
    """Compare a run of pagd with that of another program on the same mesh."""
    common = {p for p, _ in ours.tips} & {p for p, _ in theirs.tips}
    pressure = max(common, default=ours.last_recorded())
    errors = tuple(exact.error(run, pressure) if exact else None for run in (ours, theirs))
    ratio = there = None
    if ours.is_complete and (theirs.is_complete or theirs.status == "time_limit"):
        ratio = Ratio(theirs.wall_s / ours.wall_s, not theirs.is_complete)
    if common:
        there = Ratio(theirs.seconds_to(pressure) / ours.seconds_to(pressure))
    return Comparison(pressure, (errors[0], errors[1]), ratio, there)


@dataclass(frozen=True, slots=True)
class EqualError:
    """What another program takes for an error as small as ours.

    Attributes
    ----------
    ratio
        Of its time to ours: of the first mesh that is as good, or at least that of the last one
        that was tried; None where it never came to the last pressure, nor to its time limit.
    estimate
        Where no mesh was as good: extrapolated by error and time of its last two meshes; None
        where that is not possible.
    """

    ratio: Ratio | None
    estimate: float | None


def equal_error(
    ours: Solved, error: float, theirs: Sequence[Solved], errors: Sequence[float | None]
) -> EqualError:
    """Find what another program takes on finer and finer meshes to be as good as ours."""
    pairs = [
        (run, found)
        for run, found in zip(theirs, errors, strict=True)
        if run.is_complete and found is not None
    ]
    for run, found in pairs:
        if found <= error:
            return EqualError(Ratio(run.wall_s / ours.wall_s), None)
    tried = [run.wall_s for run in theirs if run.is_complete or run.status == "time_limit"]
    ratio = Ratio(max(tried) / ours.wall_s, at_least=True) if tried else None
    return EqualError(ratio, _estimate(ours, error, pairs))


def _estimate(ours: Solved, error: float, pairs: Sequence[tuple[Solved, float]]) -> float | None:
    """The ratio at our error, by a power law between time and error."""
    if len(pairs) < 2:
        return None
    (coarse, large), (fine, small) = pairs[-2:]
    if not (0 < small < large and coarse.wall_s < fine.wall_s and error > 0):
        return None
    power = log(fine.wall_s / coarse.wall_s) / log(large / small)
    return fine.wall_s / ours.wall_s * exp(power * log(small / error))


def median_of(runs: Sequence[Solved]) -> Solved:
    """Return the run of the median wall time; of an even number, the slower of the two."""
    return sorted(runs, key=lambda run: run.wall_s)[len(runs) // 2]
