"""Pictures of contact, blocked force and cavity volume, and what the page says of them."""

import dataclasses
import json

import numpy as np
import pytest
from figure_samples import (
    FORCE,
    SIZE,
    STEPS,
    path_only,
    record,
    solve_record,
    solved,
    states_of,
    steps,
)
from figure_samples import block as sample_block
from matplotlib.text import Text

from pagd.errors import InputError, Status
from pagd.figures import load
from pagd.figures.blocked import Blocked, Pair, blocked_force_figure, draw_blocked_force
from pagd.figures.contact import contact_figure, draw_contact, picture_of_touching
from pagd.figures.curves import curves_of, steps_data
from pagd.figures.deformed import Shapes, _chosen
from pagd.figures.forces import draw_forces, forces_figure
from pagd.figures.groups import by_mode, read_entries
from pagd.figures.load import Steps
from pagd.figures.page.mechanics import contact_note, mechanics_of
from pagd.figures.pressure_volume import (
    draw_pressure_volume,
    pressure_volume_figure,
    volume_controlled,
)
from pagd.figures.surface import OUTSIDE
from pagd.figures.touching import deformed_faces
from pagd.record import write_record
from pagd.stages import figures as stage
from pagd.tables import TRAJECTORY, write_table

# A path whose pressure falls at its end.
FALLING = np.array([0.0, 5.0, 10.0, 20.0, 15.0])


# Pressure and force of the states whose force is known.
KNOWN = np.column_stack([STEPS, FORCE])[STEPS != 5.0]


def steps_of(pressure=STEPS, contact=True, force=None, closing=0.007):
    columns = steps(contact, pressure, closing)
    names = [field.name for field in dataclasses.fields(Steps)][:-1]
    return Steps(**{name: columns[name] for name in names}, blocked_force_N=force)


def labels(figure):
    figure.draw_without_rendering()
    return [text.get_text() for text in figure.findobj(Text) if text.get_text()]


# ---- reading --------------------------------------------------------------------------------


def test_steps_are_those_of_the_files(tmp_path):
    folder = solved(tmp_path / "d")
    free, held = load.load_history(folder), load.load_blocked_force(folder)
    np.testing.assert_array_equal(free.recorded, [True, False, True, True, True])
    assert np.isnan(free.smallest_gap_mm[0])
    assert free.smallest_gap_mm[-1] == pytest.approx(-0.01)
    assert free.blocked_force_N is None
    np.testing.assert_allclose(held.blocked_force_N, FORCE)
    free_states, held_states = load.load_states(folder), load.load_blocked_states(folder)
    np.testing.assert_allclose(held_states.displacement, 0.4 * free_states.displacement, atol=1e-5)


def test_a_trajectory_keeps_the_order_of_its_path(tmp_path):
    """Past a limit point a pressure may come twice, the second time farther bent."""
    pressure = [0.0, 20.0, 30.0, 20.0]
    p, s = (np.array(a).ravel() for a in np.meshgrid(pressure, [0, 1], indexing="ij"))
    bending = np.repeat([0.0, 30.0, 60.0, 90.0], 2) * s
    columns = {"x_mm": s, "y_mm": s, "z_mm": s, "bending_deg": bending, "twist_deg": bending}
    table = {"design_id": ["d"] * 8, "pressure_kPa": p, "station": s.astype(np.int32)} | columns
    (tmp_path / "metrics").mkdir()
    write_table(tmp_path / "metrics" / "trajectory.parquet", TRAJECTORY, table)
    path = load.load_trajectory(tmp_path)
    np.testing.assert_array_equal(path.pressure_kPa, pressure)
    np.testing.assert_array_equal(path.bending_deg[:, -1], [0, 30, 60, 90])


def test_states_of_a_path_that_turns_are_drawn_to_its_end():
    pressure = np.array([0.0, 10.0, 20.0, 30.0, 20.0, 10.0])
    np.testing.assert_array_equal(_chosen(pressure), np.arange(6))
    # Evenly by pressure where it only rises, the end included.
    rising = np.array([0.0, 1.0, 10.0, 20.0, 30.0, 40.0, 49.0, 50.0])
    np.testing.assert_array_equal(_chosen(rising), [0, 2, 3, 4, 5, 7])


# ---- pressure and volume --------------------------------------------------------------------


def test_the_section_under_control_of_the_volume_begins_where_the_pressure_stopped():
    assert volume_controlled(FALLING, None) is None
    assert volume_controlled(FALLING, 20.0) == slice(3, None)
    # It was to begin at the last step, and none followed.
    assert volume_controlled(STEPS, 30.0) is None


