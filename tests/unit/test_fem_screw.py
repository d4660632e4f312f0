"""Tests of the screw condition: motions, tangents, invariance."""

from __future__ import annotations

import numpy as np
import pytest
from fem_checks import ROTATION, SHIFT
from numpy.typing import NDArray
from reduced_samples import SLANTED, STRAIGHT, cell
from scipy.sparse import csr_array

from pagd.design import Design
from pagd.errors import InputError
from pagd.fem.assembly import State
from pagd.fem.screw import ScrewTie
from pagd.fem.tied_assembly import TiedAssembly
from pagd.reduced.segment import Segment
from pagd.rotations import rotation_matrix, rotation_vector

FloatArray = NDArray[np.float64]

LOAD, STEP = 0.02, 1e-6
#: Contact pressures that are iterated take some rounds to be those of the gaps.
ROUNDS = 30

POINTS = np.array(
    [[0, 0, 0], [0, 1, 0], [0, 0, 1], [2, 0, 0], [2, 1, 0], [2, 0, 1], [0, 0, 0], [0, 0, 0]],
    dtype=np.float64,
)
TIE = ScrewTie(POINTS, np.array([3, 4, 5]), np.array([0, 1, 2]), 6)


def unknowns_of(motion: FloatArray, seed: int = 0) -> FloatArray:
    """Random masters and a motion (2, 3); the slaves are not yet where they belong."""
    rows = np.random.default_rng(seed).normal(size=POINTS.shape)
    rows[6:] = motion
    return rows.ravel()


def test_slaves_are_where_the_motion_carries_their_masters() -> None:
    unknowns = unknowns_of(np.array([[0.3, -0.5, 0.2], [0.1, 0.2, -0.4]]))
    TIE.settle(unknowns)
    rows = unknowns.reshape(-1, 3)
    carry = TIE.rigid(rows[6], rows[7])
    np.testing.assert_allclose((POINTS + rows)[3:6], carry((POINTS + rows)[:3]), atol=1e-12)
    assert TIE.translation.tolist() == [2, 0, 0]


def test_at_rest_the_motion_is_the_translation() -> None:
    unknowns = np.zeros(POINTS.size)
    TIE.settle(unknowns)
    np.testing.assert_allclose(unknowns, 0, atol=1e-12)


def test_corrections_of_the_slaves_are_of_first_order() -> None:
    start = unknowns_of(np.array([[0.3, -0.5, 0.2], [0.1, 0.2, -0.4]]))
    TIE.settle(start)
    correction = unknowns_of(np.random.default_rng(3).normal(size=(2, 3)), seed=2)
    errors = []
    for size in (1e-3, 1e-4):
        linear = size * correction
        TIE.complete(TIE.motion_at(start), linear)
        whole = TIE.compose(start, linear)
        errors.append(np.abs(whole - (start + linear))[9:18].max())
    assert errors[1] < 2e-2 * errors[0]


def test_rotations_compose_in_space() -> None:
    start = unknowns_of(np.array([[0.3, -0.5, 0.2], [0.0, 0.0, 0.0]]))
    further = np.zeros_like(start)
    further[18:21] = [0.1, 0.7, -0.2]
    found = TIE.compose(start, further)[18:21]
    wanted = rotation_matrix(further[18:21]) @ rotation_matrix(start[18:21])
    np.testing.assert_allclose(found, rotation_vector(wanted), atol=1e-12)


def test_what_acts_on_slaves_does_the_same_work_on_masters_and_motion() -> None:
    state = unknowns_of(np.array([[0.3, -0.5, 0.2], [0.1, 0.2, -0.4]]))
    TIE.settle(state)
    motion = TIE.motion_at(state)
    forces = np.random.default_rng(5).normal(size=state.size)
    correction = unknowns_of(np.random.default_rng(3).normal(size=(2, 3)), seed=2)
    reduced = forces.copy()
    TIE.reduce(motion, reduced)
    assert not reduced.reshape(-1, 3)[3:6].any()
    TIE.complete(motion, correction)
    assert reduced @ correction == pytest.approx(forces @ correction, rel=1e-12)


def test_ends_that_differ_are_refused() -> None:
    points = POINTS.copy()
    points[3, 1] += 0.5
    with pytest.raises(InputError, match=r"nodes are up to 0\.333 mm from where one translation"):
        ScrewTie(points, np.array([3, 4, 5]), np.array([0, 1, 2]), 6)


