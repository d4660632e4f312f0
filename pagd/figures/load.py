"""What the stages left behind for one design, as the pictures need it. All reading is here."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pagd.catalogue import design_from
from pagd.design import Design
from pagd.errors import InputError
from pagd.families import Actuator
from pagd.mesh.types import Mesh
from pagd.record import RECORD_NAME, Record, read_record
from pagd.states import read_states
from pagd.tables import read_table

FloatArray = NDArray[np.float64]

__all__ = [
    "STAGES",
    "Path3D",
    "States",
    "Steps",
    "contact_setting",
    "has_blocked_force",
    "has_blocked_states",
    "has_contact",
    "has_history",
    "has_states",
    "has_trajectory",
    "load_blocked_force",
    "load_blocked_states",
    "load_design",
    "load_history",
    "load_mesh",
    "load_records",
    "load_states",
    "load_trajectory",
    "records_of",
    "stl_paths",
]

#: Folders of a design, in the order the stages run.
STAGES = ("geometry", "repair", "mesh", "solve", "metrics")
# In the folder of the stage solve: steps of the free actuation, and with a held tip.
_FREE, _BLOCKED = "history.parquet", "blocked_force.parquet"


@dataclass(frozen=True, eq=False, slots=True)
class States:
    """Deformed states of one design, the unloaded one first.

    mesh: the mesh they are on.
    pressure_kPa: (p,) from 0, in the order of the path: past a limit point it falls.
    displacement: (p, n, 3) in mm.
    strain: (p, n) largest principal logarithmic strain.
    """

    mesh: Mesh
    pressure_kPa: FloatArray
    displacement: FloatArray
    strain: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Path3D:
    """Trajectory of one design: s stations at p pressures, the unloaded state first.

    pressure_kPa: (p,) from 0, in the order of the path: past a limit point it falls.
    positions: (p, s, 3) in mm; bending_deg, twist_deg: (p, s).
    """

    pressure_kPa: FloatArray
    positions: FloatArray
    bending_deg: FloatArray
    twist_deg: FloatArray


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Steps:
    """Converged steps of one analysis, the unloaded state first, in the order of the path.

    pressure_kPa, cavity_volume_mm3, work_mJ: (k,) of the whole actuator.
    recorded: (k,) whether the state was kept.
    smallest_gap_mm: (k,) between walls, negative for a penetration; NaN where none are near.
    blocked_force_N: (k,) on the support, NaN where it is not known; None of a free actuation.
    """

    pressure_kPa: FloatArray
    cavity_volume_mm3: FloatArray
    work_mJ: FloatArray
    recorded: NDArray[np.bool_]
    smallest_gap_mm: FloatArray
    blocked_force_N: FloatArray | None = None

    @property
    def forces(self) -> tuple[FloatArray, FloatArray]:
        """Pressures and blocked forces (f,) of the steps that have one."""
        return self._forces(np.ones_like(self.recorded))

    @property
    def recorded_forces(self) -> tuple[FloatArray, FloatArray]:
        """Pressures and blocked forces (f,) of the recorded states that have one."""
        return self._forces(self.recorded)

    def _forces(self, wanted: NDArray[np.bool_]) -> tuple[FloatArray, FloatArray]:
        if self.blocked_force_N is None:
            return np.zeros(0), np.zeros(0)
        known = wanted & np.isfinite(self.blocked_force_N)
        return self.pressure_kPa[known], self.blocked_force_N[known]


def load_records(folder: Path) -> dict[str, Record]:
    """Return the records of a design's stages that there are, by stage, in order."""
    paths = {stage: folder / stage for stage in STAGES}
    return {s: read_record(p) for s, p in paths.items() if (p / RECORD_NAME).is_file()}


def records_of(folder: Path) -> list[Record]:
    """Return the records of a design's stages, in order; InputError if there is none."""
    found = list(load_records(folder).values())
    if not found:
        raise InputError(f"{folder}: holds no folder of a stage with a record.json.")
    return found


def load_design(folder: Path) -> Design | Actuator | None:
    """Return the design, or None where a user's own mesh was solved instead."""
    path = folder / "geometry" / "design.json"
    return design_from(str(path)).design if path.is_file() else None


def stl_paths(folder: Path) -> tuple[Path, Path] | None:
    """Return the surfaces of body and base, repaired if possible, or None."""
    for stage in ("repair", "geometry"):
        pair = folder / stage / "body.stl", folder / stage / "base.stl"
        if all(path.is_file() for path in pair):
            return pair
    return None


