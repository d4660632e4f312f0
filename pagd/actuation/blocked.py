"""Blocked force: what the actuator presses with where its tip cannot go.

Two variants, both from pressure zero on. ``edge``: the lower edge of the tip, the nodes farthest
along the actuator and lowest of these, keeps its height on a frictionless support; the force is
the support's reaction. ``plate``: a rigid frictionless plate lies under the base, at a distance;
the force is what the clamp has to hold against it, less the weight.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.body import Body, normals_of
from pagd.actuation.follow import follow
from pagd.actuation.recorder import Force, Recorder
from pagd.actuation.result import ActuationResult, Figures, Progress, Stop
from pagd.actuation.settings import SUPPORTS, Actuation
from pagd.errors import InputError
from pagd.fem.assembly import Assembly, State
from pagd.fem.contact import ContactLaw
from pagd.fem.plane_contact import PlaneContact
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_VERTICAL = 2
# Nodes of one edge, in mm: surfaces come with six digits.
_SAME_PLACE = 1e-3
# Faces that can come down on a plate look downwards or along the actuator by at least so much.
_LOOKS_DOWN = -0.5
_LOOKS_AHEAD = 0.5


def blocked_force(
    mesh: Mesh | Body,
    material: Elastomer,
    paper: Sheet,
    actuation: Actuation | None = None,
    stop: Stop | None = None,
    progress: Progress | None = None,
) -> ActuationResult:
    """Raise the pressure from zero with the tip held.

    Parameters
    ----------
    mesh, material, paper, stop, progress
        See :func:`pagd.actuation.free_actuation`; a :class:`Body` that went through free
        actuation brings the pairs of faces that came near each other there.
    actuation
        Pressures, element and tolerances; ``blocked_force`` tells what holds the tip.

    Returns
    -------
    ActuationResult
        With the column ``blocked_force_N`` of the history: force of the whole actuator on what
        holds it, in N, positive downwards (towards −z); gravity's share is in it.

    Raises
    ------
    InputError
        Where the mesh or the settings cannot be used, or nothing is to hold the tip.
    """
    wanted = actuation or Actuation()
    if wanted.blocked_force not in SUPPORTS[:-1]:
        raise InputError(
            f"blocked_force is {wanted.blocked_force!r}, but must be one of edge, plate for an "
            "analysis of the blocked force"
        )
    body = mesh if isinstance(mesh, Body) else Body(mesh, material, paper, wanted)
    held = _on_edge(body) if wanted.blocked_force == "edge" else _on_plate(body, wanted)
    assembly, force = held
    result = follow(body, assembly, wanted, Recorder(body, stop, progress, force))
    last = float(result.history["blocked_force_N"][result.history["recorded"]][-1])
    figures: Figures = {"variant": wanted.blocked_force, "blocked_force_N": last}
    return replace(result, figures=result.figures | figures)


def _on_edge(body: Body) -> tuple[Assembly, Force]:
    held = 3 * tip_edge(body.mesh) + _VERTICAL
    fixed = body.fixed.copy()
    fixed[held] = True
    assembly = Assembly(body.terms, body.size, fixed)

    def force(state: State) -> float:
        energy, residual = assembly.residual_near(state)
        return body.copies * float(residual[held].sum()) if np.isfinite(energy) else np.nan

    return assembly, force


def _on_plate(body: Body, actuation: Actuation) -> tuple[Assembly, Force]:
    mesh, law = body.mesh, ContactLaw()
    # Contact begins at the law's width: without it the plate would press from the start.
    below = actuation.plate_distance_mm + law.width
    point = np.array([0.0, 0.0, mesh.points[:, _VERTICAL].min() - below])
    plate = PlaneContact(mesh.points, _lower_faces(mesh), point, np.array([0.0, 0.0, 1.0]), law)
    assembly = Assembly((*body.terms, plate), body.size, body.fixed)
    fixed = np.flatnonzero(body.fixed[: 3 * body.nodes])
    clamp = fixed[fixed % 3 == _VERTICAL]
    weight = float(body.gravity.weight[_VERTICAL]) if body.gravity else 0.0

    def force(state: State) -> float:
        # By balance with the clamp, since pressure has no resultant: the penalty is so stiff that
        # its own force would show the last thousandth of a millimetre.
        energy, residual = assembly.residual_near(state)
        if not np.isfinite(energy):
            return np.nan
        return -body.copies * (float(residual[clamp].sum()) + weight)

    return assembly, force


def tip_edge(mesh: Mesh) -> IntArray:
    """Nodes of the lower edge of the tip: farthest along x, and lowest of these."""
    x, z = mesh.points[:, 0], mesh.points[:, _VERTICAL]
    tip = np.flatnonzero(x > x.max() - _SAME_PLACE)
    return np.asarray(tip[z[tip] < z[tip].min() + _SAME_PLACE])


def _lower_faces(mesh: Mesh) -> IntArray:
    """Outer faces that look down or ahead."""
    if "outer" not in mesh.surfaces:
        raise InputError(
            "blocked_force = plate: the mesh has no surface 'outer' that could touch the plate."
        )
    faces = mesh.surfaces["outer"]
    normals = normals_of(mesh.points, faces)
    chosen = (normals[:, _VERTICAL] < _LOOKS_DOWN) | (normals[:, 0] > _LOOKS_AHEAD)
    return np.asarray(faces[chosen])
