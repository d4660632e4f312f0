"""Newton iterations of FElupe: quadratic tetrahedra with one pressure each, condensed (P2–P0).

FElupe has no membrane in space, so that there is no paper.
"""

from __future__ import annotations

from typing import Any

import felupe
import numpy as np
from felupe_cavity import FELUPE_ORDER, cavity_field
from job import FloatArray, Job, Measured, read_job
from pypardiso import PyPardisoSolver

_REAL_UNSYMMETRIC = 11


class Yeoh:
    """Isochoric Yeoh, C10 (Ī₁ − 3) + C20 (Ī₁ − 3)², by FElupe's own neo-Hookean law of µ = 2."""

    def __init__(self, C10: float, C20: float) -> None:
        self.C10, self.C20 = C10, C20
        self._invariant = felupe.NeoHooke(mu=2.0)  # its energy is Ī₁ − 3
        self.x = self._invariant.x

    def _excess(self, x: list[FloatArray]) -> Any:
        return self._invariant.function(x)[0]

    def gradient(self, x: list[FloatArray]) -> list[Any]:
        """First derivative by the deformation gradient, and the state variables as they are."""
        slope, state = self._invariant.gradient(x)
        return [(self.C10 + 2 * self.C20 * self._excess(x)) * slope, state]

    def hessian(self, x: list[FloatArray]) -> list[Any]:
        """Second derivative."""
        slope, _ = self._invariant.gradient(x)
        curved = self._invariant.hessian(x)[0]
        curved *= self.C10 + 2 * self.C20 * self._excess(x)
        curved += 2 * self.C20 * felupe.math.dya(slope, slope)
        return [curved]


def run(job: Job) -> None:
    """Iterate at the pressure of the job, from rest, and print the seconds."""
    settings = job.settings
    tets = job.tets[:, FELUPE_ORDER]
    mesh = felupe.Mesh(job.points, tets, "tetra10")
    field = felupe.FieldContainer([felupe.Field(felupe.RegionQuadraticTetra(mesh), dim=3)])
    umat = Yeoh(settings["C10"], settings["C20"])
    solid = felupe.SolidBodyNearlyIncompressible(umat, field, bulk=settings["bulk"])
    walls = cavity_field(job.points, tets, job.surfaces["cavity"])
    load = felupe.SolidBodyPressure(walls, settings["pressure_MPa"])
    held, free = _unknowns(job)
    measured, solver = Measured(), PyPardisoSolver(mtype=_REAL_UNSYMMETRIC)
    threads = settings["threads"] > 1
    for _ in range(settings["iterations"]):
        with measured.assembly():
            forces, tangent = _assembled(solid, load, field, threads)
            matrix = felupe.solve.partition(field, tangent, free, held)[2]
        correction = np.zeros(job.points.size)
        with measured.solve():
            correction[free] = solver.solve(matrix.tocsr(), -forces[free])
        field += [correction]
        measured.correction_mm.append(float(np.abs(correction).max()))
    tip = field[0].values[job.tip_node()]
    measured.tell(len(free), tip, solver="pardiso, unsymmetric")


def _assembled(solid: Any, load: Any, field: Any, threads: bool) -> tuple[FloatArray, Any]:
    """Residual (3 n,) and tangent, as FElupe's own Newton iteration adds them up."""
    load.field.link(field)
    forces = solid.assemble.vector(field, parallel=threads)
    # The minus sign of a load is FElupe's convention.
    forces = forces - load.assemble.vector(load.field, parallel=threads)
    tangent = solid.assemble.matrix(parallel=threads)
    tangent = tangent - load.assemble.matrix(parallel=threads)
    return forces.toarray()[:, 0], tangent


def _unknowns(job: Job) -> tuple[Any, Any]:
    """Numbers of the unknowns that are held, and of the others."""
    held = (3 * job.clamped()[:, None] + np.arange(3)).ravel()
    return held, np.setdiff1d(np.arange(job.points.size), held)


if __name__ == "__main__":
    run(read_job())
