"""Which result of a simpler analysis is to be trusted, and what is run where none is.

Cells alone leave out that the ends of a row are unlike its middle, and what is known of a chamber's
answer to a moment is known near its free shape. Neither cells nor pieces know their error. What is
doubted is what had the largest errors among designs that were solved in full; the limits are those
that part them best, and ``benchmarks/reduced.py`` prints how well they do.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from pagd.catalogue import NamedDesign
from pagd.design import Design
from pagd.errors import StageFailure, Status
from pagd.record import Record
from pagd.stages import geometry, mesh, metrics, repair, solve
from pagd.stages.reduced import Reduced, analyse
from pagd.stages.solve import Materials
from pagd.summary import GATHERED, performance_row
from pagd.tables import read_table

log = logging.getLogger(__name__)

#: Faults of an analysis that are one design's, not the end of all.
FAULTS: Final = (
    ArithmeticError,
    AssertionError,
    LookupError,
    MemoryError,
    OSError,
    RuntimeError,
    StageFailure,
    TypeError,
    ValueError,
)

__all__ = ["FAULTS", "doubt_of", "full_analysis", "gated"]

# With fewer chambers the ends are too much of a row for cells alone; of slanted ones more so.
_FEW: Final = 6
_FEW_SLANTED: Final = 7
# Degrees: a held tip that turns a chamber by more than this is too far from its free shape.
_FAR: Final = 15.0
_REACHED: Final = (Status.ok.value, Status.bending_limit.value, Status.no_actuation.value)
# What no other analysis would change.
_FINAL: Final = (Status.invalid_geometry.value,)


def doubt_of(row: Mapping[str, Any], design: Design, held: str = "edge") -> str | None:
    """Why the reduced result of a design is not to be trusted; none where it is.

    Parameters
    ----------
    row
        Its row of the table of performance, of cells alone or with pieces.
    design
        The design.
    held
        What holds the tip, ``solve.blocked_force`` of the configuration.
    """
    status = row["status"]
    if status in _FINAL:
        return None
    if held == "plate":
        return "Parts of a row meet no plate: they have no such blocked force."
    if status not in _REACHED:
        return f"The reduced analysis ends as {status}."
    fewest = _FEW if design.is_straight else _FEW_SLANTED
    if row["fidelity"] == "cells" and fewest > design.N:
        return f"Of {design.N} chambers the ends are too much for cells alone."
    if row.get("blocked_force_status") not in (None, Status.ok.value):
        return "No blocked force was found at the last pressure."
    turned = row.get("held_turn_deg")
    if turned is not None and turned > _FAR:
        return f"The held tip turns a chamber by {turned:.0f}°, far from its free shape."
    return None


def gated(named: NamedDesign, config: Mapping[str, Any], materials: Materials) -> Reduced:
    """The simplest analysis of a design that is trusted: cells, with pieces, or in full.

    Parameters
    ----------
    named, config, materials
        As of :func:`pagd.stages.reduced.analyse`.

    Returns
    -------
    Reduced
        ``doubt`` in its row tells why the simpler one before was not trusted; the times are of all
        that were run. Where a better analysis has a fault, it is the one before, with its doubt.

    Raises
    ------
    InputError
        Where the configuration, or what is installed, does not allow an analysis.
    """
    held = config["solve"]["blocked_force"]
    found = analyse(named, config, materials, pieces=False)
    for better in (partial(analyse, pieces=True), full_analysis):
        doubt = doubt_of(found.row, named.pneunet, held)
        if doubt is None:
            break
        before = found
        try:
            found = better(named, config, materials)
        except FAULTS as fault:
            log.warning("%s: a fault of the better analysis (%r)", named.name, fault)
            found.row["doubt"] = doubt
            break
        times = {k: round(before.row[k] + found.row[k], 4) for k in ("cpu_s", "wall_s")}
        found.row.update(doubt=doubt, **times)
    return found


def full_analysis(named: NamedDesign, config: Mapping[str, Any], materials: Materials) -> Reduced:
    """All stages of a design in folders that are thrown away: its row, and its tables.

    Parameters
    ----------
    named
        The design.
    config
        Completed configuration.
    materials
        Elastomer and paper.

    Raises
    ------
    InputError
        Where something that a stage needs is not installed.
    """
    with TemporaryDirectory(prefix="pagd-") as folder:
        out = Path(folder)
        record = _stages(named, out, config, materials)
        files = [out / "metrics" / name for _, name, _ in GATHERED]
        tables = [dict(read_table(file)) if file.is_file() else {} for file in files]
        return Reduced(performance_row(record), *tables)


def _stages(
    named: NamedDesign, out: Path, config: Mapping[str, Any], materials: Materials
) -> Record:
    geometry.run(named, out / "geometry", config)
    repair.run(out / "geometry", out / "repair", config)
    mesh.run(out / "geometry", out / "repair", out / "mesh", config)
    solve.run(out / "mesh", out / "solve", config, materials)
    folders = metrics.Folders(
        **{stage: out / stage for stage in ("geometry", "repair", "mesh", "solve")}
    )
    return metrics.run(folders, out / "metrics", config)
