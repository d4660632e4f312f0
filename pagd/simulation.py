"""From a design to its result in one call: all stages, without the workflow or a command line."""

from __future__ import annotations

import functools
import json
import re
import sys
import tempfile
from collections.abc import Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from pagd import config as configuration
from pagd.bars import bars
from pagd.catalogue import NamedDesign, design_from, design_of
from pagd.design import Design
from pagd.errors import InputError
from pagd.families import PNEUNET, Actuator, PneuNet, family_named
from pagd.long_work import shown_by
from pagd.notebook import bar, is_notebook
from pagd.result import Result, read_result
from pagd.stages import chain
from pagd.stages.solve import materials_of

__all__ = ["simulate"]


def simulate(
    design: Design | Actuator | NamedDesign | Mapping[str, object] | str | Path,
    out: Path | str | None = None,
    *,
    pressure_kPa: float | None = None,
    material: str | Mapping[str, Any] | None = None,
    config: Mapping[str, Any] | str | Path | None = None,
    threads: int = 1,
    name: str | None = None,
    progress: bool | None = None,
) -> Result:
    """Build, mesh and solve a design, and measure what it does.

    Parameters
    ----------
    design
        The design: as such, its parameters by symbol (mm, degrees), or a YAML or JSON file of
        them; ``family`` among them where it is no pneu-net.
    out
        Folder for the folders of the stages, with their pictures. Without one they are in a
        temporary folder, which goes when Python ends, and no pictures are drawn beforehand.
    pressure_kPa
        Pressure at the end; as configured unless given (50 kPa).
    material
        Name of an elastomer in the file of materials, or an entry of one with its ``name``; as
        configured unless given.
    config
        Configuration, or its YAML or JSON file; what is left out has its default.
    threads
        Threads of kernels and linear solver.
    name
        Name of the design; its own, or that of ``out``, unless given.
    progress
        Show bars of how far it is: under the cell of a notebook, elsewhere on stderr. Unless given,
        they are shown in a notebook, and at a terminal in an interactive session of Python; a
        program shows none.

    Returns
    -------
    Result
        Also of a design that fails: its ``status`` and ``reason`` say how and why.

    Raises
    ------
    InputError
        If anything given is unusable; nothing has been written then.
    MachineError
        If the machine fails and not the design, as a full disk does.
    """
    wanted = None if out is None else Path(out)
    named = _named(design, name, wanted)
    settings = _settings(config, pressure_kPa)
    materials = materials_of(settings, _as_text(material))
    if threads < 1:
        raise InputError(f"threads = {threads} must be at least 1.")
    folder = wanted or Path(tempfile.mkdtemp(dir=_scratch().name)) / named.name
    with _display(progress):
        chain.run(
            named,
            folder,
            settings,
            materials,
            last="metrics" if wanted is None else "figures",
            threads=threads,
        )
    return read_result(folder)


def _named(
    design: Design | Actuator | NamedDesign | Mapping[str, object] | str | Path,
    name: str | None,
    out: Path | None,
) -> NamedDesign:
    """The design with a name, checked as those in files are."""
    if isinstance(design, (str, Path)):
        design = design_from(str(design))
    if isinstance(design, NamedDesign):
        own, origin, made = design.name, design.origin, design.design
    else:
        # A folder's name serves as that of a design that has none.
        own = "design" if out is None else re.sub(r"[^A-Za-z0-9_-]+", "-", out.name).strip("-")
        origin = "own"
        made = design if isinstance(design, (Design, Actuator)) else _made(_mapping(design))
    named = NamedDesign(name=name or own or "design", origin=origin, design=made)
    return design_of(json.loads(named.as_json()), f"design {named.name}")


def _made(mapping: Mapping[str, object]) -> Design | Actuator:
    parameters = {key: value for key, value in mapping.items() if key != "family"}
    made = family_named(mapping.get("family", PNEUNET)).from_mapping(parameters)
    return made.design if isinstance(made, PneuNet) else made


def _mapping(design: object) -> Mapping[str, object]:
    if not isinstance(design, Mapping):
        raise InputError(f"design = {design!r} must be a design, its parameters or a file of them.")
    return design


def _settings(
    given: Mapping[str, Any] | str | Path | None, pressure_kPa: float | None
) -> dict[str, Any]:
    if isinstance(given, Mapping):
        settings = configuration.checked(given, "config")
    else:
        settings = configuration.load(None if given is None else str(given))
    if pressure_kPa is None:
        return settings
    settings["solve"]["maximum_pressure_kPa"] = pressure_kPa
    return configuration.checked(settings, f"pressure_kPa = {pressure_kPa}")


def _as_text(material: str | Mapping[str, Any] | None) -> str | None:
    return json.dumps(dict(material)) if isinstance(material, Mapping) else material


@functools.cache
def _scratch() -> tempfile.TemporaryDirectory[str]:
    """A folder that goes with the process, however many designs are in it."""
    return tempfile.TemporaryDirectory(prefix="pagd-")


def _display(wanted: bool | None) -> AbstractContextManager[None]:
    """What shows whoever looks on how far it is, where that is wanted; None: where one looks on."""
    if wanted is False:
        return shown_by(None)
    if is_notebook():
        return shown_by(bar)
    return bars(bool(wanted) or (_is_interactive() and sys.stderr.isatty()))


def _is_interactive() -> bool:
    """Whether a person types at this Python, and runs no program."""
    return hasattr(sys, "ps1") or bool(sys.flags.interactive)
