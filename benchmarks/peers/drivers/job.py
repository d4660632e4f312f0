"""What every driver is given, and what it prints; needs nothing but numpy.

Called as ``python DRIVER.py MESH.npz JOB.json``. A driver solves one load step from rest by
Newton's method, and prints one JSON object: seconds of assembly and of the linear solution of each
iteration, the number of unknowns and the displacement of the tip.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Job", "Measured", "read_job"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Nodes of one edge, in mm.
_SAME_PLACE = 1e-3


@dataclass(frozen=True)
class Job:
    """A mesh and what to do with it.

    Attributes
    ----------
    points, tets
        Coordinates (n, 3) in mm, and ten-node tetrahedra (m, 10) in gmsh's order.
    surfaces
        Name to six-node triangles (k, 6); those of ``cavity`` point out of the solid.
    settings
        ``C10``, ``C20`` and ``bulk`` in MPa; ``paper`` with ``youngs_modulus`` in MPa,
        ``poisson_ratio`` and ``thickness`` in mm, or None; ``pressure_MPa``, ``iterations``,
        ``threads``, and for pagd ``element``, ``material`` and ``sheet``.
    """

    points: FloatArray
    tets: IntArray
    surfaces: dict[str, IntArray]
    settings: dict[str, Any]

    def tip_node(self) -> int:
        """Corner node of the lower edge of the free end that is nearest to its middle."""
        corners = np.unique(self.tets[:, :4])
        x, y, z = self.points[corners].T
        tip = np.flatnonzero(x > x.max() - _SAME_PLACE)
        edge = tip[z[tip] < z[tip].min() + _SAME_PLACE]
        return int(corners[edge[np.argmin(np.abs(y[edge]))]])

    def clamped(self) -> IntArray:
        """Nodes (k,) that are held."""
        return np.unique(self.surfaces["fixed"])


@dataclass
class Measured:
    """Seconds of each part of each iteration, and largest correction of a node in mm."""

    assembly_s: list[float] = field(default_factory=list)
    solve_s: list[float] = field(default_factory=list)
    correction_mm: list[float] = field(default_factory=list)

    @contextmanager
    def assembly(self) -> Iterator[None]:
        """Time residual and tangent of an iteration."""
        start = time.perf_counter()
        yield
        self.assembly_s.append(time.perf_counter() - start)

    @contextmanager
    def solve(self) -> Iterator[None]:
        """Time factorisation and solution of an iteration."""
        start = time.perf_counter()
        yield
        self.solve_s.append(time.perf_counter() - start)

    def tell(self, unknowns: int, tip: FloatArray, **more: Any) -> None:
        """Print the result: number of unknowns, displacement (3,) of the tip in mm, and more."""
        told = {"unknowns": unknowns, "tip_mm": np.asarray(tip).tolist(), **vars(self), **more}
        print(json.dumps(told))


def read_job() -> Job:
    """Read what the command line names."""
    mesh, settings = sys.argv[1:3]
    with np.load(mesh) as arrays:
        prefix = "surface_"
        return Job(
            points=arrays["points"],
            tets=arrays["tets"],
            surfaces={
                name.removeprefix(prefix): arrays[name]
                for name in arrays.files
                if name.startswith(prefix)
            },
            settings=json.loads(Path(settings).read_text("utf-8")),
        )
