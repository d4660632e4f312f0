"""Tables in Parquet files: declared columns, with unit and description in the metadata."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from pagd.design import PARAMETERS
from pagd.errors import InputError
from pagd.files import must_exist, replaced_file

__all__ = [
    "BLOCKED",
    "DESIGNS",
    "GENERATED",
    "HISTORY",
    "MEASURES",
    "PERFORMANCE",
    "STATES",
    "TRAJECTORY",
    "Column",
    "concatenate",
    "read_rows",
    "read_table",
    "units",
    "write_rows",
    "write_table",
]


class Column(NamedTuple):
    """One column: its name, its Arrow type, its unit ('1' for a pure number, '' for text)."""

    name: str
    type: str
    unit: str
    description: str


def _parameter(symbol: str) -> Column:
    parameter = PARAMETERS[symbol]
    kind = "int64" if parameter.whole else "double"
    return Column(symbol, kind, _UNITS.get(parameter.unit, parameter.unit), parameter.description)


_UNITS = {"degrees": "deg"}

DESIGNS = (
    Column("design_id", "string", "", "name of the design, unique"),
    *(_parameter(symbol) for symbol in PARAMETERS),
    Column("L_T", "double", "mm", "total length"),
    Column("N1", "int64", "1", "number of helical chambers, from the fixed end"),
    Column("N2", "int64", "1", "number of straight chambers, at the tip"),
    Column("mode", "string", "", "mode the design is drawn for: bending, twisting or mixed"),
    Column("cross_section", "string", "", "cross-section of a chamber"),
    Column("origin", "string", "", "where the design comes from"),
)

GENERATED = (
    *DESIGNS,
    Column("novelty", "double", "1", "distance to the nearest training design, encoded"),
    Column("novelty_plane", "double", "1", "the same in the embedding, scaled to the unit square"),
    Column("component", "int32", "1", "Gaussian it is drawn from; null: of no mixture"),
    Column("z1", "double", "1", "first coordinate in the reduced space; null: drawn without one"),
    Column("z2", "double", "1", "second coordinate in the reduced space"),
)

STATES = (
    Column("pressure_kPa", "double", "kPa", "pressure in the cavity"),
    Column("node", "int32", "1", "row of the node in the mesh, from 0"),
    Column("ux", "float", "mm", "displacement along the actuator"),
    Column("uy", "float", "mm", "displacement across"),
    Column("uz", "float", "mm", "displacement upwards"),
    Column("strain", "float", "1", "largest principal logarithmic strain at the node"),
)

HISTORY = (
    Column("pressure_kPa", "double", "kPa", "pressure of a converged step"),
    Column("cavity_volume_mm3", "double", "mm³", "volume of the cavity"),
    Column("stored_energy_mJ", "double", "mJ", "elastic energy of elastomer and paper"),
    Column("work_mJ", "double", "mJ", "work of the pressure so far, ∫p dV"),
    Column("newton_iterations", "int32", "1", "Newton iterations of the step"),
    Column("recorded", "bool", "", "whether the step is a recorded state: k-th true, k-th state"),
    Column("smallest_gap_mm", "double", "mm", "gap between walls, negative: penetration"),
)

BLOCKED = (
    *HISTORY,
    Column("blocked_force_N", "double", "N", "force on the support, positive towards -z"),
)

TRAJECTORY = (
    Column("design_id", "string", "", "name of the design"),
    Column("pressure_kPa", "double", "kPa", "pressure in the cavity"),
    Column("station", "int32", "1", "section of the actuator, counted from the fixed end"),
    Column("x_mm", "double", "mm", "position of the section along the undeformed actuator"),
    Column("y_mm", "double", "mm", "position of the section across"),
    Column("z_mm", "double", "mm", "position of the section upwards"),
    Column("bending_deg", "double", "deg", "rotation of the section about the width axis"),
    Column("twist_deg", "double", "deg", "rotation of the section about the deformed axis"),
)

MEASURES = (
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
    Column("measured_mode", "string", "", "mode measured from bending and twist of the joints"),
    Column("cavity_volume_mm3", "double", "mm³", "volume of the whole cavity"),
    Column("work_mJ", "double", "mJ", "work of the pressure so far, ∫p dV"),
    Column("stored_energy_mJ", "double", "mJ", "elastic energy of elastomer and paper"),
    Column("energy_balance", "double", "1", "|∫p dV − U| / U with the stored energy U"),
    Column("work_density_kJ_m3", "double", "kJ/m³", "work of the pressure by elastomer volume"),
    Column("strain_max", "double", "1", "largest principal logarithmic strain"),
    Column("strain_p99", "double", "1", "99th percentile of the largest principal log strain"),
)

PERFORMANCE = (
    Column("design_id", "string", "", "name of the design, unique"),
    Column("name", "string", "", "name of the design for people"),
    Column("origin", "string", "", "where the design comes from"),
    Column("mode", "string", "", "mode the design was drawn for"),
    Column("measured_mode", "string", "", "mode measured from bending and twist"),
    Column("status", "string", "", "how the design ended"),
    Column("reason", "string", "", "why, where the status is not ok"),
    Column("fidelity", "string", "", "full: finite elements of the whole actuator"),
    Column("pressure_kPa", "double", "kPa", "pressure reached; the figures below are for it"),
    Column("bending_deg", "double", "deg", "rotation of the tip about the width axis, unwrapped"),
    Column("twist_deg", "double", "deg", "rotation of the tip about the deformed axis"),
    Column("tip_x_mm", "double", "mm", "position of the tip along the undeformed actuator"),
    Column("tip_y_mm", "double", "mm", "position of the tip across"),
    Column("tip_z_mm", "double", "mm", "position of the tip upwards"),
    Column("blocked_force_N", "double", "N", "reaction at a held tip; null: not simulated"),
    Column("work_density_kJ_m3", "double", "kJ/m³", "work of the pressure by elastomer volume"),
    Column("strain_p99", "double", "1", "99th percentile of the largest principal log strain"),
    Column("energy_balance", "double", "1", "|∫p dV − U| / U with the stored energy U"),
    Column("novelty", "double", "1", "distance to the nearest known design; null: not computed"),
    Column("tets", "int64", "1", "tetrahedra of the mesh"),
    Column("unknowns", "int64", "1", "unknowns of the finite-element system"),
    Column("newton_iterations", "int64", "1", "Newton iterations of the whole path"),
    Column("cpu_s", "double", "s", "processor time of all stages"),
    Column("wall_s", "double", "s", "wall time of all stages, one after the other"),
    Column("peak_memory_MB", "double", "MB", "largest resident memory of any stage, 10^6 bytes"),
)


def write_table(path: Path, columns: Sequence[Column], data: Mapping[str, Any]) -> None:
    """Write one Parquet file with exactly the ``columns``; it appears complete or not at all.

    Parameters
    ----------
    path
        Target file.
    columns
        Declared columns, in order.
    data
        Column name to values, all of one length; a missing name becomes a column of nulls.

    Raises
    ------
    ValueError
        If ``data`` has a column that is not declared, or lengths differ.
    """
    unknown = sorted(set(data) - {column.name for column in columns})
    if unknown:
        raise ValueError(f"columns {unknown} are not declared for {path.name}")
    length = max((len(values) for values in data.values()), default=0)
    arrays = [
        pa.array(data.get(column.name, [None] * length), type=_arrow_type(column), from_pandas=True)
        for column in columns
    ]
    _write(path, pa.Table.from_arrays(arrays, schema=_arrow_schema(columns)))


def write_rows(path: Path, columns: Sequence[Column], rows: Iterable[Mapping[str, Any]]) -> None:
    """Write a table from its ``rows``; a key that a row lacks becomes null."""
    found = list(rows)
    unknown = {key for row in found for key in row} - {column.name for column in columns}
    if unknown:
        raise ValueError(f"columns {sorted(unknown)} are not declared for {path.name}")
    write_table(path, columns, {c.name: [row.get(c.name) for row in found] for c in columns})


def read_table(path: Path) -> dict[str, NDArray[Any]]:
    """Read a Parquet file into one array a column; nulls of numbers become NaN.

    Raises
    ------
    InputError
        If the file is missing or no Parquet file.
    """
    table = _read(path)
    return {
        name: np.asarray(table.column(name).to_numpy(zero_copy_only=False))
        for name in table.column_names
    }


def read_rows(path: Path) -> list[dict[str, Any]]:
    """Read a Parquet file into a dictionary a row; nulls become None."""
    rows: list[dict[str, Any]] = _read(path).to_pylist()
    return rows


def units(path: Path) -> dict[str, str]:
    """Return the unit of every column, from the file's metadata ('' where there is none)."""
    schema = pq.read_schema(path)
    return {f.name: (f.metadata or {}).get(b"unit", b"").decode() for f in schema}


def concatenate(path: Path, parts: Sequence[Path], columns: Sequence[Column]) -> None:
    """Write the rows of all ``parts``, in order, to one table."""
    schema = _arrow_schema(columns)
    tables = [_read(part).select(schema.names).cast(schema) for part in parts]
    _write(path, pa.concat_tables(tables) if tables else schema.empty_table())


def _read(path: Path) -> Any:
    must_exist(path)
    try:
        return pq.read_table(path)
    except (OSError, pa.ArrowInvalid) as error:
        raise InputError(f"{path}: not a readable Parquet table ({error}).") from error


def _write(path: Path, table: Any) -> None:
    with replaced_file(path) as temporary:
        pq.write_table(table, temporary, compression="zstd")


def _arrow_type(column: Column) -> Any:
    return pa.type_for_alias(column.type)


def _arrow_schema(columns: Sequence[Column]) -> Any:
    return pa.schema(
        pa.field(
            column.name,
            _arrow_type(column),
            metadata={"unit": column.unit, "description": column.description},
        )
        for column in columns
    )
