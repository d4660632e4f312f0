"""The sections about CalculiX as Markdown."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from performance.origin import LIBRARIES, origin_lines
from performance.page import table, wrapped

from peers.bodies import Body
from peers.comparison import Comparison, Ratio
from peers.converged import FEWEST_MESHES, Converged
from peers.solved import Solved
from peers.studies import EqualErrorRow, SameMeshRow

__all__ = ["converged_text", "equal_error_text", "same_mesh_text"]

_NO_HYBRID = (
    "CalculiX has no element for nearly incompressible solids (no C3D10H): its C3D10 has "
    "displacements alone, and is too stiff here. Both have the same tetrahedra, or the same nodes "
    "where pagd has hexahedra, which are split for CalculiX, the same Yeoh material, paper (S6 in "
    "CalculiX), clamp and follower pressure; no contact. pagd gives a state at every 5 kPa; "
    "CalculiX goes to the last pressure in one step, with a first increment of 1.25 kPa, since it "
    "makes its shells anew in every step and does not get far by steps of 5 kPa. Times are of "
    "whole processes: `pagd solve` and `ccx`, kernels compiled before. CalculiX runs by its own "
    "criteria of convergence and step control, with SPOOLES, as Debian builds it. An error is the "
    "distance of the tip from its mesh-converged place, by the displacement of the latter, at the "
    "last pressure that both reached."
)

_HEADINGS = (
    "example",
    "program",
    "kPa",
    "unknowns",
    "wall, s",
    "core-s",
    "iterations",
    "s each",
    "tip x, y, z, mm",
    "error",
    "times slower",
)


# A trend that leads further than so many times what was measured is no figure.
_FARTHEST: Final = 20.0


def same_mesh_text(
    command: str, rows: Sequence[SameMeshRow], threads: int, exact: Mapping[str, Converged]
) -> str:
    """Return the section of both programs on the same meshes."""
    lines = [line for row in rows for line in _same_mesh_lines(row)]
    notes = [note for row in rows for note in _notes(row)]
    notes += _converged_notes(dict.fromkeys(row.body.design for row in rows), exact)
    runs = [run for row in rows for run in (row.ours, row.theirs)]
    return _section(command, runs, threads, table(_HEADINGS, lines), notes)


def _converged_notes(designs: Iterable[str], exact: Mapping[str, Converged]) -> Iterable[str]:
    for design in designs:
        if design not in exact:
            yield (
                f"- Errors of {design} are not known: `python benchmarks/peers.py converged` "
                "computes the mesh-converged tip."
            )
            continue
        tip = exact[design]
        length = math.hypot(*tip.tip_mm[-1])
        sizes = ", ".join(f"{mesh['size_mm']:g}" for mesh in tip.meshes)
        left_out = "one of them left out, or " if len(tip.meshes) > FEWEST_MESHES else ""
        yield (
            f"- {design}: the mesh-converged tip moves by {_place(tip.tip_mm[-1])} mm at "
            f"{tip.pressure_kPa[-1]:g} kPa, extrapolated over meshes of {sizes} mm; with "
            f"{left_out}another order of the error, it would be off by "
            f"{_percent(tip.spread_mm[-1] / length)} at most."
        )


def _same_mesh_lines(row: SameMeshRow) -> Iterable[list[str]]:
    comparison = row.comparison
    ours, theirs = comparison.errors
    yield [*_cells(row.body, row.ours, comparison.pressure_kPa), _percent(ours), "1"]
    cells = _cells(row.body, row.theirs, comparison.pressure_kPa)
    yield [*cells, _percent(theirs), _ratio(comparison)]


def _ratio(comparison: Comparison) -> str:
    return str(comparison.ratio or comparison.ratio_there or "–")


def _cells(body: Body, run: Solved, pressure: float) -> list[str]:
    tip = run.tip(pressure)
    return [
        _named(body),
        run.program,
        f"{run.pressure_kPa:.4g}",
        f"{run.unknowns:,}",
        f"{run.wall_s:.1f}",
        f"{run.cpu_s:.1f}",
        str(run.iterations),
        f"{run.seconds_an_iteration():.2f}",
        "–" if tip is None else ", ".join(f"{x:z.2f}" for x in tip),
    ]


def _named(body: Body) -> str:
    mesher = "" if body.mesher == "gmsh" else f" {body.mesher}"
    return f"{body.design}, {body.size_mm:g} mm{mesher}{', half model' if body.half else ''}"


def _notes(row: SameMeshRow) -> Iterable[str]:
    for run in (row.ours, row.theirs):
        if not run.is_complete:
            text = f"- {_named(row.body)}, {run.program}: `{run.status}` at "
            text += f"{run.pressure_kPa:.4g} kPa. {run.reason or ''}"
            if row.comparison.ratio_there:
                text += f" To {row.comparison.pressure_kPa:g} kPa, which both reached, CalculiX "
                text += f"takes {row.comparison.ratio_there} times as long as pagd."
            yield text


def equal_error_text(
    command: str, rows: Sequence[EqualErrorRow], threads: int, exact: Mapping[str, Converged]
) -> str:
    """Return the section of equal error: pagd on its mesh, CalculiX on finer and finer ones."""
    headings = ("example", "program", "tetrahedra", "kPa", "wall, s", "error", "times slower")
    lines, notes = [], []
    for row in rows:
        lines.append([*_short(row.body, row.ours), _percent(row.error), "1"])
        for body, run, error in row.finer:
            lines.append([*_short(body, run), _percent(error), _slower(row, run)])
        notes += [_finding(row)]
    notes += _converged_notes(dict.fromkeys(row.body.design for row in rows), exact)
    runs = [run for row in rows for run in (row.ours, *(run for _, run, _ in row.finer))]
    return _section(command, runs, threads, table(headings, lines), notes)


def _short(body: Body, run: Solved) -> list[str]:
    reached = f"{run.pressure_kPa:.4g}"
    return [_named(body), run.program, f"{run.tets:,}", reached, f"{run.wall_s:.1f}"]


def _slower(row: EqualErrorRow, run: Solved) -> str:
    ratio = run.seconds_to(row.pressure_kPa) / row.ours.seconds_to(row.pressure_kPa)
    if run.tip(row.pressure_kPa) is not None:
        return str(Ratio(ratio))
    return str(Ratio(ratio, at_least=True)) if run.status == "time_limit" else "–"


def _finding(row: EqualErrorRow) -> str:
    """What the meshes of one example show."""
    text = f"- {_named(row.body)}: at an error of {_percent(row.error)} at "
    text += f"{row.pressure_kPa:g} kPa, "
    if row.result.ratio is None:
        return f"{text}nothing can be said: CalculiX did not come so far."
    text += f"CalculiX takes **{row.result.ratio} times** as long"
    if not row.result.ratio.at_least:
        return f"{text}."
    text += "; no mesh that it came through was as good"
    estimate, ratio = row.result.estimate, row.result.ratio.value
    if estimate is not None and estimate <= _FARTHEST * ratio:
        text += f" (by the trend of its last two: {estimate:,.0f} times)"
    return f"{text}."


def converged_text(tips: Mapping[str, Converged], order: float) -> str:
    """Return the table of meshes and their extrapolation, at the last pressure."""
    headings = ("design", "mesh, mm", "tetrahedra", "wall, s", "tip x, y, z, mm", "error")
    lines = []
    for tip in tips.values():
        last = tip.pressure_kPa[-1]
        for mesh in tip.meshes:
            error = tip.error_of(mesh["tip_mm"], last)
            size, tets = f"{mesh['size_mm']:g}", f"{mesh['tets']:,}"
            seconds = f"{mesh['wall_s']:.1f}"
            place = _place(mesh["tip_mm"])
            lines.append([tip.design, size, tets, seconds, place, _percent(error)])
        spread = f"± {tip.spread_mm[-1]:.2f} mm"
        lines.append([tip.design, "0", "", "", _place(tip.tip_mm[-1]), spread])
    text = (
        f"Tip at the last pressure, extrapolated with the order {order:.3g}; ± is how far off it "
        "would be, at most, with one of three meshes or more left out, or with another order."
    )
    return f"{wrapped(text)}\n\n{table(headings, lines)}"


def told_threads(count: int) -> str:
    """Return a number of threads in words."""
    return "one thread" if count == 1 else f"{count} threads"


def _place(tip: Sequence[float]) -> str:
    return ", ".join(f"{x:z.3f}" for x in tip)


def _percent(share: float | None) -> str:
    return "–" if share is None else f"{100 * share:.1f} %"


def _section(
    command: str, runs: Sequence[Solved], threads: int, rows: str, notes: Sequence[str]
) -> str:
    programs = sorted({run.program for run in runs if not run.program.startswith("pagd")})
    origin = origin_lines(command, LIBRARIES, [run.commit for run in runs])
    told = f"{', '.join(programs)}, {told_threads(threads)} each. {_NO_HYBRID}"
    parts = [origin, wrapped(told), rows]
    if notes:
        parts.append("\n".join(wrapped(note, "  ") for note in notes))
    return "\n\n".join(parts)
