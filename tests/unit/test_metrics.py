"""Metrics of displacement fields that are known in closed form."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from pagd import metrics
from pagd.design import Design
from pagd.errors import InputError
from pagd.metrics import Thresholds, energy_balance, measure, measured_mode, work_of_pressure
from pagd.rotations import twist_angle
from pagd.sections import Stations, even_stations, place_sections, stations_of

LENGTH, WIDTH, LEVEL, JOINTS = 120.0, 15.0, -1.06, 12
TIP = np.array([LENGTH, 0.0, LEVEL])


def paper_mesh(low=-WIDTH / 2, high=WIDTH / 2, size=2.5, jitter=0.25, hole=None):
    """Nodes and six-node faces of a flat, irregular mesh of the rectangle."""
    nx, ny = round(LENGTH / size), round((high - low) / size)
    x, y = np.meshgrid(np.linspace(0, LENGTH, nx + 1), np.linspace(low, high, ny + 1))
    move = np.random.default_rng(5).uniform(-jitter, jitter, (2, *x.shape)) * size
    x[:, 1:-1] += move[0, :, 1:-1]
    y[1:-1] += move[1, 1:-1]
    i = np.arange((nx + 1) * (ny + 1)).reshape(ny + 1, nx + 1)
    a, b, c, d = (i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1])
    corners = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    points = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, LEVEL)])
    if hole is not None:
        corners = corners[~hole(points[corners].mean(axis=1))]
    edges = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    unique, inverse = np.unique(edges, axis=0, return_inverse=True)
    middles = len(points) + inverse.reshape(-1, 3)
    return np.vstack([points, points[unique].mean(axis=1)]), np.hstack([corners, middles])


def screw(points, twist, bending, sideways=0.0):
    """Displacement of constant twist and curvature with the given totals in radians."""
    rate = np.array([twist, bending, sideways]) / LENGTH
    arc = points[:, 0]
    angle = np.maximum(np.linalg.norm(rate) * arc, 1e-9)[:, None]
    axis = rate / max(np.linalg.norm(rate), 1e-30)
    # Centre line: the integral of exp(s [rate]x) e_x over the arc length.
    along, across = np.cross(axis, [1.0, 0, 0]), np.cross(axis, np.cross(axis, [1.0, 0, 0]))
    line = (1 - np.cos(angle)) / angle * along + (1 - np.sin(angle) / angle) * across
    line = arc[:, None] * (line + np.array([1.0, 0.0, 0.0]))
    arm = points * [0.0, 1.0, 1.0] - [0.0, 0.0, LEVEL]
    arm = Rotation.from_rotvec(arc[:, None] * rate).apply(arm)
    return line + arm + np.array([0.0, 0.0, LEVEL]) - points


def trajectory(fields, points, faces, stations=None, mirrored=False):
    stations = stations or even_stations(LENGTH, JOINTS + 1)
    sections = place_sections(points, faces, stations, mirrored=mirrored)
    found = measure(sections, np.arange(1.0, len(fields) + 1.0), np.array(fields))
    assert found.pressure_kPa[0] == 0.0
    # The unloaded state has a test of its own.
    return dataclasses.replace(
        found,
        **{k: getattr(found, k)[1:] for k in ("pressure_kPa", "positions", "rotations", "joints")},
    )


def test_unloaded_actuator_has_no_angles():
    points, faces = paper_mesh()
    sections = place_sections(points, faces, even_stations(LENGTH, JOINTS + 1), mirrored=False)
    found = measure(sections, np.empty(0), np.empty((0, *points.shape)))
    assert found.pressure_kPa == pytest.approx([0.0])
    assert np.abs(found.joints).max() < 1e-9
    np.testing.assert_allclose(found.positions[0, -1], TIP, atol=1e-9)
    assert found.chord_deg == pytest.approx(0.0)


def test_frames_of_a_rigid_motion_are_its_rotation():
    points, faces = paper_mesh()
    rotation = Rotation.from_rotvec([0.4, -2.0, 1.1]).as_matrix()
    field = points @ rotation.T + [3.0, 4.0, 5.0] - points
    sections = place_sections(points, faces, even_stations(LENGTH, 13), mirrored=False)
    frames = sections.frames(field)
    np.testing.assert_allclose(frames, np.broadcast_to(rotation, frames.shape), atol=1e-10)
    np.testing.assert_allclose(sections.positions(field)[-1], rotation @ TIP + [3, 4, 5])


def test_bending_goes_through_400_degrees_in_few_states():
    points, faces = paper_mesh()
    totals = np.radians([60.0, 130.0, 250.0, 400.0])
    found = trajectory([screw(points, 0.0, a) for a in totals], points, faces)
    np.testing.assert_allclose(found.bending_deg[:, -1], np.degrees(totals), rtol=2e-3)
    np.testing.assert_allclose(np.diff(found.bending_deg[-1]), 400 / JOINTS, rtol=0.02)
    assert np.abs(found.twist_deg).max() < 0.3
    assert np.abs(found.sideways_deg).max() < 0.3


def test_positive_bending_is_towards_the_paper_side():
    points, faces = paper_mesh()
    angle = np.pi / 2
    found = trajectory([screw(points, 0.0, angle)], points, faces)
    radius = LENGTH / angle
    np.testing.assert_allclose(found.positions[0, -1], [radius, 0.0, LEVEL - radius], atol=1e-6)
    # An arc's chord turns by half of its tip.
    assert found.chord_deg[0] == pytest.approx(45.0, abs=1e-6)
    assert found.swing_deg[0] == pytest.approx(90.0, abs=0.2)


def test_positive_twist_raises_the_edge_at_positive_y():
    points, faces = paper_mesh()
    field = screw(points, np.radians(30.0), 0.0)
    assert field[np.argmax(points[:, 0] + points[:, 1]), 2] > 0.0
    found = trajectory([field, screw(points, np.radians(500.0), 0.0)], points, faces)
    np.testing.assert_allclose(found.twist_deg[:, -1], [30.0, 500.0], rtol=1e-3)
    assert np.abs(found.bending_deg).max() < 0.1
    np.testing.assert_allclose(found.positions[:, -1], [TIP, TIP], atol=1e-6)


@pytest.mark.parametrize("count", [7, 13, 25])
def test_angles_of_a_helix_do_not_depend_on_the_number_of_stations(count):
    points, faces = paper_mesh()
    field = screw(points, np.radians(40.0), np.radians(100.0))
    found = trajectory([field], points, faces, even_stations(LENGTH, count))
    assert found.twist_deg[0, -1] == pytest.approx(40.0, abs=0.1)
    assert found.bending_deg[0, -1] == pytest.approx(100.0, abs=0.2)


def test_swing_twist_of_a_helix_mixes_bending_into_twist():
    points, faces = paper_mesh()
    twist, bending = np.radians([40.0, 100.0])
    found = trajectory([screw(points, twist, bending)], points, faces)
    whole = np.hypot(twist, bending)
    expected = 2.0 * np.arctan(twist / whole * np.tan(whole / 2.0))
    assert np.degrees(expected) == pytest.approx(53.9, abs=0.1)
    assert found.swing_twist_deg[0] == pytest.approx(np.degrees(expected), abs=0.2)
    # Of one joint, a twelfth of it, both notions are the same to 0.5 %.
    joint = found.rotations[0, 4].T @ found.rotations[0, 5]
    single = np.degrees(twist_angle(joint))
    assert single == pytest.approx(float(np.diff(found.twist_deg[0])[4]), rel=5e-3)


def test_out_of_plane_deflection_has_the_sign_of_y():
    points, faces = paper_mesh()
    field = screw(points, 0.0, 0.0, np.radians(30.0))
    found = trajectory([field], points, faces)
    expected = LENGTH * (1.0 - np.cos(np.radians(30.0))) / np.radians(30.0)
    assert found.out_of_plane_mm[0] == pytest.approx(expected, rel=1e-6)
    assert found.sideways_deg[0, -1] == pytest.approx(30.0, abs=0.05)


def test_mirror_image_bends_alike_and_twists_opposite():
    points, faces = paper_mesh()
    angles = [
        trajectory([screw(points, s * 0.7, 2.0, s * 0.2)], points, faces) for s in (1.0, -1.0)
    ]
    np.testing.assert_allclose(angles[0].bending_deg, angles[1].bending_deg, atol=0.05)
    np.testing.assert_allclose(angles[0].twist_deg, -angles[1].twist_deg, atol=0.05)


def test_single_joint_is_followed_beyond_half_a_turn():
    points, faces = paper_mesh()
    totals = np.radians([100.0, 170.0, 260.0, 370.0, 540.0])
    fields = [screw(points, 0.2 * a, a) for a in totals]
    stations = Stations(np.array([0.0, LENGTH]), ("fixed end", "tip"))
    found = trajectory(fields, points, faces, stations)
    np.testing.assert_allclose(found.bending_deg[:, -1], np.degrees(totals), rtol=0.01)


def test_half_model_gives_the_angles_of_the_whole_without_twist():
    angle = np.radians(300.0)
    whole, half = paper_mesh(), paper_mesh(low=0.0)
    bowed = [screw(p, 0.0, angle) for p in (whole[0], half[0])]
    for field, (points, _) in zip(bowed, (whole, half), strict=True):
        # The strip also bows across, as a bent elastomer does, and widens.
        field[:, 1] += 0.02 * points[:, 1]
        field[:, 2] += 0.004 * points[:, 1] ** 2 * points[:, 0] / LENGTH
    full = trajectory([bowed[0]], *whole)
    mirrored = trajectory([bowed[1]], *half, mirrored=True)
    np.testing.assert_allclose(mirrored.bending_deg, full.bending_deg, atol=0.25)
    assert np.abs(mirrored.twist_deg).max() < 1e-9
    assert np.abs(mirrored.sideways_deg).max() < 1e-9
    np.testing.assert_allclose(mirrored.positions, full.positions, atol=1e-3)


def test_mesh_size_and_irregularity_hardly_matter():
    bending = []
    for size, jitter in ((5.0, 0.3), (2.0, 0.0)):
        points, faces = paper_mesh(size=size, jitter=jitter)
        bending.append(trajectory([screw(points, 0.3, np.radians(270.0))], points, faces))
    np.testing.assert_allclose(bending[0].bending_deg, bending[1].bending_deg, atol=1.5)
    np.testing.assert_allclose(bending[0].twist_deg, bending[1].twist_deg, atol=1.5)


def test_noise_of_a_micrometre_turns_the_tip_by_less_than_a_tenth_of_a_degree():
    points, faces = paper_mesh()
    field = screw(points, 0.5, 2.0)
    noisy = field + 1e-3 * np.random.default_rng(6).normal(size=field.shape)
    clean, found = (trajectory([f], points, faces) for f in (field, noisy))
    assert 0.0 < np.abs(found.bending_deg - clean.bending_deg).max() < 0.1
    assert 0.0 < np.abs(found.twist_deg - clean.twist_deg).max() < 0.1


def test_hole_in_the_paper_is_left_out():
    points, faces = paper_mesh(hole=lambda c: (np.abs(c[:, 0] - 70.0) < 4.0) & (c[:, 1] > 2.5))
    found = trajectory([screw(points, 0.5, 2.0)], points, faces)
    # One side of a twisted strip bends a little more or less; the joints beyond see none of it.
    np.testing.assert_allclose(np.diff(found.bending_deg[0]), np.degrees(2.0) / JOINTS, rtol=0.1)
    assert found.bending_deg[0, -1] == pytest.approx(np.degrees(2.0), rel=2e-3)


def test_station_off_the_paper_is_refused():
    points, faces = paper_mesh()
    with pytest.raises(InputError, match=r"'tip', x = 130 mm.*off the paper"):
        place_sections(points, faces, even_stations(130.0, 5), mirrored=False)


def test_section_with_a_single_face_of_paper_is_refused():
    points, faces = paper_mesh(
        jitter=0.0, hole=lambda c: (np.abs(c[:, 0] - 60.0) < 9.0) & (np.abs(c[:, 1]) > 1.3)
    )
    near = np.abs(points[faces[:, :3]].mean(axis=1)[:, 0] - 60.0) < 9.0
    around = np.isclose(points[faces[:, :3]], [60.0, 0.0, LEVEL]).all(axis=2).any(axis=1)
    with pytest.raises(InputError, match=r"'section 1'.*too little of it lies on the paper"):
        place_sections(points, faces[~near | around], even_stations(LENGTH, 3), mirrored=False)


@pytest.mark.parametrize("x", [[0.0], [0.0, 5.0, 5.0], [3.0, 1.0], [0.0, np.nan]])
def test_stations_must_rise(x):
    with pytest.raises(InputError, match="rising x"):
        Stations(np.array(x), ("a",) * len(x))


def test_stations_of_a_design_lie_in_the_middle_of_its_gaps():
    design = Design(
        L=8.01, W=15.12, H=12.98, t=1.49, t_n=2.8, t_h=4.07, t_ab=2.05, t_b=1.97, N=12,
        theta=27.2, alpha=0.5,
    )  # fmt: skip
    stations = stations_of(design)
    assert len(stations.x) == 13
    assert stations.x[[0, -1]] == pytest.approx([0.0, design.L_T])
    half_skew = 15.12 / 2 * np.tan(np.radians(27.2))
    assert stations.x[1] == pytest.approx(half_skew + 8.01 + 1.4)
    assert np.diff(stations.x)[7:11] == pytest.approx(10.81)
    assert stations.names[6] == "chamber 6|7"


MODES = {
    "bending": np.zeros(12),
    "twisting": np.full(12, 6.0),
    "mixed": np.repeat([6.0, 0.0], 6),
}


@pytest.mark.parametrize("mode", MODES)
def test_mode_is_told_from_the_joints(mode):
    bending = np.linspace(0.0, 240.0, 13)
    twist = np.concatenate([[0.0], np.cumsum(MODES[mode])])
    assert measured_mode(bending, twist) == mode
    assert measured_mode(bending, -twist) == mode
    one_odd_joint = twist.copy()
    one_odd_joint[1:] += 3.0 if mode == "bending" else -6.0
    assert measured_mode(bending, one_odd_joint) == mode


def test_twist_without_bending_is_twisting():
    assert measured_mode(np.zeros(9), np.linspace(0.0, 50.0, 9)) == "twisting"


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("tip_twist", "expected"), [(0.0, "bending"), (-1.5, "twisting")])
def test_where_no_joint_turns_enough_the_tip_tells(tip_twist, expected):
    """100 joints of 0.06° each."""
    line = np.linspace(0.0, 1.0, 101)
    assert measured_mode(6.0 * line, tip_twist * line) == expected
    # The tip has turned by less than what is left out of joints.
    short = Thresholds(still_deg=0.0, joint_deg=10.0)
    assert measured_mode(6.0 * line, tip_twist * line, short) == expected


@pytest.mark.filterwarnings("error")
def test_what_does_not_turn_at_all_has_no_mode():
    for joint_deg in (0.0, 0.2):
        every = Thresholds(still_deg=0.0, joint_deg=joint_deg)
        assert measured_mode(np.zeros(9), np.zeros(9), every) == "none"


def test_actuator_below_the_threshold_is_still():
    line = np.linspace(0.0, 1.0, 9)
    assert measured_mode(4.9 * line, 4.9 * line) == "none"
    assert measured_mode(5.1 * line, 0.0 * line) == "bending"
    assert measured_mode(4.9 * line, 0.0 * line, Thresholds(still_deg=1.0)) == "bending"
    assert metrics.is_still(-3.0, 4.0)
    assert not metrics.is_still(-6.0, 0.0)


def test_work_of_a_linear_cavity_is_exact():
    pressure = np.array([0.0, 5.0, 12.0, 50.0])
    # 20 mm³/kPa: ∫ p dV = 20 p²/2 kPa mm³.
    work = work_of_pressure(pressure, 3000.0 + 20.0 * pressure)
    np.testing.assert_allclose(work, 10.0 * pressure**2 * 1e-3)


def test_energy_balance_is_relative_to_the_stored_energy():
    balance = energy_balance(np.array([0.0, 0.0, 1.0, 99.0]), np.array([0.0, 1e-13, 0.0, 100.0]))
    np.testing.assert_allclose(balance, [0.0, 0.0, np.inf, 0.01])


def test_performance_takes_the_recorded_steps_of_the_history():
    points, faces = paper_mesh()
    fields = [screw(points, 0.1 * p, p) for p in (0.5, 1.0, 2.0)]
    found = trajectory(fields, points, faces)
    steps = np.array([0.0, 0.4, 1.0, 1.7, 2.0, 3.0])
    history = {
        "pressure_kPa": steps,
        "cavity_volume_mm3": 100.0 + 10.0 * steps,
        "stored_energy_mJ": 5e-3 * steps**2 * 1.01,
        "smallest_gap_mm": 2.0 - 0.5 * steps,
        "recorded": np.isin(steps, found.pressure_kPa),
    }
    table = metrics.performance(found, history, solid_volume_mm3=20.0)
    np.testing.assert_allclose(table["work_mJ"], 5e-3 * np.array([1.0, 4.0, 9.0]))
    np.testing.assert_allclose(table["work_density_kJ_m3"], 0.25 * np.array([1.0, 4.0, 9.0]))
    np.testing.assert_allclose(table["energy_balance"], 0.01 / 1.01)
    np.testing.assert_allclose(table["cavity_volume_mm3"], [110.0, 120.0, 130.0])
    assert list(table["measured_mode"]) == ["bending"] * 3
    assert {len(column) for column in table.values()} == {3}
    np.testing.assert_allclose(table["smallest_gap_mm"], [1.5, 1.0, 0.5])
    with pytest.raises(ValueError, match=r"\[1.0, 2.0\] kPa, the states at \[1.0, 2.0, 3.0\]"):
        metrics.performance(found, {k: v[:5] for k, v in history.items()}, 20.0)


def test_states_are_found_by_their_mark_where_the_pressure_falls_and_comes_again():
    points, faces = paper_mesh()
    fields = np.array([screw(points, 0.0, 0.1 * p) for p in range(4)])
    sections = place_sections(points, faces, even_stations(LENGTH, 5), mirrored=False)
    found = measure(sections, np.array([0.0, 5.0, 10.0, 8.0]), fields)
    history = {
        "pressure_kPa": np.array([0.0, 5.0, 12.0, 9.0, 5.0, 10.0, 8.0]),
        "cavity_volume_mm3": 1000.0 * np.arange(1.0, 8.0),
        "stored_energy_mJ": np.arange(7.0),
        "smallest_gap_mm": np.full(7, np.nan),
        "recorded": np.array([True, True, False, False, False, True, True]),
    }
    table = metrics.performance(found, history, 20.0)
    np.testing.assert_allclose(table["stored_energy_mJ"], [0.0, 1.0, 5.0, 6.0])
    # Trapezoids along the path: 2.5 + 8.5 + 10.5 + 7 + 7.5 + 9 kPa times 1000 mm³.
    np.testing.assert_allclose(table["work_mJ"], [0.0, 2.5, 36.0, 45.0])
    assert found.bending_deg[-1, -1] == pytest.approx(np.degrees(0.3), rel=5e-3)


def test_trajectory_table_has_a_row_a_pressure_and_station():
    points, faces = paper_mesh()
    found = trajectory([screw(points, 0.3, a) for a in (0.5, 1.0)], points, faces)
    table = found.columns()
    assert {len(column) for column in table.values()} == {2 * (JOINTS + 1)}
    last = (table["pressure_kPa"] == 2.0) & (table["station"] == JOINTS)
    assert table["x_mm"][last] == pytest.approx(found.positions[1, -1, 0])
    assert table["twist_deg"][last] == pytest.approx(found.twist_deg[1, -1])
