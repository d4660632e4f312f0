"""The arguments of every subcommand. Light on purpose: ``pagd --help`` imports nothing heavy."""

from __future__ import annotations

import argparse
import functools
from pathlib import Path
from typing import Any

import shtab

from pagd import __version__
from pagd.cli.arguments import (
    add_command,
    add_config,
    add_folder,
    add_materials,
    add_out,
    add_stage_options,
    add_verbose,
    override,
)
from pagd.cli.generative_parser import add_generative
from pagd.errors import Status

__all__ = ["make_parser"]

_EPILOG = """\
examples:
  pagd run my_design.yaml --out my_design          all stages for a design of your own
  pagd design check my_design.yaml                 is it buildable?
  pagd generate --mode mixed -n 100 --out mixed    new designs that bend and twist
  pagd mesh --body body.stl --base base.stl --size-mm 3 --out mesh
  pagd solve --mesh mesh --material dragon_skin_30 --pressure-kPa 30 --vtu --out solve
  pagd view my_design                              shape, curves and figures in the browser
  pagd status                                      how far a run of the workflow is

exit codes: 0 done, 1 the design failed (its record says why), 2 bad input, 70 a fault of pagd,
75 the machine failed (disk, memory, time): the same may succeed later
"""


@functools.cache
def make_parser() -> argparse.ArgumentParser:
    """Return the parser; each subcommand carries its ``handler(options) -> exit code``."""
    parser = argparse.ArgumentParser(
        prog="pagd",
        description="Design and simulate soft pneumatic actuators, from parameters to "
        "trajectories. Units are mm, N, MPa; kPa and degrees where the name says so.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"pagd {__version__}")
    shtab.add_argument_to(
        parser, "--print-completion", help="print what makes a shell complete words, and end"
    )
    commands = parser.add_subparsers(metavar="command", required=True)
    _add_run(commands)
    _add_design(commands)
    _add_geometry(commands)
    _add_repair(commands)
    _add_mesh(commands)
    _add_solve(commands)
    _add_deck(commands)
    _add_metrics(commands)
    _add_figures(commands)
    _add_export(commands)
    _add_gathering(commands)
    _add_keeping(commands)
    _add_archiving(commands)
    add_generative(commands)
    return parser


def _add_run(commands: Any) -> None:
    run = add_command(commands, "run", "run_all", "all stages for one design, in one folder")
    run.add_argument("design", help="design: a YAML or JSON file, or JSON text")
    add_stage_options(run)
    _add_mesh_options(run)
    _add_solve_options(run)


def _add_design(commands: Any) -> None:
    design = commands.add_parser("design", help="look at a design before anything is run")
    actions = design.add_subparsers(metavar="action", required=True)
    for action, handler, text in (
        ("check", "check_design", "tell every rule that the design breaks"),
        ("show", "show_design", "print the parameters and what follows from them"),
    ):
        sub = add_command(actions, action, handler, text)
        sub.add_argument("design", help="design: a YAML or JSON file, or JSON text")
        add_config(sub)
        add_verbose(sub)


def _add_geometry(commands: Any) -> None:
    geometry = add_command(commands, "geometry", "geometry", "parameters → surfaces, by OpenSCAD")
    geometry.add_argument(
        "--design", required=True, help="design: a YAML or JSON file, or JSON text"
    )
    add_stage_options(geometry)


def _add_repair(commands: Any) -> None:
    repair = add_command(commands, "repair", "repair", "surfaces → sound surfaces, by pymeshlab")
    add_folder(repair, "geometry", required=True)
    add_stage_options(repair)


def _add_mesh(commands: Any) -> None:
    mesh = add_command(
        commands, "mesh", "mesh", "surfaces → quadratic tetrahedra with named surfaces"
    )
    add_folder(mesh, "geometry", required=False)
    add_folder(mesh, "repair", required=False)
    own = mesh.add_argument_group("surfaces of your own, instead of a design")
    own.add_argument("--body", type=Path, metavar="STL", help="solid above the paper, hollow")
    own.add_argument("--base", type=Path, metavar="STL", help="solid below the paper")
    own.add_argument(
        "--half", action="store_true", help="they are the half y ≥ 0 of a symmetric actuator"
    )
    own.add_argument("--name", help="name in the record (default: that of the body's file)")
    _add_mesh_options(mesh)
    add_stage_options(mesh)


def _add_mesh_options(command: argparse.ArgumentParser) -> None:
    group = command.add_argument_group("mesh (instead of the configuration's values)")
    override(group, "mesh", "block_mm", float, "longest edge of the hexahedra, for structured")
    override(group, "mesh", "size_mm", float, "edge length of the tetrahedra, for the others")
    group.add_argument(
        "--meshers",
        dest="mesh.meshers",
        nargs="+",
        metavar="NAME",
        help="structured, gmsh, ftetwild or module:class, in the order they are tried",
    )
    override(group, "mesh", "time_limit_s", float, "a mesher is ended after this time")


def _add_solve(commands: Any) -> None:
    solve = add_command(
        commands, "solve", "solve", "free actuation and blocked force: pressure from 0 up"
    )
    solve.add_argument(
        "--mesh",
        type=Path,
        required=True,
        help="folder of the stage mesh, or a .msh file with surfaces fixed, cavity, paper, …",
    )
    solve.add_argument("--name", help="name in the record (default: that of the mesh)")
    _add_solve_options(solve)
    add_stage_options(solve)


def _add_solve_options(command: argparse.ArgumentParser) -> None:
    group = add_materials(command)
    override(group, "solve", "element", str, "taylor_hood or element_pressure")
    override(group, "solve", "blocked_force", str, "what holds the tip: edge, plate or none")
    group.add_argument(
        "--threads", type=int, default=1, metavar="N", help="threads of the solver (default: 1)"
    )
    group.add_argument("--vtu", action="store_true", help="also write the states for ParaView")


def _add_deck(commands: Any) -> None:
    deck = add_command(commands, "deck", "deck", "input deck of an actuator for CalculiX or Abaqus")
    deck.add_argument(
        "--mesh",
        type=Path,
        required=True,
        help="folder of the stage mesh, or a .msh file with surfaces fixed, cavity, paper, …",
    )
    deck.add_argument("--out", type=Path, required=True, metavar="FILE", help="deck to write")
    add_materials(deck)
    form = deck.add_argument_group("form of the deck")
    for option, default, text in (
        ("solid-element", "C3D10", "tetrahedron: C3D10, or C3D10H and C3D10HS for Abaqus"),
        ("sheet-element", "S6", "paper: S6, or STRI65 for Abaqus; M3D6 is a membrane in both"),
        ("stress-unit", "MPa", "MPa, kPa or Pa; lengths are in mm"),
    ):
        form.add_argument(
            f"--{option}", default=default, metavar="NAME", help=f"{text} (default: {default})"
        )
    form.add_argument(
        "--one-step",
        action="store_true",
        help="one step to the last pressure: CalculiX goes farther so, where there is paper",
    )
    add_config(deck)
    add_verbose(deck)


def _add_metrics(commands: Any) -> None:
    metrics = add_command(
        commands, "metrics", "metrics", "states → trajectory, bending, twist, work"
    )
    for stage in ("geometry", "repair"):
        add_folder(metrics, stage, required=False)
    for stage in ("mesh", "solve"):
        add_folder(metrics, stage, required=True)
    metrics.add_argument(
        "--sections",
        type=int,
        default=11,
        metavar="N",
        help="evenly spaced sections to follow where there is no design (default: %(default)s)",
    )
    add_stage_options(metrics)


def _add_figures(commands: Any) -> None:
    figures = add_command(commands, "figures", "figures", "pictures of geometry, mesh and shapes")
    figures.add_argument(
        "design_folder", type=Path, metavar="FOLDER", help="folder with a design's stage folders"
    )
    add_stage_options(figures)


def _add_export(commands: Any) -> None:
    export = add_command(
        commands, "export", "export", "a design for other programs: STL, STEP, moulds, VTU, CSV"
    )
    export.add_argument(
        "design_folder", type=Path, metavar="FOLDER", help="folder with a design's stage folders"
    )
    add_stage_options(export)


def _add_gathering(commands: Any) -> None:
    summary = add_command(commands, "summary", "summary", "tables of designs: one row a design")
    report = add_command(commands, "report", "report", "page of designs, for any browser")
    view = add_command(commands, "view", "view", "the same page, shown in the browser at once")
    for command in (summary, report, view):
        command.add_argument(
            "design_folders",
            type=Path,
            nargs="+",
            metavar="FOLDER",
            help="folder with a design's stage folders",
        )
        add_verbose(command)
    summary.add_argument("--out", type=Path, required=True, help="folder of the tables")
    report.add_argument("--out", type=Path, required=True, help="HTML file to write")
    view.add_argument("--out", type=Path, help="HTML file to write (default: beside the folder)")
    view.add_argument("--no-browser", action="store_true", help="write the page, and show nothing")
    summary.add_argument(
        "--dataset",
        type=Path,
        metavar="DIR",
        help="folder of stage dataset: also tell how far each design is from the nearest in it",
    )


def _add_keeping(commands: Any) -> None:
    status = add_command(
        commands, "status", "keeping:status", "how far a run is: counts, rate, what failed"
    )
    audit = add_command(
        commands, "audit", "keeping:audit", "whether the files of a run are still what they were"
    )
    for command in (status, audit):
        command.add_argument(
            "results",
            type=Path,
            nargs="?",
            default=Path("results"),
            metavar="FOLDER",
            help="folder of the run (default: %(default)s)",
        )
        add_verbose(command)
    add_config(status)
    status.add_argument("--json", action="store_true", help="all of it, for machines")
    audit.add_argument("--quick", action="store_true", help="compare the sizes of files alone")
    audit.add_argument(
        "--discard",
        action="store_true",
        help="remove what is damaged, with what was made of it: the next run makes it again",
    )
    audit.add_argument(
        "--again",
        nargs="+",
        choices=[one.value for one in Status],
        default=[],
        metavar="STATUS",
        help="treat designs that ended so as damaged: crashed, timed_out, …",
    )


def _add_archiving(commands: Any) -> None:
    archive = add_command(
        commands, "archive", "archiving:archive", "public data set of what a run has left"
    )
    archive.add_argument("results", type=Path, metavar="FOLDER", help="folder of the run")
    archive.add_argument(
        "--more",
        type=Path,
        nargs="+",
        default=[],
        metavar="DIR",
        help="folders of designs that were simulated elsewhere",
    )
    archive.add_argument("--date", metavar="DATE", help="of publication (default: today)")
    archive.add_argument(
        "--pictures", type=int, default=12, metavar="N", help="simulated designs to draw (12)"
    )
    archive.add_argument(
        "--zip", type=Path, metavar="FILE", help="write all of it to a ZIP file as well"
    )
    add_out(archive)
    check = add_command(
        commands, "check-archive", "archiving:check_archive", "whether a data set is sound"
    )
    check.add_argument(
        "archive", type=Path, metavar="FOLDER", help="folder of the data set, or its ZIP file"
    )
    for command in (archive, check):
        add_verbose(command)
