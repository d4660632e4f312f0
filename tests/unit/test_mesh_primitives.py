import numpy as np
import pytest

from pagd.errors import InputError
from pagd.fem.cells import reference_geometry
from pagd.mesh.blocks import check_blocks, hexahedra, wedges
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


@pytest.mark.parametrize(("blocks", "shares"), [("hexahedra", 1.0), ("both", 0.5), ("wedges", 0.0)])
def test_cells_of_boxes_are_hexahedra_or_pairs_of_wedges(blocks: str, shares: float) -> None:
    mesh = box((1.0, 2.0, 3.0), (2, 3, 2), paper_layer=1, blocks=blocks)
    mesh.check()
    check_blocks(mesh)
    assert (mesh.hexahedra, mesh.wedges) == (12 * shares, 24 * (1 - shares))
    plain = box((1.0, 2.0, 3.0), (2, 3, 2), paper_layer=1)
    np.testing.assert_array_equal(mesh.points, plain.points)
    assert set(mesh.surfaces) == set(plain.surfaces)
    assert volume_of_blocks(mesh) == pytest.approx(6.0)


def volume_of_blocks(mesh: Mesh) -> float:
    """By the functions of 27 and 18 nodes."""
    cells = (hexahedra(mesh), wedges(mesh))
    volumes = [reference_geometry(mesh.points, nodes)[1].sum() for nodes in cells if len(nodes)]
    return float(sum(volumes))


@pytest.mark.parametrize("blocks", ["hexahedra", "both", "wedges"])
def test_blocks_of_a_cylinder_and_around_a_void(blocks: str) -> None:
    curved = cylinder_quarter(10.0, 15.0, 2.0, (2, 4, 1), blocks)
    hollow = hollow_block((3.0, 6.0, 4.5), (3, 3, 3), ((1, 2),) * 3, 1, blocks=blocks)
    for mesh, volume in ((curved, np.pi / 4 * 125 * 2), (hollow, 78.0)):
        mesh.check()
        check_blocks(mesh)
        assert volume_of_blocks(mesh) == pytest.approx(volume, rel=1e-4)
    check_actuator(hollow)


def test_blocks_of_a_sphere_are_curved_wedges() -> None:
    mesh = sphere_octant(10.0, 15.0, (2, 4), "wedges")
    mesh.check()
    check_blocks(mesh)
    assert (mesh.hexahedra, mesh.wedges) == (0, 2 * 4 * 4)
    assert volume_of_blocks(mesh) == pytest.approx(np.pi / 6 * (15**3 - 10**3), rel=3e-3)


def test_unknown_blocks_are_refused() -> None:
    with pytest.raises(InputError, match=r"blocks = 'bricks' must be hexahedra, wedges or both\."):
        box((1.0, 1.0, 1.0), (1, 1, 1), blocks="bricks")
    with pytest.raises(InputError, match=r"blocks = 'hexahedra', but those of a sphere must be"):
        sphere_octant(10.0, 15.0, (1, 1), "hexahedra")
