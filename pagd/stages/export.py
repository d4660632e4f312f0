"""Stage 7: a design for other programs, and its card for the page: what there is of it."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pagd.errors import InputError, StageFailure
from pagd.export import write_csv, write_step
from pagd.figures.load import STAGES, records_of, stl_paths
from pagd.figures.page.cards import CARD_NAME, write_card
from pagd.geometry import openscad_version, parts_of_model, render_model
from pagd.inventory import damages, sha256_of
from pagd.mesh.msh import read_msh
from pagd.mesh.surfaces import read_stl
from pagd.record import RECORD_NAME, Meter, Record, read_record, versions
from pagd.stages import STAGE_VERSIONS
from pagd.stages.mesh import MESH_NAME
from pagd.stages.metrics import PERFORMANCE_NAME, TRAJECTORY_NAME
from pagd.stages.solve import BLOCKED_NAME, HISTORY_NAME, STATES_NAME
from pagd.stages.stage import Outcome, run_stage
from pagd.states import read_states

__all__ = ["kept", "run"]

_MODEL = "design.scad"
# How parts of a model begin that are not rendered before, and files that need OpenSCAD.
_MOULD = "mould_"
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
    figures, ``left_out``, with the reason: no solid, a table that cannot be read, moulds where
    OpenSCAD is missing. The others are there.

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
    upstream = records_of(design)

    files = _files(design, config["geometry"]["time_limit_s"])

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        left_out: dict[str, str] = {}
        for name, write in files.items():
            with meter.part(name):
                _attempt(write, folder / name, left_out)
        outcome.figures |= {
            "files": sorted(path.name for path in folder.iterdir()),
            "left_out": left_out,
        }
        _attempt(lambda path: write_card(design, path.parent), folder / CARD_NAME, left_out)

    return run_stage(
        "export",
        out,
        work,
        design_id=upstream[-1].design_id,
        configuration=_made_of(design, config),
        upstream=upstream,
        goes_on=True,
        libraries=_programs(files),
    )


def kept(design: Path, out: Path, config: Mapping[str, Any]) -> Record | None:
    """Return the record of an export that :func:`run` would only repeat; None if there is none.

    It was made of the same records by the same versions, left nothing out, and has all its files as
    they were made. The parameters are those of :func:`run`.
    """
    if not (out / RECORD_NAME).is_file():
        return None
    try:
        record = read_record(out)
    except InputError:
        return None
    if record.stage != "export" or record.configuration != _made_of(design, config):
        return None
    now = versions(STAGE_VERSIONS["export"], _programs(_files(design, 0.0)))
    # OpenSCAD may have gone since: what it has made is as good as it was.
    same = all(record.versions.get(key) == one for key, one in now.items() if one is not None)
    sound = not any(damages(out, record, thorough=True))
    return record if same and sound and not record.figures["left_out"] else None


def _made_of(design: Path, config: Mapping[str, Any]) -> dict[str, Any]:
    """What an export is made of: the configuration, and the records before it by their SHA-256.

    A card shows records as they are, and pictures: so a record counts with its times, and that of
    the pictures too.
    """
    records = {stage: design / stage / RECORD_NAME for stage in (*STAGES, "figures")}
    digests = {stage: sha256_of(path) for stage, path in records.items() if path.is_file()}
    return {"geometry": config["geometry"], "upstream_sha256": digests}


def _attempt(write: Write, path: Path, left_out: dict[str, str]) -> None:
    """Write a file; why it cannot be written joins what is left out."""
    try:
        write(path)
    except (InputError, StageFailure) as error:
        left_out[path.name] = str(error)


def _programs(files: Mapping[str, Write]) -> dict[str, str | None]:
    """Return the version of OpenSCAD where files need it; None where it is missing."""
    if not any(name.startswith(_MOULD) for name in files):
        return {}
    try:
        return {"openscad": openscad_version()}
    except InputError:
        return {"openscad": None}


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
            moulds = (part for part in parts_of_model(model) if part.startswith(_MOULD))
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
