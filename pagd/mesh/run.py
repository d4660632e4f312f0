"""Meshing that always comes back: child processes with a time limit, and a second mesher."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from pagd.errors import InputError, MachineError, PagdError, StageFailure, Status
from pagd.limits import die_with_parent
from pagd.mesh import worker
from pagd.mesh.checks import check_actuator
from pagd.mesh.interface import MESHERS, STRUCTURED, mesher_named
from pagd.mesh.quality import MeshQuality, mesh_quality
from pagd.mesh.surfaces import SurfacePair
from pagd.mesh.types import Mesh

__all__ = ["Attempt", "MeshGate", "MeshingResult", "mesh_with_limits"]


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshGate:
    """What a mesh must reach to be accepted; a mesher that falls short has failed."""

    smallest_scaled_jacobian: float = 0.01
    largest_volume_error: float = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Attempt:
    """One run of one mesher: seconds it took, and why it failed (None if it did not)."""

    mesher: str
    seconds: float
    reason: str | None


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshingResult:
    """The mesh, its figures, and all attempts; the last one made the mesh."""

    mesh: Mesh
    quality: MeshQuality
    attempts: tuple[Attempt, ...]

    @property
    def mesher(self) -> str:
        """Name of the mesher that succeeded."""
        return self.attempts[-1].mesher


def mesh_with_limits(
    surfaces: SurfacePair,
    mesher_names: Sequence[str] = tuple(MESHERS),
    *,
    size: float,
    time_limit_s: float,
    exact_volume: float | None = None,
    gate: MeshGate | None = None,
    structured: Callable[[], Mesh] | None = None,
) -> MeshingResult:
    """Mesh with the first of the named meshers that succeeds.

    Each of those that mesh surfaces runs in a process of its own, which is killed with all it
    started when the time is up, so that neither an endless loop nor a crash inside a mesher
    reaches the caller.

    Parameters
    ----------
    surfaces
        The solid, as two surfaces that meet in the paper plane.
    mesher_names
        Names from :data:`pagd.mesh.interface.MESHERS`, or ``structured``, in the order they are
        tried.
    size
        Length of the elements' edges in mm.
    time_limit_s
        Seconds for each mesher.
    exact_volume
        Volume in mm^3 of the solid (of the half, if ``surfaces`` are a half) to measure the
        mesh against; the volume within the surfaces unless given.
    gate
        What the mesh must reach.
    structured
        What the mesher ``structured`` does, where there is a design behind the surfaces; without
        it that mesher is passed over.

    Raises
    ------
    InputError
        If a setting is unusable.
    StageFailure
        ``mesh_failed`` if no mesher succeeds, with every mesher's reason.
    MachineError
        If a mesher was killed from outside.
    """
    _check_settings(mesher_names, size, time_limit_s)
    volume = surfaces.volume() if exact_volume is None else exact_volume
    attempts: list[Attempt] = []
    for name in mesher_names:
        start = time.perf_counter()
        try:
            if name == STRUCTURED:
                mesh = _run_structured(structured)
            else:
                mesh = _run_apart(name, surfaces, size, time_limit_s)
            quality = _accepted(mesh, volume, gate or MeshGate())
        except MachineError:
            raise
        except PagdError as error:
            seconds = time.perf_counter() - start
            attempts.append(Attempt(mesher=name, seconds=seconds, reason=str(error)))
            continue
        attempts.append(Attempt(mesher=name, seconds=time.perf_counter() - start, reason=None))
        return MeshingResult(mesh=mesh, quality=quality, attempts=tuple(attempts))
    reasons = " ".join(f"{attempt.mesher}: {attempt.reason}" for attempt in attempts)
    raise StageFailure(Status.mesh_failed, f"No mesher succeeded. {reasons}")


def _check_settings(names: Sequence[str], size: float, time_limit_s: float) -> None:
    for key, value in (("size", size), ("time_limit_s", time_limit_s)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{key} = {value:g}: must be greater than 0.")
    if not names:
        raise InputError("mesher_names: must name at least one mesher.")
    for name in names:
        if name != STRUCTURED:
            mesher_named(name)


def _accepted(mesh: Mesh, volume: float, gate: MeshGate) -> MeshQuality:
    """Return the figures of a mesh that passes all checks; StageFailure if it does not."""
    check_actuator(mesh)
    quality = mesh_quality(mesh, volume)
    if quality.scaled_jacobian_min < gate.smallest_scaled_jacobian:
        raise StageFailure(
            Status.mesh_failed,
            f"The smallest scaled Jacobian is {quality.scaled_jacobian_min:.3g}, "
            f"must be at least {gate.smallest_scaled_jacobian:g}.",
        )
    if abs(quality.volume_mm3 / volume - 1.0) > gate.largest_volume_error:
        raise StageFailure(
            Status.mesh_failed,
            f"The volume is {quality.volume_mm3:.6g} mm³, must be within "
            f"{gate.largest_volume_error:g} of {volume:.6g} mm³.",
        )
    return quality


def _run_structured(structured: Callable[[], Mesh] | None) -> Mesh:
    if structured is None:
        raise StageFailure(
            Status.mesh_failed, "It divides designs by their parameters; there are surfaces only."
        )
    return structured()


def _run_apart(name: str, surfaces: SurfacePair, size: float, time_limit_s: float) -> Mesh:
    """Run a mesher in a child process and return its mesh; StageFailure if there is none."""
    with tempfile.TemporaryDirectory(prefix="pagd-mesh-") as folder_name:
        folder = Path(folder_name)
        worker.write_task(folder, surfaces, name, size, time_limit_s)
        _run_limited(folder, time_limit_s)
        return worker.read_answer(folder)


def _run_limited(folder: Path, time_limit_s: float) -> None:
    """Run the worker on ``folder``; StageFailure if it is killed or dies without an answer."""
    command = [sys.executable, "-m", worker.__name__, str(folder)]
    with (
        (folder / "messages.txt").open("wb") as messages,
        subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=messages,
            start_new_session=True,
            preexec_fn=die_with_parent,
        ) as process,
    ):
        try:
            code = process.wait(timeout=time_limit_s)
        except subprocess.TimeoutExpired:
            reason = f"It did not finish within {time_limit_s:g} s."
            raise StageFailure(Status.mesh_failed, reason) from None
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
    if -code == signal.SIGKILL:
        raise MachineError("The mesher was killed from outside, as for lack of memory.")
    if code != 0:
        text = (folder / "messages.txt").read_text(encoding="utf-8", errors="replace")
        raise StageFailure(Status.mesh_failed, _cause_of_death(code, text))


def _cause_of_death(code: int, messages: str) -> str:
    if code < 0:
        return f"It crashed ({signal.Signals(-code).name})."
    last = messages.strip().splitlines()[-1:] or ["no message"]
    return f"It ended with exit code {code} ({last[0]})."
