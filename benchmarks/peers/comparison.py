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
        Of its time to ours: of the first mesh that is as good, or at least that of the slowest one
        that was tried; None where it never came to the pressure, nor to its time limit.
    estimate
        Where no mesh was as good: extrapolated by error and time of its last two meshes; None
        where that is not possible.
    """

    ratio: Ratio | None
    estimate: float | None


def equal_error(
    seconds: float, error: float, tried: Sequence[tuple[float, float | None]]
) -> EqualError:
    """Find what another program takes on finer and finer meshes to be as good as ours.

    Parameters
    ----------
    seconds, error
        Of pagd.
    tried
        Seconds and error of each mesh, the coarsest first; the error is None, and the seconds are
        those of the time limit, where it was not known to get so far.
    """
    pairs = [(time, found) for time, found in tried if found is not None]
    for time, found in pairs:
        if found <= error:
            return EqualError(Ratio(time / seconds), None)
    slowest = max((time for time, _ in tried), default=None)
    ratio = None if slowest is None else Ratio(slowest / seconds, at_least=True)
    estimate = _seconds_at(error, pairs)
    return EqualError(ratio, None if estimate is None else estimate / seconds)


def _seconds_at(error: float, pairs: Sequence[tuple[float, float]]) -> float | None:
    """Seconds at a smaller error, by the power law of the last two."""
    if len(pairs) < 2:
        return None
    (short, large), (long, small) = pairs[-2:]
    if not (0 < small < large and short < long and error > 0):
        return None
    power = log(long / short) / log(large / small)
    return long * exp(power * log(small / error))


def median_of(runs: Sequence[Solved]) -> Solved:
    """Return the run of the median wall time; of an even number, the slower of the two."""
    return sorted(runs, key=lambda run: run.wall_s)[len(runs) // 2]
