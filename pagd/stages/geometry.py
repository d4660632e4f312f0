"""Stage 1: from the parameters of a design to the surfaces of its parts."""

from __future__ import annotations

import json
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

from pagd.catalogue import NamedDesign, design_from
from pagd.design import GeometryRules
from pagd.geometry import openscad_version, render, write_design_scad
from pagd.record import Meter, Record
from pagd.stages.stage import Outcome, run_stage

__all__ = ["DESIGN_NAME", "read_design", "rules_of", "run"]

DESIGN_NAME = "design.json"


def run(named: NamedDesign, out: Path, config: Mapping[str, Any]) -> Record:
    """Check a design and draw it: design.json, design.scad, body.stl, base.stl and halves.

    Parameters
    ----------
    named
        The design.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``channel``, ``limits`` and ``geometry``.
    """
    rules = rules_of(config)

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        named.actuator.check(rules)
        write_design_scad(named.design, rules, folder / "design.scad")
        with meter.part("openscad"):
            _render_all(named, rules, folder, config["geometry"]["time_limit_s"])
        outcome.figures |= _figures(named, rules)

    return run_stage(
        "geometry",
        out,
        work,
        design_id=named.name,
        configuration={
            "design": _in_words(json.loads(named.as_json())),
            **{key: config[key] for key in ("channel", "limits", "geometry")},
            **_family(named),
        },
        libraries={"openscad": openscad_version()},
        given={DESIGN_NAME: named.as_json() + "\n"},
    )


def rules_of(config: Mapping[str, Any]) -> GeometryRules:
    """Return the rules of the geometry that a configuration sets."""
    sections = {
        section: {key.removesuffix("_mm"): value for key, value in config[section].items()}
        for section in ("channel", "limits")
    }
    return GeometryRules.from_mapping(sections)


def read_design(folder: Path) -> NamedDesign:
    """Read the design back from the folder of this stage."""
    return design_from(str(folder / DESIGN_NAME))


def _in_words(row: Mapping[str, Any]) -> dict[str, Any]:
    # JSON has no word for a number that is not finite, and such a design has a record too.
    odd = {key for key, value in row.items() if isinstance(value, float) and not isfinite(value)}
    return {key: str(value) if key in odd else value for key, value in row.items()}


def _family(named: NamedDesign) -> dict[str, str]:
    """Return what files made the geometry, where a family has its own."""
    digest = named.actuator.digest()
    return {} if digest is None else {"family_sha256": digest}


def _render_all(named: NamedDesign, rules: GeometryRules, folder: Path, time_limit: float) -> None:
    halves = (False, True) if named.actuator.is_symmetric else (False,)
    for half in halves:
        for part in ("body", "base"):
            path = folder / f"{part}{'_half' if half else ''}.stl"
            render(named.design, rules, part, path, half=half, time_limit=time_limit)


def _figures(named: NamedDesign, rules: GeometryRules) -> dict[str, Any]:
    volumes = named.actuator.volumes(rules)
    if volumes is None:
        return named.actuator.figures()
    return named.actuator.figures() | {
        "body_volume_mm3": volumes.body,
        "base_volume_mm3": volumes.base,
        "solid_volume_mm3": volumes.solid,
        "cavity_volume_mm3": volumes.cavity,
    }
