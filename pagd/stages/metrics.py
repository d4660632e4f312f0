"""Stage 5: from the deformed states to trajectory, bending, twist, work, contact and mode."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError, Status
from pagd.fem.contact import ContactLaw
from pagd.inventory import read_sound_record
from pagd.mesh.interface import STRUCTURED
from pagd.mesh.msh import read_msh
from pagd.mesh.types import Mesh
from pagd.metrics import (
    Kind,
    Thresholds,
    Trajectory,
    blocked_force_at,
    chamber_columns,
    first_contact_pressure,
    is_still,
    measure,
    performance,
    strain_columns,
)
from pagd.record import Meter, Record
from pagd.sections import Stations
from pagd.stages.geometry import read_design
from pagd.stages.mesh import identity, mesh_file
from pagd.stages.sections import even_stations_of, sections_of
from pagd.stages.solve import BLOCKED_NAME, HISTORY_NAME, STATES_NAME
from pagd.stages.stage import Outcome, run_stage
from pagd.states import read_states
from pagd.tables import CHAMBERS, MEASURES, TRAJECTORY, Column, read_table, write_table

__all__ = ["CHAMBERS_NAME", "PERFORMANCE_NAME", "TRAJECTORY_NAME", "Folders", "run"]

TRAJECTORY_NAME = "trajectory.parquet"
CHAMBERS_NAME = "chambers.parquet"
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
        return [read_sound_record(folder) for folder in stages if folder and not folder.is_file()]


def run(folders: Folders, out: Path, config: Mapping[str, Any], sections: int = 11) -> Record:
    """Measure the recorded states: trajectory, chambers and performance, a Parquet file each.

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
    settings = dict(config["metrics"])
    ramp = settings.pop("pressure_ramp_kPa_per_s")
    thresholds = Thresholds(**settings)

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        outcome.figures |= _described(folders.geometry) | _cost(upstream)
        if not (folders.solve / STATES_NAME).is_file():
            return
        solved = upstream[-1]
        trajectory = _trajectory(folders, solved, sections)
        history = read_table(folders.solve / HISTORY_NAME)
        measures = performance(trajectory, history, solved.figures["solid_volume_mm3"], thresholds)
        measures |= _strains(solved, ramp) | _blocked(folders.solve, trajectory)
        _write(folder, solved.design_id, trajectory, measures, _kinds(folders.geometry))
        last = {key: _plain(values[-1]) for key, values in measures.items()}
        contact = {"first_contact_pressure_kPa": _first_contact(solved, history)}
        outcome.figures |= last | contact | _of_solve(solved) | _sizes(upstream)
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
    return {"name": named.name, "origin": named.origin, "mode": named.actuator.mode}


def _cost(upstream: list[Record]) -> dict[str, float]:
    return {
        "cpu_s": round(sum(record.timings_s["cpu"] for record in upstream), 3),
        "wall_s": round(sum(record.timings_s["wall"] for record in upstream), 3),
        "peak_memory_MB": max(record.peak_memory_MB for record in upstream),
    }


def _sizes(upstream: list[Record]) -> dict[str, Any]:
    solved = upstream[-1]
    sizes = [_size_of(record) for record in upstream if record.stage == "mesh"]
    return {
        "size_mm": sizes[0] if sizes else None,
        "material": solved.configuration["material"]["name"],
        **{key: solved.figures[key] for key in ("tets", "unknowns", "newton_iterations")},
    }


