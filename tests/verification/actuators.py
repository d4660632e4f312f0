"""Meshes of the example designs, made as every mesh is: drawn, repaired, meshed."""

from __future__ import annotations

import tempfile
from functools import lru_cache
from pathlib import Path

import numpy as np
from solving import FloatArray

from pagd.catalogue import read_designs
from pagd.design import Channel, Design, GeometryRules
from pagd.geometry import render
from pagd.materials import Elastomer, Sheet, elastomer, find_material, sheet
from pagd.mesh.chamber_row import chamber_row
from pagd.mesh.gmsh_mesher import GmshMesher
from pagd.mesh.interface import Mesher
from pagd.mesh.surfaces import SurfacePair
from pagd.mesh.types import Mesh
from pagd.metrics import Trajectory, measure
from pagd.repair import repair
from pagd.sections import place_sections, stations_of

ROOT = Path(__file__).parents[2]

_MATERIALS = ROOT / "config" / "materials.yaml"


def design(name: str) -> Design:
    """One of the three designs of Table 2."""
    return read_designs({"table2": str(ROOT / "config" / "table2.csv")})[name].design


def default_elastomer() -> Elastomer:
    return elastomer("elastosil_m4601", find_material(_MATERIALS, "elastosil_m4601"))


def default_paper() -> Sheet:
    return sheet("paper", find_material(_MATERIALS, "paper", "paper"))


def mesh_of(name: str, size: float, half: bool = False) -> Mesh:
    """Mesh of a design of Table 2 with elements of a size (mm), or of its half y ≥ 0."""
    return mesh_of_design(design(name), size, half)


@lru_cache(maxsize=8)
def mesh_of_design(
    drawn: Design, size: float, half: bool = False, mesher: Mesher | None = None
) -> Mesh:
    """The same for any design; by gmsh unless another mesher is given."""
    with tempfile.TemporaryDirectory() as folder:
        parts = []
        for part in ("body", "base"):
            raw, repaired = Path(folder, f"{part}.stl"), Path(folder, f"{part}_repaired.stl")
            render(drawn, GeometryRules(), part, raw, half=half)
            repair(raw, repaired)
            parts.append(repaired)
        return (mesher or GmshMesher())(SurfacePair.from_stl(*parts, half), size)


def block_mesh(name: str, size: float) -> Mesh:
    """The same of blocks up to a size (mm); of the half y ≥ 0 where the design is symmetric."""
    drawn = design(name)
    return chamber_row(drawn, Channel(), size, half=drawn.is_straight)


def mirrored(mesh: Mesh) -> Mesh:
    """The mirror image about y = 0; connectivities turn round, so that volumes stay positive."""
    # Corners 0 and 1 change places, and with them the edges (1,2)–(2,0) and (3,0)–(1,3).
    tets = mesh.tets[:, [1, 0, 2, 3, 4, 6, 5, 9, 8, 7]]
    surfaces = {name: faces[:, [1, 0, 2, 3, 5, 4]] for name, faces in mesh.surfaces.items()}
    return Mesh(points=mesh.points * [1, -1, 1], tets=tets, surfaces=surfaces)


def whole_of(half: Mesh) -> Mesh:
    """A half and its mirror image as one mesh; nodes of the symmetry plane are shared."""
    other = mirrored(half)
    shared = half.nodes_of("symmetry")
    kept = np.setdiff1d(np.arange(len(half.points)), shared)
    numbers = np.empty(len(half.points), np.int64)
    numbers[shared] = shared
    numbers[kept] = len(half.points) + np.arange(len(kept))
    surfaces = {
        name: np.vstack([faces, numbers[other.surfaces[name]]])
        for name, faces in half.surfaces.items()
        if name != "symmetry"
    }
    return Mesh(
        points=np.vstack([half.points, other.points[kept]]),
        tets=np.vstack([half.tets, numbers[other.tets]]),
        surfaces=surfaces,
    )


def trajectory(
    name: str, mesh: Mesh, pressure_kPa: FloatArray, displacement: FloatArray
) -> Trajectory:
    """Where the chambers of a design of Table 2 are at each pressure, and how they have turned."""
    return trajectory_of_design(design(name), mesh, pressure_kPa, displacement)


def trajectory_of_design(
    drawn: Design, mesh: Mesh, pressure_kPa: FloatArray, displacement: FloatArray
) -> Trajectory:
    """The same for any design."""
    half = "symmetry" in mesh.surfaces
    stations = stations_of(drawn)
    sections = place_sections(mesh.points, mesh.surfaces["paper"], stations, mirrored=half)
    return measure(sections, pressure_kPa, displacement)