def load_mesh(folder: Path) -> Mesh:
    """Return the mesh of a design; InputError if there is none."""
    from pagd.mesh.msh import read_msh  # imports gmsh

    return read_msh(folder / "mesh" / "mesh.msh")


def has_states(folder: Path) -> bool:
    """Tell whether the design has a mesh and deformed states."""
    return all((folder / n).is_file() for n in ("mesh/mesh.msh", "solve/states.parquet"))


def has_trajectory(folder: Path) -> bool:
    """Tell whether the design has a trajectory."""
    return (folder / "metrics" / "trajectory.parquet").is_file()


def has_history(folder: Path) -> bool:
    """Tell whether the steps of the free actuation are there."""
    return (folder / "solve" / _FREE).is_file()


def has_blocked_force(folder: Path) -> bool:
    """Tell whether the design was also solved with its tip held."""
    return (folder / "solve" / _BLOCKED).is_file()


def has_blocked_states(folder: Path) -> bool:
    """Tell whether there are deformed states both free and with the tip held."""
    return has_states(folder) and (folder / "solve" / "blocked_states.parquet").is_file()


def has_contact(folder: Path) -> bool:
    """Tell whether walls could press each other apart in the analysis of a design."""
    return bool(contact_setting(folder))


def contact_setting(folder: Path) -> bool | None:
    """Return whether contact was on in the analysis of a design; None where no record tells."""
    if not (folder / "solve" / RECORD_NAME).is_file():
        return None
    setting = read_record(folder / "solve").configuration.get("solve", {}).get("contact")
    return setting if isinstance(setting, bool) else None


def load_states(folder: Path) -> States:
    """Return the mesh and the deformed states of a design under free actuation.

    Raises
    ------
    InputError
        If a file is missing, or mesh and states do not belong together.
    """
    return _states_in(folder, "states.parquet")


def load_blocked_states(folder: Path) -> States:
    """Return the deformed states of a design whose tip is held; see :func:`load_states`."""
    return _states_in(folder, "blocked_states.parquet")


def load_history(folder: Path) -> Steps:
    """Return the steps of the free actuation; InputError if there are none."""
    return _steps_in(folder / "solve" / _FREE)


def load_blocked_force(folder: Path) -> Steps:
    """Return the steps of the analysis with a held tip; InputError if there are none."""
    return _steps_in(folder / "solve" / _BLOCKED)


def load_trajectory(folder: Path) -> Path3D:
    """Return the trajectory of a design; InputError if there is none.

    The rows of every station are in the order of the path, in which a pressure may come twice.
    """
    table = read_table(folder / "metrics" / "trajectory.parquet")
    order = np.argsort(table["station"], kind="stable")
    shape = (len(np.unique(table["station"])), -1)
    column = {name: values[order].reshape(shape).T for name, values in table.items()}
    positions = np.stack([column[f"{axis}_mm"] for axis in "xyz"], axis=-1)
    pressure = column["pressure_kPa"][:, 0]
    return Path3D(pressure, positions, column["bending_deg"], column["twist_deg"])


def _states_in(folder: Path, name: str) -> States:
    mesh = load_mesh(folder)
    path = folder / "solve" / name
    found = read_states(path)
    if found.strain.shape[1:] != mesh.points.shape[:1]:
        raise InputError(f"{path}: does not hold one row for each of {len(mesh.points)} nodes.")
    return _from_zero(States(mesh, found.pressure_kPa, found.displacement, found.strain))


def _steps_in(path: Path) -> Steps:
    table = read_table(path)
    return Steps(
        pressure_kPa=table["pressure_kPa"],
        cavity_volume_mm3=table["cavity_volume_mm3"],
        work_mJ=table["work_mJ"],
        recorded=table["recorded"].astype(np.bool_),
        smallest_gap_mm=table["smallest_gap_mm"].astype(np.float64),
        blocked_force_N=table.get("blocked_force_N"),
    )


def _from_zero(states: States) -> States:
    if len(states.pressure_kPa) and states.pressure_kPa[0] == 0.0:
        return states
    return States(
        states.mesh,
        np.pad(states.pressure_kPa, (1, 0)),
        np.pad(states.displacement, ((1, 0), (0, 0), (0, 0))),
        np.pad(states.strain, ((1, 0), (0, 0))),
    )
