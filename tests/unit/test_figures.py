"""Pictures: what goes into them is checked in numbers, what comes out by its pixels."""

import dataclasses
import itertools
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import pyvista as pv
import yaml
from figure_samples import (
    SIZE,
    block,
    path_of,
    path_only,
    solved,
    states_of,
    three_designs,
    trajectory,
)
from matplotlib.axes import Axes
from matplotlib.legend import Legend
from matplotlib.text import Text
from PIL import Image

from pagd.design import Design
from pagd.errors import InputError, Status
from pagd.figures import gallery, groups, load, viewer
from pagd.figures.angles import angles_figure, draw_angles
from pagd.figures.deformed import Shapes, draw_deformed, strain_limit
from pagd.figures.drawing import draw_side_by_side
from pagd.figures.gallery import draw_gallery, gallery_figure
from pagd.figures.geometry import draw_geometry, geometry_figure
from pagd.figures.groups import by_mode, line_looks, read_entries
from pagd.figures.load import States
from pagd.figures.mesh import draw_mesh
from pagd.figures.outline import section_loops
from pagd.figures.paths_by_mode import (
    _spread,
    angles_by_mode,
    members_of,
    trajectories_by_mode,
)
from pagd.figures.scene import Camera, Sheet, render
from pagd.figures.sections import sections_figure
from pagd.figures.style import kilopascals, number
from pagd.figures.surface import cut_faces, sharp_edges, skin_of, split_faces
from pagd.figures.trajectories import draw_trajectories, load_all, trajectories_figure
from pagd.tables import TRAJECTORY, write_table

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def designs(tmp_path_factory):
    return three_designs(tmp_path_factory.mktemp("designs"))


def volume(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", np.cross(a, b), c) / 6.0


def drawn_share(path):
    """Share of the picture's pixels that are not white."""
    with Image.open(path) as image:
        assert min(image.size) > 300
        return np.mean(np.asarray(image.convert("L")) < 250)


# ---- triangles ------------------------------------------------------------------------------


@pytest.mark.parametrize("corners_only", [False, True])
@pytest.mark.parametrize(("half", "width"), [(False, 5.0), (True, 10.0)])
def test_skin_encloses_the_whole_body(half, width, corners_only):
    mesh = block(half)
    skin = skin_of(mesh, corners_only=corners_only)
    points = skin.vectors(mesh.points)
    assert volume(points, skin.triangles) == pytest.approx(SIZE[0] * width * SIZE[2])
    edges = np.sort(skin.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert set(np.unique(edges, axis=0, return_counts=True)[1]) == {2}


def test_mirrored_half_of_a_field_turns_its_y_only():
    mesh = block(half=True)
    skin = skin_of(mesh)
    field = np.ones_like(mesh.points)
    assert set(map(tuple, skin.vectors(field))) == {(1.0, 1.0, 1.0), (1.0, -1.0, 1.0)}
    np.testing.assert_array_equal(skin.scalars(field[:, 1]), 1.0)


def test_four_triangles_of_a_face_cover_it_the_same_way_round():
    points = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
    a, b, c = (points[split_faces(np.arange(6)[None])[:, i]] for i in range(3))
    np.testing.assert_allclose(np.cross(b - a, c - a), np.tile([0.0, 0.0, 1.0], (4, 1)))


def test_sharp_edges_of_a_box_are_its_twelve_edges():
    mesh = block(half=False)
    skin = skin_of(mesh)
    points = skin.vectors(mesh.points)
    edges = sharp_edges(points, skin.triangles)
    length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).sum()
    assert length == pytest.approx(4 * sum(SIZE))


def test_cut_mesh_stays_closed_and_shows_the_paper():
    mesh = block(half=False)
    middles = mesh.points[mesh.tets[:, :4]].mean(axis=1)
    kept = (middles[:, 0] < 10.0) | (middles[:, 2] < SIZE[2] / 4)
    faces = cut_faces(mesh, kept)
    together = np.vstack(list(faces.values()))
    corners = mesh.points[together[:, :3]]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    np.testing.assert_allclose(areas.sum(axis=0), 0.0, atol=1e-9)
    paper = mesh.points[faces["paper"][:, :3]]
    assert len(paper) > 0
    assert len(faces["cut"]) > 0
    np.testing.assert_allclose(paper[..., 2], SIZE[2] / 4)
    assert paper[..., 0].min() >= 10.0
    whole = cut_faces(mesh, np.ones(len(mesh.tets), dtype=bool))
    assert len(whole["cut"]) == 0
    assert len(whole["paper"]) == 0
    assert len(whole["cavity"]) == len(mesh.surfaces["cavity"])


# ---- rendering ------------------------------------------------------------------------------


def test_picture_shows_a_triangle_where_the_camera_projects_it():
    camera = Camera((0.0, -1.0, 0.0))
    box = camera.box(np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 8.0]]))
    points = np.array([[6.0, 3.0, 5.0], [9.0, 3.0, 5.0], [6.0, 3.0, 7.0]])
    sheet = Sheet(points=points, triangles=np.array([[0, 1, 2]]), colour="red", smooth=False)
    image = render([sheet], camera, box, 20.0)
    assert image.shape == (160, 200, 4)
    rows, columns = np.nonzero(image[..., 3])
    assert columns.mean() / 20.0 == pytest.approx(points[:, 0].mean(), abs=0.1)
    assert 8.0 - rows.mean() / 20.0 == pytest.approx(points[:, 2].mean(), abs=0.1)
    assert image[..., 3].sum() / 255.0 / 400.0 == pytest.approx(3.0, abs=0.1)
    red, green, _ = image[int(rows.mean()), int(columns.mean()), :3].astype(int)
    assert red > green + 50


