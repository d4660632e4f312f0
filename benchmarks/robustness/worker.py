"""The process of one design: its task as one line of JSON on standard input, then every stage.

Ends at once when standard input closes: with the study, its workers are gone too.
"""

from __future__ import annotations

import importlib
import json
import os
import resource
import sys
import threading
from pathlib import Path
from typing import Any

__all__ = ["USAGE_NAME", "run_chain"]

#: What a process has used, written as its last act: processor seconds ``cpu_s``, imports included.
USAGE_NAME = "usage.json"


def run_chain(task: dict[str, Any]) -> None:
    """Run geometry, repair, mesh, solve and metrics of a task's design, without pictures.

    With ``halvings`` in the task, every edge of the mesh is halved so many times before it is
    solved.
    """
    from pagd.catalogue import design_from
    from pagd.stages import geometry, mesh, metrics, repair, solve

    config = task["config"]
    out = {s: Path(task["out"], s) for s in ("geometry", "repair", "mesh", "solve", "metrics")}
    geometry.run(design_from(json.dumps(task["design"])), out["geometry"], config)
    repair.run(out["geometry"], out["repair"], config)
    mesh.run(out["geometry"], out["repair"], out["mesh"], config)
    for _ in range(task.get("halvings", 0)):
        _halve(out["mesh"] / mesh.MESH_NAME)
    solve.run(out["mesh"], out["solve"], config, solve.materials_of(config))
    folders = metrics.Folders(
        mesh=out["mesh"], solve=out["solve"], geometry=out["geometry"], repair=out["repair"]
    )
    metrics.run(folders, out["metrics"], config)
    Path(task["out"], USAGE_NAME).write_text(json.dumps({"cpu_s": _cpu_seconds()}), "utf-8")


def _halve(file: Path) -> None:
    sys.path.insert(0, str(Path(__file__).parents[1]))
    importlib.import_module("performance.halving").halve(file)


def _cpu_seconds() -> float:
    """Processor time of this process since it was started, and of its children."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return round(sum(one.ru_utime + one.ru_stime for one in used), 3)


def _leave_with_the_study() -> None:
    sys.stdin.read()
    os._exit(os.EX_UNAVAILABLE)


if __name__ == "__main__":
    given = json.loads(sys.stdin.readline())
    threading.Thread(target=_leave_with_the_study, daemon=True).start()
    run_chain(given)
