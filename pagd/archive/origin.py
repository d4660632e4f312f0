"""What made the analyses of a data set: configuration, material, mesh, versions."""

from __future__ import annotations

from pathlib import Path

from pagd.errors import InputError
from pagd.record import RECORD_NAME, Record, configuration_hash, read_record

__all__ = ["made_of"]


def made_of(results: Path) -> dict[str, str]:
    """Return what made the analyses of a run, by name, as text for people.

    Parameters
    ----------
    results
        Folder of a run with screened designs, all made with one configuration.

    Raises
    ------
    InputError
        If no designs have been screened.
    """
    record = _screening(results)
    made = record.configuration
    solve = made["solve"]
    names = (name for name in record.versions if name not in ("pagd", "stage"))
    return {
        "pagd": str(record.versions["pagd"]),
        "SHA-256 of the configuration": configuration_hash(made),
        "elastomer": made["material"]["name"],
        "sheet in the base": made["paper"]["name"],
        "mesh": f"hexahedra of at most {made['mesh']['block_mm']:g} mm",
        "element": str(solve["element"]),
        "pressures": f"to {solve['maximum_pressure_kPa']:g} kPa, recorded every "
        f"{solve['recorded_step_kPa']:g} kPa",
        "bending limit": f"{solve['bending_limit_deg']:g}°",
        "versions": ", ".join(f"{name} {record.versions[name]}" for name in names),
    }


def _screening(results: Path) -> Record:
    for which in ("training", "generated"):
        folder = results / "screening" / which
        if (folder / RECORD_NAME).is_file():
            return read_record(folder)
    raise InputError(f"{results / 'screening'}: no designs have been screened; make run does it.")
