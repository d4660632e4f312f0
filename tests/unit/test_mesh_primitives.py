import numpy as np
import pytest

from pagd.mesh.checks import check_actuator
from pagd.mesh.primitives import box, cylinder_quarter, hollow_block, sphere_octant
from pagd.mesh.quality import mesh_quality
from pagd.mesh.types import FloatArray, Mesh


def vector_area(mesh: Mesh, name: str) -> FloatArray:
    """Integral of the normal, each curved face as four flat ones through its nodes."""
    faces = mesh.points[mesh.surfaces[name]]
    corners = [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]
    pieces = [np.cross(faces[:, b] - faces[:, a], faces[:, c] - faces[:, a]) for a, b, c in corners]
    return np.asarray(np.sum(pieces, axis=(0, 1)) / 2)


def test_sides_of_a_box_point_outwards() -> None:
    mesh = box((1.0, 2.0, 3.0), (2, 1, 2), paper_layer=1)
    mesh.check()
    assert mesh_quality(mesh).volume_mm3 == pytest.approx(6.0)
    np.testing.assert_allclose(vector_area(mesh, "x0"), [-6, 0, 0], atol=1e-14)
    np.testing.assert_allclose(vector_area(mesh, "y1"), [0, 3, 0], atol=1e-14)
    np.testing.assert_allclose(vector_area(mesh, "z1"), [0, 0, 2], atol=1e-14)
    np.testing.assert_allclose(vector_area(mesh, "paper"), [0, 0, -2], atol=1e-14)
    assert set(mesh.points[mesh.nodes_of("paper"), 2]) == {1.5}


def test_sphere_octant_lies_on_its_spheres_and_planes() -> None:
    mesh = sphere_octant(10.0, 15.0, (2, 3))
    mesh.check()
    radii = {n: np.linalg.norm(mesh.points[mesh.nodes_of(n)], axis=1) for n in ("cavity", "outer")}
    np.testing.assert_allclose(radii["cavity"], 10.0)
    np.testing.assert_allclose(radii["outer"], 15.0)
    for axis, name in enumerate(("x0", "y0", "z0")):
        np.testing.assert_allclose(mesh.points[mesh.nodes_of(name), axis], 0.0, atol=1e-13)
    quarter = np.pi * 100 / 4
    np.testing.assert_allclose(vector_area(mesh, "cavity"), -quarter * np.ones(3), rtol=2e-2)


def test_cylinder_quarter_lies_on_its_cylinders_and_planes() -> None:
    mesh = cylinder_quarter(10.0, 15.0, 2.0, (2, 4, 1))
    mesh.check()
    inner = mesh.points[mesh.nodes_of("cavity")]
    np.testing.assert_allclose(np.hypot(inner[:, 0], inner[:, 1]), 10.0)
    np.testing.assert_allclose(mesh.points[mesh.nodes_of("x0"), 0], 0.0, atol=1e-13)
    np.testing.assert_allclose(mesh.points[mesh.nodes_of("z1"), 2], 2.0)
    np.testing.assert_allclose(vector_area(mesh, "cavity"), [-20, -20, 0], atol=1e-2)


@pytest.mark.parametrize("half", [False, True])
def test_hollow_block_is_an_actuator(half: bool) -> None:
    void = ((1, 5), (0, 1) if half else (1, 3), (2, 3))
    mesh = hollow_block((6.0, 2.0 if half else 4.0, 4.0), (6, 2 if half else 4, 4), void, 1, half)
    check_actuator(mesh)
    assert ("symmetry" in mesh.surfaces) == half
    assert mesh_quality(mesh).volume_mm3 == pytest.approx(44.0 if half else 88.0)
