"""Solids: patch test, rigid rotation, order of convergence, block bending, Cook's membrane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from closed_forms import NEO_HOOKE, YEOH, bending_moment, bent_block, sphere_mean_stress
from dead_load import DeadLoad
from figure import Figure
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation
from solving import (
    BLOCKS,
    FloatArray,
    Solid,
    Solved,
    elastomer,
    held,
    solid_of,
    solve,
    tolerance_of,
)

from pagd.fem.quadrature import tetrahedron
from pagd.fem.shapes import tetrahedron_values
from pagd.fem.solid import TaylorHoodSolid
from pagd.fem.term import node_dofs
from pagd.mesh.primitives import box, sphere_octant
from pagd.mesh.types import Mesh

ELEMENTS = ("taylor_hood", "element_pressure", "hexahedron", "wedge")

PATCH = "closed form: one deformation gradient everywhere"
RIVLIN = "closed form: Rivlin 1949, a block bent into an arc"


def distorted_box(element: str, seed: int = 3) -> Mesh:
    """A box of 3 × 3 × 3 cells, its inner corners moved by a fifth of a cell, edges straight."""
    mesh = box((6.0, 4.0, 4.0), (3, 3, 3), blocks=BLOCKS.get(element))
    points = mesh.points.copy()
    corners = np.unique(mesh.tets[:, :4])
    inside = corners[((points[corners] > 0) & (points[corners] < [6, 4, 4])).all(axis=1)]
    points[inside] += np.random.default_rng(seed).uniform(-0.3, 0.3, (len(inside), 3))
    for k, (a, b) in enumerate(((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))):
        points[mesh.tets[:, 4 + k]] = (points[mesh.tets[:, a]] + points[mesh.tets[:, b]]) / 2
    return replace(mesh, points=points)


def patch_test() -> list[Figure]:
    """Affine displacement of the boundary of a distorted mesh: the inside follows.

    With every element, the displacement inside is the affine field, and the energy is the density
    of one deformation gradient times the volume, to round-off.
    """
    return [figure for element in ELEMENTS for figure in _patch(element)]


def _patch(element: str) -> list[Figure]:
    mesh = distorted_box(element)
    gradient = np.array([[1.3, 0.3, -0.1], [0.1, 0.9, 0.2], [-0.2, 0.1, 0.95]])
    gradient *= (1.001 / np.linalg.det(gradient)) ** (1 / 3)
    field = mesh.points @ (gradient - np.eye(3)).T
    boundary = np.unique(np.concatenate([mesh.nodes_of(s) for s in mesh.surfaces]))
    fixed = np.zeros(mesh.points.shape, np.bool_)
    fixed[boundary] = True
    material = elastomer(YEOH)
    (solved,) = solve(
        mesh.points,
        [solid_of(mesh, material, element)],
        fixed,
        [1.0],
        lambda load: load * field,
        tolerance=1e-8,
    )
    c10, c20 = YEOH
    ratio = np.linalg.det(gradient)
    excess = (gradient**2).sum() / ratio ** (2 / 3) - 3
    density = c10 * excess + c20 * excess**2 + material.bulk_modulus / 2 * (ratio - 1) ** 2
    return [
        Figure(
            name=f"patch test, {element}: displacement inside, largest difference",
            source=PATCH,
            reference=0.0,
            value=float(np.abs(solved.displacement - field).max()),
            tolerance=1e-8,
            unit="mm",
            scale=1.0,
        ),
        Figure(
            name=f"patch test, {element}: energy",
            source=PATCH,
            reference=density * 96.0,
            value=solved.energies["solid"],
            tolerance=1e-8,
            unit="mJ",
        ),
    ]


def rigid_rotation() -> list[Figure]:
    """One face turned by 170° in steps, the rest free: a rigid body, without energy."""
    return [figure for element in ELEMENTS for figure in _rotation(element)]


def _rotation(element: str) -> list[Figure]:
    mesh = distorted_box(element)

    def turned(load: float) -> FloatArray:
        rotation = Rotation.from_rotvec(load * np.array([0.3, 1.0, -0.5])).as_matrix()
        return mesh.points @ (rotation - np.eye(3)).T

    angle = np.radians(170) / np.linalg.norm([0.3, 1.0, -0.5])
    (solved,) = solve(
        mesh.points,
        [solid_of(mesh, elastomer(YEOH), element)],
        held(mesh, x0="xyz"),
        [angle],
        turned,
        tolerance=1e-8,
    )
    return [
        Figure(
            name=f"rotation by 170°, {element}: displacement, largest difference to a rigid body",
            source="identity: a rigid body",
            reference=0.0,
            value=float(np.abs(solved.displacement - turned(angle)).max()),
            tolerance=1e-8,
            unit="mm",
            scale=1.0,
        ),
        Figure(
            name=f"rotation by 170°, {element}: energy",
            source="identity: a rigid body",
            reference=0.0,
            value=solved.energies["solid"],
            tolerance=1e-12,
            unit="mJ",
            scale=1.0,
        ),
    ]


def _displacement_error(mesh: Mesh, solid: Solid, found: Solved, stretch: float) -> float:
    """Root mean square over a sphere of the error of r = (R³ + A³ (λa³ − 1))^⅓, in mm."""
    values = tetrahedron_values(tetrahedron().points)
    places = np.einsum("qa,eai->eqi", values, mesh.points[mesh.tets])
    moved = np.einsum("qa,eai->eqi", values, found.displacement[mesh.tets])
    radius = np.linalg.norm(places, axis=-1, keepdims=True)
    exact = places * ((radius**3 + INNER**3 * (stretch**3 - 1)) ** (1 / 3) / radius - 1)
    return _root_mean_square(solid, ((moved - exact) ** 2).sum(axis=-1))


def _pressure_error(mesh: Mesh, solid: TaylorHoodSolid, found: Solved, stretch: float) -> float:
    """Root mean square of the error of the mean stress, in MPa."""
    pressures = np.zeros(len(mesh.points))
    pressures[solid.corners] = found.unknowns[mesh.points.size :]
    corners = mesh.tets[:, :4]
    # Barycentric places; the edges are curved, so the radius is that of the quadratic map.
    linear = np.einsum("qa,ea->eq", tetrahedron().points, pressures[corners])
    values = tetrahedron_values(tetrahedron().points)
    places = np.einsum("qa,eai->eqi", values, mesh.points[mesh.tets])
    radii = np.linspace(INNER, OUTER, 201)
    stresses = [sphere_mean_stress(NEO_HOOKE, INNER, OUTER, stretch, r) for r in radii]
    exact = CubicSpline(radii, stresses)(np.linalg.norm(places, axis=-1))
    return _root_mean_square(solid, (linear - exact) ** 2)


def _root_mean_square(solid: Solid, squares: FloatArray) -> float:
    return float(np.sqrt((solid.weights * squares).sum() / solid.weights.sum()))


INNER, OUTER = 10.0, 15.0
#: Layers of the spheres; fewer are not yet in the asymptotic range (2 to 4 shows 2.5).
LAYERS = (4, 8, 12)


def sphere_errors(layers: int, stretch: float = 1.3) -> tuple[float, float]:
    """Errors of displacement (mm) and pressure (MPa) on an octant, the inner wall moved."""
    mesh = sphere_octant(INNER, OUTER, (layers, layers))
    material = elastomer(NEO_HOOKE, poisson_ratio=0.499999)
    solid = TaylorHoodSolid(mesh.points, mesh.tets, material, mesh.points.size)
    fixed = held(mesh, x0="x", y0="y", z0="z", cavity="xyz")
    (found,) = solve(mesh.points, [solid], fixed, [stretch - 1], lambda load: load * mesh.points)
    return (
        _displacement_error(mesh, solid, found, stretch),
        _pressure_error(mesh, solid, found, stretch),
    )


def convergence() -> list[Figure]:
    """Orders of P2-P1 in L2: 3 for the quadratic displacement, 2 for the linear pressure.

    A neo-Hookean sphere of radii 10 and 15 mm, its inner wall moved to λa = 1.3, curved elements.
    On the coarser meshes the error of the pressure is that of the displacement behind it and
    falls faster than its own order, so that only the finest pair is shown, with a wide tolerance.
    """
    errors = np.array([sphere_errors(layers) for layers in LAYERS])
    pairs = list(pairwise(zip(LAYERS, errors, strict=True)))
    orders = [_order("displacement", 3.0, 0.05, pair) for pair in pairs]
    return [*orders, _order("pressure", 2.0, 0.3, pairs[-1])]


Errors = tuple[int, FloatArray]


def _order(field: str, expected: float, tolerance: float, pair: tuple[Errors, Errors]) -> Figure:
    """The order that a field's errors on two meshes show."""
    (n, coarse), (m, fine) = pair
    column = 0 if field == "displacement" else 1
    return Figure(
        name=f"sphere, P2-P1, {n} to {m} layers: order of the {field}",
        source="theory: Taylor-Hood elements",
        reference=expected,
        value=float(np.log(coarse[column] / fine[column]) / np.log(m / n)),
        tolerance=tolerance,
    )