def test_the_shaded_area_is_the_work():
    path = steps_of(FALLING)
    figure = pressure_volume_figure("d", path, 20.0)
    (axes,) = figure.axes
    x, y = axes.collections[0].get_paths()[0].vertices.T
    area = abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
    assert 1e-3 * area * path.cavity_volume_mm3[0] == pytest.approx(path.work_mJ[-1])
    assert path.work_mJ[-1] > 1.0
    (legend,) = figure.legends
    names = [text.get_text() for text in legend.get_texts()]
    assert names == [
        f"work {path.work_mJ[-1]:.1f} mJ",
        "steps",
        "steps under control of the volume",
        "recorded states",
        "limit point",
    ]
    lines = {line.get_label(): line.get_xydata() for line in axes.lines}
    np.testing.assert_allclose(lines["steps under control of the volume"][:, 1], [20.0, 15.0])
    assert lines["limit point"].tolist() == [[1.4, 20.0]]
    assert len(lines["recorded states"]) == 4
    assert "20 kPa" in labels(figure)


@pytest.mark.parametrize("pressure", [STEPS, np.array([0.0, 10.0, 9.999, 20.0, 30.0])])
def test_a_rising_path_has_no_limit_in_its_picture(pressure):
    """A fall by less than the tolerance of the iteration is none."""
    names = labels(pressure_volume_figure("d", steps_of(pressure)))
    assert not {"limit point", "steps under control of the volume"} & set(names)


# ---- contact --------------------------------------------------------------------------------


@pytest.mark.parametrize("half", [False, True])
def test_faces_seen_from_outside_close_the_body(half):
    mesh = sample_block(half)
    faces = deformed_faces(mesh, np.zeros_like(mesh.points), OUTSIDE)
    a, b, c = (faces[:, i] for i in range(3))
    volume = np.einsum("ij,ij->", np.cross(a, b), c) / 6
    assert volume == pytest.approx(SIZE[0] * SIZE[1] * SIZE[2] * (2 if half else 1))


def touching_states(gap):
    """Two blocks, one above the other, that a pressure has brought near."""
    mesh = sample_block(half=False)
    size = len(mesh.points)
    above = mesh.points + np.array([0.0, 0.0, SIZE[2] + 3.0])
    surfaces = {name: np.vstack([f, f + size]) for name, f in mesh.surfaces.items()}
    both = dataclasses.replace(
        mesh,
        points=np.vstack([mesh.points, above]),
        tets=np.vstack([mesh.tets, mesh.tets + size]),
        surfaces=surfaces,
    )
    moved = np.zeros((2, 2 * size, 3))
    moved[1, size:, 2] = gap - 3.0
    return load.States(both, np.array([0.0, 30.0]), moved, np.zeros((2, 2 * size)))


def test_touching_parts_are_seen_through_the_body():
    (red, wall), (pale, none) = (
        picture_of_touching(touching_states(gap), (300.0, 300.0), touches=True)
        for gap in (0.03, 0.5)
    )
    assert (wall, none) == (pytest.approx(2 * SIZE[0] * SIZE[1], rel=0.02), 0.0)
    reddish = [
        np.sum((image[..., 0].astype(int) - image[..., 2] > 60) & (image[..., 3] > 0))
        for image in (red, pale)
    ]
    assert reddish[0] > 500
    assert reddish[1] == 0


def test_contact_shows_gaps_and_the_first_touch():
    analyses = {"free": steps_of(closing=0.0046), "held": steps_of()}
    states = {"free": touching_states(0.07), "held": touching_states(0.03)}
    figure = contact_figure("d", analyses, states, 28.57)
    curve = figure.axes[0]
    lines = {line.get_label(): np.asarray(line.get_xdata()) for line in curve.lines}
    assert set(lines["first contact, free: 28.57 kPa"]) == {28.57}
    assert "walls touch below 0.06 mm" in lines
    np.testing.assert_array_equal(lines["held"], STEPS)
    assert {"free, 30 kPa: no contact", "held, 30 kPa: 200 mm² in contact"} <= set(labels(figure))
    low, high = curve.get_ylim()
    assert low < 0.0 < high


@pytest.mark.parametrize(
    ("closing", "gap", "told"),
    [(0.0047, 0.03, "200 mm²"), (0.0047, 0.5, "less than 1 mm²"), (0.0046, 0.03, "no")],
)
def test_the_picture_says_of_contact_what_the_gap_of_its_state_says(closing, gap, told):
    """Walls touch at 0.2 - 0.0047 · 30 = 0.059 mm, and not at 0.2 - 0.0046 · 30 = 0.062 mm."""
    figure = contact_figure(
        "d", {"free": steps_of(closing=closing)}, {"free": touching_states(gap)}, None
    )
    assert any(text.startswith(f"free, 30 kPa: {told}") for text in labels(figure))


