"""Stage 6: pictures of one design, of as much of it as there is."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pagd.figures.blocked import draw_blocked_force
from pagd.figures.contact import draw_contact
from pagd.figures.deformed import draw_deformed
from pagd.figures.geometry import draw_geometry
from pagd.figures.load import (
    has_blocked_force,
    has_contact,
    has_history,
    has_states,
    records_of,
    stl_paths,
)
from pagd.figures.mesh import draw_mesh
from pagd.figures.pressure_volume import draw_pressure_volume
from pagd.figures.style import set_resolution
from pagd.long_work import counted
from pagd.record import Meter, Record
from pagd.stages.mesh import MESH_NAME
from pagd.stages.stage import Outcome, run_stage

__all__ = ["run"]


def run(design: Path, out: Path, config: Mapping[str, Any]) -> Record:
    """Draw what there is of a design: one that failed has fewer pictures.

    They are geometry.png, mesh.png, deformed.png and pressure_volume.png; contact.png unless
    contact was off; blocked_force.png unless none was asked for.

    Parameters
    ----------
    design
        Folder with the folders of the design's stages.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``figures.resolution_dpi``.
    """
    upstream = records_of(design)

    resolution = config["figures"]["resolution_dpi"]

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        set_resolution(resolution)
        drawable = _drawable(design)
        asked = counted(drawable.items(), "drawing", len(drawable), "pictures", even=False)
        for name, draw in asked:
            with meter.part(name):
                draw(design, folder / f"{name}.png")
        outcome.figures["pictures"] = sorted(path.name for path in folder.glob("*.png"))

    return run_stage(
        "figures",
        out,
        work,
        design_id=upstream[-1].design_id,
        configuration={"figures": {"resolution_dpi": resolution}},
        upstream=upstream,
        goes_on=True,
        libraries=("matplotlib", "pyvista"),
    )


def _drawable(design: Path) -> dict[str, Any]:
    """Return what can be drawn: name of the picture to function(design folder, file)."""
    solved = has_states(design) and has_history(design)
    there = {
        "geometry": (stl_paths(design) is not None, draw_geometry),
        "mesh": ((design / "mesh" / MESH_NAME).is_file(), draw_mesh),
        "deformed": (has_states(design), draw_deformed),
        "pressure_volume": (solved, draw_pressure_volume),
        "contact": (solved and has_contact(design), draw_contact),
        "blocked_force": (has_blocked_force(design), draw_blocked_force),
    }
    return {name: draw for name, (found, draw) in there.items() if found}
