"""The example designs on finer and finer meshes: what is left of them in the limit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from actuators import default_elastomer, default_paper, mesh_of, trajectory
from figure import Figure
from refinement import halved, solve_again
from scipy.optimize import brentq
from solving import BoolArray, Solved, solve

from pagd.actuation import Body
from pagd.actuation.blocked import tip_edge
from pagd.mesh.types import Mesh

PRESSURE = 0.01  # MPa
#: Mesh sizes in mm of the meshes that are drawn; the first and the last are halved too.
SIZES = (5.0, 4.0, 3.0)
#: Largest error by mesh; the default size is 3 mm.
TOLERANCES = {"5 mm": 0.2, "4 mm": 0.2, "3 mm": 0.15, "5 mm halved": 0.1, "3 mm halved": 0.08}
#: Near inward edges of 90° the displacement goes with the distance to the power 0.5445.
ORDER = 2 * 0.5445


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


def limit_of(coarse: float, fine: float) -> float:
    """Richardson's limit of a value on a mesh and on its halves."""
    return fine + (fine - coarse) / (2**ORDER - 1)


def order_of(sizes: Sequence[float], values: Sequence[float]) -> float:
    """The order p of f₀ + C hᵖ through the values on three meshes; no number if there is none."""
    (a, b, c), (first, second, third) = sizes, values
    ratio = (second - first) / (third - second)

    def mismatch(order: float) -> float:
        return float((b**order - a**order) / (c**order - b**order) - ratio)

    lowest, highest = 0.05, 8.0
    if mismatch(lowest) * mismatch(highest) > 0:
        return float("nan")
    return float(brentq(mismatch, lowest, highest))


def bending_meshes() -> list[Figure]:
    """The bending design (half model) at 10 kPa: tip, angle, blocked force, mesh by mesh.

    Gmsh's meshes of 5, 4 and 3 mm, 3 mm being the default, and those of 5 and 3 mm with every edge
    halved, eight times as many tetrahedra. Meshes drawn anew scatter (thin walls have one layer of
    elements in all of them), halves do not: the limit is extrapolated from 3 mm and its halves,
    with the order of the singular inward edges, which is the lowest there can be, so that the
    errors are rather overestimated. The error of a row is the estimate for its mesh; that of 3 mm
    is the error to expect of a result of `make run`. The tip is that of the free actuator, relative
    to its whole displacement; the blocked force is that of the edge on its support.
    """
    return rows("bending", study("bending"))


def twisting_meshes() -> list[Figure]:
    """The twisting design at 10 kPa, on meshes as those of the bending one."""
    return rows("twisting", study("twisting"))


def mixed_meshes() -> list[Figure]:
    """The mixed design at 10 kPa, on meshes as those of the bending one."""
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
    """Every result on every mesh beside its limit, and the order of the bending angle."""
    known = {found.mesh: found for found in series}
    pair = known[f"{SIZES[-1]:g} mm"].results, known[f"{SIZES[-1]:g} mm halved"].results
    limits = {result: limit_of(pair[0][result], pair[1][result]) for result in pair[0]}
    moved = float(np.linalg.norm([limits[f"tip {axis}"] for axis in "xyz"]))
    # What symmetry makes zero is a case of its own.
    shown = [result for result in limits if name != "bending" or result not in ("tip y", "twist")]
    figures = [
        Figure(
            name=f"{name}, {found.mesh}: {result}",
            source=f"extrapolated from {SIZES[-1]:g} mm and its halves",
            reference=limits[result],
            value=found.results[result],
            tolerance=TOLERANCES[found.mesh],
            unit=UNITS.get(result, "mm"),
            # A component of a displacement may be small beside the whole.
            scale=None if result in UNITS else moved,
        )
        for result in shown
        for found in series
    ]
    return [*figures, _order(name, known)]


UNITS = {"bending": "°", "twist": "°", "blocked force": "N"}


def _order(name: str, known: dict[str, Found]) -> Figure:
    """The order that the bending angle shows on the coarsest mesh and both halved ones."""
    labels = (f"{SIZES[0]:g} mm", f"{SIZES[0]:g} mm halved", f"{SIZES[-1]:g} mm halved")
    meshes = [known[label] for label in labels]
    observed = order_of([m.size for m in meshes], [m.results["bending"] for m in meshes])
    return Figure(
        name=f"{name}: order of the bending angle",
        source="theory: 1.1 (inward edges, Williams 1952) to 4 (smooth)",
        reference=2.5,
        value=observed,
        # Its meshes are of two families, whose scatter shows in the order.
        tolerance=2.0,
        scale=1.0,
    )
