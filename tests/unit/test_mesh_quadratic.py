import numpy as np

from pagd.mesh.primitives import grid
from pagd.mesh.quadratic import compact, quadratic_mesh, sort_along_axis
from pagd.mesh.topology import boundary_faces
from pagd.mesh.types import TET_EDGES, TRI_EDGES, corner_volumes

POINTS, TETS = grid((1.0, 5.0, 2.0), np.ones((1, 3, 2), dtype=np.bool_))
MESH = quadratic_mesh(POINTS, TETS, {"all": boundary_faces(TETS)})


def test_edge_nodes_lie_half_way_and_are_shared() -> None:
    MESH.check()
    for nodes, edges in ((MESH.tets, TET_EDGES), (MESH.surfaces["all"], TRI_EDGES)):
        corners = 4 if edges is TET_EDGES else 3
        middle = MESH.points[nodes[:, :corners]][:, edges].mean(axis=2)
        np.testing.assert_array_equal(MESH.points[nodes[:, corners:]], middle)
    assert len(np.unique(MESH.points.round(9), axis=0)) == len(MESH.points)


def test_elements_keep_volume_and_orientation() -> None:
    np.testing.assert_allclose(corner_volumes(MESH.points, MESH.tets).sum(), 10.0)


def test_nodes_and_elements_are_sorted_along_the_longest_axis() -> None:
    assert (np.diff(MESH.points[:, 1]) >= 0).all()
    assert (np.diff(MESH.tets.min(axis=1)) >= 0).all()


def test_sorting_twice_changes_nothing() -> None:
    again = sort_along_axis(MESH)
    np.testing.assert_array_equal(again.points, MESH.points)
    np.testing.assert_array_equal(again.tets, MESH.tets)
    np.testing.assert_array_equal(again.surfaces["all"], MESH.surfaces["all"])


def test_unused_points_are_dropped_and_faces_on_them_marked() -> None:
    points = np.vstack(([9.0, 9.0, 9.0], POINTS))
    faces = np.vstack((boundary_faces(TETS) + 1, [0, 1, 2]))
    kept, tets, surfaces = compact(points, TETS + 1, {"all": faces})
    np.testing.assert_array_equal(kept, POINTS)
    np.testing.assert_array_equal(tets, TETS)
    assert surfaces["all"][-1].tolist() == [-1, 0, 1]
