"""The arguments of the subcommands of one design: all stages, each of them, and a look before."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from pagd.cli.arguments import (
    add_command,
    add_config,
    add_folder,
    add_materials,
    add_stage_options,
    add_verbose,
    override,
)

__all__ = ["add_stages"]

_DESIGN = "design: a YAML or JSON file, or JSON text"


def add_stages(commands: Any) -> None:
    """Add the subcommands that work on one design."""
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


def _add_run(commands: Any) -> None:
    run = add_command(
        commands, "run", "run_all", "simulate a design: all stages below, into one folder"
    )
    run.add_argument("design", metavar="DESIGN", help=_DESIGN)
    add_stage_options(run)
    _add_mesh_options(run)
    _add_solve_options(run)


def _add_design(commands: Any) -> None:
    design = commands.add_parser(
        "design",
        help="check a design, or show it, before anything is run",
        description="Check a design, or show it, before anything is run.",
    )
    actions = design.add_subparsers(metavar="action", required=True)
    for action, handler, text in (
        (
            "check",
            "check_design",
            "tell every rule that the design breaks, or that it can be built",
        ),
        ("show", "show_design", "print the parameters and what follows from them"),
    ):
        sub = add_command(actions, action, handler, text)
        sub.add_argument("design", metavar="DESIGN", help=_DESIGN)
        add_config(sub)
        add_verbose(sub)


def _add_geometry(commands: Any) -> None:
    geometry = add_command(
        commands, "geometry", "geometry", "parameters → surfaces of the solids, by OpenSCAD"
    )
    geometry.add_argument("design", nargs="?", metavar="DESIGN", help=_DESIGN)
    geometry.add_argument("--design", dest="design_option", metavar="DESIGN", help="the same")
    add_stage_options(geometry)


def _add_repair(commands: Any) -> None:
    repair = add_command(
        commands, "repair", "repair", "surfaces → watertight surfaces, by pymeshlab"
    )
    add_folder(repair, "geometry", required=True)
    add_stage_options(repair)


def _add_mesh(commands: Any) -> None:
    mesh = add_command(commands, "mesh", "mesh", "design or surfaces → mesh with named surfaces")
    _add_own_design(mesh, "geometry/, repair/ and mesh/")
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


def _add_own_design(command: argparse.ArgumentParser, folders: str) -> None:
    command.add_argument(
        "design",
        nargs="?",
        metavar="DESIGN",
        help=f"{_DESIGN}: the stages before are run too, into {folders} of --out",
    )


def _add_mesh_options(
    command: argparse.ArgumentParser, title: str = "mesh (instead of the configuration's values)"
) -> None:
    group = command.add_argument_group(title)
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
        commands,
        "solve",
        "solve",
        "design or mesh → free actuation and blocked force",
    )
    _add_own_design(solve, "geometry/, repair/, mesh/ and solve/")
    solve.add_argument(
        "--mesh",
        type=Path,
        metavar="PATH",
        help="folder of the stage mesh, or a .msh file with surfaces fixed, cavity, paper, …",
    )
    solve.add_argument("--name", help="name in the record (default: that of the mesh)")
    _add_mesh_options(solve, "mesh, of a design (instead of the configuration's values)")
    _add_solve_options(solve)
    add_stage_options(solve)


def _add_solve_options(command: argparse.ArgumentParser) -> None:
    group = add_materials(command)
    override(group, "solve", "element", str, "auto, hexahedron, taylor_hood or element_pressure")
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
        metavar="PATH",
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
    figures = add_command(
        commands, "figures", "figures", "pictures of geometry, mesh, shapes and curves"
    )
    figures.add_argument(
        "design_folder", type=Path, metavar="FOLDER", help="folder with a design's stage folders"
    )
    add_stage_options(figures)


def _add_export(commands: Any) -> None:
    export = add_command(
        commands, "export", "export", "files of a design: STL, STEP, moulds, VTU, CSV"
    )
    export.add_argument(
        "design_folder", type=Path, metavar="FOLDER", help="folder with a design's stage folders"
    )
    add_stage_options(export)
