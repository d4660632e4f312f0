"""Geometry of a design: the OpenSCAD model, and its parts as triangulated surfaces.

The surfaces are binary STL files. OpenSCAD's text formats (STL, OFF, AMF) keep six significant
digits, which moves a vertex near the tip by up to 0.5 um and a volume by some 1e-5; binary STL
keeps 24 bits, 4 nm there. Equal coordinates of two parts stay equal, so that body and base
share the corners of the paper plane to the last bit.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import Literal

import numpy as np

from pagd.design import Design, GeometryRules
from pagd.errors import InputError, MachineError, StageFailure, Status
from pagd.families import Actuator, actuator_of
from pagd.files import replaced_file, write_text
from pagd.limits import die_with_parent

__all__ = [
    "Part",
    "openscad_version",
    "parts_of_model",
    "render",
    "render_model",
    "write_design_scad",
]

Part = Literal["body", "base", "cavity", "mould_outside", "mould_core", "mould_base"]

_SETTING = re.compile(r"^(?P<name>\w+) = (?P<value>[^;]+);(?: // \[(?P<range>[^\]:]+:[^\]]+)\])?$")
_PARTS = re.compile(r'^part = "\w+"; // \[(?P<names>[\w, ]+)\]$')
_CANNOT_RUN = (126, 127)
# A binary STL file: 80 bytes of title, the number of facets, and a record each.
_STL_HEADER = 84
_STL_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write_design_scad(design: Design | Actuator, rules: GeometryRules, path: Path) -> None:
    """Write the OpenSCAD model with the values of one design, ready to be opened.

    The file needs no other: it holds the parameters, with their sliders, and the modules.

    Raises
    ------
    InputError
        If the model of the design's family lacks one of its settings.
    """
    actuator = actuator_of(design)
    settings, model = actuator.settings(rules), actuator.model().splitlines()
    found = {match["name"] for match in map(_SETTING.match, model) if match}
    missing = [name for name in settings if name not in found]
    if missing:
        raise InputError(
            f"OpenSCAD model of the family {actuator.family}: has no line '{missing[0]} = …;' to "
            f"set {' and '.join(missing)}."
        )
    lines = [_with_setting(line, settings) for line in model]
    write_text(path, "\n".join(lines) + "\n")


def render(
    design: Design | Actuator,
    rules: GeometryRules,
    part: Part,
    path: Path,
    half: bool = False,
    time_limit: float = 120.0,
) -> None:
    """Write one part of a design as a binary STL file (mm).

    Parameters
    ----------
    design, rules
        What to make; checked before anything is run.
    part
        "body" (above the paper plane, hollow), "base" (below it) or "cavity" (the air); of the
        moulds "mould_outside" (around the chambers), "mould_core" (the air on a plate) and
        "mould_base" (a tray as deep as the base).
    path
        The STL file; it appears only when it is complete.
    half
        Only y > 0, cut open at the plane of symmetry; for symmetric designs, and not for moulds.
    time_limit
        Seconds after which OpenSCAD is ended.

    Raises
    ------
    InputError
        If OpenSCAD is not installed or does not start, the model lacks a setting, or half of a
        design that is not symmetric is asked for.
    StageFailure
        ``invalid_geometry`` if the design breaks a rule, or OpenSCAD fails or takes too long.
    """
    actuator = actuator_of(design)
    actuator.check(rules)
    if half and not actuator.is_symmetric:
        told = ", ".join(f"{symbol} = {value:g}" for symbol, value in actuator.as_dict().items())
        raise InputError(f"A design that is not symmetric has no half model ({told}).")
    with tempfile.TemporaryDirectory(prefix="pagd-") as folder:
        model = Path(folder) / "design.scad"
        write_design_scad(actuator, rules, model)
        render_model(model, part, path, half=half, time_limit=time_limit)


def render_model(
    model: Path, part: str, path: Path, *, half: bool = False, time_limit: float = 120.0
) -> None:
    """Write one part of an OpenSCAD model, by the name that its setting ``part`` has for it.

    ``path``, ``half``, ``time_limit`` and what is raised are those of :func:`render`.
    """
    with replaced_file(path) as target:
        command = [_openscad(), "-q", "--export-format", "binstl", "-o", str(target)]
        command += ["-D", f'part="{part}"', "-D", f"half={str(half).lower()}", str(model)]
        _run(command, time_limit, f"the {part.replace('_', ' ')}")
        _sort_facets(target)


def parts_of_model(model: Path) -> tuple[str, ...]:
    """Return the parts that an OpenSCAD model lists beside its setting ``part``."""
    for line in model.read_text(encoding="utf-8").splitlines():
        found = _PARTS.match(line)
        if found is not None:
            return tuple(name.strip() for name in found["names"].split(","))
    return ()


def openscad_version() -> str:
    """Version of the openscad program, for records.

    Raises
    ------
    InputError
        If OpenSCAD is not installed.
    """
    answer = subprocess.run([_openscad(), "--version"], capture_output=True, text=True, check=False)
    return (answer.stdout + answer.stderr).strip().removeprefix("OpenSCAD version ")


def _openscad() -> str:
    program = shutil.which("openscad")
    if program is None:
        raise InputError(
            "The program openscad is not on the PATH; install OpenSCAD 2021.01 or later."
        )
    return program


_WRITE_ERROR = "write error"


def _run(command: list[str], time_limit: float, what: str) -> None:
    """Run OpenSCAD; its process group does not outlive this call, whatever happens."""
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        start_new_session=True,
        preexec_fn=die_with_parent,
    ) as process:
        try:
            _, messages = process.communicate(timeout=time_limit)
        except subprocess.TimeoutExpired:
            reason = f"OpenSCAD did not finish {what} within {time_limit:g} s."
            raise StageFailure(Status.invalid_geometry, reason) from None
        finally:
            _end_group(process)
    # OpenSCAD ends well when the disk is full, and says no more than this.
    if _WRITE_ERROR in messages.lower():
        raise MachineError(f"OpenSCAD could not write {what}: {_last_lines(messages)}.")
    if -process.returncode == signal.SIGKILL:
        raise MachineError(f"OpenSCAD was killed from outside while it made {what}.")
    if process.returncode in _CANNOT_RUN:
        raise InputError(f"The program openscad does not start: {_last_lines(messages)}.")
    if process.returncode != 0:
        reason = f"OpenSCAD could not make {what}: {_last_lines(messages)}."
        raise StageFailure(Status.invalid_geometry, reason)


def _sort_facets(path: Path) -> None:
    """Bring the facets of a binary STL file into one order; OpenSCAD's differs from run to run.

    A mesher's result depends on the order, and the same design is to give the same mesh. Each
    facet begins with its smallest corner, which keeps its orientation.
    """
    content = path.read_bytes()
    facets = np.frombuffer(content[_STL_HEADER:], dtype=_STL_FACET).copy()
    corners = facets["corners"]
    rank = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)[1].reshape(-1, 3)
    first = (rank.argmin(axis=1)[:, None] + np.arange(3)) % 3
    rank = np.take_along_axis(rank, first, axis=1)
    facets["corners"] = np.take_along_axis(corners, first[:, :, None], axis=1)
    path.write_bytes(content[:_STL_HEADER] + facets[np.lexsort(rank.T[::-1])].tobytes())


def _end_group(process: subprocess.Popen[str]) -> None:
    """Kill what is left of the process and its children (its group bears its number)."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGKILL)


def _last_lines(messages: str, count: int = 3) -> str:
    lines = [line.strip() for line in messages.splitlines() if line.strip()]
    return " | ".join(lines[-count:]).rstrip(".") or "it gave no reason"


def _with_setting(line: str, settings: dict[str, str]) -> str:
    """The line of the model, with the value of ``settings`` where it sets one of them."""
    match = _SETTING.match(line)
    if match is None or match["name"] not in settings:
        return line
    value = settings[match["name"]]
    slider = f" // [{_widened(match['range'], float(value))}]" if match["range"] else ""
    return f"{match['name']} = {value};{slider}"


def _widened(slider: str, value: float) -> str:
    """Range "low:step:high" of a slider, made to hold the value: else it would be cut off."""
    low, step, high = slider.split(":")
    if value < float(low):
        low = repr(value)
    if value > float(high):
        high = repr(value)
    return f"{low}:{step}:{high}"
