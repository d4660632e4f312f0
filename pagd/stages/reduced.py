"""The reduced-order analysis of a design, measured as the full one is."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.actuation import Actuation
from pagd.catalogue import NamedDesign
from pagd.design import Channel, Design, GeometryRules, violations
from pagd.design.volumes import cavity_volume, solid_volume
from pagd.errors import StageFailure, Status
from pagd.fem.contact import ContactLaw
from pagd.fem.linear_solver import SingularMatrixError
from pagd.mesh.chamber_row import chamber_row
from pagd.mesh.types import Mesh
from pagd.metrics import (
    Thresholds,
    Trajectory,
    chamber_columns,
    first_contact_pressure,
    is_still,
    kinds_of,
    measure,
    performance,
    strain_columns,
)
from pagd.reduced.blocked import Blocked, blocked_forces
from pagd.reduced.history import row_history, row_strains
from pagd.reduced.solve import ReducedRow, solve_row
from pagd.sections import stations_of
from pagd.self_collision import self_collision_stop
from pagd.stages.geometry import rules_of
from pagd.stages.sections import sections_of
from pagd.stages.solve import Materials

__all__ = ["CELLS", "PIECES", "Reduced", "analyse"]

FloatArray = NDArray[np.float64]
Columns = dict[str, Any]

# Degrees: a row that bends by less is nowhere near itself, and need not be searched.
_CURLED = 120.0

#: What the column ``fidelity`` says of results of cells alone, and of cells with pieces.
CELLS, PIECES = "cells", "pieces"


@dataclass(frozen=True, eq=False, slots=True)
class Reduced:
    """What is known of a design: its row of the table of all designs, and three tables of its own.

    The tables are empty where nothing could be solved.
    """

    row: dict[str, Any]
    by_pressure: Columns
    trajectory: Columns
    chambers: Columns


def analyse(
    named: NamedDesign,
    config: Mapping[str, Any],
    materials: Materials,
    *,
    pieces: bool,
) -> Reduced:
    """Analyse a design by its cells, with ``pieces`` of their own at its ends and changes.

    Whatever becomes of it is a result; only bad configurations raise.

    Parameters
    ----------
    named
        The design.
    config
        Completed configuration; uses ``channel``, ``limits``, ``mesh``, ``solve`` and ``metrics``.
    materials
        Elastomer and paper.
    pieces
        Whether chambers unlike their neighbours are solved too.
    """
    begun, wall = time.process_time(), time.perf_counter()
    design, rules = named.pneunet, rules_of(config)
    row: dict[str, Any] = {
        "design_id": named.name,
        "name": named.name,
        "origin": named.origin,
        "mode": design.mode,
        "fidelity": PIECES if pieces else CELLS,
        "status": Status.ok.value,
        "reason": None,
    }
    tables: tuple[Columns, Columns, Columns] = ({}, {}, {})
    try:
        tables = _analysed(named, config, materials, rules, row, pieces=pieces)
    except StageFailure as failure:
        row |= {"status": failure.status.value, "reason": failure.reason}
    row["cpu_s"] = round(time.process_time() - begun, 4)
    row["wall_s"] = round(time.perf_counter() - wall, 4)
    return Reduced(row, *tables)


def _analysed(
    named: NamedDesign,
    config: Mapping[str, Any],
    materials: Materials,
    rules: GeometryRules,
    row: dict[str, Any],
    *,
    pieces: bool,
) -> tuple[Columns, Columns, Columns]:
    design = named.pneunet
    _refuse_invalid(design, rules)
    settings = dict(config["solve"])
    limit = settings.pop("bending_limit_deg")
    settings.pop("first_guess")
    actuation = Actuation(**settings | {"gravity_m_s2": tuple(settings["gravity_m_s2"])})
    size = config["mesh"]["block_mm"]
    mesh = chamber_row(design, rules.channel, size, half=design.is_straight)
    reduced = solve_row(
        design,
        rules.channel,
        size,
        materials.elastomer,
        materials.paper,
        actuation,
        mesh if pieces else None,
        keeps_factors=True,
    )
    try:
        moved = _moved(reduced, mesh, rules.channel)
        sections = sections_of(mesh, stations_of(design))
        trajectory = measure(sections, reduced.pressure_kPa, moved)
        row |= {"status": reduced.status.value, "reason": reduced.reason}
        count = _until_stopped(trajectory, moved, mesh, limit, row)
        reduced = replace(reduced, pressure_kPa=reduced.pressure_kPa[:count])
        trajectory = measure(sections, reduced.pressure_kPa, moved[:count])
        return _measured(named, config, rules, reduced, trajectory, actuation, row)
    finally:
        reduced.free()


def _refuse_invalid(design: Design, rules: GeometryRules) -> None:
    broken = violations(design, rules)
    if broken:
        raise StageFailure(Status.invalid_geometry, " ".join(str(rule) for rule in broken))


def _moved(reduced: ReducedRow, mesh: Mesh, channel: Channel) -> FloatArray:
    row = reduced.row(mesh.points, channel)
    return np.stack([reduced.displacement(row, float(p)) for p in reduced.pressure_kPa])


def _until_stopped(
    trajectory: Trajectory,
    moved: FloatArray,
    mesh: Mesh,
    limit_deg: float,
    row: dict[str, Any],
) -> int:
    """How many states there are up to the first that would end a full analysis, that one too."""
    collides = self_collision_stop(mesh)
    for number, pressure in enumerate(trajectory.pressure_kPa):
        bending = abs(float(trajectory.bending_deg[number, -1]))
        if bending > limit_deg:
            reason = f"At {pressure:.4g} kPa it bends by {bending:.1f}°, over {limit_deg:g}°."
            row |= {"status": Status.bending_limit.value, "reason": reason}
            return number + 1
        ending = collides(float(pressure), moved[number]) if bending > _CURLED else None
        if ending is not None:
            row |= {"status": ending[0].value, "reason": ending[1]}
            return number + 1
    return len(moved)


def _measured(
    named: NamedDesign,
    config: Mapping[str, Any],
    rules: GeometryRules,
    reduced: ReducedRow,
    trajectory: Trajectory,
    actuation: Actuation,
    row: dict[str, Any],
) -> tuple[Columns, Columns, Columns]:
    settings = dict(config["metrics"])
    ramp = settings.pop("pressure_ramp_kPa_per_s")
    thresholds = Thresholds(**settings)
    design = named.pneunet
    history = row_history(reduced, cavity_volume(design, rules))
    measures: Columns = dict(
        performance(trajectory, history, solid_volume(design, rules), thresholds)
    )
    measures |= strain_columns(reduced.pressure_kPa, *row_strains(reduced), ramp)
    blocked = _blocked(reduced, rules.channel, actuation)
    measures["blocked_force_N"] = blocked.force_N
    row |= {key: _plain(values[-1]) for key, values in measures.items()}
    row["largest_pressure_kPa"] = float(reduced.pressure_kPa[-1])
    row["first_contact_pressure_kPa"] = first_contact_pressure(
        history["pressure_kPa"], history["smallest_gap_mm"], ContactLaw().width
    )
    row["newton_iterations"] = reduced.factorisations
    row |= _force_row(reduced.pressure_kPa, blocked, actuation)
    if is_still(row["bending_deg"], row["twist_deg"], thresholds) and row["status"] == "ok":
        row |= {
            "status": Status.no_actuation.value,
            "reason": f"At {row['pressure_kPa']:g} kPa it bends and twists by less than "
            f"{thresholds.still_deg:g}°.",
        }
    tables = measures, trajectory.columns(), chamber_columns(trajectory, kinds_of(design))
    fidelity = row["fidelity"]
    for table in tables:
        rows = len(table["pressure_kPa"])
        table |= {"design_id": [named.name] * rows, "fidelity": [fidelity] * rows}
    return tables


def _blocked(reduced: ReducedRow, channel: Channel, actuation: Actuation) -> Blocked:
    """What holds the tip at all pressures; not a number where nothing does."""
    nothing = Blocked(*np.full((2, len(reduced.pressure_kPa)), np.nan))
    if actuation.blocked_force != "edge" or reduced.design.N < 2:
        return nothing
    try:
        return blocked_forces(reduced, channel)
    except SingularMatrixError:
        return nothing


def _force_row(pressure_kPa: FloatArray, blocked: Blocked, actuation: Actuation) -> dict[str, Any]:
    forces = blocked.force_N
    known = np.flatnonzero(np.isfinite(forces[1:])) + 1
    if actuation.blocked_force != "edge" or len(forces) < 2:
        return {"blocked_force_N": None}
    if len(known) == 0:
        status = Status.not_converged.value
        return {"blocked_force_N": None, "blocked_force_status": status}
    last = int(known[-1])
    status = Status.ok if last == len(forces) - 1 else Status.not_converged
    return {
        "blocked_force_N": float(forces[last]),
        "blocked_force_pressure_kPa": float(pressure_kPa[last]),
        "blocked_force_variant": "edge",
        "blocked_force_status": status.value,
        # A row that curls into a loop can be held with less again, on another branch.
        "held_turn_deg": float(np.nanmax(blocked.turned_deg)),
    }


def _plain(value: Any) -> Any:
    """A number of Python's own; none for what is not finite."""
    if isinstance(value, (str, bytes)):
        return str(value)
    number = float(value)
    return number if math.isfinite(number) else None
