"""Which parts of a surface touch others: flat, bulged, and on faces as large as of balloons."""

import numpy as np
import pytest
import pyvista as pv

from pagd.fem.contact import ContactLaw
from pagd.figures.captions import captions_of_design
from pagd.figures.pieces import Pieces
from pagd.figures.touching import touching_mm, touching_triangles

MOST = 40_000


def with_middles(corners):
    """Flat six-node faces (t, 6, 3) of triangles (t, 3, 3)."""
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    return np.concatenate([corners, middles], axis=1)


def corners_of(surface):
    return np.asarray(surface.points, float)[surface.faces.reshape(-1, 4)[:, 1:]]


def two_boxes(gap):
    """Faces of two boxes, those of 3 × 4 mm between them `gap` apart."""
    left = pv.Box((0.0, 5.0, 0.0, 3.0, 0.0, 4.0)).triangulate()
    right = pv.Box((5.0 + gap, 9.0, 0.0, 3.0, 0.0, 4.0)).triangulate()
    return with_middles(corners_of(left.append_polydata(right)))


def balloon(radius, height, count):
    """Six-node faces of a sphere from pole to pole, its lowest point on the z axis at a height."""
    sphere = pv.Sphere(radius=radius, theta_resolution=count, phi_resolution=count)
    faces = with_middles(corners_of(sphere))
    faces *= radius / np.linalg.norm(faces, axis=2, keepdims=True)
    return faces + np.array([0.0, 0.0, height + radius])


def area(triangles):
    a, b, c = (triangles[:, i] for i in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def test_walls_touch_where_the_contact_law_begins_to_push():
    assert touching_mm() == ContactLaw().width
    assert f"nearer than {ContactLaw().width} mm" in captions_of_design()["contact"]


@pytest.mark.parametrize(
    ("gap", "expected"), [(0.03, 24.0), (0.0, 24.0), (-0.03, 24.0), (0.07, 0.0), (1.0, 0.0)]
)
def test_touching_faces_are_the_two_between(gap, expected):
    triangles = touching_triangles(two_boxes(gap))
    assert area(triangles) == pytest.approx(expected, rel=0.02)
    if expected:
        assert np.abs(triangles[..., 0] - 5.0 - gap / 2).max() < 0.1


def test_the_sides_of_a_sharp_edge_do_not_touch():
    """Slanted walls meet the sides of a chamber at as little as 45°."""
    wedge = pv.PolyData(
        np.array([[0, 0, 0], [6, 0, 0], [6, 6, 0], [0, 0, 6], [6, 0, 6], [6, 6, 6.0]]),
        faces=[3, 0, 2, 1, 3, 3, 4, 5, 4, 0, 1, 4, 3, 4, 1, 2, 5, 4, 4, 0, 3, 5, 2],
    ).triangulate()
    corners = corners_of(wedge)
    assert area(corners) > 100.0
    assert len(touching_triangles(with_middles(corners))) == 0


def test_a_wall_touches_with_its_bulge():
    """The six nodes of the bulge are 0.5 mm and more away from the flat wall, its middle is not."""
    x = np.array([[-4, -3], [4, -3], [0, 5], [0, -3], [2, 1], [-2, 1]], dtype=float)
    top = 0.5 * (x**2).sum(axis=1)
    bulge = np.column_stack([x, top])
    flat = with_middles(np.array([[[-9, -9, 0.0], [0, 9, 0.0], [9, -9, 0.0]]])[:, [0, 2, 1]])
    found = touching_triangles(np.concatenate([bulge[None, [0, 2, 1, 5, 4, 3]], flat]), 0.1)
    assert top.min() > 0.5
    middles = found.mean(axis=1)
    # Where the paraboloid x² / 2 is nearer than 0.1 mm to the wall: within 0.45 mm.
    assert len(found) > 0
    assert np.linalg.norm(middles[:, :2], axis=1).max() < 0.45 + 0.05
    assert area(found) == pytest.approx(2 * np.pi * 0.2, rel=0.4)


@pytest.mark.parametrize("overlap", [0.0, 0.1])
def test_large_faces_touch_where_small_ones_do(overlap):
    """Balloons of 672 faces up to 42 mm long: what touches is a cap about the poles."""
    radius, gap = 80.0, 0.02 - overlap
    lower, upper = balloon(radius, -2 * radius, 14), balloon(radius, gap, 14)
    faces = np.concatenate([lower, upper])
    assert 40.0 < Pieces.of(faces).longest_sides.max() < 45.0
    found = touching_triangles(faces, 0.06)
    # Two spheres part by r² / R: nearer than 0.06 mm within r² = R (0.06 - gap).
    reach = radius * (0.06 - gap)
    assert area(found) == pytest.approx(2 * np.pi * reach, rel=0.15)
    assert np.linalg.norm(found.mean(axis=1)[:, :2], axis=1).max() < 1.1 * np.sqrt(reach)


def test_pieces_of_large_faces_are_bounded_in_number():
    """The longest side once divided all faces: 85 parts of 0.5 mm each, 7225 triangles a face."""
    faces = np.concatenate([balloon(80.0, 0.0, 14), two_boxes(0.05)])
    pieces = Pieces.of(faces).divided(0.5, MOST)
    assert MOST / 2 < len(pieces.face) <= MOST
    assert len(pieces.divided(0.01, 1000).face) == len(pieces.face)
    # The small faces of the boxes are divided by their own sides.
    counts = np.bincount(pieces.face)
    assert counts[-24:].max() < counts.max() / 8


def test_pieces_lie_on_the_curved_face():
    x = np.array([[0, 0], [4, 0], [0, 4], [2, 0], [2, 2], [0, 2]], dtype=float)
    face = np.column_stack([x, (x**2).sum(axis=1) / 8])
    pieces = Pieces.of(face[None]).divided(0.6, MOST)
    corners = pieces.corners
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert sides.max() <= pieces.longest_sides.max() <= 0.6 + 1e-12
    np.testing.assert_allclose(corners[..., 2], (corners[..., :2] ** 2).sum(-1) / 8, atol=1e-12)
    assert area(corners * [1.0, 1.0, 0.0]) == pytest.approx(8.0)
    # All are of the face's sense, and within the hulls of their Bézier points.
    assert pieces.normals[:, 2].min() > 0.0
    hulls = pieces.hulls
    assert (hulls.min(axis=1) <= pieces.middles).all()
    assert (hulls.max(axis=1) >= pieces.middles).all()


def test_no_faces_touch_nothing():
    assert touching_triangles(np.zeros((0, 6, 3))).shape == (0, 3, 3)