def test_walls_that_never_come_near_are_said_to():
    states = {"free": states_of(sample_block(half=False))}
    figure = contact_figure("d", {"free": steps_of(contact=False)}, states, None)
    assert {"no two walls come near", "free, 30 kPa: no contact"} <= set(labels(figure))


# ---- blocked force --------------------------------------------------------------------------

ENDED = {"variant": "plate", "status": "not_converged", "reason": "The step fell."}


def test_the_force_is_told_with_what_held_the_tip_and_how_it_ended():
    held = steps_of(force=FORCE)
    whole = blocked_force_figure("d", Blocked.of(held, solve_record("d").figures))
    assert {"0.690 N at 30 kPa", "d: blocked force, lower edge of the tip held"} <= set(
        labels(whole)
    )
    curve, dots = whole.axes[0].lines[1:]
    np.testing.assert_allclose(curve.get_xydata(), KNOWN)
    np.testing.assert_allclose(dots.get_xydata(), KNOWN)
    every = steps_of(force=0.1 * STEPS)
    curve, dots = blocked_force_figure("d", Blocked.of(every, {})).axes[0].lines[1:]
    assert (len(curve.get_xdata()), len(dots.get_xdata())) == (5, 4)
    early = labels(blocked_force_figure("d", Blocked.of(held, {"blocked_force": ENDED})))
    assert "0.690 N at 30 kPa\nended there: not converged" in early
    assert "d: blocked force, on a rigid plate" in early


def test_the_held_shape_is_shown_beside_the_free_one_of_its_pressure(tmp_path):
    folder = solved(tmp_path / "d")
    free, held = load.load_states(folder), load.load_blocked_states(folder)
    sooner = dataclasses.replace(
        held,
        pressure_kPa=held.pressure_kPa[:3],
        displacement=held.displacement[:3],
        strain=held.strain[:3],
    )
    pair = Pair(Shapes.of(free), Shapes.of(sooner))
    assert pair.state == 2
    analysis = Blocked.of(load.load_blocked_force(folder), ENDED)
    assert {"free, 20 kPa", "held, 20 kPa"} <= set(
        labels(blocked_force_figure("d", analysis, pair))
    )


def test_a_few_designs_share_a_panel_of_forces_and_many_go_by_mode(tmp_path):
    modes = ("mixed", "bending", "bending", "bending", "twisting")
    folders = [solved(tmp_path / f"d{i}", mode=mode) for i, mode in enumerate(modes)]
    entries = read_entries(folders)
    found = {folder.name: load.load_blocked_force(folder) for folder in folders}
    (one,) = forces_figure({"": entries[:2]}, found).axes
    assert [t.get_text() for t in one.get_legend().get_texts()] == ["d0", "d1"]
    panels = forces_figure(by_mode(entries), found).axes
    assert [axes.get_title(loc="left") for axes in panels] == [
        "bending (3)",
        "twisting (1)",
        "mixed (1)",
    ]
    assert len({axes.get_ylim() for axes in panels}) == 1
    lines = {line.get_label(): line.get_xydata() for line in panels[1].lines}
    np.testing.assert_allclose(lines["d4"], KNOWN)
    draw_forces([*folders, solved(tmp_path / "free", support="none")], tmp_path / "forces.png")
    assert (tmp_path / "forces.png").stat().st_size > 10_000
    with pytest.raises(InputError, match="None of the designs"):
        draw_forces([tmp_path / "free"], tmp_path / "none.png")


# ---- the stage ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("settings", "absent"),
    [
        ({}, set()),
        ({"contact": False}, {"contact"}),
        ({"support": "none"}, {"blocked_force"}),
    ],
)
def test_what_was_not_asked_for_is_not_drawn(tmp_path, settings, absent):
    folder = solved(tmp_path / "d", **settings)
    expected = {"mesh", "deformed", "pressure_volume", "contact", "blocked_force"} - absent
    assert set(stage._drawable(folder)) == expected


def test_of_a_design_that_was_not_solved_nothing_is_drawn(tmp_path):
    (tmp_path / "solve").mkdir()
    reason = {"status": Status.mesh_failed, "reason": "why"}
    write_record(record("d", "solve", **reason), tmp_path / "solve")
    assert stage._drawable(tmp_path) == {}
    assert curves_of(tmp_path) == {}


