"""Pictures and page: what goes into them is checked in numbers, what comes out by its pixels."""

import base64
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
from matplotlib.axes import Axes
from matplotlib.legend import Legend
from matplotlib.text import Text
from PIL import Image

from pagd.design import Design
from pagd.errors import InputError, Status
from pagd.figures import gallery, load, viewer
from pagd.figures.angles import angles_figure, draw_angles
from pagd.figures.deformed import Shapes, draw_deformed, strain_limit
from pagd.figures.drawing import draw_side_by_side
from pagd.figures.gallery import draw_gallery
from pagd.figures.geometry import draw_geometry, geometry_figure
from pagd.figures.load import Path3D, States
from pagd.figures.mesh import draw_mesh
from pagd.figures.outline import section_loops
from pagd.figures.page import write_page
from pagd.figures.scene import Camera, Sheet, render
from pagd.figures.style import number
from pagd.figures.surface import cut_faces, sharp_edges, skin_of, split_faces
from pagd.figures.trajectories import draw_trajectories, trajectories_figure
from pagd.mesh.msh import write_msh
from pagd.mesh.primitives import hollow_block
from pagd.record import Record, versions, write_record
from pagd.states import States as SolvedStates
from pagd.states import write_states
from pagd.tables import TRAJECTORY, write_table

ROOT = Path(__file__).parents[2]
SIZE = (20.0, 5.0, 6.0)
PRESSURE = np.array([10.0, 20.0, 30.0])


def block(half):
    """A hollow block; as a half model, the half of one that is twice as wide."""
    void = ((1, 3), (0, 1) if half else (1, 2), (2, 3))
    return hollow_block(SIZE, (4, 3, 4), void, paper_layer=1, half=half)


def bent(mesh, angle):
    """Displacement of a circular arc towards −z."""
    if angle == 0.0:
        return np.zeros_like(mesh.points)
    x, y, z = mesh.points.T
    turn, radius = angle * x / SIZE[0], SIZE[0] / angle + z
    height = radius * np.cos(turn) - SIZE[0] / angle
    return np.column_stack([radius * np.sin(turn), y, height]) - mesh.points


def states_of(mesh):
    moved = np.stack([bent(mesh, 0.02 * p) for p in (0.0, *PRESSURE)])
    strain = np.linspace(0.0, 0.3, 4)[:, None] * mesh.points[:, 2] / SIZE[2]
    return States(mesh, np.array([0.0, *PRESSURE]), moved, strain)


def solved(folder, half=False):
    """Leave what the stages mesh, solve and metrics leave for one design."""
    mesh = block(half)
    for stage in ("mesh", "solve", "metrics"):
        (folder / stage).mkdir(parents=True)
    write_msh(mesh, folder / "mesh" / "mesh.msh")
    recorded = states_of(load.load_mesh(folder))
    kept = SolvedStates(
        pressure_kPa=recorded.pressure_kPa[1:],
        displacement=recorded.displacement[1:],
        strain=recorded.strain[1:],
    )
    write_states(kept, folder / "solve" / "states.parquet")
    write_table(folder / "metrics" / "trajectory.parquet", TRAJECTORY, trajectory(folder.name))
    figures = {"bending_deg": 34.4, "tip_z_mm": -5.25, "tets": len(mesh.tets), "mode": "bending"}
    write_record(record(folder.name, "metrics", figures=figures), folder / "metrics")
    return folder


def trajectory(name):
    """Table of four pressures and three stations, in an order of its own."""
    p, s = (a.ravel() for a in np.meshgrid([0.0, *PRESSURE], [2, 0, 1]))
    columns = {"x_mm": 10.0 * s, "y_mm": 0.1 * p, "z_mm": -p * s}
    angles = {"bending_deg": p * s, "twist_deg": 0.5 * p * s}
    names = {"design_id": [name] * len(p), "pressure_kPa": p, "station": s.astype(np.int32)}
    return {**names, **columns, **angles}


def record(name, stage, status=Status.ok, reason=None, figures=None):
    return Record(
        stage=stage,
        design_id=name,
        status=status,
        reason=reason,
        figures=figures or {},
        configuration={},
        versions=versions(1),
        timings_s={"wall": 1.0, "cpu": 1.0},
        peak_memory_MB=1.0,
    )


@pytest.fixture(scope="module")
def designs(tmp_path_factory):
    """Two solved designs, one of them a half model, and one that failed."""
    root = tmp_path_factory.mktemp("designs")
    failed = root / "failed"
    (failed / "geometry").mkdir(parents=True)
    reason = "t_ab = 9 is <too thick> & leaves no cavity."
    write_record(record("failed", "geometry", Status.invalid_geometry, reason), failed / "geometry")
    return [solved(root / "whole"), solved(root / "half", half=True), failed]


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


def path_of(stations, twist=0.0, bending=5.0):
    """A trajectory at three pressures that leaves the x axis downwards only."""
    p, s = np.meshgrid([0.0, 5.0, 10.0], np.arange(stations), indexing="ij")
    positions = np.stack([10.0 * s, 0.0 * s, -0.02 * p * s], axis=-1)
    return Path3D(p[:, 0], positions, bending * s * p / 10.0, twist * s * p / 10.0)


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


# ---- page -----------------------------------------------------------------------------------


def unpacked(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=kind)


