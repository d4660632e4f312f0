"""Cells that a screw motion repeats: a tube against its closed form, rows against whole ones."""

from __future__ import annotations

import numpy as np
from actuators import default_elastomer, default_paper, design
from closed_forms import NEO_HOOKE, YEOH, Coefficients, closed_tube
from figure import Figure
from solving import elastomer

from pagd.actuation import Actuation, free_actuation
from pagd.design import Channel
from pagd.fem.continuation import Continuation, Step, StepControl
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.linear_solver import linear_solver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.fem.screw import ScrewTie
from pagd.fem.solid import ElementPressureSolid
from pagd.fem.tied_assembly import TiedAssembly
from pagd.mesh.blocks import block_faces, hexahedra
from pagd.mesh.chamber_row import chamber_row
from pagd.mesh.primitives import cylinder_quarter
from pagd.metrics import measure
from pagd.reduced.caps import Cap
from pagd.reduced.rows import Rows
from pagd.reduced.solve import solve_row
from pagd.sections import place_sections, stations_of

INNER, OUTER, HEIGHT = 10.0, 15.0, 2.0
STRETCHES = (1.1, 1.2, 1.4)
MATERIALS = {"neo-Hooke": (NEO_HOOKE, STRETCHES[:2]), "Yeoh": (YEOH, STRETCHES)}
#: Rows of Table 2 on the default blocks; tips by their displacement, with and without pieces.
ROWS = {"bending": (0.01, 1e-3), "twisting": (0.01, 1e-3), "mixed": (0.01, 3e-3)}
PRESSURE_KPA = 20.0


def closed_tubes() -> list[Figure]:
    """A slice of a thick tube with closed ends, tied to itself: inner and axial stretch.

    Radii 10 and 15 mm, a quarter of 4 × 6 × 2 curved hexahedra; the cut at the top follows that at
    the bottom along the axis, and caps close the air at both. The axial stretch is what no force
    but the air's on the caps leaves: of second order in the pressure for incompressible tubes, so
    that its error is given by that of the inner wall.
    """
    return [
        figure
        for name, (material, stretches) in MATERIALS.items()
        for figure in _tube(name, material, stretches)
    ]


def rows_of_parts() -> list[Figure]:
    """Designs of Table 2 at 20 kPa by their cells, and with pieces, against the whole model.

    On the default blocks, of which parts and whole have the same: distance of the tips by the
    whole model's displacement, and the bending of a chamber in the middle, which no end is near.
    """
    return [figure for name in ROWS for figure in _row(name)]


def _tube(name: str, material: Coefficients, stretches: tuple[float, ...]) -> list[Figure]:
    exact = [closed_tube(material, INNER, OUTER, stretch) for stretch in stretches]
    found = _solved_tube(material, [pressure for pressure, _ in exact])
    figures = []
    for stretch, (_, axial), (inner, along) in zip(stretches, exact, found, strict=True):
        what = f"tube, {name}, under the pressure of λa = {stretch}"
        source = "closed form: thick tube with closed ends, by quadrature"
        figures += [
            Figure(
                name=f"{what}: λa − 1",
                source=source,
                reference=stretch - 1,
                value=inner - 1,
                tolerance=0.003,
            ),
            Figure(
                name=f"{what}: λz − 1",
                source=source,
                reference=axial - 1,
                value=along - 1,
                tolerance=0.003,
                scale=stretch - 1,
            ),
        ]
    return figures


