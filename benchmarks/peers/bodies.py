"""The examples' meshes, made by the stages of pagd, and where their tips go."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from performance.halving import halve

from pagd import config as configuration
from pagd.catalogue import NamedDesign, read_designs
from pagd.errors import InputError, Status
from pagd.files import write_text
from pagd.mesh.interface import STRUCTURED
from pagd.mesh.types import Mesh
from pagd.record import read_record
from pagd.stages import geometry, mesh, repair
from pagd.stages.mesh import mesh_file
from peers.kept import digest, source_digest

__all__ = ["Body", "made", "tip_displacement"]

FloatArray = NDArray[np.float64]

_ROOT = Path(__file__).parents[2]
_MADE_OF = "made_of.json"

# Nodes of one edge, in mm.
_SAME_PLACE = 1e-3


@dataclass(frozen=True, slots=True)
class Body:
    """A mesh to be solved.

    Attributes
    ----------
    design
        Name of a design of Table 2.
    mesher, size_mm
        Name of the mesher, and the size of its tetrahedra or blocks.
    half
        Whether half of it is meshed where it is symmetric.
    halvings
        How often every edge of the mesh is halved.
    """

    design: str
    mesher: str
    size_mm: float
    half: bool = False
    halvings: int = 0

    @property
    def name(self) -> str:
        """For files."""
        mesher = self.mesher.replace(":", ".")
        half, halved = "-half" if self.half else "", "-halved" * self.halvings
        return f"{self.design}-{mesher}-{self.size_mm:g}mm{half}{halved}"

    def config(self) -> dict[str, Any]:
        """Return the completed configuration of its stages."""
        settings = {
            "meshers": [self.mesher],
            "block_mm" if self.mesher == STRUCTURED else "size_mm": self.size_mm,
            "half_model": self.half,
            # A fine mesh takes its time.
            "time_limit_s": 1800,
        }
        return configuration.load(json.dumps({"mesh": settings}))


def made(body: Body, folder: Path) -> Path:
    """Mesh a body under ``folder``, unless that is done, and return the folder of its mesh.

    Raises
    ------
    InputError
        If there is no design of that name, or it cannot be meshed so.
    """
    out, named, config = folder / body.name, _design(body.design), body.config()
    halving = Path(halve.__code__.co_filename).read_text(encoding="utf-8")
    made_of = digest([named.as_json(), config["mesh"], source_digest(), halving])
    stamp = out / _MADE_OF
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == made_of:
        return out / "mesh"
    shutil.rmtree(out, ignore_errors=True)
    geometry.run(named, out / "geometry", config)
    repair.run(out / "geometry", out / "repair", config)
    mesh.run(out / "geometry", out / "repair", out / "mesh", config)
    record = read_record(out / "mesh")
    if record.status is not Status.ok:
        raise InputError(f"{body.name}: there is no mesh ({record.reason})")
    for _ in range(body.halvings):
        halve(mesh_file(out / "mesh"))
    write_text(stamp, made_of)
    return out / "mesh"


def _design(name: str) -> NamedDesign:
    designs = read_designs({"table2": str(_ROOT / "config" / "table2.csv")})
    if name not in designs:
        raise InputError(f"--designs: {name!r} must be one of {', '.join(designs)}.")
    return designs[name]


def tip_displacement(solid: Mesh, displacement: FloatArray) -> FloatArray:
    """Return the displacement (3,) in mm of the middle of the lower edge at the free end.

    By a parabola through the three nodes of the edge that are nearest to the middle, at y = 0.

    Parameters
    ----------
    solid
        The mesh of an actuator, or of its half.
    displacement
        Of its nodes, (n, 3) in mm.
    """
    x, y, z = solid.points.T
    tip = np.flatnonzero(x > x.max() - _SAME_PLACE)
    edge = tip[z[tip] < z[tip].min() + _SAME_PLACE]
    near = edge[np.argsort(np.abs(y[edge]))[:3]]
    a, b, c = y[near]
    weights = [
        b * c / ((a - b) * (a - c)),
        a * c / ((b - a) * (b - c)),
        a * b / ((c - a) * (c - b)),
    ]
    return np.asarray(weights @ displacement[near])
