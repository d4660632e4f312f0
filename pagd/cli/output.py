"""What the command line says while it works and when it is done."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable

from pagd.catalogue import NamedDesign
from pagd.design import GeometryRules
from pagd.errors import Status
from pagd.families import PNEUNET
from pagd.record import Record

__all__ = ["print_design", "print_result", "progress_to", "start_log", "verdict"]

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


def progress_to(maximum_kPa: float) -> Callable[[float, int], None]:
    """Return what tells how far a solve is: in place for a person, line by line for a file."""
    if not sys.stderr.isatty():
        return lambda pressure, count: log.info("%.4g kPa: iterations %d", pressure, count)

    def show(pressure_kPa: float, iterations: int) -> None:
        end = "\n" if pressure_kPa >= maximum_kPa else ""
        print(f"\r{pressure_kPa:8.3f} of {maximum_kPa:g} kPa", end=end, file=sys.stderr, flush=True)

    return show


def verdict(record: Record, keep_going: bool) -> int:
    """Return the exit code for how a design stands, and say on stderr why it is not ok."""
    if record.status is Status.ok:
        return 0
    print(f"pagd: {record.design_id}: {record.status}: {record.reason}", file=sys.stderr)
    return 0 if keep_going else 1


def print_design(named: NamedDesign, rules: GeometryRules) -> None:
    """Print the parameters of a design and, if it can be built, what follows from them."""
    design = named.actuator
    family = "" if design.family == PNEUNET else f", {design.family}"
    print(f"{named.name} ({named.origin}{family})")
    parameters = design.parameters()
    for symbol, value in design.as_dict().items():
        _print_row(symbol, value, parameters[symbol].unit, parameters[symbol].description)
    broken = design.violations(rules)
    if broken:
        print("cannot be built:", *broken, sep="\n  ")
        return
    for row in design.derived():
        _print_row(*row)
    volumes = design.volumes(rules)
    if volumes is not None:
        _print_row("solid", volumes.solid, "mm³", "volume of the elastomer")
        _print_row("cavity", volumes.cavity, "mm³", "volume of the air")


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
