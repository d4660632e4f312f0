"""The paper alone: a strip of membrane and bending terms, as an elastica.

ν = 0, so that a strip of any width bends like a rod. The strip hardly stretches (its thickness
is a thousandth of its length), so the elastica's closed forms hold to 1e-5.
"""

from __future__ import annotations

import numpy as np
from closed_forms import elastica_tip
from dead_load import DeadLoad
from figure import Figure
from solving import FloatArray, Solved, solve

from pagd.fem import shapes
from pagd.fem.bending import bending_terms
from pagd.fem.membrane import Membrane
from pagd.fem.term import NO_INTERNAL, ElementSystem, EnergyTerm, IntArray, node_dofs
from pagd.materials import Sheet
from pagd.mesh.primitives import box

LENGTH, WIDTH, RADIUS = 100.0, 15.0, 30.0
SIZES = (5.0, 3.0, 2.0)
PAPER = Sheet(name="paper", youngs_modulus=6500.0, poisson_ratio=0.0, thickness=0.1)


def strip(size: float) -> tuple[FloatArray, IntArray]:
    """Points and faces of the strip, corners inside moved by up to a quarter of the size."""
    cells = round(LENGTH / size), round(WIDTH / size)
    mesh = box((LENGTH, WIDTH, 1.0), (*cells, 1))
    numbers, faces = np.unique(mesh.surfaces["z0"], return_inverse=True)
    points, faces = mesh.points[numbers], faces.reshape(-1, 6)
    corners = np.unique(faces[:, :3])
    moves = np.random.default_rng(0).uniform(-size / 4, size / 4, (len(corners), 2))
    inside = (points[corners, :2] > 1e-9) & (points[corners, :2] < [LENGTH - 1e-9, WIDTH - 1e-9])
    points[corners, :2] += moves * inside
    for k, (a, b) in enumerate(shapes.TRIANGLE_EDGES):
        points[faces[:, 3 + k]] = (points[faces[:, a]] + points[faces[:, b]]) / 2
    return points, faces


def _end_edges(points: FloatArray, faces: IntArray) -> tuple[IntArray, IntArray]:
    """Faces and local edges at x = LENGTH."""
    ends = np.array(shapes.TRIANGLE_EDGES)
    return np.nonzero(np.isclose(points[faces[:, ends], 0], LENGTH).all(axis=2))


class EndMoment:
    """A moment that turns with the end: the potential −load · M · mean of atan2(z′, x′).

    x′ and z′ are the slopes along the strip, at the two Gauss points of each end edge.
    """

    name = "moment"

    def __init__(self, points: FloatArray, faces: IntArray, moment: float) -> None:
        at, edge = _end_edges(points, faces)
        self._faces = faces[at]
        self._points = points
        self._moment = moment
        self.dofs = node_dofs(self._faces)
        ends = np.array(shapes.TRIANGLE_EDGES)[edge]
        self._slopes = np.array(
            [self._slope(face, pair) for face, pair in zip(self._faces, ends, strict=True)]
        )
        first, second = (points[self._faces[np.arange(len(at)), ends[:, i]]] for i in (0, 1))
        lengths = np.linalg.norm(second - first, axis=1)
        self._shares = np.repeat(lengths[:, None] / lengths.sum() / 2, 2, axis=1)

    def _slope(self, face: IntArray, pair: IntArray) -> FloatArray:
        """∂N/∂x (2, 6) at the Gauss points of the edge between two corners."""
        barycentric = np.zeros((2, 3))
        barycentric[:, pair[0]] = 0.5 + np.array([-1, 1]) * 3**-0.5 / 2
        barycentric[:, pair[1]] = 1 - barycentric[:, pair[0]]
        a, b, c = self._points[face[:3], :2]
        inverse = np.linalg.inv(np.column_stack([b - a, c - a]))
        return np.asarray((shapes.triangle_derivatives(barycentric) @ inverse)[:, :, 0])

    def _tangent(self, unknowns: FloatArray) -> FloatArray:
        places = self._points[self._faces] + unknowns[self.dofs].reshape(-1, 6, 3)
        return np.einsum("ega,eai->egi", self._slopes, places)

    def internal_at_rest(self) -> FloatArray:
        return NO_INTERNAL

    def advance(self, correction: FloatArray) -> FloatArray:
        return NO_INTERNAL

    def energy(self, unknowns: FloatArray, load: float) -> float:
        x, _, z = np.moveaxis(self._tangent(unknowns), -1, 0)
        # The angle grows beyond half a turn on the way; its branch does not enter the forces.
        return float(-load * self._moment * (self._shares * np.arctan2(z, x)).sum())

    def linearize(
        self, unknowns: FloatArray, internal: FloatArray, load: float, system: ElementSystem
    ) -> float:
        x, _, z = np.moveaxis(self._tangent(unknowns), -1, 0)
        squared = x**2 + z**2
        zero = np.zeros_like(x)
        slope = np.stack([-z, zero, x], axis=-1) / squared[..., None]
        twice, difference = 2 * x * z / squared**2, (z**2 - x**2) / squared**2
        curvature = np.stack(
            [twice, zero, difference, zero, zero, zero, difference, zero, -twice], axis=-1
        ).reshape(*x.shape, 3, 3)
        factor = -load * self._moment * self._shares
        forces = np.einsum("eg,ega,egi->eai", factor, self._slopes, slope)
        matrix = np.einsum(
            "eg,ega,egij,egb->eaibj", factor, self._slopes, curvature, self._slopes
        ).reshape(-1, 18, 18)
        rows, columns = np.triu_indices(18)
        system.residual[:] = forces.reshape(-1, 18)
        system.tangent[:] = matrix[:, rows, columns]
        return self.energy(unknowns, load)


