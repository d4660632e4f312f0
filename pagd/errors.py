"""Errors that a caller can act on, and the statuses that a design can end with."""

from __future__ import annotations

from enum import StrEnum

__all__ = ["InputError", "MachineError", "PagdError", "StageFailure", "Status"]


class Status(StrEnum):
    """How the run of one design ended; everything but ``ok`` comes with a reason."""

    ok = "ok"
    invalid_geometry = "invalid_geometry"
    mesh_failed = "mesh_failed"
    not_converged = "not_converged"
    no_actuation = "no_actuation"
    overstretched = "overstretched"
    self_collision = "self_collision"
    bending_limit = "bending_limit"
    buckled = "buckled"
    timed_out = "timed_out"
    out_of_memory = "out_of_memory"
    crashed = "crashed"


class PagdError(Exception):
    """Base of every error that pagd raises on purpose."""


class InputError(PagdError):
    """The user gave something unusable; the message is one sentence for the user (exit code 2)."""


class MachineError(PagdError):
    """The machine has failed, not the design: the same may well succeed later, or with more.

    A full disk, a process killed from outside, too little time or memory where there may be more
    (exit code 75, which stands for that in ``sysexits.h``).
    """


class StageFailure(PagdError):
    """A design failed in an expected way: a result to record, not a crash.

    Parameters
    ----------
    status
        What the record will say; never ``Status.ok``.
    reason
        One sentence for people.
    """

    def __init__(self, status: Status, reason: str) -> None:
        if status is Status.ok:
            raise ValueError("a failure cannot have the status 'ok'")
        super().__init__(reason)
        self.status = status
        self.reason = reason

    def __reduce__(self) -> tuple[type[StageFailure], tuple[Status, str]]:
        # The default passes only the message back to __init__; meshers run in a child process.
        return StageFailure, (self.status, self.reason)