HEIGHT, LENGTH, WIDTH = 4.0, 20.0, 2.0
ANGLES_DEG = (45, 90, 180)


def block_bending() -> list[Figure]:
    """A block bent into an arc, its ends prescribed: moment per width, and no resultant force.

    4 mm high and 20 mm long, in plane strain, 4 x 16 cells of tetrahedra, and of hexahedra, which
    lose their stability at 126° on this mesh; further on a coarser one under "No locking".
    """
    return bent_block_rows("taylor_hood") + bent_block_rows("hexahedron", angles_deg=(45, 90))


def bent_block_rows(
    element: str,
    cells: tuple[int, int] = (4, 16),
    poisson_ratio: float = 0.4999,
    angles_deg: Sequence[int] = ANGLES_DEG,
) -> list[Figure]:
    """The same with an element on a mesh of so many cells along height and length."""
    # x runs along the height and z along the length, the middle of which stays.
    mesh = box((HEIGHT, WIDTH, LENGTH), (cells[0], 1, cells[1]), blocks=BLOCKS.get(element))
    points = mesh.points - [0, 0, LENGTH / 2]

    def bent(angle: float) -> FloatArray:
        """Displacement by r² = 2 α X + r_a², φ = Z/α."""
        alpha, inner, _ = bent_block(HEIGHT, LENGTH, angle)
        radius = np.sqrt(2 * alpha * points[:, 0] + inner**2)
        turn = points[:, 2] / alpha
        places = [radius * np.cos(turn) - inner, points[:, 1], radius * np.sin(turn)]
        return np.column_stack(places) - points

    loads = [float(np.radians(a)) for a in angles_deg]
    solved = solve(
        points,
        [solid_of(mesh, elastomer(NEO_HOOKE, poisson_ratio=poisson_ratio), element)],
        held(mesh, y0="y", y1="y", z0="xyz", z1="xyz"),
        loads,
        bent,
        tolerance=tolerance_of(element),
    )
    figures = []
    for degrees, state in zip(angles_deg, solved, strict=True):
        end = mesh.nodes_of("z1")
        places, forces = (points + state.displacement)[end], state.reactions[end]
        # About the centre of curvature, so that a normal force at the wrong radius shows too.
        _, inner, _ = bent_block(HEIGHT, LENGTH, state.load)
        arms = places - [-inner, 0, 0]
        moment = np.cross(arms, forces)[:, 1].sum() / WIDTH
        exact = bending_moment(0.22, HEIGHT, LENGTH, state.load)
        figures.append(
            Figure(
                name=f"block bent by {degrees}°, {element}: moment per width",
                source=RIVLIN,
                reference=exact,
                value=float(abs(moment)),
                tolerance=0.005,
                unit="N",
            )
        )
        figures.append(
            Figure(
                name=f"block bent by {degrees}°, {element}: resultant force per width",
                source=RIVLIN,
                reference=0.0,
                value=float(np.linalg.norm(forces.sum(axis=0)) / WIDTH),
                tolerance=0.005,
                unit="N",
                scale=exact / HEIGHT,
            )
        )
    return figures


