"""Solved designs without a solver: blocks bent to arcs, and the files their stages leave."""

import dataclasses

import numpy as np

from pagd.errors import Status
from pagd.figures import load
from pagd.figures.load import Path3D, States
from pagd.mesh.msh import write_msh
from pagd.mesh.primitives import hollow_block
from pagd.record import Record, versions, write_record
from pagd.states import States as SolvedStates
from pagd.states import write_states
from pagd.tables import BLOCKED, HISTORY, TRAJECTORY, write_table

SIZE = (20.0, 5.0, 6.0)
PRESSURE = np.array([10.0, 20.0, 30.0])


def block(half):
    """A hollow block; as a half model, the half of one that is twice as wide."""
    void = ((1, 3), (0, 1) if half else (1, 2), (2, 3))
    return hollow_block(SIZE, (4, 3, 4), void, paper_layer=1, half=half)


def bent(mesh, angle):
    """Displacement of a circular arc towards −z."""
    if angle == 0.0:
        return np.zeros_like(mesh.points)
    x, y, z = mesh.points.T
    turn, radius = angle * x / SIZE[0], SIZE[0] / angle + z
    height = radius * np.cos(turn) - SIZE[0] / angle
    return np.column_stack([radius * np.sin(turn), y, height]) - mesh.points


def states_of(mesh):
    moved = np.stack([bent(mesh, 0.02 * p) for p in (0.0, *PRESSURE)])
    strain = np.linspace(0.0, 0.3, 4)[:, None] * mesh.points[:, 2] / SIZE[2]
    return States(mesh, np.array([0.0, *PRESSURE]), moved, strain)


def solved(
    folder,
    half=False,
    status=Status.ok,
    reason=None,
    contact=True,
    support="edge",
    closing=0.007,
    **figures,
):
    """Leave what the stages mesh, solve and metrics leave for one design.

    The gap between walls, 0.2 mm, closes by so many mm/kPa.
    """
    mesh = block(half)
    for stage in ("mesh", "solve", "metrics"):
        (folder / stage).mkdir(parents=True)
    write_msh(mesh, folder / "mesh" / "mesh.msh")
    recorded = states_of(load.load_mesh(folder))
    kept = SolvedStates(
        pressure_kPa=recorded.pressure_kPa[1:],
        displacement=recorded.displacement[1:],
        strain=recorded.strain[1:],
    )
    write_states(kept, folder / "solve" / "states.parquet")
    write_table(folder / "solve" / "history.parquet", HISTORY, steps(contact, STEPS, closing))
    if support != "none":
        held(folder, kept, contact)
    write_record(solve_record(folder.name, contact, support), folder / "solve")
    write_table(folder / "metrics" / "trajectory.parquet", TRAJECTORY, trajectory(folder.name))
    known = {"bending_deg": 34.4, "tip_z_mm": -5.25, "tets": len(mesh.tets), "mode": "bending"}
    written = record(folder.name, "metrics", status, reason, {**known, **figures})
    write_record(written, folder / "metrics")
    return folder


# Steps: the unloaded state, one between, and the recorded ones.
STEPS = np.array([0.0, 5.0, *PRESSURE])
# Of the state that is not recorded no force is known.
FORCE = np.where(STEPS == 5.0, np.nan, 0.02 * STEPS + 1e-4 * STEPS**2)


def steps(contact=True, pressure=STEPS, closing=0.007):
    """Columns of a history whose gap closes, unless more slowly, between 20 and 30 kPa."""
    volume = 1000.0 + 20.0 * STEPS
    gap = np.where(STEPS < 5.0, np.nan, 0.2 - closing * STEPS)
    work = np.concatenate([[0.0], np.cumsum((pressure[1:] + pressure[:-1]) / 2 * np.diff(volume))])
    return {
        "pressure_kPa": pressure,
        "cavity_volume_mm3": volume,
        "stored_energy_mJ": 1e-3 * work,
        "work_mJ": 1e-3 * work,
        "newton_iterations": np.full(len(STEPS), 3, dtype=np.int32),
        "recorded": STEPS != 5.0,
        "smallest_gap_mm": gap if contact else np.full(len(STEPS), np.nan),
    }


def held(folder, free, contact):
    """Leave what the analysis with a held tip leaves: it bends less than half as far."""
    kept = SolvedStates(
        pressure_kPa=free.pressure_kPa, displacement=0.4 * free.displacement, strain=free.strain
    )
    write_states(kept, folder / "solve" / "blocked_states.parquet")
    table = {**steps(contact), "blocked_force_N": FORCE}
    write_table(folder / "solve" / "blocked_force.parquet", BLOCKED, table)


def solve_record(name, contact=True, support="edge", **figures):
    """Record of the stage solve; walls press each other by up to a twentieth of the gap."""
    touching = {"deepest_penetration_mm": 0.01, "penetration_share": 0.05} if contact else {}
    ending = {
        "variant": support,
        "status": "ok",
        "reason": None,
        "pressure_kPa": 30.0,
        "blocked_force_N": 0.69,
    }
    blocked = {} if support == "none" else {"blocked_force": ending}
    made = record(name, "solve", figures={**touching, **blocked, "limit_points": 0, **figures})
    settings = {"solve": {"contact": contact, "blocked_force": support}}
    return dataclasses.replace(made, configuration=settings)


def path_only(folder, **figures):
    """Leave a trajectory and a record, as much as the pictures of paths need."""
    (folder / "metrics").mkdir(parents=True)
    write_table(folder / "metrics" / "trajectory.parquet", TRAJECTORY, trajectory(folder.name))
    write_record(record(folder.name, "metrics", figures=figures), folder / "metrics")
    return folder


def trajectory(name):
    """Table of four pressures and three stations, in an order of its own."""
    p, s = (a.ravel() for a in np.meshgrid([0.0, *PRESSURE], [2, 0, 1]))
    columns = {"x_mm": 10.0 * s, "y_mm": 0.1 * p, "z_mm": -p * s}
    angles = {"bending_deg": p * s, "twist_deg": 0.5 * p * s}
    names = {"design_id": [name] * len(p), "pressure_kPa": p, "station": s.astype(np.int32)}
    return {**names, **columns, **angles}


def record(name, stage, status=Status.ok, reason=None, figures=None):
    return Record(
        stage=stage,
        design_id=name,
        status=status,
        reason=reason,
        figures=figures or {},
        configuration={},
        versions=versions(1),
        timings_s={"wall": 1.0, "cpu": 1.0},
        peak_memory_MB=1.0,
    )


def three_designs(root):
    """Two solved designs, one of them a half model, and one that failed."""
    failed = root / "failed"
    (failed / "geometry").mkdir(parents=True)
    reason = "t_ab = 9 is <too thick> & leaves no cavity."
    write_record(record("failed", "geometry", Status.invalid_geometry, reason), failed / "geometry")
    return [solved(root / "whole", blocked_force_N=0.69), solved(root / "half", half=True), failed]


def path_of(stations, twist=0.0, bending=5.0):
    """A trajectory at three pressures that leaves the x axis downwards only."""
    p, s = np.meshgrid([0.0, 5.0, 10.0], np.arange(stations), indexing="ij")
    positions = np.stack([10.0 * s, 0.0 * s, -0.02 * p * s], axis=-1)
    return Path3D(p[:, 0], positions, bending * s * p / 10.0, twist * s * p / 10.0)