def test_pictures_of_a_solved_design_are_drawn_from_its_files(tmp_path):
    folder = solved(tmp_path / "d", support="edge", first_contact_pressure_kPa=28.6)
    for draw in (draw_pressure_volume, draw_contact, draw_blocked_force):
        draw(folder, tmp_path / f"{draw.__name__}.png")
        assert (tmp_path / f"{draw.__name__}.png").stat().st_size > 10_000


# ---- the page -------------------------------------------------------------------------------


def test_curves_hold_what_the_steps_know():
    free = steps_data(steps_of(contact=False))
    assert set(free) == {"pressure_kPa", "volume"}
    assert free["volume"] == [1.0, 1.1, 1.2, 1.4, 1.6]
    held = steps_data(steps_of(force=FORCE))
    assert held["gap_mm"] == [None, 0.165, 0.13, 0.06, -0.01]
    assert held["force_N"] == [0.0, None, 0.21, 0.44, 0.69]
    json.dumps(held, allow_nan=False)


def told(folder):
    return mechanics_of(read_entries([folder])[0])


def test_a_design_is_told_by_what_its_records_say(tmp_path):
    touched = solved(tmp_path / "touched", first_contact_pressure_kPa=20.0)
    assert told(touched) == (
        "In free actuation walls first touch at 20 kPa, and overlap by at most 0.010 mm, 5.0 % of"
        " the gap. Blocked force (lower edge of the tip held): 0.690 N at 30 kPa."
    )
    for depth, words in [(0.0, ", and nowhere overlap."), (4e-4, "less than 0.001 mm, 0.2 % ")]:
        figures = {"deepest_penetration_mm": depth, "penetration_share": 5.0 * depth}
        write_record(solve_record("d", support="none", **figures), touched / "solve")
        assert words in told(touched)
        assert told(touched).endswith("No blocked force was asked for.")
    assert told(solved(tmp_path / "off", contact=False)).startswith(
        "Contact was off: walls that balloon may overlap."
    )
    assert told(path_only(tmp_path / "bare")) == ""


@pytest.mark.parametrize(
    ("closing", "words"),
    [
        (0.0046, "No walls touched in free actuation. "),
        (0.0047, "In free actuation walls touch, and overlap by at most 0.010 mm, 5.0 % of the"),
    ],
)
def test_walls_touched_if_the_gap_of_a_step_was_below_the_width_of_the_law(
    tmp_path, closing, words
):
    assert told(solved(tmp_path / "d", closing=closing)).startswith(words)


def test_limit_points_and_an_early_end_are_told(tmp_path):
    folder = solved(tmp_path / "d", closing=0.003)
    ending = {"blocked_force": {**ENDED, "pressure_kPa": 20.0, "blocked_force_N": 0.5}}
    limits = {"limit_points": 1, "volume_controlled_from_kPa": 16.5}
    reached = {"largest_pressure_kPa": 17.2, "pressure_kPa": 8.1}
    write_record(solve_record("d", **limits, **ending, **reached), folder / "solve")
    assert told(folder) == (
        "No walls touched in free actuation. The pressure has 1 limit point. From 16.5 kPa on the"
        " volume was controlled. The pressure went through 17.2 kPa and ended at 8.1 kPa. Blocked"
        " force (on a rigid plate): 0.500 N at 20 kPa, where it ended: not converged. The step"
        " fell."
    )
    write_record(solve_record("d", largest_pressure_kPa=17.2, pressure_kPa=17.1), folder / "solve")
    assert "went through" not in told(folder)


def test_the_page_says_of_contact_what_the_records_say(tmp_path):
    on = [solved(tmp_path / name) for name in ("a", "b")]
    off = [solved(tmp_path / name, contact=False) for name in ("c", "d")]
    deeper = {"deepest_penetration_mm": 0.002, "penetration_share": 0.08}
    write_record(solve_record("b", **deeper), on[1] / "solve")
    together = contact_note(read_entries([*on, off[0]]))
    assert "touch where the gap between them is below 0.06 mm" in together
    assert "acts at: by at most 0.002 mm, 8.0 % of the gap." in together
    assert together.endswith("Contact was off for 1 design: walls that balloon may overlap there.")
    assert "off" not in contact_note(read_entries(on))
    none = {"deepest_penetration_mm": 0.0, "penetration_share": 0.0}
    write_record(solve_record("e", **none), solved(tmp_path / "e") / "solve")
    assert contact_note(read_entries([tmp_path / "e"])).endswith("; walls nowhere overlap.")
    assert contact_note(read_entries(off)).startswith("Contact was off for all designs")
    assert contact_note([]) == ""
