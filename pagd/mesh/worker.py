"""The child process in which a mesher runs: ``python -m pagd.mesh.worker FOLDER``.

Task and answer are files in the folder, so that whatever a mesher prints or breaks stays here.
"""

from __future__ import annotations

import json
import math
import signal
import sys
from pathlib import Path
from typing import Any

import numpy as np

from pagd.errors import PagdError, StageFailure, Status
from pagd.mesh.interface import mesher_named
from pagd.mesh.surfaces import Surface, SurfacePair
from pagd.mesh.types import Mesh

__all__ = ["main", "read_answer", "write_task"]

_SURFACES, _TASK, _MESH, _FAILURE = "surfaces.npz", "task.json", "mesh.npz", "failure.json"
_SURFACE_PREFIX = "surface_"


def write_task(
    folder: Path, surfaces: SurfacePair, mesher: str, size: float, time_limit_s: float
) -> None:
    """Write what the child needs to know."""
    body, base = surfaces.body, surfaces.base
    np.savez(
        folder / _SURFACES,
        body_points=body.points,
        body_triangles=body.triangles,
        base_points=base.points,
        base_triangles=base.triangles,
    )
    task = {"mesher": mesher, "size": size, "half": surfaces.half, "time_limit_s": time_limit_s}
    (folder / _TASK).write_text(json.dumps(task), encoding="utf-8")


def read_answer(folder: Path) -> Mesh:
    """Return the mesh the child made; StageFailure with its reason if it failed."""
    if (folder / _FAILURE).is_file():
        reason = json.loads((folder / _FAILURE).read_text(encoding="utf-8"))["reason"]
        raise StageFailure(Status.mesh_failed, reason)
    with np.load(folder / _MESH) as arrays:
        return Mesh(
            points=arrays["points"],
            tets=arrays["tets"],
            surfaces={
                name.removeprefix(_SURFACE_PREFIX): arrays[name]
                for name in arrays
                if name.startswith(_SURFACE_PREFIX)
            },
        )


def main(folder: Path) -> None:
    """Do the task in ``folder`` and leave a mesh or the reason for there being none."""
    task = json.loads((folder / _TASK).read_text(encoding="utf-8"))
    _die_after(task["time_limit_s"])
    with np.load(folder / _SURFACES) as given:
        body = Surface(given["body_points"], given["body_triangles"])
        base = Surface(given["base_points"], given["base_triangles"])
    try:
        mesh = mesher_named(task["mesher"])(SurfacePair(body, base, task["half"]), task["size"])
    except PagdError as error:
        (folder / _FAILURE).write_text(json.dumps({"reason": str(error)}), encoding="utf-8")
        return
    arrays: dict[str, Any] = {"points": mesh.points, "tets": mesh.tets}
    arrays |= {_SURFACE_PREFIX + name: faces for name, faces in mesh.surfaces.items()}
    np.savez(folder / _MESH, **arrays)


def _die_after(seconds: float) -> None:
    """End this process some time after the limit, in case nobody is left to kill it.

    The default action of the signal ends it even inside a C library.
    """
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(math.ceil(seconds) + 5)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
