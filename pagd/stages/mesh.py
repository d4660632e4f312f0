"""Stage 3: quadratic tetrahedra with named surfaces."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from pagd.design import Channel, Design
from pagd.errors import InputError, StageFailure, Status
from pagd.inventory import read_sound_record
from pagd.mesh.checks import EXTENT_MM
from pagd.mesh.joining import Complex, Patch, join
from pagd.mesh.msh import write_msh
from pagd.mesh.run import MeshGate, mesh_with_limits
from pagd.mesh.surfaces import SurfacePair
from pagd.mesh.topology import components, edge_neighbours
from pagd.mesh.types import Mesh
from pagd.record import Meter, Record, read_record
from pagd.stages.geometry import read_design, rules_of
from pagd.stages.stage import Outcome, run_stage

__all__ = ["MESH_NAME", "OwnSurfaces", "identity", "mesh_file", "name_of", "run", "run_own"]

MESH_NAME = "mesh.msh"


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnSurfaces:
    """Watertight surfaces of one's own: STL files of the body and of the base.

    ``half``: they are the half y ≥ 0 of a symmetric actuator. ``name``: for the record; that of
    the body's file unless given.
    """

    body: Path
    base: Path
    half: bool = False
    name: str | None = None


def mesh_file(mesh: Path) -> Path:
    """Return the mesh of the stage's folder, or the .msh file of one's own that is given."""
    return mesh / MESH_NAME if mesh.is_dir() else mesh


def run(geometry: Path, repair: Path, out: Path, config: Mapping[str, Any]) -> Record:
    """Mesh a design, or half of it where it is symmetric: mesh.msh.

    Parameters
    ----------
    geometry, repair
        Folders of the stages before.
    out
        Folder of the stage.
    config
        Completed configuration; uses ``mesh``.
    """
    drawn, repaired = read_sound_record(geometry), read_sound_record(repair)

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        half = config["mesh"]["half_model"] and (repair / "body_half.stl").is_file()
        ending = "_half.stl" if half else ".stl"
        pair = SurfacePair.from_stl(repair / f"body{ending}", repair / f"base{ending}", half)
        volume = drawn.figures.get("solid_volume_mm3")
        volume = volume / 2 if volume is not None and half else volume
        blocks = partial(_structured, geometry, config["mesh"]["block_mm"], half)
        _mesh(pair, volume, folder, outcome, config["mesh"], blocks)

    return run_stage(
        "mesh",
        out,
        work,
        design_id=drawn.design_id,
        configuration={"mesh": config["mesh"]} | _row(geometry, drawn),
        upstream=[drawn, repaired],
        libraries=_LIBRARIES,
    )


def _row(geometry: Path, drawn: Record) -> dict[str, Any]:
    """What row of chambers is meshed, for stages that know its parts; nothing if it failed."""
    if drawn.status is not Status.ok:
        return {}
    named = read_design(geometry)
    if not isinstance(named.design, Design):
        return {"design": {"family": named.design.family, **named.design.as_dict()}}
    return {"design": named.design.as_dict(), "channel": drawn.configuration["channel"]}


def _structured(geometry: Path, size: float, half: bool) -> Mesh:
    """What the stage geometry has drawn, in blocks."""
    rules = rules_of(read_record(geometry).configuration)
    return read_design(geometry).actuator.blocks(rules, size, half=half)


def channel_of(lengths: Mapping[str, float]) -> Channel:
    """Return the air channel of the configuration's ``channel``."""
    return Channel(**{key.removesuffix("_mm"): value for key, value in lengths.items()})


def run_own(own: OwnSurfaces, out: Path, config: Mapping[str, Any]) -> Record:
    """Mesh surfaces of one's own; as :func:`run` otherwise.

    Raises
    ------
    InputError
        If the surfaces are not those of an actuator: no mesher could help.
    """

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        pair = SurfacePair.from_stl(own.body, own.base, own.half)
        where = f"body {own.body} and base {own.base}"
        try:
            _check_length(pair)
            _check_hollow(join(pair))
        except StageFailure as failure:
            raise InputError(f"{where}: {failure.reason}") from None
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
        _mesh(pair, None, folder, outcome, config["mesh"])

    return run_stage(
        "mesh",
        out,
        work,
        design_id=own.name or name_of(own.body),
        configuration={
            "mesh": config["mesh"],
            "body": own.body.name,
            "base": own.base.name,
            "half": own.half,
        },
        libraries=_LIBRARIES,
    )


def identity(mesh: Mesh) -> dict[str, Any]:
    """Return what tells one mesh from another: number of nodes, digest of points and elements."""
    digest = hashlib.sha256(mesh.points.tobytes() + mesh.tets.tobytes())
    return {"nodes": len(mesh.points), "mesh_sha256": digest.hexdigest()[:16]}


def name_of(file: Path) -> str:
    """Return a name for a design from that of a file."""
    return re.sub(r"[^A-Za-z0-9_-]+", "-", file.stem).strip("-") or "own"


def _check_length(pair: SurfacePair) -> None:
    """Refuse surfaces that are in another unit than mm."""
    points = np.vstack((pair.body.points, pair.base.points))
    length, (shortest, longest) = float(np.ptp(points, axis=0).max()), EXTENT_MM
    if not shortest <= length <= longest:
        raise InputError(
            f"they are {length:.6g} mm long, expected {shortest:g} to {longest:g}; coordinates "
            "must be in mm."
        )


def _check_hollow(solid: Complex) -> None:
    """Refuse a solid without a void inside, and a half model that is none."""
    y = solid.points[solid.triangles][:, :, 1]
    if solid.half and abs(float(y.min())) > solid.tolerance:
        raise InputError(
            f"half: the half y ≥ 0 of an actuator must begin at y = 0, not at {y.min():.6g} mm."
        )
    cut = (np.abs(y) <= solid.tolerance).all(axis=1) & solid.half
    walls = solid.triangles[(solid.patches != Patch.paper) & ~cut]
    if components(edge_neighbours(walls), len(walls)).max() == 0:
        raise InputError(
            "body: must be hollow, but has no surface apart from the outside"
            f"{'' if solid.half else ' (half of a symmetric actuator must be given as such)'}."
        )


_LIBRARIES = ("gmsh", "numpy", "pytetwild")


def _mesh(
    pair: SurfacePair,
    volume: float | None,
    folder: Path,
    outcome: Outcome,
    settings: Mapping[str, Any],
    structured: Callable[[], Mesh] | None = None,
) -> None:
    outcome.figures["half"] = pair.half
    result = mesh_with_limits(
        pair,
        settings["meshers"],
        size=settings["size_mm"],
        time_limit_s=settings["time_limit_s"],
        exact_volume=volume,
        gate=MeshGate(
            smallest_scaled_jacobian=settings["smallest_scaled_jacobian"],
            largest_volume_error=settings["largest_volume_error"],
        ),
        structured=structured,
    )
    write_msh(result.mesh, folder / MESH_NAME)
    outcome.figures |= {
        **result.quality.as_dict(),
        "mesher": result.mesher,
        "attempts": [asdict(attempt) for attempt in result.attempts],
        "surfaces": {name: len(faces) for name, faces in result.mesh.surfaces.items()},
    }