def disturbed(model: Segment, assembly: TiedAssembly, size: float, turn: float) -> State:
    """A state off equilibrium, with the internal variables that belong to it."""
    assert model.tie is not None
    at = slice(3 * model.tie.motion, 3 * model.tie.motion + 3)
    random = np.random.default_rng(0)
    unknowns = np.zeros(assembly.size)
    unknowns[assembly.free] = size * random.standard_normal(len(assembly.free))
    unknowns[at] = np.where(model.fixed[at], 0.0, turn)
    assembly.settle(unknowns)
    return consistent(assembly, State(LOAD, unknowns, assembly.at_rest().internal))


def consistent(assembly: TiedAssembly, state: State) -> State:
    """The state with the internal variables that belong to its unknowns."""
    for _ in range(ROUNDS):
        assembly.look_around(state)
        assembly.linearize(state)
        state = assembly.advance(state, np.zeros(assembly.size))
    return state


@pytest.mark.parametrize(
    ("design", "half", "turn"),
    [(STRAIGHT, True, 0.05), (STRAIGHT, False, 0.02), (SLANTED, False, 0.02)],
)
def test_tangent_is_the_derivative_of_the_residual(design: Design, half: bool, turn: float) -> None:
    """But for the turning of the moment, which vanishes in equilibrium.

    The tangent is symmetric. The residual of the rotation is the moment in space; its change by a
    rotation δθ has, beside the symmetric part, half of δθ × moment.
    """
    model = cell(design, half=half)
    assembly = model.assembly()
    assert isinstance(assembly, TiedAssembly)
    assembly.iterates_stresses = False
    state = disturbed(model, assembly, 0.003, turn)
    _, residual, values = assembly.linearize(state)
    residual, values = residual.copy(), values.copy()
    count = len(assembly.free)
    pattern = assembly.pattern
    upper = csr_array((values, pattern.columns, pattern.starts), shape=(count, count))
    direction = np.random.default_rng(7).standard_normal(count)
    product = upper @ direction + upper.T @ direction - upper.diagonal() * direction
    found = []
    for sign in (1, -1):
        assembly.linearize(state)
        moved = assembly.advance(state, assembly.full(sign * STEP * direction))
        moved = consistent(assembly, moved)
        _, forces, _ = assembly.linearize(moved)
        found.append((sum(t.energy(moved.unknowns, LOAD) for t in model.terms), forces.copy()))
    slope = (found[0][0] - found[1][0]) / (2 * STEP)
    assert slope == pytest.approx(residual[assembly.free] @ direction, rel=1e-6)
    change = (found[0][1] - found[1][1]) / (2 * STEP)
    assert model.tie is not None
    at = slice(3 * model.tie.motion, 3 * model.tie.motion + 3)
    spin = assembly.full(direction)[at]
    wanted = np.zeros(assembly.size)
    wanted[assembly.free] = product
    wanted[at] += 0.5 * np.cross(spin, residual[at])
    error = np.abs(change - wanted)[assembly.free].max()
    assert error < 1e-6 * np.abs(wanted).max()


def test_a_rigid_motion_of_all_changes_nothing() -> None:
    model = cell(SLANTED)
    assembly = model.assembly()
    assert isinstance(assembly, TiedAssembly)
    state = disturbed(model, assembly, 0.003, 0.02)
    tie, points = model.tie, model.points
    assert tie is not None
    rows = state.unknowns.reshape(-1, 3)
    moved = (points + rows) @ ROTATION.T + SHIFT - points
    # The motion, seen from where all has gone.
    before = tie.rigid(rows[tie.motion], rows[tie.motion + 1])
    rotation = ROTATION @ before.rotation @ ROTATION.T
    shift = ROTATION @ before.displacement + SHIFT - rotation @ SHIFT
    moved[tie.motion] = rotation_vector(rotation)
    moved[tie.motion + 1] = shift + rotation @ tie.centre - tie.centre - tie.translation
    settled = moved.ravel().copy()
    assembly.settle(settled)
    np.testing.assert_allclose(settled, moved.ravel(), atol=1e-9)
    for term in model.terms:
        energy = term.energy(state.unknowns, LOAD)
        assert term.energy(moved.ravel(), LOAD) == pytest.approx(energy, rel=1e-9, abs=1e-12)