def test_strain_bar_ends_where_one_node_in_a_hundred_is_beyond():
    mesh = block(half=False)
    states = states_of(mesh)
    shapes = Shapes.of(states)
    assert strain_limit([shapes]) == pytest.approx(0.3)
    peak = states.strain.copy()
    peak[-1, np.argmax(peak[-1])] = 50.0
    spiked = Shapes.of(States(mesh, states.pressure_kPa, states.displacement, peak))
    assert strain_limit([spiked]) == pytest.approx(0.3)


def hollow_body():
    """Surface of a block with a closed void in it."""
    outside = pv.Box((0.0, 30.0, -5.0, 5.0, 0.0, 8.0)).triangulate()
    void = pv.Box((4.0, 26.0, -3.0, 3.0, 2.0, 6.0)).triangulate()
    return outside.append_polydata(void.flip_faces())


def test_section_of_a_hollow_body_has_two_outlines():
    for axis, sizes in ((0, (10 * 8, 6 * 4)), (1, (30 * 8, 22 * 4)), (2, (30 * 10, 22 * 6))):
        loops = section_loops(hollow_body(), axis, 4.5 if axis != 1 else 0.0)
        areas = [
            abs(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2
            for x, y in (p.T for p in loops)
        ]
        assert sorted(areas, reverse=True) == pytest.approx(sizes, rel=1e-5)


# ---- reading --------------------------------------------------------------------------------


def test_states_begin_unloaded(designs):
    states = load.load_states(designs[0])
    np.testing.assert_allclose(states.pressure_kPa, [0.0, 10.0, 20.0, 30.0])
    assert np.abs(states.displacement[0]).max() == 0.0
    expected = states_of(states.mesh)
    np.testing.assert_allclose(states.displacement, expected.displacement, atol=1e-5)


def test_trajectory_is_sorted_by_pressure_and_station(designs):
    path = load.load_trajectory(designs[0])
    assert path.positions.shape == (4, 3, 3)
    np.testing.assert_allclose(path.positions[2], [[0, 2, 0], [10, 2, -20], [20, 2, -40]])
    np.testing.assert_allclose(path.bending_deg[:, -1], [0, 20, 40, 60])


def test_states_of_another_mesh_are_refused(designs, tmp_path):
    shutil.copytree(designs[0] / "solve", tmp_path / "solve")
    shutil.copytree(designs[1] / "mesh", tmp_path / "mesh")
    with pytest.raises(InputError, match="does not hold one row for each of"):
        load.load_states(tmp_path)


# ---- pictures -------------------------------------------------------------------------------


def test_pictures_of_solved_designs_show_something(designs, tmp_path):
    for folder in designs[:2]:
        for draw in (draw_mesh, draw_deformed):
            draw(folder, tmp_path / "one.png")
            assert drawn_share(tmp_path / "one.png") > 0.02
    for draw in (draw_gallery, draw_trajectories, draw_angles):
        draw(designs, tmp_path / "all.png")
        assert drawn_share(tmp_path / "all.png") > 0.01


def test_geometry_is_drawn_with_and_without_a_design(tmp_path):
    for name in ("own", "drawn"):
        (tmp_path / name / "repair").mkdir(parents=True)
        hollow_body().save(tmp_path / name / "repair" / "body.stl")
        pv.Box((0.0, 30.0, -5.0, 5.0, -1.0, 0.0)).triangulate().save(
            tmp_path / name / "repair" / "base.stl"
        )
    design = Design(
        L=13.0, W=10.0, H=7.0, t=2.0, t_n=4.0, t_h=2.0, t_ab=2.0, t_b=2.0, N=2, theta=0, alpha=0
    )  # fmt: skip
    (tmp_path / "drawn" / "geometry").mkdir()
    text = json.dumps({"name": "drawn", "origin": "own", **design.as_dict()})
    (tmp_path / "drawn" / "geometry" / "design.json").write_text(text)
    shapes = []
    for name in ("own", "drawn"):
        draw_geometry(tmp_path / name, tmp_path / f"{name}.png")
        assert drawn_share(tmp_path / f"{name}.png") > 0.1
        with Image.open(tmp_path / f"{name}.png") as image:
            shapes.append(image.size)
    # Dimensions need a row of their own.
    assert shapes[1][1] > shapes[0][1]


def labels(figure):
    """All text of a picture, as it is drawn."""
    figure.draw_without_rendering()
    return [text.get_text() for text in figure.findobj(Text) if text.get_text()]


@pytest.mark.parametrize(
    ("count", "alpha", "expected", "absent"),
    [
        (1, 0, {"$t_{ab}$ 2"}, "$t_n$ 4"),
        (1, 1, {"$t_{ab}$ 2 / cos θ = 2.13"}, "$t_n$ 4"),
        (2, 0, {"$t_{ab}$ 2", "$t_n$ 4"}, None),
        # Half a skew, 5 mm tan 20°, widens the gap between the two kinds of chambers.
        (2, 0.5, {"$t_{ab}$ 2", "5.82"}, "$t_n$ 4"),
        (2, 1, {"$t_{ab}$ 2 / cos θ = 2.13", "$t_n$ 4"}, None),
    ],
)
def test_few_chambers_have_the_dimensions_that_there_are(count, alpha, expected, absent):
    design = Design(
        L=13.0, W=10.0, H=7.0, t=2.0, t_n=4.0, t_h=2.0, t_ab=2.0, t_b=2.0, N=count,
        theta=20.0 if alpha else 0.0, alpha=alpha,
    )  # fmt: skip
    body = pv.Box((0.0, design.L_T, -5.0, 5.0, -1.0, 7.0)).triangulate()
    base = pv.Box((0.0, design.L_T, -5.0, 5.0, -2.0, -1.0)).triangulate()
    figure = geometry_figure("few", body, base, design)
    found = labels(figure)
    assert {"$L$ 13", "$H$ 7", "$W$ 10", "$t$ 2", "$t_b$ 2"} | expected <= set(found)
    assert absent not in found
    # A short body does not make a long picture.
    assert figure.get_figheight() < 1.5 * figure.get_figwidth()


def test_surfaces_of_ones_own_are_not_said_to_have_chambers():
    body, base = hollow_body(), pv.Box((0.0, 30.0, -5.0, 5.0, -1.0, 0.0)).triangulate()
    found = labels(geometry_figure("own", body, base, None))
    assert {"plan, half-way up the body", "side view, in the middle"} <= set(found)


def test_both_pictures_of_a_design_show_the_same_plan():
    design = Design(
        L=13.0, W=10.0, H=7.0, t=2.0, t_n=4.0, t_h=2.0, t_ab=2.0, t_b=2.0, N=2, theta=20, alpha=1
    )  # fmt: skip
    # Narrower towards its top, so that the width of a plan tells where it is cut.
    body = pv.Cone(
        center=(15.0, 0.0, 3.5), direction=(0, 0, 1), height=7.0, radius=10.0, resolution=64
    ).triangulate()
    base = pv.Box((0.0, 30.0, -5.0, 5.0, -1.0, 0.0)).triangulate()
    one, other = geometry_figure("a", body, base, design), sections_figure(body, base, design)
    plans = [
        next(axes for axes in figure.axes if axes.get_title("left").startswith("plan"))
        for figure in (one, other)
    ]
    titles = [plan.get_title("left") for plan in plans]
    assert titles[0] == "plan, through the chambers, θ = 20°"
    assert titles[1] == f"{titles[0]}; twisting design, 2 chambers"
    widths = [np.ptp(plan.patches[0].get_path().vertices[:, 0]) for plan in plans]
    # At 0.85 (H − t_h) = 4.25 mm of 7 mm.
    np.testing.assert_allclose(widths, 2 * 10.0 * (1 - 4.25 / 7.0), rtol=1e-2)


@pytest.mark.parametrize("chambers", [1, 2])
def test_paths_of_few_chambers_are_drawn_with_room_for_ticks(chambers):
    figure = trajectories_figure({"few": path_of(chambers + 1)})
    figure.draw_without_rendering()
    for axes in figure.findobj(Axes):
        if axes.get_ylabel() == "z, mm":
            sides = np.sort([np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())])
            assert sides[0] > 0.25 * sides[1]
    joints = angles_figure({"few": path_of(chambers + 1)}).axes[2].lines[0]
    assert list(joints.get_xdata()) == list(range(1, chambers + 1))
    np.testing.assert_allclose(joints.get_ydata(), 5.0)


