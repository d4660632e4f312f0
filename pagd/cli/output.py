"""What the command line says while it works and when it is done."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pagd.catalogue import NamedDesign
from pagd.cli.answer import Answer, answer_of
from pagd.design import GeometryRules
from pagd.errors import Status
from pagd.families import PNEUNET
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
    design = named.actuator
    broken, volumes = design.violations(rules), None
    document: dict[str, Any] = {
        "name": named.name,
        "origin": named.origin,
        **({} if design.family == PNEUNET else {"family": design.family}),
        "parameters": design.as_dict(),
        "can_be_built": not broken,
        "violations": [{**one._asdict(), "message": str(one)} for one in broken],
    }
    if not broken:
        document |= {row.symbol: row.value for row in design.derived()}
        volumes = design.volumes(rules)
    if volumes is not None:
        document |= {
            "solid_volume_mm3": volumes.solid,
            "cavity_volume_mm3": volumes.cavity,
        }
    return document


def print_design(named: NamedDesign, document: Mapping[str, Any]) -> None:
    """Print what :func:`design_document` returns of a design."""
    told = ", ".join(document[key] for key in ("origin", "family") if key in document)
    print(f"{document['name']} ({told})")
    parameters = named.actuator.parameters()
    for symbol, value in document["parameters"].items():
        _print_row(symbol, value, parameters[symbol].unit, parameters[symbol].description)
    if not document["can_be_built"]:
        messages = [one["message"] for one in document["violations"]]
        print("cannot be built:", *messages, sep="\n  ")
        return
    for row in named.actuator.derived():
        _print_row(*row)
    for name, key, text in (
        ("solid", "solid_volume_mm3", "volume of the elastomer"),
        ("cavity", "cavity_volume_mm3", "volume of the air"),
    ):
        if key in document:
            _print_row(name, document[key], "mm³", text)


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
