"""What each subcommand does: read the options, call the stage, tell how it went.

Stages are imported where they are used: each needs libraries that the others do not.
"""

from __future__ import annotations

import re
import shlex
from argparse import Namespace
from pathlib import Path

from pagd.catalogue import design_from
from pagd.cli.answer import Answer
from pagd.cli.options import checked_threads, config_of, design_of, refuse_beside
from pagd.cli.output import design_document, print_design, print_result, steps_of_solve, verdict
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
    "run_all",
    "show_design",
    "solve",
]

# Of a deck's steps to each recorded pressure, as a share of the step.
_FIRST_INCREMENT = 0.25


def check_design(options: Namespace) -> Answer:
    """Tell every rule that a design breaks; 1 if it breaks any."""
    from pagd.stages.geometry import rules_of

    found = design_document(design_from(options.design), rules_of(config_of(options)))
    for violation in found["violations"]:
        print(violation["message"])
    print(f"{found['name']}: {'can' if found['can_be_built'] else 'cannot'} be built")
    return Answer(0 if found["can_be_built"] else 1, found)


def show_design(options: Namespace) -> Answer:
    """Print a design's parameters and what follows from them."""
    from pagd.stages.geometry import rules_of

    named = design_from(options.design)
    found = design_document(named, rules_of(config_of(options)))
    print_design(named, found)
    return Answer(0, found)


def geometry(options: Namespace) -> Answer:
    """Run the stage geometry."""
    from pagd.stages import geometry as stage

    named = design_from(design_of(options))
    record = stage.run(named, options.out, config_of(options))
    return verdict(record, options.out, options.keep_going)


def repair(options: Namespace) -> Answer:
    """Run the stage repair."""
    from pagd.stages import repair as stage

    record = stage.run(options.geometry, options.out, config_of(options))
    return verdict(record, options.out, options.keep_going)


def mesh(options: Namespace) -> Answer:
    """Run the stage mesh, on surfaces of ours or of the user, or all stages up to it."""
    if options.design:
        refuse_beside(options, "a design", "geometry", "repair", "body", "base", "half", "name")
        return _chain(options, "mesh")
    from pagd.stages import mesh as stage

    config = config_of(options)
    if options.body or options.base:
        own = stage.OwnSurfaces(name=_name(options), half=options.half, **_both(options))
        record = stage.run_own(own, options.out, config)
    elif options.geometry and options.repair:
        record = stage.run(options.geometry, options.repair, options.out, config)
    else:
        raise InputError("mesh needs a design, or --geometry and --repair, or --body and --base.")
    return verdict(record, options.out, options.keep_going)


def solve(options: Namespace) -> Answer:
    """Run the stage solve, on a mesh of ours or of the user, or all stages up to it."""
    if options.design:
        refuse_beside(options, "a design", "mesh", "name")
        return _chain(options, "solve")
    if not options.mesh:
        raise InputError("solve needs a design, as a YAML file, or a mesh: --mesh.")
    refuse_beside(options, "--mesh", *(name for name in vars(options) if name.startswith("mesh.")))
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
        progress=steps_of_solve(),
        threads=threads,
    )
    return verdict(record, options.out, options.keep_going)


def deck(options: Namespace) -> Answer:
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
    return Answer(0, {"file": options.out, "pressures_kPa": wanted})


def metrics(options: Namespace) -> Answer:
    """Run the stage metrics."""
    from pagd.stages import metrics as stage

    if options.sections < 2:
        raise InputError(f"--sections = {options.sections} must be at least 2.")
    folders = stage.Folders(
        mesh=options.mesh, solve=options.solve, geometry=options.geometry, repair=options.repair
    )
    record = stage.run(folders, options.out, config_of(options), options.sections)
    print_result(record)
    return verdict(record, options.out, options.keep_going)


def figures(options: Namespace) -> Answer:
    """Run the stage figures."""
    from pagd.stages import figures as stage

    record = stage.run(options.design_folder, options.out, config_of(options))
    return verdict(record, options.out, options.keep_going)


def export(options: Namespace) -> Answer:
    """Run the stage export."""
    from pagd.stages import export as stage

    record = stage.run(options.design_folder, options.out, config_of(options))
    return verdict(record, options.out, options.keep_going)


def run_all(options: Namespace) -> Answer:
    """Run all stages of one design, each in a folder of its own under ``--out``."""
    answer = _chain(options, "figures")
    print(f"To look at it: pagd view {shlex.quote(str(options.out))}")
    return answer


def _chain(options: Namespace, last: str) -> Answer:
    """Run the stages of one design up to the ``last``, each in its own folder under ``--out``."""
    threads = checked_threads(vars(options).get("threads", 1))
    from pagd.stages import chain
    from pagd.stages.solve import materials_of

    config = config_of(options)
    given = vars(options)
    record = chain.run(
        design_from(options.design),
        options.out,
        config,
        materials_of(config, given.get("material"), given.get("paper")),
        last=last,
        vtu=given.get("vtu", False),
        progress=steps_of_solve(),
        threads=threads,
    )
    print_result(record)
    return verdict(record, options.out / record.stage, options.keep_going)


def _name(options: Namespace) -> str | None:
    name: str | None = options.name
    if name is not None and not re.fullmatch(r"[A-Za-z0-9_-]+", name):
        raise InputError(f"--name = {name!r} must consist of letters, digits, '_' and '-'.")
    return name


def _both(options: Namespace) -> dict[str, Path]:
    if not (options.body and options.base):
        raise InputError("--body and --base must be given together.")
    return {"body": options.body, "base": options.base}
