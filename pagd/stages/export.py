"""Stage 7: a design for other programs, and its card for the page: what there is of it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pagd.errors import InputError, StageFailure
from pagd.export import write_csv, write_step
from pagd.figures.load import load_records, stl_paths
from pagd.figures.page.cards import write_card
from pagd.geometry import openscad_version, parts_of_model, render_model
from pagd.mesh.msh import read_msh
from pagd.mesh.surfaces import read_stl
from pagd.record import Meter, Record
from pagd.stages.mesh import MESH_NAME
from pagd.stages.metrics import PERFORMANCE_NAME, TRAJECTORY_NAME
from pagd.stages.solve import BLOCKED_NAME, HISTORY_NAME, STATES_NAME
from pagd.stages.stage import Outcome, run_stage
from pagd.states import read_states

__all__ = ["run"]

_MODEL = "design.scad"
#: Tables as CSV: name of the file to stage and table.
_TABLES = {
    "trajectory.csv": ("metrics", TRAJECTORY_NAME),
    "performance.csv": ("metrics", PERFORMANCE_NAME),
    "free_actuation.csv": ("solve", HISTORY_NAME),
    "blocked_force.csv": ("solve", BLOCKED_NAME),
}

#: Writes a file, whose path it is given.
Write = Callable[[Path], object]


def run(design: Path, out: Path, config: Mapping[str, Any]) -> Record:
    """Write a design's surfaces, solids, moulds, last state and tables, and card.js for the page.

    A design that failed has fewer files. What one of them could not be made for is among the
    figures, ``left_out``; the others are there.

    Parameters
    ----------
    design
        Folder with the folders of the design's stages.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``geometry.time_limit_s``.

    Raises
    ------
    InputError
        If the folder holds no stage of a design.
    """
    upstream = list(load_records(design).values())
    if not upstream:
        raise InputError(f"{design}: holds no folder of a stage with a record.json.")

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        left_out = {}
        for name, write in _files(design, config["geometry"]["time_limit_s"]).items():
            try:
                with meter.part(name):
                    write(folder / name)
            except StageFailure as failure:
                left_out[name] = failure.reason
        outcome.figures |= {
            "files": sorted(path.name for path in folder.iterdir()),
            "left_out": left_out,
        }
        write_card(design, folder)

    return run_stage(
        "export",
        out,
        work,
        design_id=upstream[-1].design_id,
        configuration={"geometry": config["geometry"]},
        upstream=upstream,
        goes_on=True,
        libraries={"openscad": openscad_version()},
    )


def _files(design: Path, time_limit: float) -> dict[str, Write]:
    """Return what can be written of a design: name of the file to function(path)."""
    found: dict[str, Write] = {}
    model, pair = design / "geometry" / _MODEL, stl_paths(design)
    if pair is not None:
        found |= {path.name: _copy_of(path) for path in pair}
        found["solids.step"] = lambda path: write_step([read_stl(one) for one in pair], path)
    if model.is_file():
        found[_MODEL] = _copy_of(model)
        if pair is not None:
            moulds = (part for part in parts_of_model(model) if part.startswith("mould_"))
            found |= {f"{part}.stl": _part_of(model, part, time_limit) for part in moulds}
    if all((design / name).is_file() for name in (f"mesh/{MESH_NAME}", f"solve/{STATES_NAME}")):
        found["last_state.vtu"] = lambda path: _write_last_state(design, path)
    tables = {name: design / stage / table for name, (stage, table) in _TABLES.items()}
    return found | {name: _csv_of(path) for name, path in tables.items() if path.is_file()}


def _copy_of(path: Path) -> Write:
    return lambda target: shutil.copyfile(path, target)


def _part_of(model: Path, part: str, time_limit: float) -> Write:
    return lambda target: render_model(model, part, target, time_limit=time_limit)


def _csv_of(table: Path) -> Write:
    return lambda target: write_csv(table, target)


def _write_last_state(design: Path, path: Path) -> None:
    from pagd.vtu import write_state

    states = read_states(design / "solve" / STATES_NAME)
    write_state(read_msh(design / "mesh" / MESH_NAME), states, -1, path)