def test_no_text_lies_in_the_panels_of_the_tips():
    """The designs end in the same point, where labels would cover each other."""
    paths = {"first": path_of(3), "second": path_of(3, twist=1.0)}
    figure = trajectories_figure(paths)
    found = labels(figure)
    assert {"first, to 10 kPa", "second, to 10 kPa"} <= set(found)
    (legend,) = figure.findobj(Legend)
    around = legend.get_window_extent()
    for axes in figure.findobj(Axes):
        assert not around.overlaps(axes.get_tightbbox())
        assert not axes.texts


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [(-0.04, 1, "0.0"), (-0.3, 0, "0"), (-0.0, 2, "0.00"), (0.0, 0, "0"), (-0.06, 1, "−0.1"),
     (-1234.56, 1, "−1,234.6"), (1080, 0, "1,080")],
)  # fmt: skip
def test_zero_has_no_sign(value, digits, expected):
    assert number(value, digits) == expected


@pytest.mark.parametrize(
    ("pressure", "expected"),
    [(45.9116, "45.91 kPa"), (100.0, "100 kPa"), (12345.6, "12350 kPa"), (0.0, "0 kPa")],
)
def test_a_pressure_has_four_digits(pressure, expected):
    assert kilopascals(pressure) == expected


def test_a_twist_of_nearly_nothing_is_written_as_zero(tmp_path):
    assert "0°" in labels(angles_figure({"one": path_of(3, twist=-1e-3)}))
    folder = solved(tmp_path / "still")
    table = trajectory("still")
    table["twist_deg"] = table["twist_deg"] * -1e-4
    write_table(folder / "metrics" / "trajectory.parquet", TRAJECTORY, table)
    assert gallery.caption(folder) == "bends 60°, twists 0°"
    text = json.dumps(viewer.path_data(load.load_trajectory(folder)))
    assert not re.search(r"-0(\.0+)?[,\]]", text)