def pull_of_end(points: FloatArray, faces: IntArray, force: float) -> DeadLoad:
    """A dead force along z, spread evenly over the end."""
    at, edge = _end_edges(points, faces)
    ends = np.array(shapes.TRIANGLE_EDGES)[edge]
    nodes = np.column_stack([faces[at, ends[:, 0]], faces[at, 3 + edge], faces[at, ends[:, 1]]])
    lengths = np.linalg.norm(points[nodes[:, 2]] - points[nodes[:, 0]], axis=1)
    # Simpson's weights are exact for the quadratic shape functions.
    shares = lengths[:, None] / lengths.sum() * np.array([1, 4, 1]) / 6
    return DeadLoad(3 * nodes + 2, force * shares)


def bend(points: FloatArray, faces: IntArray, load: EnergyTerm) -> Solved:
    """The strip, clamped at x = 0, under the load."""
    clamped = np.flatnonzero(np.isclose(points[:, 0], 0))
    terms = [
        Membrane(points, faces, PAPER),
        *bending_terms(points, faces, PAPER, clamped=clamped),
        load,
    ]
    fixed = np.zeros(points.shape, np.bool_)
    fixed[clamped] = True
    return solve(points, terms, fixed, [1.0], first=0.02, wanted_correction=3.0, tolerance=1e-4)[0]


def _tip(points: FloatArray, solved: Solved) -> FloatArray:
    end = np.isclose(points[:, 0], LENGTH)
    return np.asarray((points + solved.displacement)[end].mean(axis=0))


def end_moment(size: float) -> tuple[float, float]:
    """Distance of the tip from the circle's end over LENGTH; share of the energy in the plane."""
    points, faces = strip(size)
    moment = PAPER.bending_stiffness * WIDTH / RADIUS
    solved = bend(points, faces, EndMoment(points, faces, moment))
    angle = LENGTH / RADIUS
    exact = [RADIUS * np.sin(angle), WIDTH / 2, RADIUS * (1 - np.cos(angle))]
    energies = solved.energies
    bending = sum(energies[name] for name in ("bending", "hinges", "held edges"))
    distance = np.linalg.norm(_tip(points, solved) - exact) / LENGTH
    return float(distance), energies["membrane"] / bending


def circle() -> list[Figure]:
    """End moment: the strip becomes an arc of 191° with a radius of 30 mm.

    Bending must not stretch it: with the strain of the quadratic positions themselves instead of
    the tied one, a tenth of the energy was in the plane on 5 mm faces, and the tip off by 0.43.
    """
    figures = []
    for size, tolerance in zip(SIZES, (0.03, 0.012, 0.005), strict=True):
        distance, share = end_moment(size)
        name = f"paper strip, end moment, {size:g} mm faces: "
        figures += [
            Figure(
                name=name + "distance of the tip from the arc's end / length",
                source="closed form: circular arc under an end moment",
                reference=0.0,
                value=distance,
                tolerance=tolerance,
                scale=1.0,
            ),
            Figure(
                name=name + "energy of the membrane / of bending",
                source="closed form: pure bending does not stretch",
                reference=0.0,
                value=share,
                tolerance=0.005,
                scale=1.0,
            ),
        ]
    return figures


def end_force(size: float, load: float) -> tuple[float, float]:
    """Tip x and z over LENGTH under a dead force P = load · EI / LENGTH²."""
    points, faces = strip(size)
    force = load * PAPER.bending_stiffness * WIDTH / LENGTH**2
    tip = _tip(points, bend(points, faces, pull_of_end(points, faces, force)))
    return float(tip[0] / LENGTH), float(tip[2] / LENGTH)


def elastica(load: float = 5.0) -> list[Figure]:
    """End force P L²/EI = 5: the tip turns by 70°."""
    x, z, _ = elastica_tip(load)
    figures = []
    for size, tolerance in zip(SIZES, (0.006, 0.003, 0.002), strict=True):
        found = end_force(size, load)
        for axis, reference, value in zip("xz", (x, z), found, strict=True):
            name = f"paper strip, end force, {size:g} mm faces: tip {axis} / length"
            figures.append(
                Figure(
                    name=name,
                    source="elastica, by quadrature (checked by elliptic integrals)",
                    reference=reference,
                    value=value,
                    tolerance=tolerance,
                )
            )
    return figures
