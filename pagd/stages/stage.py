"""What all stages have in common: the folder, the record, and failures that are passed on."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pagd.errors import StageFailure, Status
from pagd.files import emptied
from pagd.inventory import inventory
from pagd.limits import in_force, run_apart
from pagd.machine import machine_class
from pagd.record import Meter, Record, stage_folder, versions, write_record
from pagd.stages import STAGE_VERSIONS

__all__ = ["ALL_DESIGNS", "Outcome", "Work", "run_stage"]

#: The design_id in the record of a stage that works on all designs at once.
ALL_DESIGNS = "all"

log = logging.getLogger(__name__)


@dataclass(slots=True)
class Outcome:
    """What a stage found out; filled while it works, so that a failure keeps what came before."""

    figures: dict[str, Any] = field(default_factory=dict)
    status: Status = Status.ok
    reason: str | None = None

    def end(self, status: Status, reason: str | None) -> None:
        """Set how the design stands."""
        self.status, self.reason = status, reason


#: A stage's own work: (folder to fill, outcome to fill, clock).
Work = Callable[[Path, Outcome, Meter], None]


def run_stage(
    stage: str,
    out: Path,
    work: Work,
    *,
    design_id: str,
    configuration: Mapping[str, Any],
    upstream: Sequence[Record] = (),
    goes_on: bool = False,
    libraries: Mapping[str, str | None] | tuple[str, ...] = (),
    given: Mapping[str, str] | None = None,
) -> Record:
    """Run one stage of one design and leave its folder.

    Parameters
    ----------
    stage
        Name of the stage, one of ``STAGE_VERSIONS``.
    out
        Its folder; appears complete, with a record, or not at all.
    work
        Fills the folder; raises ``StageFailure`` where the design fails as designs may.
    design_id
        Name of the design.
    configuration
        What the record says the result was made of.
    upstream
        Records of the stages before, in order. A failed one is passed on without any work, …
    goes_on
        … unless what it left is enough for this stage.
    libraries
        Packages whose versions the record names.
    given
        Files, name and text, that the folder has whatever becomes of the work.

    Raises
    ------
    MachineError
        Under limits (:mod:`pagd.limits`), where more of them may help.

    Notes
    -----
    Under limits the work is done in a process of its own. Limits exceeded for good are then how
    the design ends, and so is a crash.
    """
    meter, outcome = Meter(), Outcome()
    failed = next((record for record in upstream if record.status is not Status.ok), None)
    with stage_folder(out) as folder:
        if failed is None or goes_on:
            outcome = _attempt(work, folder, outcome, meter)
        for name, text in (given or {}).items():
            (folder / name).write_text(text, encoding="utf-8")
        if failed is not None:
            outcome.end(failed.status, failed.reason)
        files = inventory(folder)
        record = Record(
            stage=stage,
            design_id=design_id,
            status=outcome.status,
            reason=outcome.reason,
            figures=outcome.figures,
            configuration=dict(configuration),
            versions=versions(STAGE_VERSIONS[stage], libraries),
            timings_s=meter.timings_s(),
            peak_memory_MB=meter.peak_memory_MB(),
            files=files,
            machine=machine_class(),
        )
        write_record(record, folder)
    _report(record)
    return record


def _attempt(work: Work, folder: Path, outcome: Outcome, meter: Meter) -> Outcome:
    """Do the work; the outcome, with what it has found out until it failed, if it did."""
    limits = in_force()
    if limits is None:
        return _done(work, folder, outcome, meter)
    try:
        found, parts = run_apart(lambda: (_done(work, folder, outcome, meter), meter.parts), limits)
    except StageFailure as failure:
        # Of what a process has found out that is gone, nothing is known; its files may be halves.
        emptied(folder)
        outcome.end(failure.status, failure.reason)
        return outcome
    meter.parts = parts
    return found


def _done(work: Work, folder: Path, outcome: Outcome, meter: Meter) -> Outcome:
    try:
        work(folder, outcome, meter)
    except StageFailure as failure:
        outcome.end(failure.status, failure.reason)
    return outcome


def _report(record: Record) -> None:
    seconds = record.timings_s["wall"]
    log.info("%s of %s: %s (%.1f s)", record.stage, record.design_id, record.status, seconds)