def test_equal_results_give_equal_files(designs, tmp_path):
    for name in ("first", "second"):
        draw_angles(designs, tmp_path / f"{name}.png")
    assert (tmp_path / "first.png").read_bytes() == (tmp_path / "second.png").read_bytes()


def test_nothing_to_draw_is_said(designs, tmp_path):
    for draw in (draw_gallery, draw_trajectories, draw_angles):
        with pytest.raises(InputError, match="None of the designs"):
            draw([designs[2]], tmp_path / "none.png")
    with pytest.raises(InputError, match="no surfaces"):
        draw_geometry(designs[2], tmp_path / "none.png")
    assert not list(tmp_path.iterdir())


# ---- many designs ---------------------------------------------------------------------------

MODES = ("mixed", "bending", "twisting", "bending", "bending", "twisting")


def many(root, draw, modes=MODES):
    """Designs of several modes; the last but one is published, the last failed on its way."""
    folders = [draw(root / f"d{i}", mode=m, origin="generated") for i, m in enumerate(modes)]
    last = {"status": Status.bending_limit, "reason": "too far"} if draw is solved else {}
    return [
        *folders,
        draw(root / "known", mode="bending", origin="published"),
        draw(root / "stopped", mode="twisting", origin="generated", **last),
    ]


def test_designs_go_by_mode_known_ones_first(tmp_path):
    groups = by_mode(read_entries([*many(tmp_path, path_only), tmp_path / "nothing"]))
    assert {mode: [e.name for e in group] for mode, group in groups.items()} == {
        "bending": ["known", "d1", "d3", "d4"],
        "twisting": ["d2", "d5", "stopped"],
        "mixed": ["d0"],
        "no mode": ["nothing"],
    }


