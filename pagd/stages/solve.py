"""Stage 4: free actuation and blocked force, pressure from 0 to the maximum."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pagd.actuation import (
    Actuation,
    ActuationResult,
    Body,
    Progress,
    Stop,
    blocked_force,
    free_actuation,
    use_threads,
)
from pagd.config import material_file
from pagd.design import Design
from pagd.documents import read_document
from pagd.errors import InputError
from pagd.inventory import read_sound_record
from pagd.long_work import long_work
from pagd.materials import Elastomer, Sheet, Use, elastomer, find_material, sheet
from pagd.mesh.interface import STRUCTURED
from pagd.mesh.msh import read_msh
from pagd.mesh.types import Mesh
from pagd.metrics import work_of_pressure
from pagd.record import Meter, Record
from pagd.reduced.guide import RowGuide
from pagd.reduced.row import unlike_their_neighbours
from pagd.self_collision import self_collision_stop
from pagd.stages.mesh import channel_of, identity, mesh_file, name_of
from pagd.stages.stage import Outcome, run_stage
from pagd.stages.stops import bending_stop, first_of
from pagd.states import States, write_states
from pagd.tables import BLOCKED, HISTORY, Column, write_table

__all__ = [
    "BLOCKED_NAME",
    "BLOCKED_STATES_NAME",
    "HISTORY_NAME",
    "STATES_NAME",
    "Materials",
    "materials_of",
    "run",
]

# Where more of the chambers are unlike their neighbours, the parts cost as much as the whole.
_LARGEST_SHARE = 0.5

STATES_NAME = "states.parquet"
HISTORY_NAME = "history.parquet"
BLOCKED_STATES_NAME = "blocked_states.parquet"
BLOCKED_NAME = "blocked_force.parquet"


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
    threads: int | None = None,
) -> Record:
    """Solve an actuator: free, then with its tip held unless the configuration says otherwise.

    Leaves states.parquet and history.parquet, blocked_states.parquet and blocked_force.parquet,
    and VTU files of the free actuation on request. The status is that of the free actuation; how
    the other analysis ended is in the figures.

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
    threads
        Threads of kernels and linear solver; None leaves them as they are.
    """
    upstream = [read_sound_record(mesh)] if mesh.is_dir() else []
    file = mesh_file(mesh)
    settings = dict(config["solve"])
    limit = settings.pop("bending_limit_deg")
    from_cells = settings.pop("first_guess") == "cells"
    actuation = Actuation(**settings | {"gravity_m_s2": tuple(settings["gravity_m_s2"])})

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        if threads is not None:
            # Not before: a process that has started its threads cannot be forked.
            use_threads(threads)
        with meter.part("read"):
            read = read_msh(file)
            body = Body(read, materials.elastomer, materials.paper, actuation)
            collision = self_collision_stop(read)
        both = materials.elastomer, materials.paper, actuation
        stop = first_of(bending_stop(read, limit), collision)
        profile: dict[str, float] = {}
        with meter.part("solve"):
            if from_cells:
                with meter.part("cells"):
                    guide = _guide(upstream, read, both, stop, outcome)
                profile["cells"] = round(meter.parts["cells_cpu"], 3)
            else:
                guide = None
            with _shown("free actuation", actuation, progress) as told:
                result = free_actuation(body, *both, stop, told, guide)
        outcome.figures |= _figures(result, profile) | identity(read)
        outcome.end(result.status, result.reason)
        if actuation.blocked_force != "none":
            with (
                meter.part("blocked_force"),
                _shown("blocked force", actuation, progress) as told,
            ):
                held = blocked_force(body, *both, collision, told)
            outcome.figures["blocked_force"] = _ending(held)
            _write(held, folder / BLOCKED_STATES_NAME, folder / BLOCKED_NAME, BLOCKED)
        # At the end, since the memory that writing takes is not given back.
        _write_free(read, result, folder, vtu=vtu)

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
        libraries=("mkl", "numba", "numpy", "pypardiso", "scipy"),
    )


@contextmanager
def _shown(what: str, actuation: Actuation, progress: Progress | None) -> Iterator[Progress]:
    """Yield what is told every converged step: ``progress``, and whoever else has asked."""
    with long_work(what, actuation.maximum_pressure_kPa, "kPa") as shown:

        def told(pressure_kPa: float, iterations: int) -> None:
            shown.reach(pressure_kPa)
            if progress is not None:
                progress(pressure_kPa, iterations)

        yield told


def _guide(
    upstream: Sequence[Record],
    mesh: Mesh,
    both: tuple[Elastomer, Sheet, Actuation],
    stop: Stop,
    outcome: Outcome,
) -> RowGuide | None:
    """First guesses by the parts of the row that the mesh is of; none if it is of no row."""
    made = next((record.configuration for record in upstream), {})
    in_blocks = any(record.figures.get("mesher") == STRUCTURED for record in upstream)
    # A channel is what a row of chambers has; other families have no parts that are known.
    if not in_blocks or "channel" not in made or any(both[2].gravity_m_s2):
        return None
    if both[2].element in ("taylor_hood", "element_pressure"):
        return None
    design, channel = Design.from_mapping(made["design"]), channel_of(made["channel"])
    alone = sum(last - first + 1 for first, last in unlike_their_neighbours(design))
    if alone > _LARGEST_SHARE * design.N:
        return None
    try:
        guide = RowGuide(design, channel, mesh, made["mesh"]["block_mm"], *both, stop)
    except (InputError, ArithmeticError, AssertionError, LookupError, ValueError) as error:
        # Such as a mesh that has been refined since: the whole model does without first guesses.
        outcome.figures["cells"] = {"status": None, "reason": f"{type(error).__name__}: {error}"}
        return None
    reduced = guide.reduced
    outcome.figures["cells"] = {
        "status": reduced.status.value,
        "reason": reduced.reason,
        "pressure_kPa": float(reduced.pressure_kPa[-1]),
        "factorisations": reduced.factorisations,
    }
    return guide


def _entry(use: Use, named: str, file: Path) -> tuple[str, dict[str, Any]]:
    if not named.lstrip().startswith("{"):
        return named, find_material(file, named, use)
    entry, _ = read_document(named, use)
    if "name" not in entry:
        raise InputError(f"{use}: name is missing; a result always names its material.")
    return str(entry.pop("name")), entry


def _figures(result: ActuationResult, profile: Mapping[str, float]) -> dict[str, Any]:
    """Figures of the free actuation; ``profile``: processor time (s) of what was before it."""
    states, found = result.states, dict(result.figures)
    own = found["profile_s"]
    assert isinstance(own, dict)
    found["profile_s"] = {**profile, **own}
    recorded = {
        "pressure_kPa": [state.pressure_kPa for state in states],
        "strain_max": [state.strain_max for state in states],
        "strain_p99": [state.strain_p99 for state in states],
    }
    return {**found, "recorded": recorded}


#: What the record says of the analysis with the tip held, beside how it ended.
_HELD_FIGURES = (
    "variant",
    "blocked_force_N",
    "pressure_kPa",
    "newton_iterations",
    "factorisations",
    "corrections",
    "steps",
    "rejected_steps",
    "largest_pressure_kPa",
    "critical_pressure_kPa",
    "limit_points",
    "volume_controlled_from_kPa",
    "smallest_gap_mm",
    "deepest_penetration_mm",
    "penetration_share",
    "profile_s",
)


def _ending(held: ActuationResult) -> dict[str, Any]:
    found = {key: held.figures[key] for key in _HELD_FIGURES if key in held.figures}
    return {"status": held.status.value, "reason": held.reason, **found}


def _write_free(mesh: Mesh, result: ActuationResult, folder: Path, *, vtu: bool) -> None:
    states = _write(result, folder / STATES_NAME, folder / HISTORY_NAME, HISTORY)
    if vtu:
        from pagd.vtu import write_vtu

        write_vtu(mesh, states, folder / "vtu")


def _write(
    result: ActuationResult, states_file: Path, history_file: Path, columns: Sequence[Column]
) -> States:
    states = States.stacked(
        [state.pressure_kPa for state in result.states],
        [state.displacement for state in result.states],
        [state.strain for state in result.states],
    )
    write_states(states, states_file)
    history = result.history
    work = work_of_pressure(history["pressure_kPa"], history["cavity_volume_mm3"])
    iterations = history["newton_iterations"].astype(np.int32)
    write_table(
        history_file, columns, {**history, "work_mJ": work, "newton_iterations": iterations}
    )
    return states
