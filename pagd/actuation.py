"""Free actuation: an actuator held at one end, its cavity under rising pressure.

Knows surfaces by name, nothing of chambers: ``fixed`` is held, ``cavity`` carries
the follower pressure, ``paper`` is a shell, ``symmetry`` a plane y = 0. The same
pressures are recorded for every design, so that designs can be compared.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError, Status
from pagd.fem.assembly import Assembly
from pagd.fem.bending import bending_terms
from pagd.fem.contact import FaceContact
from pagd.fem.continuation import Continuation, LoadPath, Step, StepControl
from pagd.fem.fields import share_beyond, strains
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.linear_solver import linear_solver
from pagd.fem.membrane import Membrane
from pagd.fem.newton import Newton, NewtonSettings
from pagd.fem.solid import ElementPressureSolid, TaylorHoodSolid
from pagd.fem.term import EnergyTerm
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]

ELEMENTS = ("taylor_hood", "element_pressure")

_KPA = 1e-3  # MPa

#: Share of the volume that may be stretched beyond the material's limit.
OVERSTRETCHED_SHARE = 0.01


@dataclass(frozen=True, slots=True, kw_only=True)
class Actuation:
    """What to do: pressures in kPa, element, tolerances.

    Attributes
    ----------
    element
        ``taylor_hood`` (P2–P1) or ``element_pressure`` (P2–P0).
    maximum_pressure_kPa, recorded_step_kPa
        Pressure at the end; a state is recorded every so much, and at the end.
    first_step_kPa, smallest_step_kPa
        First step of the pressure; step below which the analysis is given up.
    tolerance_mm
        Largest correction of a node in the last iteration of a step.
    linear_solver
        ``auto``, ``pardiso`` or ``superlu``.
    contact
        Whether neighbouring chambers press each other apart where they touch, without friction.
    """

    element: str = "taylor_hood"
    maximum_pressure_kPa: float = 50.0
    recorded_step_kPa: float = 5.0
    first_step_kPa: float = 0.25
    smallest_step_kPa: float = 0.02
    tolerance_mm: float = 1e-2
    linear_solver: str = "auto"
    contact: bool = False

    def recorded_kPa(self) -> FloatArray:
        """The recorded pressures, in kPa."""
        count = int(np.floor(self.maximum_pressure_kPa / self.recorded_step_kPa + 1e-9))
        steps = self.recorded_step_kPa * np.arange(1, count + 1)
        if count and self.maximum_pressure_kPa - steps[-1] < 1e-9 * self.maximum_pressure_kPa:
            steps[-1] = self.maximum_pressure_kPa
            return np.asarray(steps)
        return np.append(steps, self.maximum_pressure_kPa)


@dataclass(frozen=True, slots=True)
class RecordedState:
    """A state at a recorded pressure.

    ``displacement`` (n, 3) in mm, ``strain`` (n,) largest principal logarithmic strain at the
    nodes, ``strain_max`` and ``strain_p99`` its largest value and 99th percentile by volume.
    """

    pressure_kPa: float
    displacement: FloatArray
    strain: FloatArray
    strain_max: float
    strain_p99: float


@dataclass(frozen=True, slots=True)
class ActuationResult:
    """How the analysis ended, and everything up to there.

    Attributes
    ----------
    status, reason
        ``ok``, or why the last pressure was not reached.
    states
        The unloaded state first, then the recorded pressures that were reached, and last the
        state at which the analysis ended early, whatever its pressure.
    history
        One row a converged step, the unloaded state first: ``pressure_kPa``,
        ``cavity_volume_mm3`` and ``stored_energy_mJ`` of the whole actuator,
        ``newton_iterations``.
    figures
        Counts: ``tets``, ``unknowns``, ``newton_iterations``, ``steps``,
        ``rejected_steps``; ``pressure_kPa`` reached; ``solid_volume_mm3`` of the whole
        actuator; ``linear_solver``; with contact ``smallest_gap_mm`` between walls at the end,
        negative for a penetration, where any are near.
    """

    status: Status
    reason: str | None
    states: list[RecordedState]
    history: dict[str, FloatArray]
    figures: dict[str, float | int | str]


#: Looks at the displacement (n, 3) of a converged step; may end the analysis.
Stop = Callable[[float, FloatArray], tuple[Status, str] | None]

#: Is told the pressure in kPa and the iterations of every converged step.
Progress = Callable[[float, int], None]


@dataclass(slots=True)
class _Recorder:
    """Collects what the path leaves."""

    body: Body
    stop: Stop | None
    progress: Progress | None
    states: list[RecordedState] = field(default_factory=list)
    rows: list[tuple[float, float, float, int]] = field(default_factory=list)
    last: FloatArray | None = None
    ending: tuple[Status, str] | None = None

    def __call__(self, step: Step) -> str | None:
        """Note a converged step; a reason to stop, if there is one."""
        pressure, self.last = step.state.load / _KPA, step.state.unknowns
        volume, energy = self.body.volume_and_energy(self.last, step.state.load)
        self.rows.append((pressure, volume, energy, step.iterations))
        if step.wanted:
            self.record_last()
        if self.progress:
            self.progress(pressure, step.iterations)
        self.ending = self._overstretched(self.last)
        if self.ending is None and self.stop:
            self.ending = self.stop(pressure, self.body.displacement(self.last))
        return self.ending[1] if self.ending else None

    def record_last(self) -> None:
        """Record the last converged state, unless it is recorded already."""
        pressure, unknowns = self.rows[-1][0], self.last
        if unknowns is None or (self.states and self.states[-1].pressure_kPa == pressure):
            return
        found = strains(self.body.solid, unknowns, self.body.nodes)
        displacement = self.body.displacement(unknowns)
        self.states.append(
            RecordedState(pressure, displacement, found.nodes, found.largest, found.percentile_99)
        )

    def _overstretched(self, unknowns: FloatArray) -> tuple[Status, str] | None:
        limit = self.body.material.largest_stretch
        share = share_beyond(self.body.solid, unknowns, limit)
        if share <= OVERSTRETCHED_SHARE:
            return None
        return Status.overstretched, (
            f"The stretch exceeds {limit:g}, the limit of {self.body.material.name}, in "
            f"{share:.1%} of the volume; {OVERSTRETCHED_SHARE:.0%} is allowed."
        )


class Body:
    """The actuator as a finite-element model.

    Parameters
    ----------
    mesh
        Quadratic tetrahedra with the surfaces ``fixed`` and ``cavity``; ``paper`` and
        ``symmetry`` where there are such.
    material, paper
        The elastomer, and the sheet at the surface ``paper``.
    element
        One of :data:`ELEMENTS`.
    contact
        Whether walls that face each other press each other apart where they touch.

    Raises
    ------
    InputError
        Where a surface is missing, the element unknown, or the paper not flat.
    """

    def __init__(
        self,
        mesh: Mesh,
        material: Elastomer,
        paper: Sheet,
        element: str,
        *,
        contact: bool = False,
    ) -> None:
        if element not in ELEMENTS:
            raise InputError(f"element is {element!r}, but must be one of {', '.join(ELEMENTS)}")
        self.material = material
        self.nodes = len(mesh.points)
        self.copies = 2 if "symmetry" in mesh.surfaces else 1
        self.size = 3 * self.nodes
        self.solid: TaylorHoodSolid | ElementPressureSolid
        if element == "taylor_hood":
            self.solid = TaylorHoodSolid(mesh.points, mesh.tets, material, self.size)
            self.size += self.solid.pressures
        else:
            self.solid = ElementPressureSolid(mesh.points, mesh.tets, material)
        self.pressure = FollowerPressure(mesh.points, _cavity(mesh))
        terms: list[EnergyTerm] = [self.solid, self.pressure, *_paper_terms(mesh, paper)]
        self.contact = _contact(mesh) if contact else None
        terms += [self.contact] if self.contact else []
        self.assembly = Assembly(terms, self.size, self._fixed(mesh))

    def _fixed(self, mesh: Mesh) -> NDArray[np.bool_]:
        fixed = np.zeros(self.size, dtype=np.bool_)
        fixed[(3 * mesh.nodes_of("fixed")[:, None] + np.arange(3)).ravel()] = True
        if "symmetry" in mesh.surfaces:
            fixed[3 * mesh.nodes_of("symmetry") + 1] = True
        return fixed

    def displacement(self, unknowns: FloatArray) -> FloatArray:
        """Displacements (n, 3) in mm."""
        return np.asarray(unknowns[: 3 * self.nodes].reshape(-1, 3).copy())

    def volume_and_energy(self, unknowns: FloatArray, load: float) -> tuple[float, float]:
        """Cavity volume in mm³ and stored energy in mJ, of the whole actuator."""
        volume = self.pressure.volume(unknowns)
        stored = sum(
            term.energy(unknowns, load) for term in self.assembly.terms if term is not self.pressure
        )
        return self.copies * volume, self.copies * stored

    @property
    def solid_volume(self) -> float:
        """Volume of elastomer of the whole actuator, in mm³."""
        return self.copies * float(self.solid.weights.sum())


def _cavity(mesh: Mesh) -> NDArray[np.int64]:
    mesh.nodes_of("cavity")  # says which surfaces there are where this is missing
    return mesh.surfaces["cavity"]


def _paper_terms(mesh: Mesh, paper: Sheet) -> list[EnergyTerm]:
    """Membrane and bending of the paper; nothing where the mesh has no such surface."""
    if "paper" not in mesh.surfaces:
        return []
    faces = mesh.surfaces["paper"]
    symmetry = mesh.nodes_of("symmetry") if "symmetry" in mesh.surfaces else None
    bending = bending_terms(
        mesh.points, faces, paper, clamped=mesh.nodes_of("fixed"), symmetry=symmetry
    )
    return [Membrane(mesh.points, faces, paper), *bending]


def _contact(mesh: Mesh) -> FaceContact | None:
    """Contact of the outer faces that look along the actuator with those that look back."""
    if "outer" not in mesh.surfaces:
        return None
    faces = mesh.surfaces["outer"]
    corners = mesh.points[faces[:, :3]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    along = normals[:, 0] / np.linalg.norm(normals, axis=1)
    slaves, masters = faces[along > _LOOKS_ALONG], faces[along < -_LOOKS_ALONG]
    if len(slaves) == 0 or len(masters) == 0:
        return None
    return FaceContact(mesh.points, slaves, masters)


# Walls are slanted by up to 45° to the actuator; nothing else of the outside looks along it.
_LOOKS_ALONG = 0.5

# Where points come into contact or leave it, corrections need not shrink at once.
_PATIENT: dict[str, Any] = {"iterations": 14, "growth": 2.0}


def free_actuation(
    mesh: Mesh,
    material: Elastomer,
    paper: Sheet,
    actuation: Actuation | None = None,
    stop: Stop | None = None,
    progress: Progress | None = None,
) -> ActuationResult:
    """Raise the pressure from zero, as far as the actuator goes.

    Parameters
    ----------
    mesh
        The actuator; ``fixed`` is held, ``cavity`` carries the pressure.
    material, paper
        The elastomer and the paper.
    actuation
        Pressures, element and tolerances.
    stop
        Called with the pressure in kPa and the displacement (n, 3) of each converged step;
        a status and a reason end the analysis.
    progress
        Called with the pressure in kPa and the iterations of each converged step.

    Returns
    -------
    ActuationResult
        Not reaching the last pressure is a result: its status and reason say why.

    Raises
    ------
    InputError
        Where the mesh or the settings cannot be used.
    """
    wanted = actuation or Actuation()
    body = Body(mesh, material, paper, wanted.element, contact=wanted.contact)
    solver = linear_solver(wanted.linear_solver)
    recorder = _Recorder(body, stop, progress)
    recorder(Step(body.assembly.at_rest(), 0, True))
    settings = NewtonSettings(tolerance=wanted.tolerance_mm, **(_PATIENT if body.contact else {}))
    control = StepControl(
        first=wanted.first_step_kPa * _KPA, smallest=wanted.smallest_step_kPa * _KPA
    )
    newton = Newton(body.assembly, solver, 3 * body.nodes, settings, body.pressure)
    path = Continuation(newton, control).follow(list(wanted.recorded_kPa() * _KPA), recorder)
    # Where the path ends early, how far it came is a result too.
    recorder.record_last()
    solver.free()
    status, reason = _ending(path, recorder)
    names = ("pressure_kPa", "cavity_volume_mm3", "stored_energy_mJ", "newton_iterations")
    columns = np.array(recorder.rows).T
    return ActuationResult(
        status=status,
        reason=reason,
        states=recorder.states,
        history=dict(zip(names, columns, strict=True)),
        figures=_figures(body, path, solver.name),
    )


def _ending(path: LoadPath, recorder: _Recorder) -> tuple[Status, str | None]:
    if recorder.ending:
        return recorder.ending
    if path.failure:
        return Status.not_converged, (
            f"No step beyond {path.load / _KPA:.4g} kPa converged ({path.failure})."
        )
    return Status.ok, None


def _figures(body: Body, path: LoadPath, solver: str) -> dict[str, float | int | str]:
    return _gap(body) | {
        "tets": len(body.solid.nodes),
        "unknowns": len(body.assembly.free),
        "newton_iterations": path.iterations,
        "steps": path.steps,
        "rejected_steps": path.rejected,
        "pressure_kPa": path.load / _KPA,
        "solid_volume_mm3": body.solid_volume,
        "linear_solver": solver,
    }


def _gap(body: Body) -> dict[str, float | int | str]:
    """Smallest gap between walls at the end, in mm; nothing where no two are near each other."""
    gap = body.contact.smallest_gap if body.contact else np.inf
    return {"smallest_gap_mm": gap} if np.isfinite(gap) else {}


def use_threads(count: int) -> None:
    """Let the kernels and the linear solver use ``count`` threads.

    To be called before the first analysis: MKL reads its setting when it is loaded.
    """
    import numba
    from numba import config

    for variable in ("MKL_NUM_THREADS", "OMP_NUM_THREADS"):
        os.environ[variable] = str(count)
    numba.set_num_threads(min(count, config.NUMBA_NUM_THREADS))  # type: ignore[attr-defined]