def test_lines_of_one_panel_differ():
    looks = line_looks([f"d{i}" for i in range(24)])
    assert len({(line.colour, line.script) for line in looks.values()}) == 24
    assert len({(line.colour, str(line.dash)) for line in looks.values()}) == 24
    assert len({line.colour for line in list(looks.values())[:6]}) == 6


@pytest.fixture(scope="module")
def gallery_rows(tmp_path_factory):
    folders = many(tmp_path_factory.mktemp("many"), solved)
    return gallery.rows_of(read_entries(folders))


def test_gallery_has_a_row_a_mode_and_names_failures(gallery_rows):
    assert [heading for heading, _ in gallery_rows] == ["bending", "twisting", "mixed"]
    assert [[t.title for t in tiles] for _, tiles in gallery_rows] == [
        ["known", "d1", "d3", "d4"],
        ["d2", "d5", "stopped"],
        ["d0"],
    ]
    tiles = {tile.title: tile for _, row in gallery_rows for tile in row}
    assert tiles["d0"].caption == "30 kPa: bends 60°, twists 30°"
    assert (tiles["stopped"].status, tiles["d0"].status) == ("bending limit", "")


def test_long_rows_are_parted_evenly(monkeypatch, gallery_rows):
    tile = gallery_rows[0][1][0]
    monkeypatch.setattr(gallery, "_tile", lambda entry: tile)
    entries = [groups.Entry(Path(f"d{i}"), None) for i in range(26)]
    lengths = [len(tiles) for _, tiles in gallery.rows_of(entries)]
    assert lengths == [6, 5, 5, 5, 5]


def test_gallery_keeps_one_scale_and_its_captions_apart(gallery_rows):
    figure = gallery_figure(gallery_rows)
    shown = [axes for axes in figure.axes if axes.images]
    widths = [axes.get_position().width * figure.get_figwidth() for axes in shown]
    boxes = [tile.box for _, tiles in gallery_rows for tile in tiles]
    scales = [width / box.width for width, box in zip(widths, boxes, strict=True)]
    np.testing.assert_allclose(scales, scales[0])
    heights = [axes.get_position().height * figure.get_figheight() for axes in shown]
    np.testing.assert_allclose(heights, [scales[0] * box.height for box in boxes])
    figure.draw_without_rendering()
    places = [text.get_window_extent() for text in figure.texts]
    pairs = itertools.combinations(places, 2)
    assert not any(one.overlaps(other) for one, other in pairs)
    assert {"bending limit", "twisting", "known"} <= set(labels(figure))


def test_one_stretched_design_of_many_does_not_pale_the_others(gallery_rows):
    tiles = [tile for _, row in gallery_rows for tile in row]
    shapes = tiles[0].shapes
    stretched = dataclasses.replace(shapes, strain=10.0 * shapes.strain)
    top = gallery._strain_top([shapes] * 19 + [stretched])
    assert top == pytest.approx(strain_limit([shapes]))
    assert gallery._strain_top([shapes, stretched]) == strain_limit([stretched]) > 5.0 * top


def paths_by_mode(root):
    folders = many(root, path_only)
    return members_of(by_mode(read_entries(folders)), load_all(folders))


