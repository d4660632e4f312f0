"""All stages of one design, one after the other: what the workflow does, without the workflow."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pagd.actuation import Progress
from pagd.catalogue import NamedDesign
from pagd.record import Record
from pagd.stages import figures, geometry, mesh, metrics, repair, solve

__all__ = ["run"]


def run(
    named: NamedDesign,
    out: Path,
    config: Mapping[str, Any],
    materials: solve.Materials,
    *,
    vtu: bool = False,
    progress: Progress | None = None,
    threads: int | None = None,
    pictures: bool = True,
) -> Record:
    """Run every stage into its own folder under ``out``; returns the record of the metrics.

    ``vtu``, ``progress`` and ``threads`` are those of :func:`pagd.stages.solve.run`; without
    ``pictures`` the stage figures, which takes some seconds, is left out.
    """
    at = {
        stage: out / stage
        for stage in ("geometry", "repair", "mesh", "solve", "metrics", "figures")
    }
    geometry.run(named, at["geometry"], config)
    repair.run(at["geometry"], at["repair"], config)
    mesh.run(at["geometry"], at["repair"], at["mesh"], config)
    solve.run(
        at["mesh"], at["solve"], config, materials, vtu=vtu, progress=progress, threads=threads
    )
    folders = metrics.Folders(
        mesh=at["mesh"], solve=at["solve"], geometry=at["geometry"], repair=at["repair"]
    )
    record = metrics.run(folders, at["metrics"], config)
    if pictures:
        figures.run(out, at["figures"], config)
    return record
