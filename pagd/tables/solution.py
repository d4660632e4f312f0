"""Columns of what the solve leaves: deformed states, and the path that leads through them."""

from __future__ import annotations

from pagd.tables.column import Column

__all__ = ["BLOCKED", "HISTORY", "STATES"]

STATES = (
    Column("pressure_kPa", "double", "kPa", "pressure in the cavity"),
    Column("node", "int32", "1", "row of the node in the mesh, from 0"),
    Column("ux", "float", "mm", "displacement along the actuator"),
    Column("uy", "float", "mm", "displacement across"),
    Column("uz", "float", "mm", "displacement upwards"),
    Column("strain", "float", "1", "largest principal logarithmic strain at the node"),
)

HISTORY = (
    Column("pressure_kPa", "double", "kPa", "pressure of the step"),
    Column("cavity_volume_mm3", "double", "mm³", "volume of the cavity"),
    Column(
        "stored_energy_mJ", "double", "mJ", "energy since zero pressure: elastic, contact, gravity"
    ),
    Column("work_mJ", "double", "mJ", "work of the pressure so far, ∫p dV"),
    Column(
        "newton_iterations",
        "int32",
        "1",
        "Newton iterations of the step; 0: interpolated",
    ),
    Column("recorded", "bool", "", "whether the state is recorded, in their order"),
    Column("smallest_gap_mm", "double", "mm", "gap between chambers, negative: overlap; null: far"),
)

BLOCKED = (
    *HISTORY,
    Column("blocked_force_N", "double", "N", "force on the support, positive towards -z"),
)
