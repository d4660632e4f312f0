"""What became of one design: one flat row from its records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, Final

from pagd.catalogue import NamedDesign
from pagd.errors import Status
from pagd.record import RECORD_NAME, Record, read_record
from robustness.drawing import is_thin_walled
from robustness.study import STAGES
from robustness.timings import cpu_of, cpu_of_process

__all__ = ["PHYSICAL_STOPS", "STARTING", "Result", "result_of"]

#: Ends that the actuator itself sets.
PHYSICAL_STOPS: Final = (
    Status.bending_limit.value,
    Status.overstretched.value,
    Status.self_collision.value,
)

_ALL_THE_WAY: Final = (Status.ok.value, *PHYSICAL_STOPS)

#: Name, among the stages, of what a process needs besides them: the interpreter and imports.
STARTING: Final = "starting"


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """A design of the study. None: not known, since it did not come so far or was not asked for.

    Attributes
    ----------
    design_id, mode, thin_walled
        The design.
    status, reason
        Final one of the chain, or how the process ended: ``crashed``, ``time_limit``.
    free_status
        Status of the free actuation alone: what moves too little may have reached its pressure.
    pressure_kPa, free_iterations, free_steps, free_rejected, free_s
        Of the free actuation, with the time it took.
    blocked_status, blocked_reason, blocked_pressure_kPa
        How the blocked-force analysis ended.
    blocked_iterations, blocked_rejected, blocked_s
        What it took.
    blocked_penetration_share
        Its deepest penetration, by the initial gap.
    free_cpu_s, blocked_cpu_s
        Processor time of either analysis.
    seconds
        Wall time of the process.
    cpu_s, process_cpu_s
        Processor time of all stages; of the whole process, with its imports.
    stages_s
        Wall time by stage, and of starting the process.
    smallest_gap_mm, penetration_share, touched
        Smallest gap between walls at the end, negative if they overlap; deepest penetration by
        the initial gap; whether walls have touched: all of the free actuation.
    energy_balance
        Work of the pressure against stored energy, relative.
    limit_points
        Maxima of the pressure along the path.
    peak_memory_MB
        Of the process.
    mesher, element
        What made the mesh, and what was solved on it.
    tets, unknowns
        Size of the model.
    commit
        Of the repository that it was run from.
    """

    design_id: str
    mode: str
    thin_walled: bool
    status: str
    reason: str | None
    seconds: float
    commit: str | None
    stages_s: Mapping[str, float]
    cpu_s: float | None = None
    process_cpu_s: float | None = None
    free_cpu_s: float | None = None
    blocked_cpu_s: float | None = None
    peak_memory_MB: float | None = None
    free_status: str | None = None
    pressure_kPa: float | None = None
    free_iterations: int | None = None
    free_steps: int | None = None
    free_rejected: int | None = None
    free_s: float | None = None
    blocked_status: str | None = None
    blocked_reason: str | None = None
    blocked_pressure_kPa: float | None = None
    blocked_iterations: int | None = None
    blocked_rejected: int | None = None
    blocked_s: float | None = None
    blocked_penetration_share: float | None = None
    smallest_gap_mm: float | None = None
    penetration_share: float | None = None
    touched: bool | None = None
    energy_balance: float | None = None
    limit_points: int | None = None
    mesher: str | None = None
    element: str | None = None
    tets: int | None = None
    unknowns: int | None = None

    @property
    def is_valid(self) -> bool:
        """Whether the geometry can be built."""
        return self.status != Status.invalid_geometry.value

    @property
    def goes_all_the_way(self) -> bool:
        """Whether the free actuation reached its last pressure or a physical stop."""
        return self.free_status in _ALL_THE_WAY

    @property
    def blocked_goes_all_the_way(self) -> bool:
        """Whether the analysis of the blocked force reached its last pressure or such a stop."""
        return self.blocked_status in _ALL_THE_WAY

    @property
    def newton_iterations(self) -> int:
        """Of both analyses together."""
        return (self.free_iterations or 0) + (self.blocked_iterations or 0)

    @property
    def free_iterations_a_step(self) -> float | None:
        """Newton's iterations of the free actuation by its steps, with those of refused tries."""
        if not self.free_iterations or not self.free_steps:
            return None
        return self.free_iterations / self.free_steps

    @property
    def outside_cpu_s(self) -> float | None:
        """Processor time of everything but the two analyses."""
        if self.free_cpu_s is None or self.process_cpu_s is None:
            return None
        return self.process_cpu_s - self.free_cpu_s - (self.blocked_cpu_s or 0.0)

    @property
    def without_blocked_cpu_s(self) -> float | None:
        """Processor time of a design whose blocked force nobody asks for."""
        if self.process_cpu_s is None:
            return None
        return self.process_cpu_s - (self.blocked_cpu_s or 0.0)

    @property
    def blocked_by_free(self) -> float | None:
        """Processor time of the blocked force by that of the free actuation."""
        if self.free_cpu_s is None or self.blocked_cpu_s is None:
            return None
        return self.blocked_cpu_s / self.free_cpu_s

    def as_dict(self) -> dict[str, Any]:
        """All attributes, ready for JSON."""
        return asdict(self)


