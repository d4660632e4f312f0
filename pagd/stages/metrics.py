"""Stage 5: from the deformed states to trajectory, bending, twist, work and mode."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError, Status
from pagd.mesh.msh import read_msh
from pagd.mesh.types import Mesh
from pagd.metrics import Thresholds, Trajectory, is_still, measure, performance
from pagd.record import Meter, Record, read_record
from pagd.sections import Stations, stations_of
from pagd.stages.geometry import read_design
from pagd.stages.mesh import identity, mesh_file
from pagd.stages.sections import even_stations_of, sections_of
from pagd.stages.solve import HISTORY_NAME, STATES_NAME
from pagd.stages.stage import Outcome, run_stage
from pagd.states import read_states
from pagd.tables import MEASURES, TRAJECTORY, read_table, write_table

__all__ = ["PERFORMANCE_NAME", "TRAJECTORY_NAME", "Folders", "run"]

TRAJECTORY_NAME = "trajectory.parquet"
PERFORMANCE_NAME = "performance.parquet"

Columns = dict[str, NDArray[Any]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Folders:
    """Folders of the stages before; ``geometry`` and ``repair`` where there is a design.

    ``mesh`` may also be a .msh file of one's own, the one that was solved.
    """

    mesh: Path
    solve: Path
    geometry: Path | None = None
    repair: Path | None = None

    def records(self) -> list[Record]:
        """Return the records of the stages before, in order."""
        stages = (self.geometry, self.repair, self.mesh, self.solve)
        return [read_record(folder) for folder in stages if folder and not folder.is_file()]


def run(folders: Folders, out: Path, config: Mapping[str, Any], sections: int = 11) -> Record:
    """Measure the recorded states: trajectory.parquet and performance.parquet.

    A design that stopped early is measured as far as it came. The figures of the record are the
    design's row in the table of all designs.

    Parameters
    ----------
    folders
        Folders of the stages before.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``metrics``.
    sections
        Number of evenly spaced sections where there is no design.

    Raises
    ------
    InputError
        If the mesh is not the one that was solved.
    """
    upstream = folders.records()
    thresholds = Thresholds(**config["metrics"])

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        outcome.figures |= _described(folders.geometry) | _cost(upstream)
        if not (folders.solve / STATES_NAME).is_file():
            return
        measures = _measured(folders, folder, sections, thresholds)
        last = {key: values[-1] for key, values in measures.items()}
        outcome.figures |= last | _sizes(upstream)
        _refuse_still(outcome, last, thresholds)

    return run_stage(
        "metrics",
        out,
        work,
        design_id=upstream[-1].design_id,
        configuration={"metrics": config["metrics"]},
        upstream=upstream,
        goes_on=True,
        libraries=("numpy", "pyarrow"),
    )


def _described(geometry: Path | None) -> dict[str, Any]:
    if geometry is None:
        return {}
    named = read_design(geometry)
    return {"name": named.name, "origin": named.origin, "mode": named.design.mode}


def _cost(upstream: list[Record]) -> dict[str, float]:
    return {
        "cpu_s": round(sum(record.timings_s["cpu"] for record in upstream), 3),
        "wall_s": round(sum(record.timings_s["wall"] for record in upstream), 3),
        "peak_memory_MB": max(record.peak_memory_MB for record in upstream),
    }


def _sizes(upstream: list[Record]) -> dict[str, Any]:
    solved = upstream[-1]
    sizes = [r.configuration["mesh"]["size_mm"] for r in upstream if r.stage == "mesh"]
    return {
        "size_mm": sizes[0] if sizes else None,
        "material": solved.configuration["material"]["name"],
        **{key: solved.figures[key] for key in ("tets", "unknowns", "newton_iterations")},
    }


def _measured(folders: Folders, out: Path, sections: int, thresholds: Thresholds) -> Columns:
    mesh = read_msh(mesh_file(folders.mesh))
    solved = read_record(folders.solve)
    _refuse_other_mesh(folders, mesh, solved)
    trajectory = _trajectory(folders, mesh, sections)
    history = read_table(folders.solve / HISTORY_NAME)
    volume = solved.figures["solid_volume_mm3"]
    measures = performance(trajectory, history, volume, thresholds)
    strains = {key: np.array(solved.figures["recorded"][key]) for key in _STRAINS}
    table = {"design_id": [solved.design_id] * trajectory.positions[..., 0].size}
    write_table(out / TRAJECTORY_NAME, TRAJECTORY, table | trajectory.columns())
    write_table(out / PERFORMANCE_NAME, MEASURES, measures | strains)
    return measures | strains


def _refuse_other_mesh(folders: Folders, mesh: Mesh, solved: Record) -> None:
    here = identity(mesh)
    there = {key: solved.figures.get(key) for key in here}
    if here != there:
        raise InputError(
            f"mesh = {folders.mesh} must be the mesh that was solved in {folders.solve}: it has "
            f"{here['nodes']} nodes (digest {here['mesh_sha256']}), that one {there['nodes']} "
            f"({there['mesh_sha256']})."
        )


_STRAINS = ("strain_max", "strain_p99")


def _trajectory(folders: Folders, mesh: Mesh, sections: int) -> Trajectory:
    placed = sections_of(mesh, _stations(folders.geometry, mesh, sections))
    states = read_states(folders.solve / STATES_NAME)
    return measure(placed, states.pressure_kPa, states.displacement)


def _stations(geometry: Path | None, mesh: Mesh, count: int) -> Stations:
    if geometry is not None:
        return stations_of(read_design(geometry).design)
    return even_stations_of(mesh, count)


def _refuse_still(outcome: Outcome, last: Mapping[str, Any], thresholds: Thresholds) -> None:
    bending, twist = float(last["bending_deg"]), float(last["twist_deg"])
    if is_still(bending, twist, thresholds):
        outcome.end(
            Status.no_actuation,
            f"At {last['pressure_kPa']:g} kPa it bends by {round(bending, 1) + 0.0}° and twists "
            f"by {round(twist, 1) + 0.0}°, both less than {thresholds.still_deg:g}°.",
        )
