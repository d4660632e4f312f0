"""Stage 2: surfaces that are closed, two-manifold and oriented, or the reason why not."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pagd.inventory import read_sound_record
from pagd.record import Meter, Record
from pagd.repair import repair
from pagd.stages.stage import Outcome, run_stage

__all__ = ["run"]

# The outside and the cavity; a half model is cut open through its cavity.
_COMPONENTS = {"body": 2, "base": 1, "body_half": 1, "base_half": 1}


def run(geometry: Path, out: Path, config: Mapping[str, Any]) -> Record:
    """Repair every surface of a design: the same file names as in the folder ``geometry``.

    Parameters
    ----------
    geometry
        Folder of the stage geometry.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``repair``.
    """
    drawn = read_sound_record(geometry)

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        for surface in [name for name in _COMPONENTS if (geometry / f"{name}.stl").is_file()]:
            report = repair(
                geometry / f"{surface}.stl",
                folder / f"{surface}.stl",
                components=_COMPONENTS[surface],
                max_hole_edges=config["repair"]["max_hole_edges"],
                merge_distance=config["repair"]["merge_distance_mm"],
            )
            outcome.figures[surface] = report.as_dict()

    return run_stage(
        "repair",
        out,
        work,
        design_id=drawn.design_id,
        configuration={"repair": config["repair"]},
        upstream=[drawn],
        libraries=("numpy", "pymeshlab"),
    )