def edge_load(mesh: Mesh, surface: str, force: tuple[float, float, float]) -> DeadLoad:
    """A dead force, spread evenly over a face."""
    faces = mesh.surfaces[surface]
    corners = mesh.points[faces[:, :3]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    # ∫ N dA is zero at the corners of a flat six-node face and a third of it at the others.
    shares = np.array([0, 0, 0, 1, 1, 1]) / 3
    parts = areas[:, None, None] / areas.sum() * shares[:, None] * np.array(force)
    return DeadLoad(node_dofs(faces), parts.reshape(len(faces), -1))


def cook(cells: tuple[int, int] = (16, 16), element: str = "taylor_hood") -> float:
    """Rise of the upper right corner of Cook's membrane, in mm.

    48 mm long, clamped edge 44 mm, loaded edge 16 mm high, 44 mm higher; plane strain, neo-Hooke
    G = 80.1938, K = 400942 MPa, 100 N per mm of thickness on the right edge (Simo, Armero,
    *Int. J. Numer. Methods Eng.* 33 (1992) 1413).
    """
    mesh = box((1.0, 1.0, 1.0), (cells[0], 1, cells[1]), blocks=BLOCKS.get(element))
    x, y, z = mesh.points.T
    points = np.column_stack([48 * x, y * 48 / cells[0], 44 * x + z * (44 - 28 * x)])
    thickness = 48 / cells[0]
    membrane = replace(mesh, points=points)
    material = elastomer((80.1938 / 2, 0.0), bulk=400942.0)
    terms = [
        solid_of(membrane, material, element),
        edge_load(membrane, "x1", (0.0, 0.0, 100 * thickness)),
    ]
    fixed = held(membrane, x0="xyz", y0="y", y1="y")
    (solved,) = solve(points, terms, fixed, [1.0], wanted_correction=5.0)
    corner = np.isclose(points[:, 0], 48) & np.isclose(points[:, 2], 60)
    return float(solved.displacement[corner, 2].mean())


def cook_membrane() -> list[Figure]:
    """The rise of the corner, 16 × 16 cells, against the finest published mesh."""
    return [
        Figure(
            name=f"Cook's membrane, {name}, 16 x 16 cells: rise of the upper corner",
            source="Simo, Armero 1992, finest published mesh",
            reference=6.89,
            value=cook(element=element),
            tolerance=0.01,
            unit="mm",
        )
        for name, element in (("P2-P1", "taylor_hood"), ("Q2-P-1", "hexahedron"))
    ]
