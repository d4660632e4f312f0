"""What the command line says while it works and when it is done."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pagd.catalogue import NamedDesign
from pagd.cli.answer import Answer, answer_of
from pagd.design import (
    PARAMETERS,
    GeometryRules,
    base_volume,
    body_volume,
    cavity_volume,
    violations,
)
from pagd.errors import Status
from pagd.long_work import is_shown
from pagd.record import Record

__all__ = [
    "design_document",
    "print_design",
    "print_result",
    "start_log",
    "steps_of_solve",
    "verdict",
]

log = logging.getLogger(__name__)


def start_log(verbose: bool) -> None:
    """Send the log to stderr: plain lines for a person, dated ones for a file."""
    people = sys.stderr.isatty()
    logging.basicConfig(
        stream=sys.stderr,
        format="%(message)s" if people else "%(asctime)s %(levelname)s %(message)s",
        force=True,
    )
    logging.getLogger("pagd").setLevel(logging.DEBUG if verbose else logging.INFO)


def steps_of_solve() -> Callable[[float, int], None] | None:
    """Return what logs every step of a solve; nothing where a bar shows them."""
    if is_shown():
        return None
    return lambda pressure, count: log.info("%.4g kPa: iterations %d", pressure, count)


def verdict(record: Record, folder: Path, keep_going: bool) -> Answer:
    """Return the answer for how a design stands, and say on stderr why it is not ok."""
    if record.status is Status.ok:
        return answer_of(record, folder)
    print(f"pagd: {record.design_id}: {record.status}: {record.reason}", file=sys.stderr)
    return answer_of(record, folder, 0 if keep_going else 1)


def design_document(named: NamedDesign, rules: GeometryRules) -> dict[str, Any]:
    """Return a design as plain data: parameters, rules broken and, if none is, what follows."""
    design, broken = named.design, violations(named.design, rules)
    document: dict[str, Any] = {
        "name": named.name,
        "origin": named.origin,
        "parameters": design.as_dict(),
        "can_be_built": not broken,
        "violations": [{**one._asdict(), "message": str(one)} for one in broken],
    }
    if not broken:
        document |= {
            "L_T": design.L_T,
            "N1": design.N1,
            "N2": design.N2,
            "mode": design.mode,
            "solid_volume_mm3": body_volume(design, rules) + base_volume(design),
            "cavity_volume_mm3": cavity_volume(design, rules),
        }
    return document


def print_design(document: Mapping[str, Any]) -> None:
    """Print what :func:`design_document` returns."""
    print(f"{document['name']} ({document['origin']})")
    for symbol, value in document["parameters"].items():
        parameter = PARAMETERS[symbol]
        _print_row(symbol, value, parameter.unit, parameter.description)
    if not document["can_be_built"]:
        messages = [one["message"] for one in document["violations"]]
        print("cannot be built:", *messages, sep="\n  ")
        return
    counts = f"{document['N1']}, {document['N2']}"
    _print_row("L_T", document["L_T"], "mm", "total length")
    _print_row("N1, N2", counts, "1", "helical and straight chambers")
    _print_row("mode", document["mode"], "", "deformation it is drawn for")
    _print_row("solid", document["solid_volume_mm3"], "mm³", "volume of the elastomer")
    _print_row("cavity", document["cavity_volume_mm3"], "mm³", "volume of the air")


def print_result(record: Record) -> None:
    """Print bending and twist at the last pressure; nothing where there is none."""
    figures = record.figures
    if "bending_deg" not in figures:
        return
    print(
        f"{record.design_id}: bends by {figures['bending_deg']:z.1f}° and twists by "
        f"{figures['twist_deg']:z.1f}° at {figures['pressure_kPa']:g} kPa "
        f"({figures['material']}, {figures['tets']} tetrahedra, "
        f"energy balance {100 * figures['energy_balance']:z.2f} %)"
    )


def _print_row(name: str, value: object, unit: str, text: str) -> None:
    shown = f"{value:g}" if isinstance(value, float) else str(value)
    print(f"  {name:<8}{shown:>12} {unit.replace('1', ''):<8} {text}")
