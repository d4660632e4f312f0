"""The example designs on finer and finer meshes: what is left of them in the limit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from actuators import default_elastomer, default_paper, mesh_of, trajectory
from figure import Figure
from refinement import halved, solve_again
from solving import BoolArray, FloatArray, Solved, solve

from pagd.actuation import Body
from pagd.actuation.blocked import tip_edge
from pagd.mesh.types import Mesh

PRESSURE = 0.01  # MPa
#: Mesh sizes in mm of the meshes that are drawn; the first and the last are halved too.
SIZES = (5.0, 4.0, 3.0)
ORDERS = np.linspace(1.0, 4.0, 301)


@dataclass(frozen=True)
class Found:
    """The results on a mesh of so many tetrahedra: by name, in mm, degrees and N."""

    mesh: str
    tets: int
    results: dict[str, float]

    @property
    def size(self) -> float:
        """What the error depends on: thin walls have smaller elements than the mesh size says."""
        return float(self.tets ** (-1 / 3))


@dataclass(frozen=True)
class Limit:
    """The limit f₀ and the order p of f₀ + C hᵖ."""

    value: float
    order: float


def limit_of(sizes: Sequence[float], values: Sequence[float]) -> Limit:
    """Fit f₀ + C hᵖ, 1 ≤ p ≤ 4, to values on meshes of sizes h, by least squares.

    Richardson's three meshes would do if they were similar; meshes that are drawn anew scatter
    (Eça, Hoekstra, *J. Comput. Phys.* 262 (2014) 104).
    """
    fits = [_fit(np.array(sizes), np.array(values), order) for order in ORDERS]
    best = int(np.argmin([residual for _, residual in fits]))
    return Limit(fits[best][0], float(ORDERS[best]))


def _fit(sizes: FloatArray, values: FloatArray, order: float) -> tuple[float, float]:
    """Limit and sum of squared residuals at an order."""
    powers = np.column_stack([np.ones_like(sizes), sizes**order])
    solution = np.linalg.lstsq(powers, values, rcond=None)[0]
    return float(solution[0]), float(((powers @ solution - values) ** 2).sum())


def bending_meshes() -> list[Figure]:
    """The bending design, half model, at 10 kPa."""
    return rows("bending", study("bending"))


def twisting_meshes() -> list[Figure]:
    """The twisting design at 10 kPa, otherwise as the bending one."""
    return rows("twisting", study("twisting"))


def mixed_meshes() -> list[Figure]:
    """The mixed design at 10 kPa, otherwise as the bending one."""
    return rows("mixed", study("mixed"))


def study(name: str) -> list[Found]:
    """Meshes of every size, and the first and the last with every edge halved."""
    found = []
    for size in SIZES:
        mesh = mesh_of(name, size, half=name == "bending")
        body, free, blocked = _analysed(mesh)
        found.append(_found(name, f"{size:g} mm", body, free, blocked))
        if size in (SIZES[0], SIZES[-1]):
            fine = _body(halved(mesh))
            again = [
                solve_again(body, fine, state, _held(fine, tip=tip), PRESSURE)
                for tip, state in ((False, free), (True, blocked))
            ]
            found.append(_found(name, f"{size:g} mm halved", fine, *again))
    return found


def _body(mesh: Mesh) -> Body:
    return Body(mesh, default_elastomer(), default_paper())


def _held(body: Body, *, tip: bool) -> BoolArray:
    """Which displacements (n, 3) are held, those of the tip's lower edge for the blocked force."""
    fixed = body.fixed[: 3 * body.nodes].reshape(-1, 3).copy()
    if tip:
        fixed[tip_edge(body.mesh), 2] = True
    return fixed


def _analysed(mesh: Mesh) -> tuple[Body, Solved, Solved]:
    """Free and held, from rest."""
    body = _body(mesh)
    free, blocked = (
        solve(mesh.points, body.terms, _held(body, tip=tip), [PRESSURE], tolerance=1e-3)[0]
        for tip in (False, True)
    )
    return body, free, blocked


def _found(name: str, label: str, body: Body, free: Solved, blocked: Solved) -> Found:
    path = trajectory(
        name,
        body.mesh,
        np.array([0.0, 1e3 * PRESSURE]),
        np.array([0 * free.displacement, free.displacement]),
    )
    moved = path.positions[-1, -1] - path.positions[0, -1]
    results = dict(zip(("tip x", "tip y", "tip z"), map(float, moved), strict=True))
    results["bending"] = float(path.bending_deg[-1, -1])
    results["twist"] = float(path.twist_deg[-1, -1])
    force = blocked.reactions[tip_edge(body.mesh), 2].sum()
    results["blocked force"] = body.copies * float(force)
    return Found(label, len(body.mesh.tets), results)


def rows(name: str, series: list[Found]) -> list[Figure]:
    return []