def test_paths_of_many_have_a_column_a_mode_and_one_scale(tmp_path):
    figure = trajectories_by_mode(paths_by_mode(tmp_path))
    found = labels(figure)
    assert {"bending (4), from the side", "twisting (3), from the side"} <= set(found)
    upper, lower = figure.axes[:3], figure.axes[3:]
    for panels in (upper, lower):
        assert len({(axes.get_xlim(), axes.get_ylim()) for axes in panels}) == 1
        assert {axes.get_aspect() for axes in panels} == {1.0}
    tips = {line.get_label(): line.get_xydata() for line in upper[0].lines}
    np.testing.assert_allclose(tips["known"], [[20, 0], [20, -20], [20, -40], [20, -60]])
    # Only the published design is named in the panel; the others by the legend.
    assert [text.get_text() for text in upper[0].texts] == ["known"]
    names = [text.get_text() for text in lower[1].get_legend().get_texts()]
    assert names == ["d2", "d5", "stopped"]


def test_angles_of_many_show_tips_and_chambers(tmp_path):
    figure = angles_by_mode(paths_by_mode(tmp_path))
    labels(figure)
    panels = np.array(figure.axes).reshape(4, 3)
    tips = {line.get_label(): line.get_xydata() for line in panels[0, 1].lines}
    np.testing.assert_allclose(tips["d5"], [[0, 0], [10, 20], [20, 40], [30, 60]])
    chambers = {line.get_label(): line.get_xydata() for line in panels[3, 1].lines}
    np.testing.assert_allclose(chambers["d5"], [[1, 15], [2, 15]])


def test_labels_of_ends_keep_their_distance():
    wanted = [0.1, 0.5, 0.5, 0.52, 0.9]
    places = np.array(_spread(wanted, 0.1))
    assert np.diff(places).min() >= 0.1 - 1e-12
    assert places[0] == pytest.approx(0.1)
    assert np.abs(places - wanted).max() < 0.15


# ---- drawing -------------------------------------------------------------------------------


def test_the_drawing_shows_the_faces_towards_the_eye_and_names_the_designs(tmp_path):
    folders = [solved(tmp_path / name, half) for name, half in (("left", True), ("right", False))]
    draw_side_by_side(folders, tmp_path / "designs.svg")
    tree = ElementTree.parse(tmp_path / "designs.svg").getroot()
    space = "{http://www.w3.org/2000/svg}"
    assert [t.text for t in tree.iter(f"{space}text")] == ["left, 30 kPa", "right, 30 kPa"]
    left, right = ([p.get("points") for p in group] for group in tree.iter(f"{space}g"))
    skin = skin_of(load.load_mesh(folders[1]), corners_only=True)
    assert 0.2 < len(right) / len(skin.triangles) < 0.7
    middle = [
        np.mean([[float(x) for x in pair.split(",")] for points in side for pair in points.split()])
        for side in (left, right)
    ]
    assert middle[0] < middle[1]


def test_the_drawing_shows_the_examples_of_the_paper_alone(tmp_path):
    folders = [
        solved(tmp_path / "new", origin="generated"),
        solved(tmp_path / "example", origin="table2"),
    ]
    draw_side_by_side(folders, tmp_path / "designs.svg")
    assert re.findall("<text.*?>(.*?)</text>", (tmp_path / "designs.svg").read_text()) == [
        "example, 30 kPa"
    ]


def test_a_drawing_of_nothing_is_refused(tmp_path):
    with pytest.raises(InputError, match="None of the designs"):
        draw_side_by_side([tmp_path], tmp_path / "designs.svg")


# ---- workflow -------------------------------------------------------------------------------


def figures_command(folder, **settings):
    """The command that the workflow would draw the design `bending` with."""
    config = folder / "config"
    config.mkdir(exist_ok=True)
    for source in (ROOT / "config" / "materials.yaml", *(ROOT / "config").glob("*.csv")):
        shutil.copy(source, config)
    (config / "config.yaml").write_text(yaml.safe_dump({"figures": settings}))
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--cores", "1", "--dry-run", "--printshellcmds"]
    target = "results/designs/bending/figures"
    answer = subprocess.run(
        [*command, target], cwd=folder, capture_output=True, text=True, check=True
    )
    (found,) = re.findall(r"pagd figures .*", answer.stdout + answer.stderr)
    return found


def test_pictures_of_a_design_do_not_depend_on_how_many_are_drawn(tmp_path):
    once, fewer = (figures_command(tmp_path, drawn_designs=count) for count in (20, 1))
    assert once == fewer
    finer = figures_command(tmp_path, drawn_designs=1, resolution_dpi=300)
    assert "300" in finer
    assert finer != fewer
