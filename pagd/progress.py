"""How far a run is: what has become of its designs, how fast it goes, what is slow, what failed."""

from __future__ import annotations

import json
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

from pagd.audit import OF_DESIGN
from pagd.errors import Status
from pagd.files import is_abandoned
from pagd.record import RECORD_NAME

__all__ = ["Ended", "Progress", "Screened", "progress_of"]

# The stages that a design needs to count as done, without its pictures.
_STAGES: Final = OF_DESIGN[:-1]
_HOUR_S: Final = 3600.0
_SLOWEST: Final = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class Ended:
    """A design that has ended: its status and reason, and seconds of wall time of its stages."""

    design_id: str
    status: str
    reason: str | None
    seconds: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Screened:
    """Designs that were analysed by a chamber each, and core-seconds of each in the mean."""

    designs: int
    core_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """How far a run is.

    ``designs``: how many are asked for. ``statuses``: of those that are done, how many ended how.
    ``at_work``: designs that a process is at work on. ``without_result``: designs that were begun
    and are not, with the last line of the log. ``per_hour``: designs done in an hour, by the last
    one; None without two of them. ``hours_left``: at that rate. ``slowest`` and ``failed``: designs
    that are done; a physical stop is no failure. ``screened``: designs by a chamber each,
    by their table.
    """

    designs: int
    statuses: dict[str, int]
    at_work: tuple[str, ...]
    without_result: dict[str, str]
    per_hour: float | None
    hours_left: float | None
    slowest: tuple[Ended, ...]
    failed: tuple[Ended, ...]
    screened: dict[str, Screened]

    @property
    def done(self) -> int:
        """Number of designs that are done, whatever became of them."""
        return sum(self.statuses.values())

    def as_dict(self) -> dict[str, Any]:
        """Return it as plain data, for JSON."""
        return {**asdict(self), "done": self.done}


#: What ends an analysis that is sound: the pressure asked for, or a stop that physics sets.
_RESULTS: Final = (
    Status.ok,
    Status.bending_limit,
    Status.self_collision,
    Status.overstretched,
    Status.no_actuation,
)


def progress_of(results: Path, names: Sequence[str]) -> Progress:
    """Look at the folder of a run, which may be under way.

    Parameters
    ----------
    results
        Folder of the run.
    names
        The designs asked for.
    """
    ended, times = {}, []
    for name in names:
        path = results / "designs" / name / "metrics" / RECORD_NAME
        found = _ended(path)
        if found is not None:
            ended[name] = found
            times.append(path.stat().st_mtime)
    left = [name for name in names if name not in ended]
    at_work = tuple(name for name in left if _is_at_work(results / "designs" / name))
    rate = _per_hour(times)
    return Progress(
        designs=len(names),
        statuses=dict(Counter(one.status for one in ended.values()).most_common()),
        at_work=at_work,
        without_result=_without_result(results, [n for n in left if n not in at_work]),
        per_hour=rate,
        hours_left=None if rate is None else len(left) / rate,
        slowest=tuple(sorted(ended.values(), key=lambda one: -one.seconds)[:_SLOWEST]),
        failed=tuple(one for one in ended.values() if one.status not in _RESULTS),
        screened=_screened(results / "screening"),
    )


def _ended(path: Path) -> Ended | None:
    content = _read(path)
    if content is None:
        return None
    try:
        return Ended(
            design_id=content["design_id"],
            status=content["status"],
            reason=content["reason"],
            seconds=content["figures"].get("wall_s", 0.0) + content["timings_s"]["wall"],
        )
    except (KeyError, TypeError, AttributeError):  # a damaged one
        return None


def _read(path: Path) -> Mapping[str, Any] | None:
    """A record, unchecked: a look must not take long, and `pagd audit` checks."""
    try:
        content: Mapping[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return content


def _per_hour(times: Sequence[float]) -> float | None:
    now = time.time()
    recent = sorted(t for t in times if now - t < _HOUR_S)
    if len(recent) < 2:
        return None
    # The first one began before the time that is looked at.
    return (len(recent) - 1) / max(now - recent[0], 1e-9) * _HOUR_S


def _is_at_work(folder: Path) -> bool:
    """Whether a process writes to a stage of the design; of another host it is believed."""
    if not folder.is_dir():
        return False
    temporary = [path for path in folder.iterdir() if path.name.startswith(".")]
    return any(not is_abandoned(path) for path in temporary)


def _without_result(results: Path, names: Sequence[str]) -> dict[str, str]:
    """The last line of the log of the first stage that is not done, of designs that were begun."""
    found = {}
    for name in names:
        folder = results / "designs" / name
        stage = next((s for s in _STAGES if not (folder / s).is_dir()), _STAGES[-1])
        line = _last_line(results / "logs" / stage / f"{name}.log")
        if line is not None:
            found[name] = f"{stage}: {line or 'cut off'}"
    return found


def _last_line(log: Path) -> str | None:
    try:
        lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return None
    return lines[-1] if lines else ""


def _screened(folder: Path) -> dict[str, Screened]:
    """How many designs of each table have been analysed by a chamber each, and what they took."""
    designs: Counter[str] = Counter()
    seconds: Counter[str] = Counter()
    for part in sorted(folder.glob("parts/*")):
        content = _read(part / RECORD_NAME)
        if content is not None:
            table = part.name.rpartition("_")[0]
            designs[table] += content["figures"]["designs"]
            # Of the whole job, with its start.
            seconds[table] += content["timings_s"]["cpu"]
    return {
        table: Screened(designs=count, core_s=seconds[table] / max(count, 1))
        for table, count in designs.items()
    }
