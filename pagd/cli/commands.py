"""What each subcommand does: read the options, call the stage, tell how it went.

Stages are imported where they are used: each needs libraries that the others do not.
"""

from __future__ import annotations

import re
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from pagd.catalogue import design_from
from pagd.cli.options import checked_threads, config_of
from pagd.cli.output import print_design, print_result, progress_to, verdict
from pagd.errors import InputError

__all__ = [
    "check_design",
    "deck",
    "export",
    "figures",
    "geometry",
    "mesh",
    "metrics",
    "repair",
    "report",
    "run_all",
    "show_design",
    "solve",
    "summary",
    "view",
]

# Of a deck's steps to each recorded pressure, as a share of the step.
_FIRST_INCREMENT = 0.25


def check_design(options: Namespace) -> int:
    """Tell every rule that a design breaks; 1 if it breaks any."""
    from pagd.design import violations
    from pagd.stages.geometry import rules_of

    named = design_from(options.design)
    broken = violations(named.design, rules_of(config_of(options)))
    for violation in broken:
        print(violation)
    print(f"{named.name}: {'cannot be built' if broken else 'can be built'}")
    return 1 if broken else 0


def show_design(options: Namespace) -> int:
    """Print a design's parameters and what follows from them."""
    from pagd.stages.geometry import rules_of

    print_design(design_from(options.design), rules_of(config_of(options)))
    return 0


def geometry(options: Namespace) -> int:
    """Run the stage geometry."""
    from pagd.stages import geometry as stage

    record = stage.run(design_from(options.design), options.out, config_of(options))
    return verdict(record, options.keep_going)


def repair(options: Namespace) -> int:
    """Run the stage repair."""
    from pagd.stages import repair as stage

    record = stage.run(options.geometry, options.out, config_of(options))
    return verdict(record, options.keep_going)


def mesh(options: Namespace) -> int:
    """Run the stage mesh, on a design's surfaces or on the user's own."""
    from pagd.stages import mesh as stage

    config = config_of(options)
    if options.body or options.base:
        own = stage.OwnSurfaces(name=_name(options), half=options.half, **_both(options))
        record = stage.run_own(own, options.out, config)
    elif options.geometry and options.repair:
        record = stage.run(options.geometry, options.repair, options.out, config)
    else:
        raise InputError("mesh needs either --geometry and --repair, or --body and --base.")
    return verdict(record, options.keep_going)


def solve(options: Namespace) -> int:
    """Run the stage solve, on a mesh of ours or on the user's own."""
    threads = checked_threads(options.threads)
    from pagd.stages import solve as stage

    config = config_of(options)
    record = stage.run(
        options.mesh,
        options.out,
        config,
        stage.materials_of(config, options.material, options.paper),
        name=_name(options),
        vtu=options.vtu,
        progress=progress_to(config["solve"]["maximum_pressure_kPa"]),
        threads=threads,
    )
    return verdict(record, options.keep_going)


def deck(options: Namespace) -> int:
    """Write an input deck with the materials and recorded pressures of a configuration."""
    from pagd.actuation import Actuation
    from pagd.deck import write_deck
    from pagd.mesh.msh import read_msh
    from pagd.stages.mesh import mesh_file
    from pagd.stages.solve import materials_of

    config = config_of(options)
    materials = materials_of(config, options.material, options.paper)
    names = ("maximum_pressure_kPa", "recorded_step_kPa")
    pressures = Actuation(**{name: config["solve"][name] for name in names}).recorded_kPa()
    wanted = pressures[-1:] if options.one_step else pressures
    write_deck(
        options.out,
        read_msh(mesh_file(options.mesh)),
        materials.elastomer,
        materials.paper,
        wanted.tolist(),
        # As a share of the step: the same pressure either way.
        first_increment=_FIRST_INCREMENT * float(pressures[0] / wanted[0]),
        solid_element=options.solid_element,
        sheet_element=options.sheet_element,
        stress_unit=options.stress_unit,
    )
    return 0


def metrics(options: Namespace) -> int:
    """Run the stage metrics."""
    from pagd.stages import metrics as stage

    if options.sections < 2:
        raise InputError(f"--sections = {options.sections} must be at least 2.")
    folders = stage.Folders(
        mesh=options.mesh, solve=options.solve, geometry=options.geometry, repair=options.repair
    )
    record = stage.run(folders, options.out, config_of(options), options.sections)
    print_result(record)
    return verdict(record, options.keep_going)


def figures(options: Namespace) -> int:
    """Run the stage figures."""
    from pagd.stages import figures as stage

    record = stage.run(options.design_folder, options.out, config_of(options))
    return verdict(record, options.keep_going)


def export(options: Namespace) -> int:
    """Run the stage export."""
    from pagd.stages import export as stage

    record = stage.run(options.design_folder, options.out, config_of(options))
    return verdict(record, options.keep_going)


def summary(options: Namespace) -> int:
    """Write the tables of designs, of those that came as far as the metrics."""
    from pagd.record import RECORD_NAME
    from pagd.summary import write_gathered, write_summary

    folders = options.design_folders
    there = [folder for folder in folders if (folder / "metrics" / RECORD_NAME).is_file()]
    measured = [folder / "metrics" for folder in there]
    novelty: dict[str, float] = {}
    if options.dataset:
        from pagd.stages.novelty import novelty_of

        novelty = novelty_of([folder / "geometry" for folder in there], options.dataset)
    performance, table = options.out / "performance.parquet", options.out / "summary.csv"
    write_summary(measured, performance, table, novelty)
    write_gathered(measured, options.out)
    print(f"{len(measured)} of {len(folders)} designs have a record of their metrics.")
    return 0


def report(options: Namespace) -> int:
    """Write the page of designs, and their cards beside it."""
    _write_page(options.design_folders, options.out)
    return 0


def view(options: Namespace) -> int:
    """Write the page of designs beside the first of them, and show it in the browser."""
    import webbrowser

    first: Path = options.design_folders[0]
    page = options.out or first.resolve().with_name(f"{first.resolve().name}.html")
    _write_page(options.design_folders, page)
    print(page)
    if not options.no_browser and not webbrowser.open(page.resolve().as_uri()):
        print("pagd: no browser was found; open the page in one.", file=sys.stderr)
    return 0


def _write_page(folders: Sequence[Path], page: Path) -> None:
    from pagd.config import load
    from pagd.figures.page import cards_beside, write_page
    from pagd.stages import export as stage

    cards, config = cards_beside(page), load(None)
    whole = [folder.resolve() for folder in folders]  # "." has no name
    for folder in whole:
        stage.run(folder, cards / folder.name, config)
    write_page(whole, page, cards=cards)


def run_all(options: Namespace) -> int:
    """Run all stages of one design, each in a folder of its own under ``--out``."""
    threads = checked_threads(options.threads)
    from pagd.stages import chain
    from pagd.stages.solve import materials_of

    config = config_of(options)
    record = chain.run(
        design_from(options.design),
        options.out,
        config,
        materials_of(config, options.material, options.paper),
        vtu=options.vtu,
        progress=progress_to(config["solve"]["maximum_pressure_kPa"]),
        threads=threads,
    )
    print_result(record)
    return verdict(record, options.keep_going)


def _name(options: Namespace) -> str | None:
    name: str | None = options.name
    if name is not None and not re.fullmatch(r"[A-Za-z0-9_-]+", name):
        raise InputError(f"--name = {name!r} must consist of letters, digits, '_' and '-'.")
    return name


def _both(options: Namespace) -> dict[str, Path]:
    if not (options.body and options.base):
        raise InputError("--body and --base must be given together.")
    return {"body": options.body, "base": options.base}
