"""A short actuator on three nested meshes: the order at which its results come in."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from actuators import (
    default_elastomer,
    default_paper,
    design,
    mesh_of_design,
    trajectory_of_design,
)
from figure import Figure
from refinement import ORDER, halved, limit_of, observed_order, solve_again
from solving import Solved, solve

from pagd.actuation import Actuation, Body
from pagd.fem import shapes
from pagd.fem.quadrature import triangle
from pagd.mesh.types import Mesh

PRESSURE = 0.005  # MPa
#: Two chambers of the bending design.
SHORT = replace(design("bending"), N=2)
SIZE = 8.0  # mm


@dataclass(frozen=True)
class Level:
    """The results on a mesh, in mm, mm³ and degrees."""

    tip: float
    volume: float
    bending: float


def nested_meshes() -> list[Figure]:
    """Two chambers of the bending design (half model) at 5 kPa, on 8 mm, its halves and theirs.

    The inward edges of the cavity make the order of the whole mesh 1.09; the mean of the tip's
    face and the volume of the cavity show it to within some 10 %. The rows of errors are those of
    the mesh halved once: the estimate by it and the one before, beside the difference to the limit
    by it and the one after. The bending angle, of strips of the paper some 1 mm long, does not
    show this order yet on elements of 8 to 2 mm: its error is 1.7 times the estimate.
    """
    first, second, third = _levels()
    return [
        *_rows("tip z, mean of the face", "mm", (first.tip, second.tip, third.tip), 0.12),
        *_rows("volume that is let in", "mm³", (first.volume, second.volume, third.volume), 0.1),
        _error("bending", "°", (first.bending, second.bending, third.bending), 0.5),
    ]


def _levels() -> list[Level]:
    body = _body(mesh_of_design(SHORT, SIZE, half=True))
    fixed = body.fixed[: 3 * body.nodes].reshape(-1, 3)
    (state,) = solve(body.mesh.points, body.terms, fixed, [PRESSURE], tolerance=1e-3)
    levels = [_level(body, state)]
    for _ in range(2):
        fine = _body(halved(body.mesh))
        fixed = fine.fixed[: 3 * fine.nodes].reshape(-1, 3)
        state, body = solve_again(body, fine, state, fixed, PRESSURE), fine
        levels.append(_level(body, state))
    return levels


def _body(mesh: Mesh) -> Body:
    """Without contact: no walls touch at this pressure."""
    return Body(mesh, default_elastomer(), default_paper(), Actuation(contact=False))


def _level(body: Body, state: Solved) -> Level:
    pressures, states = np.array([0.0, PRESSURE]), np.array([0, 1])[:, None, None]
    path = trajectory_of_design(SHORT, body.mesh, pressures, states * state.displacement)
    volume = body.volume(state.unknowns) - body.volume(0 * state.unknowns)
    return Level(_mean_of_tip(body.mesh, state), volume, float(path.bending_deg[-1, -1]))


def _mean_of_tip(mesh: Mesh, state: Solved) -> float:
    """Displacement along z of the face at the tip, mean over its area."""
    faces, rule = mesh.surfaces["tip"], triangle(4)
    corners = mesh.points[faces[:, :3]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    nodal = state.displacement[faces, 2]
    means = nodal @ shapes.triangle_values(rule.points).T @ rule.weights / rule.weights.sum()
    return float(np.average(means, weights=np.linalg.norm(normals, axis=1)))


def _rows(
    what: str, unit: str, values: tuple[float, float, float], tolerance: float
) -> list[Figure]:
    order = Figure(
        name=f"two chambers, 8 mm and halves: order of the {what}",
        source="theory: inward edges, 2 x 0.5445 (Williams 1952)",
        reference=ORDER,
        value=observed_order(*values),
        tolerance=0.2,
    )
    return [order, _error(what, unit, values, tolerance)]


def _error(what: str, unit: str, values: tuple[float, float, float], tolerance: float) -> Figure:
    first, second, third = values
    return Figure(
        name=f"two chambers, 8 mm halved: estimated error of the {what}",
        source="difference to the limit from the mesh and its halves",
        reference=limit_of(second, third) - second,
        value=limit_of(first, second) - second,
        tolerance=tolerance,
        unit=unit,
    )
