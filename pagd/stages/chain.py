"""All stages of one design, one after the other: what the workflow does, without the workflow."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from pagd.actuation import Progress
from pagd.catalogue import NamedDesign
from pagd.errors import InputError
from pagd.long_work import long_work
from pagd.record import RECORD_NAME, Record
from pagd.stages import figures, geometry, mesh, metrics, repair, solve

__all__ = ["STAGES", "run"]

#: The stages of one design, in their order.
STAGES = ("geometry", "repair", "mesh", "solve", "metrics", "figures")


def run(
    named: NamedDesign,
    out: Path,
    config: Mapping[str, Any],
    materials: solve.Materials,
    *,
    last: str = "figures",
    vtu: bool = False,
    progress: Progress | None = None,
    threads: int | None = None,
) -> Record:
    """Run every stage into its own folder under ``out``.

    Parameters
    ----------
    named
        The design.
    out
        Folder of the stages' folders.
    config
        Completed configuration.
    materials
        Elastomer and paper.
    last
        One of :data:`STAGES`: the stage to end with.
    vtu, progress, threads
        Those of :func:`pagd.stages.solve.run`.

    Returns
    -------
    record
        Of the stage ``last``; of the metrics, where that only draws.

    Raises
    ------
    InputError
        If ``out`` holds a later stage: it would be beside what it was not made of.
    """
    wanted = STAGES[: STAGES.index(last) + 1]
    _check_later(out, wanted)
    at = {stage: out / stage for stage in STAGES}
    folders = metrics.Folders(
        mesh=at["mesh"], solve=at["solve"], geometry=at["geometry"], repair=at["repair"]
    )
    work: dict[str, Callable[[], Record]] = {
        "geometry": lambda: geometry.run(named, at["geometry"], config),
        "repair": lambda: repair.run(at["geometry"], at["repair"], config),
        "mesh": lambda: mesh.run(at["geometry"], at["repair"], at["mesh"], config),
        "solve": lambda: solve.run(
            at["mesh"], at["solve"], config, materials, vtu=vtu, progress=progress, threads=threads
        ),
        "metrics": lambda: metrics.run(folders, at["metrics"], config),
        "figures": lambda: figures.run(out, at["figures"], config),
    }
    records = {}
    with long_work(wanted[0], len(wanted), "stages", even=False) as shown:
        for done, stage in enumerate(wanted):
            shown.name(stage)
            shown.reach(done)
            records[stage] = work[stage]()
    return records["metrics" if last == "figures" else last]


def _check_later(out: Path, wanted: Sequence[str]) -> None:
    for stage in STAGES[len(wanted) :]:
        if (out / stage / RECORD_NAME).is_file():
            raise InputError(
                f"{out} holds the stage {stage} of an earlier run, which would not fit a new "
                f"{wanted[-1]}: take another folder, or remove {out / stage}."
            )