def result_of(named: NamedDesign, folder: Path, run: Mapping[str, Any]) -> Result:
    """Return the result of a design from its folder and how its process ended.

    What a process that did not finish has left is counted as far as it came.
    """
    records = {s: read_record(folder / s) for s in STAGES if (folder / s / RECORD_NAME).is_file()}
    figures = _free(records) | _blocked(records) | _contact(records) | _cost(records)
    figures["process_cpu_s"] = cpu_of_process(folder)
    walls = {stage: record.timings_s["wall"] for stage, record in records.items()}
    starting = max(run["seconds"] - sum(walls.values()), 0.0)
    status, reason = _verdict(records, run)
    known = {field.name for field in fields(Result)}
    return Result(
        design_id=named.name,
        mode=named.design.mode,
        thin_walled=is_thin_walled(named.design),
        seconds=run["seconds"],
        commit=run.get("commit"),
        stages_s={STARTING: round(starting, 3), **walls} if run["end"] == "finished" else walls,
        status=status,
        reason=reason,
        **{key: value for key, value in figures.items() if key in known},
    )


def _verdict(records: Mapping[str, Record], run: Mapping[str, Any]) -> tuple[str, str | None]:
    if run["end"] != "finished":
        return run["end"], run["cause"]
    final = records[STAGES[-1]]
    return final.status.value, final.reason


def _free(records: Mapping[str, Record]) -> dict[str, Any]:
    if "solve" not in records:
        return {}
    record = records["solve"]
    figures = record.figures
    if "steps" not in figures:  # a stage before has failed
        return {"free_status": record.status.value}
    return {
        "free_status": record.status.value,
        "pressure_kPa": figures["pressure_kPa"],
        "free_iterations": figures["newton_iterations"],
        "free_steps": figures["steps"],
        "free_rejected": figures["rejected_steps"],
        "free_s": record.timings_s.get("solve"),
        "free_cpu_s": cpu_of(record, "solve"),
        "mesher": records["mesh"].figures.get("mesher") if "mesh" in records else None,
        "element": figures.get("element") or record.configuration.get("solve", {}).get("element"),
        **{key: figures.get(key) for key in ("tets", "unknowns", "limit_points")},
    }


def _blocked(records: Mapping[str, Record]) -> dict[str, Any]:
    record = records.get("solve")
    figures = record.figures.get("blocked_force") if record else None
    if not (record and figures):
        return {}
    depth, gap = figures.get("deepest_penetration_mm"), record.figures.get("initial_gap_mm")
    return {
        "blocked_status": figures["status"],
        "blocked_reason": figures.get("reason"),
        "blocked_pressure_kPa": figures.get("pressure_kPa"),
        "blocked_iterations": figures.get("newton_iterations"),
        "blocked_rejected": figures.get("rejected_steps"),
        "blocked_s": record.timings_s.get("blocked_force"),
        "blocked_cpu_s": cpu_of(record, "blocked_force"),
        "blocked_penetration_share": None if depth is None or gap is None else depth / gap,
    }


def _contact(records: Mapping[str, Record]) -> dict[str, Any]:
    solved = records["solve"].figures if "solve" in records else {}
    measured = records["metrics"].figures if "metrics" in records else {}
    contact = {key: solved.get(key) for key in ("smallest_gap_mm", "penetration_share")}
    if "first_contact_pressure_kPa" in measured:
        contact["touched"] = measured["first_contact_pressure_kPa"] is not None
    return contact | {"energy_balance": measured.get("energy_balance")}


def _cost(records: Mapping[str, Record]) -> dict[str, Any]:
    if not records:
        return {}
    return {
        "cpu_s": round(sum(record.timings_s["cpu"] for record in records.values()), 3),
        "peak_memory_MB": max(record.peak_memory_MB for record in records.values()),
    }