def _plain(value: Any) -> Any:
    """JSON has no word for what is not a finite number."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


#: Figures of the free actuation that are the design's.
_OF_THE_PATH = (
    "deepest_penetration_mm",
    "penetration_share",
    "limit_points",
    "largest_pressure_kPa",
)


def _of_solve(solved: Record) -> dict[str, Any]:
    """Return the figures of the whole path, and of the analysis with a held tip, if there is one.

    The blocked force is the one of its own last pressure.
    """
    figures = solved.figures
    path = {key: figures.get(key) for key in _OF_THE_PATH}
    held = figures.get("blocked_force")
    if not held:
        return path
    return path | {
        "blocked_force_N": held["blocked_force_N"],
        "blocked_force_pressure_kPa": held["pressure_kPa"],
        "blocked_force_variant": held["variant"],
        "blocked_force_status": held["status"],
        "blocked_force_iterations": held.get("newton_iterations"),
        "blocked_penetration_share": held.get("penetration_share"),
    }


def _first_contact(solved: Record, history: Columns) -> float | None:
    gap = history["smallest_gap_mm"].copy()
    if np.isnan(gap[0]):
        # Walls that are too far apart for the search still have a distance.
        gap[0] = solved.figures.get("initial_gap_mm", np.nan)
    return first_contact_pressure(history["pressure_kPa"], gap, ContactLaw().width)


def _strains(solved: Record, ramp_kPa_per_s: float | None) -> Columns:
    recorded = solved.figures["recorded"]
    keys = ("pressure_kPa", "strain_max", "strain_p99")
    pressure, largest, percentile = (np.array(recorded[key], np.float64) for key in keys)
    return {**strain_columns(pressure, largest, percentile, ramp_kPa_per_s)}


def _blocked(solve: Path, trajectory: Trajectory) -> Columns:
    if not (solve / BLOCKED_NAME).is_file():
        return {}
    force = blocked_force_at(trajectory.pressure_kPa, read_table(solve / BLOCKED_NAME))
    return {"blocked_force_N": force}


def _kinds(geometry: Path | None) -> list[Kind] | None:
    return read_design(geometry).actuator.kinds() if geometry else None


def _write(
    out: Path,
    design_id: str,
    trajectory: Trajectory,
    measures: Columns,
    kinds: list[Kind] | None,
) -> None:
    tables: dict[str, tuple[tuple[Column, ...], Columns]] = {
        TRAJECTORY_NAME: (TRAJECTORY, trajectory.columns()),
        CHAMBERS_NAME: (CHAMBERS, chamber_columns(trajectory, kinds)),
        PERFORMANCE_NAME: (MEASURES, measures),
    }
    for name, (columns, data) in tables.items():
        rows = len(data["pressure_kPa"])
        named = {"design_id": [design_id] * rows, "fidelity": ["full"] * rows}
        write_table(out / name, columns, named | data)


def _refuse_other_mesh(folders: Folders, mesh: Mesh, solved: Record) -> None:
    here = identity(mesh)
    there = {key: solved.figures.get(key) for key in here}
    if here != there:
        raise InputError(
            f"mesh = {folders.mesh} must be the mesh that was solved in {folders.solve}: it has "
            f"{here['nodes']} nodes (digest {here['mesh_sha256']}), that one {there['nodes']} "
            f"({there['mesh_sha256']})."
        )


def _trajectory(folders: Folders, solved: Record, sections: int) -> Trajectory:
    mesh = read_msh(mesh_file(folders.mesh))
    _refuse_other_mesh(folders, mesh, solved)
    placed = sections_of(mesh, _stations(folders.geometry, mesh, sections))
    states = read_states(folders.solve / STATES_NAME)
    return measure(placed, states.pressure_kPa, states.displacement)


def _stations(geometry: Path | None, mesh: Mesh, count: int) -> Stations:
    own = read_design(geometry).actuator.stations() if geometry else None
    return own or even_stations_of(mesh, count)


def _refuse_still(outcome: Outcome, last: Mapping[str, Any], thresholds: Thresholds) -> None:
    bending, twist = float(last["bending_deg"]), float(last["twist_deg"])
    if is_still(bending, twist, thresholds):
        outcome.end(
            Status.no_actuation,
            f"At {last['pressure_kPa']:g} kPa it bends by {round(bending, 1) + 0.0}° and twists "
            f"by {round(twist, 1) + 0.0}°, both less than {thresholds.still_deg:g}°.",
        )


def _size_of(mesh: Record) -> float:
    """Length in mm that the elements were wanted to have."""
    key = "block_mm" if mesh.figures.get("mesher") == STRUCTURED else "size_mm"
    return float(mesh.configuration["mesh"][key])
