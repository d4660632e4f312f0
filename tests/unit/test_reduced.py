"""Tests of the reduced-order tier: cells, pieces, rows, blocked force, first guesses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from fem_checks import PAPER
from reduced_samples import (
    ACTUATION,
    CHANNEL,
    ELASTOMER,
    MIXED,
    SIZE,
    SLANTED,
    STRAIGHT,
    cell,
    solved,
)
from scipy.spatial.transform import Rotation

from pagd.actuation import Actuation, Body, blocked_force, free_actuation
from pagd.design import Design
from pagd.errors import InputError, Status
from pagd.fem.guided import GuidedPath
from pagd.fem.linear_solver import linear_solver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.mesh.chamber_row import chamber_row
from pagd.mesh.pieces import piece_between
from pagd.mesh.types import Mesh
from pagd.metrics import Trajectory, measure
from pagd.reduced import blocked
from pagd.reduced.blocked import blocked_forces
from pagd.reduced.cell_mesh import cell_mesh, cuts_of
from pagd.reduced.compliance import Answers, Compliance
from pagd.reduced.rod import Rod, held_force
from pagd.reduced.row import Row, unlike_their_neighbours
from pagd.reduced.solve import ReducedRow, solve_row
from pagd.reduced.transfer import guess
from pagd.rigid import RigidMotion
from pagd.rotations import rotation_matrix
from pagd.sections import place_sections, stations_of


def mesh_of(design: Design) -> Mesh:
    return chamber_row(design, CHANNEL, SIZE, half=design.is_straight)


def measured(design: Design, mesh: Mesh, pressure: np.ndarray, moved: np.ndarray) -> Trajectory:
    mirrored = "symmetry" in mesh.surfaces
    sections = place_sections(
        mesh.points, mesh.surfaces["paper"], stations_of(design), mirrored=mirrored
    )
    return measure(sections, pressure, moved)


def trajectory(reduced: ReducedRow, mesh: Mesh) -> Trajectory:
    row = reduced.row(mesh.points, CHANNEL)
    moved = np.stack([reduced.displacement(row, float(p)) for p in reduced.pressure_kPa])
    return measured(reduced.design, mesh, reduced.pressure_kPa, moved)


def test_cells_have_the_volumes_of_their_share_of_a_row() -> None:
    for design, half in ((STRAIGHT, True), (STRAIGHT, False), (SLANTED, False)):
        model = cell(design, half=half)
        # Chamber and channel: the cavity between the walls, the channel through walls and gap.
        wall = float(design.end_wall_lengths()[0])
        inside = (design.L - 2 * wall) * (design.W - 2 * design.t) * (design.H - design.t_h)
        channel = (2 * wall + design.t_n) * CHANNEL.width * CHANNEL.height
        assert model.volume(np.zeros(model.size)) == pytest.approx(inside + channel, rel=1e-9)


def test_half_cells_and_whole_ones_agree() -> None:
    """But for the blocks of the channel, of which a whole cell has half as many across."""
    half, whole = solved(STRAIGHT, pieces=False), solved(MIXED, pieces=True)
    screw, other = (row.cells[False].path.at(20.0).screw for row in (half, whole))
    np.testing.assert_allclose(screw.rotation, other.rotation, atol=1e-3)
    np.testing.assert_allclose(screw.displacement, other.displacement, atol=1e-2)


def test_unfolded_shapes_are_those_of_a_whole_cell() -> None:
    unfolded = solved(MIXED, pieces=False).cells[False]
    whole = solved(MIXED, pieces=True).cells[False]
    assert len(unfolded.model.mesh.points) < len(whole.model.mesh.points)
    points = whole.mesh.mesh.points
    moved = [points + cell.path.at(20.0).displacement for cell in (unfolded, whole)]
    # Other nodes are held against rigid motions.
    back = RigidMotion.of(moved[1], moved[0])
    # The blocks of the channel differ.
    np.testing.assert_allclose(back(moved[1]), moved[0], atol=0.03)


def test_neighbours_that_differ_are_found() -> None:
    assert unlike_their_neighbours(STRAIGHT) == [(0, 0), (4, 4)]
    assert unlike_their_neighbours(MIXED) == [(0, 0), (3, 4), (7, 7)]
    assert unlike_their_neighbours(replace(MIXED, alpha=0.125)) == [(0, 1), (7, 7)]
    assert unlike_their_neighbours(replace(MIXED, N=3, alpha=0.34)) == [(0, 2)]


@pytest.mark.parametrize("design", [STRAIGHT, SLANTED, MIXED], ids=["straight", "slanted", "mixed"])
def test_at_rest_a_row_of_parts_is_the_row(design: Design) -> None:
    mesh = mesh_of(design)
    for pieces in (False, True):
        reduced = solved(design, pieces=pieces)
        row = reduced.row(mesh.points, CHANNEL)
        np.testing.assert_allclose(reduced.displacement(row, 0.0), 0, atol=1e-9)


@pytest.mark.parametrize(
    ("design", "alone", "with_pieces"),
    [(STRAIGHT, 0.03, 0.004), (SLANTED, 0.06, 0.004), (MIXED, 0.06, 0.004)],
    ids=["straight", "slanted", "mixed"],
)
def test_rows_of_parts_are_near_the_whole(design: Design, alone: float, with_pieces: float) -> None:
    """The tip, by its displacement: pieces see what cells alone do not, the ends."""
    mesh = mesh_of(design)
    whole = free_actuation(mesh, ELASTOMER, PAPER, ACTUATION)
    assert whole.status is Status.ok
    moved = np.stack([state.displacement for state in whole.states])
    pressures = np.array([state.pressure_kPa for state in whole.states])
    wanted = measured(design, mesh, pressures, moved)
    for pieces, largest in ((False, alone), (True, with_pieces)):
        reduced = solved(design, pieces=pieces)
        assert reduced.status is Status.ok
        np.testing.assert_allclose(reduced.pressure_kPa, pressures)
        found = trajectory(reduced, mesh)
        travel = np.linalg.norm(wanted.positions[-1, -1] - wanted.positions[0, -1])
        error = np.linalg.norm(found.positions[-1, -1] - wanted.positions[-1, -1]) / travel
        assert error < largest


def test_volume_and_energy_of_pieces_and_cells_are_those_of_the_whole() -> None:
    reduced = solved(SLANTED, pieces=True)
    whole = free_actuation(mesh_of(SLANTED), ELASTOMER, PAPER, ACTUATION)
    cells = SLANTED.N - 2
    result = reduced.cells[True].result
    recorded = result.history["recorded"]
    for name, of_piece in (("cavity_volume_mm3", "volumes"), ("stored_energy_mJ", "energies")):
        parts = cells * result.history[name][recorded]
        parts = parts + sum(getattr(piece.followed, of_piece) for piece in reduced.pieces)
        wanted = whole.history[name][whole.history["recorded"]]
        np.testing.assert_allclose(parts, wanted, rtol=3e-3, atol=1e-6)


def test_a_first_guess_from_parts_leads_to_the_same_states() -> None:
    mesh = mesh_of(SLANTED)
    whole = free_actuation(mesh, ELASTOMER, PAPER, ACTUATION)
    reduced = solved(SLANTED, pieces=True)
    row = reduced.row(mesh.points, CHANNEL)
    body = Body(mesh, ELASTOMER, PAPER, ACTUATION)
    assembly, solver = body.assembly(), linear_solver()
    newton = Newton(assembly, solver, 3 * body.nodes, NewtonSettings(), body.pressure)
    start = assembly.at_rest()
    assembly.look_around(start)
    path = GuidedPath(newton, lambda load: guess(body, reduced, row, 1e3 * load))
    found: list[np.ndarray] = []
    loads = [1e-3 * pressure for pressure in reduced.pressure_kPa[1:]]

    def observe(step: object) -> None:
        found.append(body.displacement(step.state.unknowns))  # type: ignore[attr-defined]

    ended = path.follow(loads, observe, start)
    assert not ended.failure
    assert len(found) == len(loads)
    factorisations = whole.figures["factorisations"]
    assert isinstance(factorisations, int)
    assert solver.factorisations <= factorisations / 2
    for displacement, state in zip(found, whole.states[1:], strict=True):
        np.testing.assert_allclose(displacement, state.displacement, atol=0.02)


@pytest.mark.parametrize("design", [STRAIGHT, SLANTED, MIXED], ids=["straight", "slanted", "mixed"])
def test_blocked_force_is_near_that_of_the_whole(design: Design) -> None:
    held = blocked_force(mesh_of(design), ELASTOMER, PAPER, ACTUATION)
    wanted = held.history["blocked_force_N"][held.history["recorded"]]
    for pieces in (False, True):
        found = blocked_forces(solved(design, pieces=pieces), CHANNEL).force_N
        assert len(found) == len(wanted)
        np.testing.assert_allclose(found[1:], wanted[1:], rtol=0.1)


def test_a_row_that_kept_nothing_cannot_be_held() -> None:
    short = Actuation(maximum_pressure_kPa=1.0, recorded_step_kPa=1.0)
    reduced = solve_row(STRAIGHT, CHANNEL, SIZE, ELASTOMER, PAPER, short)
    assert reduced.cells[False].kept is None
    with pytest.raises(ValueError, match="keep their factors"):
        blocked_forces(reduced, CHANNEL)


def test_two_chambers_have_a_joint() -> None:
    found = blocked_forces(solved(replace(SLANTED, N=2), pieces=False), CHANNEL)
    assert (found.force_N[1:] > 0).all()
    assert (found.turned_deg[1:] > 0).all()


@pytest.mark.parametrize("design", [STRAIGHT, SLANTED], ids=["straight", "slanted"])
def test_compliances_are_what_small_moments_do(design: Design) -> None:
    """Rotation of the motion and of the chamber's base, against states solved for."""
    known = solved(design, pieces=False).cells[bool(design.chamber_skews()[0])]
    model, state, kept = known.model, known.states[-1], known.kept
    assert kept is not None
    found = Answers(model, kept.assembly, kept.solver).at(state)
    # About the width, the axis that a half model has too; half of it bears half.
    moment = np.array([0.0, 0.02, 0.0])
    kept.assembly.moment = moment / model.copies
    settings = NewtonSettings(tolerance=1e-7, iterations=20)
    newton = Newton(kept.assembly, kept.solver, 3 * model.nodes, settings)
    loaded = newton.solve(state).state
    kept.assembly.moment = np.zeros(3)
    kept.solver.free()
    assert loaded is not None
    turned = []
    for each in (state, loaded):
        rows = each.unknowns.reshape(-1, 3)
        frames = []
        for plane in (0.0, design.L):
            nodes = model.cell.base_at(plane, 0.0)
            places = model.points[nodes]
            frames.append(RigidMotion.of(places, places + rows[nodes]).rotation)
        turned.append([rotation_matrix(rows[model.tie.motion]), *frames])
    wanted, front, back = (
        Rotation.from_matrix(after @ before.T).as_rotvec()
        for before, after in zip(*turned, strict=True)
    )
    np.testing.assert_allclose((found @ moment)[:3], wanted, rtol=0.01, atol=1e-7)
    if model.copies == 1:
        np.testing.assert_allclose((found @ moment)[6:], back - front, rtol=0.03, atol=1e-6)
        half = Compliance.constant(found).of_half_a_chamber()
        np.testing.assert_allclose(half.without[:3], 0.5 * found[6:])
        assert not half.without[3:].any()


