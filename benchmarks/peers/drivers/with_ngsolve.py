"""Newton iterations of NGSolve: P2–P1 by a symbolic energy, differentiated automatically."""

from __future__ import annotations

from typing import Any

import netgen.meshing
import ngsolve
import numpy as np
from job import Job, Measured, read_job
from ngsolve import (
    Cof,
    Det,
    Grad,
    Id,
    InnerProduct,
    OuterProduct,
    Trace,
    Variation,
    ds,
    dx,
    x,
    y,
    z,
)

# Of the direct solvers that NGSolve has, in the order of their speed here.
_SOLVERS = ("pardiso", "sparsecholesky", "umfpack")


def run(job: Job) -> None:
    """Iterate at the pressure of the job, from rest, and print the seconds."""
    settings = job.settings
    ngsolve.ngsglobals.msg_level = 0
    ngsolve.SetNumThreads(settings["threads"])
    mesh = _mesh(job)
    displacements = ngsolve.VectorH1(mesh, order=2, dirichlet="fixed")
    space = displacements * ngsolve.H1(mesh, order=1)
    form = ngsolve.BilinearForm(space, symmetric=True)
    for energy in _energies(space, settings):
        form += energy
    measured, found = Measured(), ngsolve.GridFunction(space)
    residual, correction = found.vec.CreateVector(), found.vec.CreateVector()
    inverse: Any = None
    with ngsolve.TaskManager():
        for _ in range(settings["iterations"]):
            with measured.assembly():
                form.Apply(found.vec, residual)
                form.AssembleLinearization(found.vec)
            with measured.solve():
                if inverse is None:
                    inverse, name = _inverse(form, space)
                else:
                    inverse.Update()
                correction.data = inverse * residual
            found.vec.data -= correction
            moved = correction.FV().NumPy()[: displacements.ndof]
            measured.correction_mm.append(float(np.abs(moved).max()))
    # The first unknowns of each component are the values at the corners, in their order.
    corner = int(np.searchsorted(np.unique(job.tets[:, :4]), job.tip_node()))
    components = np.split(found.vec.FV().NumPy()[: displacements.ndof], 3)
    free = sum(space.FreeDofs())
    measured.tell(free, np.array([one[corner] for one in components]), solver=name)


def _mesh(job: Job) -> Any:
    """The corners' tetrahedra; edges are straight, so that the quadratic mesh is the same."""
    corners, numbers = np.unique(job.tets[:, :4], return_inverse=True)
    known = np.full(len(job.points), -1)
    known[corners] = np.arange(len(corners))
    mesh = netgen.meshing.Mesh(dim=3)
    mesh.AddPoints(np.ascontiguousarray(job.points[corners]))
    tets = numbers.reshape(-1, 4).astype(np.int32)
    mesh.AddElements(dim=3, index=1, data=np.ascontiguousarray(tets), base=0)
    names = [name for name in ("fixed", "cavity", "paper") if name in job.surfaces]
    for index, name in enumerate(names, start=1):
        inner = 1 if name == "paper" else 0
        mesh.Add(netgen.meshing.FaceDescriptor(bc=index, domin=1, domout=inner, surfnr=index))
        faces = known[job.surfaces[name][:, :3]].astype(np.int32)
        mesh.AddElements(dim=2, index=index, data=np.ascontiguousarray(faces), base=0)
        mesh.SetBCName(index - 1, name)
    return ngsolve.Mesh(mesh)


def _energies(space: Any, settings: dict[str, Any]) -> list[Any]:
    (u, p), normal = space.TrialFunction(), ngsolve.specialcf.normal(3)
    gradient = Id(3) + Grad(u)
    volume = Det(gradient)
    excess = volume ** (-2 / 3) * Trace(gradient.trans * gradient) - 3
    solid = settings["C10"] * excess + settings["C20"] * excess * excess
    solid += p * (volume - 1) - p * p / (2 * settings["bulk"])
    surface = Id(3) + Grad(u).Trace()
    # Normals point out of the solid, into the cavity.
    place = ngsolve.CF((x, y, z)) + u
    load = settings["pressure_MPa"] / 3 * InnerProduct(place, Cof(surface) * normal)
    energies = [Variation(solid.Compile() * dx), Variation(load.Compile() * ds("cavity"))]
    if settings["paper"]:
        sheet = _membrane(surface, normal, settings["paper"])
        energies.append(Variation(sheet.Compile() * ds("paper")))
    return energies


def _membrane(surface: Any, normal: Any, paper: dict[str, float]) -> Any:
    """Energy of the sheet by area: linear elastic in the Green strain of its plane."""
    tangential = Id(3) - OuterProduct(normal, normal)
    strain = 0.5 * tangential * (surface.trans * surface - Id(3)) * tangential
    ratio = paper["poisson_ratio"]
    stiffness = paper["youngs_modulus"] * paper["thickness"] / (1 - ratio**2)
    trace = Trace(strain)
    return stiffness / 2 * (ratio * trace * trace + (1 - ratio) * InnerProduct(strain, strain))


def _inverse(form: Any, space: Any) -> tuple[Any, str]:
    for name in _SOLVERS:
        try:
            return form.mat.Inverse(space.FreeDofs(), inverse=name), name
        except Exception:  # all that NGSolve raises where it was built without a solver
            continue
    raise RuntimeError(f"NGSolve has none of the solvers {', '.join(_SOLVERS)}")


if __name__ == "__main__":
    run(read_job())
