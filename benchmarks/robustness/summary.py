"""The statistics of a study."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from robustness.results import Result

__all__ = ["GOAL", "PENETRATION_LIMIT", "groups_of", "spread", "summarize"]

#: Share of the valid designs that is to reach the last pressure or a physical stop.
GOAL: Final = 0.97

#: Penetration, as a share of the gap, that is to stay below.
PENETRATION_LIMIT: Final = 0.02

_SLOWEST = 5

#: Figures with median, 90th percentile and maximum: name in the summary, and the result's value.
_SPREADS: Final[Mapping[str, Callable[[Result], float | None]]] = {
    "newton_iterations_free": lambda r: r.free_iterations,
    "newton_iterations_blocked": lambda r: r.blocked_iterations,
    "rejected_steps_free": lambda r: r.free_rejected,
    "rejected_steps_blocked": lambda r: r.blocked_rejected,
    "free_s": lambda r: r.free_s,
    "blocked_s": lambda r: r.blocked_s,
    "free_cpu_s": lambda r: r.free_cpu_s,
    "blocked_cpu_s": lambda r: r.blocked_cpu_s,
    "without_blocked_cpu_s": lambda r: r.without_blocked_cpu_s,
    "outside_cpu_s": lambda r: r.outside_cpu_s,
    "blocked_by_free": lambda r: r.blocked_by_free,
    "chain_s": lambda r: r.seconds,
    "chain_cpu_s": lambda r: r.cpu_s,
    "unknowns": lambda r: r.unknowns,
    "peak_memory_MB": lambda r: r.peak_memory_MB,
    "penetration_share": lambda r: r.penetration_share,
    "blocked_penetration_share": lambda r: r.blocked_penetration_share,
    "energy_balance": lambda r: None if r.energy_balance is None else abs(r.energy_balance),
}


def summarize(results: Sequence[Result], asked: int) -> dict[str, Any]:
    """Return the statistics of the designs that are done, out of ``asked``; ready for JSON."""
    others = [r for r in results if not r.goes_all_the_way]
    return {
        "designs": {"asked": asked, "done": len(results)},
        "groups": {name: _group(chosen) for name, chosen in groups_of(results).items()},
        "spreads": {name: spread(map(value, results)) for name, value in _SPREADS.items()},
        "stages": _stages(results),
        "contact": _contact(results),
        "limit_points": _limit_points(results),
        "others": [_case(r, r.status, r.pressure_kPa, r.reason) for r in others],
        "blocked_others": [
            _case(r, r.blocked_status, r.blocked_pressure_kPa, r.blocked_reason)
            for r in results
            if r.blocked_status is not None and not r.blocked_goes_all_the_way
        ],
        "slowest": [_slow(r) for r in sorted(results, key=lambda r: -r.seconds)[:_SLOWEST]],
        "models": dict(
            Counter(f"{r.element} by {r.mesher}" for r in results if r.mesher).most_common()
        ),
        "commits": dict(Counter(r.commit or "unknown" for r in results).most_common()),
    }


def groups_of(results: Sequence[Result]) -> dict[str, list[Result]]:
    """Return the results that are looked at together; a design is in several groups."""
    return {
        "all": list(results),
        "bending": [r for r in results if r.mode == "bending"],
        "twisting": [r for r in results if r.mode == "twisting"],
        "thin-walled": [r for r in results if r.thin_walled],
    }


def spread(values: Iterable[float | None]) -> dict[str, float] | None:
    """Return count, median, 90th percentile, maximum and sum of the known values, if any are."""
    known = np.array([value for value in values if value is not None], np.float64)
    if len(known) == 0:
        return None
    median, p90 = np.percentile(known, (50, 90))
    return {
        "count": len(known),
        "median": float(median),
        "p90": float(p90),
        "max": float(known.max()),
        "sum": float(known.sum()),
    }


def _group(results: Sequence[Result]) -> dict[str, Any]:
    valid = [r for r in results if r.is_valid]
    reached = sum(r.goes_all_the_way for r in valid)
    # None where no design has a blocked force at all, since none was asked for.
    blocked = sum(r.blocked_goes_all_the_way for r in valid)
    asked = any(r.blocked_status is not None for r in valid)
    return {
        "designs": len(results),
        "valid": len(valid),
        "reached": reached,
        "share": reached / len(valid) if valid else None,
        "blocked_reached": blocked if asked else None,
        "blocked_share": blocked / len(valid) if asked else None,
        "statuses": _counted(r.status for r in results),
        "blocked_statuses": _counted(r.blocked_status for r in results),
    }


def _counted(statuses: Iterable[str | None]) -> dict[str, int]:
    return dict(Counter(status for status in statuses if status is not None).most_common())


def _stages(results: Sequence[Result]) -> dict[str, Any]:
    """Time by stage: its spread over the designs, and its share of the time of all of them."""
    names = dict.fromkeys(name for r in results for name in r.stages_s)
    found = {name: spread(r.stages_s.get(name) for r in results) for name in names}
    spreads = {name: one for name, one in found.items() if one}
    total = sum(one["sum"] for one in spreads.values()) or 1.0
    return {name: one | {"share": one["sum"] / total} for name, one in spreads.items()}


def _contact(results: Sequence[Result]) -> dict[str, int]:
    shares = [max(r.penetration_share or 0, r.blocked_penetration_share or 0) for r in results]
    return {
        "known": sum(r.touched is not None for r in results),
        "touched": sum(bool(r.touched) for r in results),
        "over_limit": sum(share > PENETRATION_LIMIT for share in shares),
    }


def _limit_points(results: Sequence[Result]) -> dict[str, int]:
    counts = [r.limit_points for r in results if r.limit_points is not None]
    return {
        "known": len(counts),
        "designs": sum(count > 0 for count in counts),
        "limit_points": sum(counts),
    }


def _case(
    result: Result, status: str | None, pressure: float | None, cause: str | None
) -> dict[str, Any]:
    return {
        "design_id": result.design_id,
        "mode": result.mode,
        "thin_walled": result.thin_walled,
        "status": status,
        "pressure_kPa": pressure,
        "cause": cause,
    }


def _slow(result: Result) -> dict[str, Any]:
    return {
        "design_id": result.design_id,
        "mode": result.mode,
        "status": result.status,
        "seconds": result.seconds,
        "newton_iterations": result.newton_iterations,
        "unknowns": result.unknowns,
    }