def test_a_joint_in_front_makes_a_held_row_softer() -> None:
    stiff = Compliance.constant(np.zeros((9, 3)))
    soft = Compliance.constant(np.vstack([0.02 * np.eye(3), np.zeros((6, 3))]))
    turn = Rotation.from_rotvec([0.0, 0.05, 0.0]).as_matrix()
    rod = Rod(
        base=RigidMotion.shift(0.0),
        rotations=np.tile(turn, (4, 1, 1)),
        displacements=np.tile([10.0, 0.0, 0.0], (4, 1)),
        centres=np.tile([10.0, 0.0, 0.0], (4, 1)),
        compliances=[soft] * 4,
        edge=np.array([[5.0, -5.0, 0.0], [5.0, 5.0, 0.0]]),
        height=0.0,
        is_planar=False,
    )
    place = np.array([2.0, 0.0, 0.0])
    forces = []
    for each in (rod, rod.with_joint_in_front(place, stiff), rod.with_joint_in_front(place, soft)):
        found = held_force(each)
        assert found is not None
        forces.append(found[0])
    assert forces[1] == pytest.approx(forces[0], rel=1e-6)
    assert forces[2] < 0.9 * forces[0]


def test_a_rod_of_many_joints_is_a_beam() -> None:
    """A beam of curvature κ whose tip is held at its height: F = 3 EI κ/2L, for small angles."""
    joints, length, curvature, compliance = 200, 100.0, 1e-5, 0.02
    pitch = length / joints
    turn = RigidMotion.shift(0.0)
    angle = curvature * pitch
    rotation = np.array(
        [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    )
    answer = np.vstack([compliance / joints * np.eye(3), np.zeros((6, 3))])
    rod = Rod(
        base=turn,
        rotations=np.tile(rotation, (joints, 1, 1)),
        displacements=np.tile([pitch, 0.0, 0.0], (joints, 1)),
        centres=np.tile([pitch, 0.0, 0.0], (joints, 1)),
        compliances=[Compliance.constant(answer)] * joints,
        edge=np.zeros((2, 3)),
        height=0.0,
        is_planar=True,
    )
    found = held_force(rod)
    assert found is not None
    stiffness = length / compliance
    assert found[0] == pytest.approx(1.5 * stiffness * curvature / length, rel=0.02)


def test_a_chain_of_joints_by_its_formulas() -> None:
    """What a rod lacks of equilibrium, joint by joint with rotation matrices of SciPy."""
    draw, joints = np.random.default_rng(5), 4
    rod = Rod(
        base=RigidMotion(Rotation.from_rotvec([0.1, 0.2, -0.3]).as_matrix(), draw.normal(size=3)),
        rotations=Rotation.from_rotvec(0.3 * draw.normal(size=(joints, 3))).as_matrix(),
        displacements=10.0 * draw.normal(size=(joints, 3)),
        centres=5.0 * draw.normal(size=(joints, 3)),
        compliances=[Compliance(*draw.normal(size=(2, 9, 3)), draw.normal(size=3))] * joints,
        edge=draw.normal(size=(2, 3)),
        height=0.7,
        is_planar=False,
    )
    forces, moments = draw.normal(size=2), draw.normal(size=(joints, 3))
    lacks = rod.lacking()(np.concatenate([forces, moments.ravel()]))

    place, cuts, turns = rod.base, [], []
    for k, moment in enumerate(moments):
        one = rod.compliances[k]
        share = one.moment @ moment / (one.moment @ one.moment)
        answer = (one.without + 0.5 * share * (one.loaded - one.without)) @ moment
        turned = Rotation.from_rotvec(answer[:3]).as_matrix()
        cuts.append(place(rod.centres[k]))
        turns.append(place.rotation)
        arm = rod.displacements[k] - rod.centres[k]
        behind = rod.centres[k] + turned @ arm + answer[3:6]
        place = place @ RigidMotion(turned @ rod.rotations[k], behind)
    ends = place(rod.edge)
    np.testing.assert_allclose(lacks[:2], ends[:, 2] - 0.7, rtol=1e-9)
    for k, (cut, turn) in enumerate(zip(cuts, turns, strict=True)):
        acting = sum(np.cross(e - cut, [0.0, 0.0, f]) for e, f in zip(ends, forces, strict=True))
        np.testing.assert_allclose(lacks[2:].reshape(-1, 3)[k], moments[k] - turn.T @ acting)


def test_a_pressure_too_far_is_come_to_by_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    reduced = solved(STRAIGHT, pieces=False)
    wanted = blocked_forces(reduced, CHANNEL).force_N
    starts: list[bool] = []

    def only_near(rod: Rod, guess: np.ndarray | None = None) -> tuple[float, np.ndarray] | None:
        """As if the solver found nothing from a guess that is farther off than a little."""
        found = held_force(rod, guess)
        assert found is not None
        near = guess is None or abs(rod.force(guess) - found[0]) < 0.012 * abs(found[0])
        starts.append(near)
        return found if near else None

    monkeypatch.setattr(blocked, "held_force", only_near)
    np.testing.assert_allclose(blocked_forces(reduced, CHANNEL).force_N, wanted, rtol=1e-6)
    assert not all(starts)


def test_what_a_cell_does_not_bear_changes_it_as_before() -> None:
    first = Compliance(np.ones((9, 3)), 0.5 * np.ones((9, 3)), np.array([0.0, 2.0, 0.0]))
    softer = Compliance.constant(3.0 * np.ones((9, 3))).changed_as(first)
    np.testing.assert_allclose(softer.loaded - softer.without, -0.5)


def test_fewer_recorded_pressures_than_compliances_do() -> None:
    whole = solved(STRAIGHT, pieces=False)
    two = replace(whole, pressure_kPa=whole.pressure_kPa[:2])
    found = blocked_forces(two, CHANNEL)
    assert found.force_N.shape == found.turned_deg.shape == (2,)
    assert found.force_N[1] > 0
    assert found.turned_deg[1] > 0


def test_a_cell_that_a_design_does_not_have_is_refused() -> None:
    with pytest.raises(InputError, match="A design without slanted chambers has no slanted cell"):
        cell_mesh(STRAIGHT, CHANNEL, SIZE, helical=True)


def test_gravity_is_refused() -> None:
    with pytest.raises(InputError, match="Under gravity the cells of a row are not alike"):
        cell(STRAIGHT, actuation=Actuation(gravity_m_s2=(0.0, 0.0, -9.81)))


def test_nodes_that_are_no_cells_are_refused() -> None:
    reduced = solved(STRAIGHT, pieces=False)
    mesh = mesh_of(STRAIGHT)
    middle = np.abs(mesh.points[:, 0] - mesh.points[:, 0].mean()) < 5
    points = mesh.points + 0.3 * middle[:, None]
    with pytest.raises(InputError, match="not those of its cells"):
        Row(STRAIGHT, {False: reduced.cells[False].mesh}, points, CHANNEL.gap_floor)


def test_pieces_of_a_mesh_are_cut_at_its_planes() -> None:
    mesh = mesh_of(STRAIGHT)
    front, back = cuts_of(STRAIGHT, SIZE)
    piece = piece_between(mesh, 10 + front, 10 + back)
    assert piece.mesh.points[:, 0].min() == pytest.approx(10 + front)
    assert piece.mesh.points[:, 0].max() == pytest.approx(10 + back)
    np.testing.assert_array_equal(piece.mesh.points, mesh.points[piece.numbers])
    assert {"cavity", "paper", "outer", "symmetry"} == set(piece.mesh.surfaces)
    with pytest.raises(InputError, match=r"no planes at x = 9\.5 and 21 mm"):
        piece_between(mesh, 9.5, 21.0)


def test_straight_rows_may_be_whole() -> None:
    mesh = chamber_row(STRAIGHT, CHANNEL, SIZE, half=False)
    short = replace(ACTUATION, maximum_pressure_kPa=5.0)
    reduced = solve_row(STRAIGHT, CHANNEL, SIZE, ELASTOMER, PAPER, short, mesh)
    assert reduced.status is Status.ok
    assert reduced.cells[False].model.copies == 1
