import numpy as np
import pytest

from pagd.errors import InputError
from pagd.mesh.primitives import grid
from pagd.mesh.topology import (
    boundary_faces,
    components,
    doubled_areas,
    edge_neighbours,
    interface_faces,
    occurrences,
    open_edges,
    row_numbers,
    shared_faces,
)

POINTS, TETS = grid((2.0, 1.0, 1.0), np.ones((2, 1, 1), dtype=np.bool_))


def test_row_numbers_are_equal_just_for_equal_rows() -> None:
    rows = np.array([[1, 2, 3], [3, 2, 1], [1, 2, 3], [1, 2, 4], [2, 2, 3]])
    numbers = row_numbers(rows)
    assert numbers[0] == numbers[2]
    assert len(np.unique(numbers)) == 4
    np.testing.assert_array_equal(occurrences(rows), [2, 1, 2, 1, 1])


def test_row_numbers_survive_node_numbers_whose_packed_key_would_overflow() -> None:
    big = 3_000_000
    rows = np.array([[big, big - 1, big - 2], [big, big - 1, big - 3], [big, big - 1, big - 2]])
    assert row_numbers(rows).tolist() == [1, 0, 1]


def test_boundary_is_closed_and_has_the_area_of_the_box() -> None:
    faces = boundary_faces(TETS)
    areas = doubled_areas(POINTS, faces) / 2
    assert np.linalg.norm(areas, axis=1).sum() == pytest.approx(10.0)
    np.testing.assert_allclose(areas.sum(axis=0), 0.0, atol=1e-14)
    assert len(open_edges(faces)) == 0


def test_each_inner_face_has_two_owners() -> None:
    faces, owners = shared_faces(TETS)
    assert len(faces) == (4 * len(TETS) + len(boundary_faces(TETS))) / 2
    for face, pair in zip(faces, owners, strict=True):
        for tet in pair[pair >= 0]:
            assert set(face) < set(TETS[tet])


def test_interface_points_from_above_to_below() -> None:
    right = POINTS[TETS].mean(axis=1)[:, 0] > 1.0
    areas = doubled_areas(POINTS, interface_faces(TETS, right)) / 2
    np.testing.assert_allclose(areas.sum(axis=0), [-1.0, 0.0, 0.0], atol=1e-14)


def test_overlapping_tetrahedra_are_refused() -> None:
    with pytest.raises(InputError, match="overlap"):
        shared_faces(np.vstack((TETS, TETS[:1])))
    points = [0, 1, 2, 3], [0, 1, 2, 4]  # both on the same side of the face 0 1 2
    with pytest.raises(InputError, match="overlap"):
        shared_faces(np.array(points))


def test_components_follow_shared_edges_and_labels() -> None:
    triangles = np.array([[0, 1, 2], [2, 1, 3], [3, 4, 5], [6, 7, 8], [8, 7, 9]])
    labels = components(edge_neighbours(triangles), 5)
    assert labels.tolist() == [0, 0, 1, 2, 2]
    split = components(edge_neighbours(triangles, np.array([0, 1, 0, 0, 0])), 5)
    assert len(np.unique(split)) == 4
