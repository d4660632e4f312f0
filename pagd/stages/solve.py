"""Stage 4: free actuation, pressure from 0 to the maximum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.actuation import Actuation, ActuationResult, Progress, Stop, free_actuation
from pagd.config import material_file
from pagd.documents import read_document
from pagd.errors import InputError, Status
from pagd.materials import Elastomer, Sheet, Use, elastomer, find_material, sheet
from pagd.mesh.msh import read_msh
from pagd.mesh.types import Mesh
from pagd.metrics import measure, work_of_pressure
from pagd.record import Meter, Record, read_record
from pagd.stages.mesh import identity, mesh_file, name_of
from pagd.stages.sections import even_stations_of, sections_of
from pagd.stages.stage import Outcome, run_stage
from pagd.states import States, write_states
from pagd.tables import HISTORY, write_table

__all__ = ["HISTORY_NAME", "STATES_NAME", "Materials", "materials_of", "run"]

STATES_NAME = "states.parquet"
HISTORY_NAME = "history.parquet"

# Sections for the limit of bending: enough that no piece between two turns by 180°.
_SECTIONS = 13


@dataclass(frozen=True, slots=True)
class Materials:
    """The elastomer and the sheet in the base."""

    elastomer: Elastomer
    paper: Sheet


def materials_of(
    config: Mapping[str, Any], material: str | None = None, paper: str | None = None
) -> Materials:
    """Return the materials that the configuration names, or those given instead.

    Parameters
    ----------
    config
        Completed configuration; uses ``material_file``, ``material`` and ``paper``.
    material, paper
        Names in the file of materials, or entries as JSON text with a ``name``.

    Raises
    ------
    InputError
        If a name is not in the file, or an entry is unusable.
    """
    file = material_file(config)
    return Materials(
        elastomer(*_entry("material", material or config["material"], file)),
        sheet(*_entry("paper", paper or config["paper"], file)),
    )


def run(
    mesh: Path,
    out: Path,
    config: Mapping[str, Any],
    materials: Materials,
    *,
    name: str | None = None,
    vtu: bool = False,
    progress: Progress | None = None,
) -> Record:
    """Solve an actuator: states.parquet, history.parquet, and VTU files on request.

    Parameters
    ----------
    mesh
        Folder of the stage mesh, or a .msh file with named surfaces.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``solve``.
    materials
        Elastomer and paper.
    name
        Name for the record; that of the mesh unless given.
    vtu
        Also write the states for ParaView, to ``vtu/``.
    progress
        Told pressure (kPa) and iterations of every converged step.
    """
    upstream = [read_record(mesh)] if mesh.is_dir() else []
    file = mesh_file(mesh)
    settings = dict(config["solve"])
    limit = settings.pop("bending_limit_deg")

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        with meter.part("read"):
            body = read_msh(file)
        with meter.part("solve"):
            result = free_actuation(
                body,
                materials.elastomer,
                materials.paper,
                Actuation(**settings),
                stop=_bending_stop(body, limit),
                progress=progress,
            )
        outcome.figures |= _figures(result) | identity(body)
        outcome.end(result.status, result.reason)
        _write(body, result, folder, vtu=vtu)

    return run_stage(
        "solve",
        out,
        work,
        design_id=name or (upstream[0].design_id if upstream else name_of(file)),
        configuration={
            "solve": config["solve"],
            "material": asdict(materials.elastomer),
            "paper": asdict(materials.paper),
            "mesh": file.name,
        },
        upstream=upstream,
        libraries=("numba", "numpy", "pypardiso", "scipy"),
    )


def _entry(use: Use, named: str, file: Path) -> tuple[str, dict[str, Any]]:
    if not named.lstrip().startswith("{"):
        return named, find_material(file, named, use)
    entry, _ = read_document(named, use)
    if "name" not in entry:
        raise InputError(f"{use}: name is missing; a result always names its material.")
    return str(entry.pop("name")), entry


def _bending_stop(mesh: Mesh, limit_deg: float) -> Stop | None:
    """Return what ends the analysis where the tip has bent beyond the limit."""
    if "paper" not in mesh.surfaces:
        return None
    sections = sections_of(mesh, even_stations_of(mesh, _SECTIONS))

    def stop(pressure_kPa: float, moved: NDArray[np.float64]) -> tuple[Status, str] | None:
        trajectory = measure(sections, np.array([pressure_kPa]), moved[None])
        bending = abs(float(trajectory.bending_deg[-1, -1]))
        if bending <= limit_deg:
            return None
        reason = f"At {pressure_kPa:.4g} kPa it bends by {bending:.1f}°, over {limit_deg:g}°."
        return Status.bending_limit, reason

    return stop


def _figures(result: ActuationResult) -> dict[str, Any]:
    states = result.states
    recorded = {
        "pressure_kPa": [state.pressure_kPa for state in states],
        "strain_max": [state.strain_max for state in states],
        "strain_p99": [state.strain_p99 for state in states],
    }
    return {**result.figures, "recorded": recorded}


def _write(mesh: Mesh, result: ActuationResult, folder: Path, *, vtu: bool) -> None:
    states = States.stacked(
        [state.pressure_kPa for state in result.states],
        [state.displacement for state in result.states],
        [state.strain for state in result.states],
    )
    write_states(states, folder / STATES_NAME)
    history = result.history
    work = work_of_pressure(history["pressure_kPa"], history["cavity_volume_mm3"])
    iterations = history["newton_iterations"].astype(np.int32)
    columns = {**history, "work_mJ": work, "newton_iterations": iterations}
    write_table(folder / HISTORY_NAME, HISTORY, columns)
    if vtu:
        from pagd.vtu import write_vtu

        write_vtu(mesh, states, folder / "vtu")
