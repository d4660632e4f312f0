from dataclasses import replace

import numpy as np
import pytest

from pagd.errors import InputError
from pagd.mesh.primitives import box
from pagd.mesh.types import TET_EDGES, TET_FACES, TRI_EDGES, Mesh, corner_volumes

MESH = box((1.0, 2.0, 3.0), (1, 1, 1))


def objection(**changes: object) -> str:
    with pytest.raises(InputError) as caught:
        replace(MESH, **changes).check()
    return str(caught.value)


def test_faces_of_a_tetrahedron_point_outwards_and_carry_their_edge_nodes() -> None:
    corners = np.vstack((np.zeros(3), np.eye(3)))
    nodes = np.vstack((corners, corners[TET_EDGES].mean(axis=1)))
    for face in TET_FACES:
        a, b, c = nodes[face[:3]]
        assert np.cross(b - a, c - a) @ ((a + b + c) / 3 - corners.mean(axis=0)) > 0
        np.testing.assert_array_equal(nodes[face[3:]], nodes[face[TRI_EDGES]].mean(axis=1))


def test_sound_mesh_has_no_objection() -> None:
    MESH.check()


def test_corner_volumes_add_up_and_change_sign_with_orientation() -> None:
    assert corner_volumes(MESH.points, MESH.tets).sum() == pytest.approx(6.0)
    mirrored = MESH.points * np.array([-1.0, 1.0, 1.0])
    assert corner_volumes(mirrored, MESH.tets).sum() == pytest.approx(-6.0)


def test_nodes_of_a_surface_are_its_nodes_and_an_unknown_surface_is_named() -> None:
    nodes = MESH.nodes_of("x1")
    assert len(nodes) == 9
    assert (MESH.points[nodes, 0] == 1.0).all()
    with pytest.raises(InputError, match=r"no surface 'lid'; it has: x0, x1"):
        MESH.nodes_of("lid")


def test_check_names_what_is_wrong() -> None:
    assert "points must be a (n, 3) array of float64" in objection(points=MESH.points[:, :2])
    assert "tets is empty" in objection(tets=MESH.tets[:0])
    assert "outside 0…26" in objection(tets=MESH.tets + 1)
    assert "not finite" in objection(points=np.where(MESH.points == 0.0, np.nan, MESH.points))
    assert "1 nodes that belong to no" in objection(points=np.vstack((MESH.points, [9.0, 9, 9])))
    assert "6 inverted" in objection(points=MESH.points * np.array([-1.0, 1.0, 1.0]))
    assert "surfaces['x0'] must be a (n, 6)" in objection(
        surfaces={"x0": MESH.surfaces["x0"][:, :3]}
    )


def test_mesh_cannot_be_reassigned() -> None:
    with pytest.raises(AttributeError):
        MESH.points = MESH.points  # type: ignore[misc]
    assert isinstance(MESH, Mesh)
