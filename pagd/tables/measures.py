"""Columns of what is measured: sections, chambers, every recorded pressure, every design."""

from __future__ import annotations

from pagd.tables.column import Column

__all__ = ["CHAMBERS", "MEASURES", "PERFORMANCE", "TRAJECTORY"]

TRAJECTORY = (
    Column("design_id", "string", "", "name of the design"),
    Column("pressure_kPa", "double", "kPa", "pressure in the cavity"),
    Column("station", "int32", "1", "section of the actuator, counted from the fixed end"),
    Column("x_mm", "double", "mm", "position of the section along the undeformed actuator"),
    Column("y_mm", "double", "mm", "position of the section across"),
    Column("z_mm", "double", "mm", "position of the section upwards"),
    Column("bending_deg", "double", "deg", "rotation of the section about the width axis"),
    Column("twist_deg", "double", "deg", "rotation of the section about the deformed axis"),
    Column("fidelity", "string", "", "full, pieces or cells: how much of the actuator was solved"),
)

CHAMBERS = (
    Column("design_id", "string", "", "name of the design"),
    Column("pressure_kPa", "double", "kPa", "pressure in the cavity"),
    Column("chamber", "int32", "1", "number of the chamber, 1 at the fixed end"),
    Column("kind", "string", "", "helical or straight; null: a mesh without a design, cut evenly"),
    Column("bending_deg", "double", "deg", "bending of that chamber alone; the sum is the tip's"),
    Column("twist_deg", "double", "deg", "twist of that chamber alone; the sum is the tip's"),
    Column("fidelity", "string", "", "full, pieces or cells: how much of the actuator was solved"),
)

MEASURES = (
    Column("design_id", "string", "", "name of the design"),
    Column("pressure_kPa", "double", "kPa", "recorded pressure"),
    Column("bending_deg", "double", "deg", "bending of the tip, summed over the joints"),
    Column("twist_deg", "double", "deg", "twist of the tip, summed over the joints"),
    Column("sideways_deg", "double", "deg", "bending within the paper, summed over the joints"),
    Column("swing_deg", "double", "deg", "angle between the tip and the undeformed axis"),
    Column("swing_twist_deg", "double", "deg", "twist part of the tip's whole rotation"),
    Column("chord_deg", "double", "deg", "angle of the line from the fixed end to the tip"),
    Column("out_of_plane_mm", "double", "mm", "deflection of the tip across"),
    Column("tip_x_mm", "double", "mm", "position of the tip along the undeformed actuator"),
    Column("tip_y_mm", "double", "mm", "position of the tip across"),
    Column("tip_z_mm", "double", "mm", "position of the tip upwards"),
    Column("measured_mode", "string", "", "bending, twisting, mixed or none, as measured"),
    Column("cavity_volume_mm3", "double", "mm³", "volume of the whole cavity"),
    Column("work_mJ", "double", "mJ", "work of the pressure so far, ∫p dV"),
    Column(
        "stored_energy_mJ", "double", "mJ", "energy since zero pressure: elastic, contact, gravity"
    ),
    Column("energy_balance", "double", "1", "|∫p dV − U| / U with the stored energy U"),
    Column("work_density_kJ_m3", "double", "kJ/m³", "work of the pressure by elastomer volume"),
    Column("strain_max", "double", "1", "largest principal logarithmic strain"),
    Column("strain_p99", "double", "1", "99th percentile of the largest principal log strain"),
    Column("strain_rate_per_kPa", "double", "1/kPa", "dε/dp of strain_p99; null: p does not rise"),
    Column("strain_rate_per_s", "double", "1/s", "the same by time; null: no ramp configured"),
    Column("blocked_force_N", "double", "N", "force of the held tip on its support; null: none"),
    Column("smallest_gap_mm", "double", "mm", "gap between chambers; negative: penetration"),
    Column("fidelity", "string", "", "full, pieces or cells: how much of the actuator was solved"),
)

PERFORMANCE = (
    Column("design_id", "string", "", "name of the design, unique"),
    Column("name", "string", "", "name of the design for people"),
    Column("origin", "string", "", "where the design comes from"),
    Column("mode", "string", "", "mode the design was drawn for"),
    Column("measured_mode", "string", "", "bending, twisting, mixed or none, as measured"),
    Column("status", "string", "", "how the design ended"),
    Column("reason", "string", "", "why, where the status is not ok"),
    Column("fidelity", "string", "", "full, pieces or cells: how much of the actuator was solved"),
    Column(
        "doubt",
        "string",
        "",
        "why it is not trusted, or of a gated one what was simpler; null: it is",
    ),
    Column("pressure_kPa", "double", "kPa", "pressure reached; the figures below are for it"),
    Column(
        "largest_pressure_kPa", "double", "kPa", "largest along the path; it may have fallen since"
    ),
    Column("bending_deg", "double", "deg", "rotation of the tip about the width axis, unwrapped"),
    Column("twist_deg", "double", "deg", "rotation of the tip about the deformed axis"),
    Column("tip_x_mm", "double", "mm", "position of the tip along the undeformed actuator"),
    Column("tip_y_mm", "double", "mm", "position of the tip across"),
    Column("tip_z_mm", "double", "mm", "position of the tip upwards"),
    Column("blocked_force_N", "double", "N", "force of the held tip on its support; null: none"),
    Column("blocked_force_pressure_kPa", "double", "kPa", "pressure of that force, its last one"),
    Column("blocked_force_variant", "string", "", "edge: the tip is held; plate: it meets a plate"),
    Column("blocked_force_status", "string", "", "how the analysis of the blocked force ended"),
    Column("held_turn_deg", "double", "deg", "most that a held tip turns a chamber; not in full"),
    Column(
        "first_contact_pressure_kPa",
        "double",
        "kPa",
        "gap passes the contact law's width; null: never",
    ),
    Column("deepest_penetration_mm", "double", "mm", "of a chamber into another, on the path"),
    Column("penetration_share", "double", "1", "deepest_penetration_mm by the gap at no pressure"),
    Column("blocked_penetration_share", "double", "1", "the same of the analysis with a held tip"),
    Column("work_mJ", "double", "mJ", "work of the pressure, ∫p dV"),
    Column("work_density_kJ_m3", "double", "kJ/m³", "work of the pressure by elastomer volume"),
    Column("strain_p99", "double", "1", "99th percentile of the largest principal log strain"),
    Column("strain_rate_per_kPa", "double", "1/kPa", "dε/dp of strain_p99; null: p does not rise"),
    Column("strain_rate_per_s", "double", "1/s", "the same by time; null: no ramp configured"),
    Column("limit_points", "int64", "1", "maxima of the pressure along the path"),
    Column("energy_balance", "double", "1", "|∫p dV − U| / U with the stored energy U"),
    Column("novelty", "double", "1", "distance to the nearest known design; null: not computed"),
    Column("tets", "int64", "1", "tetrahedra of the mesh"),
    Column("unknowns", "int64", "1", "unknowns of the finite-element system"),
    Column("newton_iterations", "int64", "1", "Newton iterations of the free actuation"),
    Column(
        "blocked_force_iterations", "int64", "1", "Newton iterations, tip held; null: not computed"
    ),
    Column("cpu_s", "double", "s", "processor time of all stages, with both analyses"),
    Column("wall_s", "double", "s", "wall time of all stages, with both analyses"),
    Column("peak_memory_MB", "double", "MB", "largest resident memory of any stage, 10^6 bytes"),
)