@pytest.mark.parametrize("half", [False, True])
def test_viewer_keeps_shape_and_strain(half):
    states = states_of(block(half))
    data = viewer.viewer_data(states)
    count, index = data["vertices"], f"<u{data['index_bits'] // 8}"
    positions = unpacked(data["positions"], "<i2").reshape(4, 3, count) * data["step_mm"]
    triangles = unpacked(data["triangles"], index).reshape(-1, 3)
    skin = skin_of(states.mesh)
    for state, u in enumerate(states.displacement):
        exact = skin.vectors(states.mesh.points) + skin.vectors(u)
        kept = positions[state].T[triangles]
        assert np.abs(kept - exact[skin.triangles]).max() <= 0.5001 * data["step_mm"]
    strain = unpacked(data["strain"], "<u1").reshape(4, count)[-1] / 255.0 * data["top"]
    exact = np.minimum(skin.scalars(states.strain[-1])[skin.triangles], data["top"])
    np.testing.assert_allclose(strain[triangles], exact, atol=data["top"] / 500.0)


def test_viewer_splits_a_box_into_its_six_sides():
    mesh = block(half=False)
    data = viewer.viewer_data(states_of(mesh))
    triangles = unpacked(data["triangles"], "<u2").reshape(-1, 3)
    rest = unpacked(data["positions"], "<i2").reshape(4, 3, -1)[0].T * data["step_mm"]
    normals = {}
    for triangle in triangles:
        a, b, c = rest[triangle]
        normal = np.cross(b - a, c - a)
        for vertex in triangle:
            normals.setdefault(vertex, set()).add(tuple(np.round(normal / np.abs(normal).max())))
    # No vertex belongs to two sides: shading has no reason to round the edges.
    assert {len(found) for found in normals.values()} == {1}
    edges = rest[unpacked(data["edges"], "<u2").reshape(-1, 2)]
    length = np.linalg.norm(edges[:, 0] - edges[:, 1], axis=1).sum()
    assert length == pytest.approx(4 * sum(SIZE), rel=1e-3)


def test_large_skins_go_by_their_corners(monkeypatch):
    states = states_of(block(half=False))
    fine = viewer.viewer_data(states)
    monkeypatch.setattr(viewer, "_MANY", 10)
    coarse = viewer.viewer_data(states)
    assert len(coarse["triangles"]) * 4 == pytest.approx(len(fine["triangles"]), abs=8)


def test_path_of_the_tip_is_the_last_station():
    positions = np.arange(24.0).reshape(2, 4, 3)
    angles = np.array([[0.0, 1.0, 2.0, 3.0], [0.0, 2.0, 4.0, 6.0]])
    data = viewer.path_data(Path3D(np.array([0.0, 5.0]), positions, angles, -angles))
    assert data["bending_deg"] == [3.0, 6.0]
    assert data["twist_deg"] == [-3.0, -6.0]
    x, _, z = data["lines"][1]
    assert (x, z) == ([12.0, 15.0, 18.0, 21.0], [14.0, 17.0, 20.0, 23.0])


@pytest.fixture(scope="module")
def page(designs, tmp_path_factory):
    root = tmp_path_factory.mktemp("report")
    pictures = root / "pictures"
    draw_angles(designs, pictures / "angles.png")
    write_page(designs, root / "index.html", pictures)
    return root / "index.html"


def test_page_needs_no_other_file(page):
    text = page.read_text(encoding="utf-8")
    scripts = re.sub(r"<script>.*?</script>", "", text, flags=re.DOTALL)
    assert not re.search(r"""(?:src|href)=["'](?!data:|#)""", scripts)
    assert "@import" not in scripts
    assert "url(" not in scripts
    assert text.count("data:image/webp;base64,") == 1


def test_page_tells_of_every_design(page):
    text = page.read_text(encoding="utf-8")
    rows = re.findall(r"<tr><th><a.*?</tr>", text)
    assert len(rows) == 3
    assert "34.4" in rows[0]
    assert "−5.2" in rows[1]
    assert "invalid geometry" in rows[2]
    assert "t_ab = 9 is &lt;too thick&gt; &amp; leaves no cavity." in text
    data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL).group(1))
    assert [d["name"] for d in data["designs"]] == ["whole", "half", "failed"]
    assert [d["viewer"] is not None for d in data["designs"]] == [True, True, False]


def test_page_of_failed_designs_only(designs, tmp_path):
    write_page([designs[2], tmp_path / "never-run"], tmp_path / "index.html")
    text = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "invalid geometry" in text
    assert "not run" in text


@pytest.mark.skipif(not shutil.which("chromium"), reason="needs a browser: chromium")
def test_page_draws_without_errors_in_a_browser(page, tmp_path):
    flags = "--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-sync"
    flags += " --disable-background-networking --disable-component-update --enable-logging=stderr"
    flags += " --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --dump-dom"
    flags += " --window-size=1200,4000 --virtual-time-budget=20000"
    command = ["chromium", *flags.split(), f"--user-data-dir={tmp_path}", page.as_uri()]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert "Uncaught" not in answer.stderr
    document = re.sub(r"<script.*?</script>", "", answer.stdout, flags=re.DOTALL)
    # Four plots of all designs, and shape and angles of two designs.
    assert document.count('class="plot-container') == 4 + 2 * 2
    assert document.count('class="gl-container') >= 2
    assert "30 kPa</output>" in document
    # The key of the designs is text of the page; no legend lies over a title of theirs.
    key = re.search(r'<ul id="key">(.*?)</ul>', document, re.DOTALL).group(1)
    assert re.findall(r"<li[^>]*>(.*?)</li>", key) == ["whole", "half"]
    assert document.count('class="legend"') == 2


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


def test_a_drawing_of_nothing_is_refused(tmp_path):
    with pytest.raises(InputError, match="None of the designs"):
        draw_side_by_side([tmp_path], tmp_path / "designs.svg")


# ---- workflow -------------------------------------------------------------------------------


def figures_command(folder, **settings):
    """The command that the workflow would draw the design `bending` with."""
    config = folder / "config"
    config.mkdir(exist_ok=True)
    for name in ("materials.yaml", "table2.csv"):
        shutil.copy(ROOT / "config" / name, config)
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