def _solved_tube(material: Coefficients, pressures: list[float]) -> list[tuple[float, float]]:
    """Inner and axial stretch at pressures (MPa)."""
    mesh = cylinder_quarter(INNER, OUTER, HEIGHT, (4, 6, 2), "hexahedra")
    bottom, top = (_sorted(mesh.points, mesh.nodes_of(name)) for name in ("z0", "z1"))
    rows = Rows(mesh.points)
    caps = [
        Cap(mesh, cut, centre=np.array([0.0, 0.0, z])) for cut, z in ((bottom, 0.0), (top, HEIGHT))
    ]
    spans = [rows.add(cap.points) for cap in caps]
    motion = int(rows.add(np.zeros((2, 3)))[0])
    points = rows.points()
    slaves, masters = np.concatenate([top, spans[1]]), np.concatenate([bottom, spans[0]])
    quadrilaterals, _ = block_faces(mesh, "cavity")
    faces = np.vstack([cap.triangles(span) for cap, span in zip(caps, spans, strict=True)])
    pressure = FollowerPressure(points, faces, quadrilaterals=quadrilaterals)
    solid = ElementPressureSolid(mesh.points, hexahedra(mesh), elastomer(material, 0.4999))
    fixed = np.zeros(points.shape, dtype=np.bool_)
    fixed[mesh.nodes_of("x0"), 0] = fixed[mesh.nodes_of("y0"), 1] = True
    fixed[spans[0]] = fixed[motion] = fixed[motion + 1, :2] = fixed[bottom[0], 2] = True
    tie = ScrewTie(points, slaves, masters, motion)
    assembly = TiedAssembly([solid, pressure], points.size, fixed.ravel(), tie)
    newton = Newton(
        assembly, linear_solver(), points.size, NewtonSettings(tolerance=1e-6), pressure
    )
    inside = mesh.nodes_of("cavity")
    found: list[tuple[float, float]] = []

    def observe(step: Step) -> None:
        moved = step.state.unknowns.reshape(-1, 3)
        radius = np.linalg.norm((points + moved)[inside, :2], axis=1).mean()
        if step.wanted:
            found.append((radius / INNER, 1 + moved[motion + 1, 2] / HEIGHT))

    Continuation(newton, StepControl(first=pressures[0] / 4)).follow(pressures, observe)
    return found


def _sorted(points: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Nodes of a cut in the order of their places on it."""
    across = np.round(points[nodes, :2], 6)
    return nodes[np.lexsort((across[:, 0], across[:, 1]))]


def _row(name: str) -> list[Figure]:
    drawn, channel = design(name), Channel()
    actuation = Actuation(maximum_pressure_kPa=PRESSURE_KPA, recorded_step_kPa=5.0)
    mesh = chamber_row(drawn, channel, 6.0, half=drawn.is_straight)
    both = default_elastomer(), default_paper(), actuation
    whole = free_actuation(mesh, *both)
    sections = place_sections(
        mesh.points,
        mesh.surfaces["paper"],
        stations_of(drawn),
        mirrored="symmetry" in mesh.surfaces,
    )
    pressure = np.array([PRESSURE_KPA])
    wanted = measure(sections, pressure, whole.states[-1].displacement[None])
    travel = float(np.linalg.norm(wanted.positions[-1, -1] - wanted.positions[0, -1]))
    figures = []
    for words, tolerance, given in zip(
        ("cells alone", "cells and pieces"), ROWS[name], (None, mesh), strict=True
    ):
        reduced = solve_row(drawn, channel, 6.0, *both, given)
        row = reduced.row(mesh.points, channel)
        moved = reduced.displacement(row, PRESSURE_KPA)
        found = measure(sections, pressure, moved[None])
        off = float(np.linalg.norm(found.positions[-1, -1] - wanted.positions[-1, -1]))
        middle = drawn.N // 4
        figures += [
            Figure(
                name=f"{name} design, {words}: distance of the tips",
                source="the whole model, free actuation",
                reference=0.0,
                value=off,
                tolerance=tolerance,
                unit="mm",
                scale=travel,
            ),
            Figure(
                name=f"{name} design, {words}: bending of chamber {middle + 1}",
                source="the whole model, free actuation",
                reference=float(np.degrees(wanted.joints[-1, middle, 1])),
                value=float(np.degrees(found.joints[-1, middle, 1])),
                tolerance=0.01,
                unit="deg",
            ),
        ]
    return figures
