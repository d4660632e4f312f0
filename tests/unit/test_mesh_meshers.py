"""One contract for all meshers."""

import subprocess
import sys

import numpy as np
import pytest
from mesh_samples import (
    BALL_VOLUME,
    BLOCK_VOLUME,
    HALF_VOLUME,
    ball_pair,
    block_pair,
    box_surface,
    half_pair,
)

from pagd.errors import InputError, StageFailure, Status
from pagd.mesh.checks import check_actuator
from pagd.mesh.interface import MESHERS, mesher_named
from pagd.mesh.quality import mesh_quality, scaled_jacobians
from pagd.mesh.surfaces import Surface, SurfacePair
from pagd.mesh.topology import doubled_areas
from pagd.mesh.types import FloatArray, Mesh

WHOLE = ["fixed", "cavity", "paper", "tip", "outer"]


@pytest.fixture(scope="module", params=list(MESHERS))
def block(request: pytest.FixtureRequest) -> Mesh:
    return mesher_named(request.param)(block_pair(), 4.0)


@pytest.fixture(scope="module", params=list(MESHERS))
def half(request: pytest.FixtureRequest) -> Mesh:
    return mesher_named(request.param)(half_pair(), 4.0)


def area(mesh: Mesh, name: str) -> FloatArray:
    """Integral of the normal over a surface."""
    return np.asarray(doubled_areas(mesh.points, mesh.surfaces[name]).sum(axis=0) / 2)


def test_mesh_passes_every_check_and_fills_the_solid(block: Mesh) -> None:
    check_actuator(block)
    quality = mesh_quality(block, BLOCK_VOLUME)
    assert quality.volume_error == pytest.approx(0.0, abs=1e-3)
    assert quality.scaled_jacobian_min > 0.05


def test_surfaces_have_names_places_and_directions(block: Mesh) -> None:
    assert list(block.surfaces) == WHOLE
    np.testing.assert_allclose(area(block, "fixed"), [-100, 0, 0], rtol=1e-2, atol=0.5)
    np.testing.assert_allclose(area(block, "tip"), [100, 0, 0], rtol=1e-2, atol=0.5)
    np.testing.assert_allclose(area(block, "paper"), [0, 0, -200], rtol=1e-2, atol=0.5)
    np.testing.assert_allclose(area(block, "cavity"), 0.0, atol=1e-9)
    assert set(block.points[block.nodes_of("fixed"), 0]) == {0.0}
    assert set(block.points[block.nodes_of("tip"), 0]) == {20.0}
    assert set(block.points[block.nodes_of("paper"), 2]) == {2.0}


def test_cavity_points_out_of_the_solid_and_encloses_the_void(block: Mesh) -> None:
    inner = Surface(block.points, block.surfaces["cavity"][:, :3])
    assert inner.volume() == pytest.approx(-14 * 6 * 4, rel=5e-3)


def test_half_model_is_open_at_its_plane_of_symmetry(half: Mesh) -> None:
    check_actuator(half)
    assert list(half.surfaces) == [*WHOLE, "symmetry"]
    assert set(half.points[half.nodes_of("symmetry"), 1]) == {0.0}
    np.testing.assert_allclose(area(half, "symmetry"), [0, -(200 - 48), 0], rtol=1e-2, atol=0.5)
    # The void is missing its side at y = 0, which has the area of the cut.
    np.testing.assert_allclose(area(half, "cavity"), [0, -12 * 4, 0], rtol=1e-2, atol=0.5)
    assert mesh_quality(half, HALF_VOLUME).volume_error == pytest.approx(0.0, abs=1e-3)


def test_elements_are_straight(block: Mesh) -> None:
    first, second = np.array([(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)]).T
    middle = (block.points[block.tets[:, first]] + block.points[block.tets[:, second]]) / 2
    np.testing.assert_allclose(block.points[block.tets[:, 4:]], middle, atol=1e-13)


@pytest.mark.parametrize("name", MESHERS)
def test_thin_walls_do_not_spoil_the_mesh(name: str) -> None:
    """A void with walls of 0.75 mm in elements of 5 mm."""
    body = np.array([[0, 0, 2], [30, 12, 10]], dtype=float)
    void = body + np.array([[0.75], [-0.75]])
    outer, inner = box_surface(*map(tuple, body)), box_surface(*map(tuple, void), inwards=True)
    both = Surface(
        np.vstack((outer.points, inner.points)), np.vstack((outer.triangles, inner.triangles + 8))
    )
    pair = SurfacePair(both, box_surface((0, 0, 1), (30, 12, 2)))
    mesh = mesher_named(name)(pair, 5.0)
    check_actuator(mesh)
    assert mesh_quality(mesh, pair.volume()).volume_error == pytest.approx(0.0, abs=5e-3)
    assert scaled_jacobians(mesh.points, mesh.tets).min() > 0.03


@pytest.mark.parametrize("name", MESHERS)
def test_curved_void_is_meshed(name: str) -> None:
    mesh = mesher_named(name)(ball_pair(divisions=12), 1.5)
    check_actuator(mesh)
    assert mesh_quality(mesh, BALL_VOLUME).volume_error == pytest.approx(0.0, abs=1e-2)
    radii = np.linalg.norm(
        mesh.points[np.unique(mesh.surfaces["cavity"][:, :3])] - [8, 5, 6], axis=1
    )
    np.testing.assert_allclose(radii, 3.0, atol=0.1)
    # The surface has 6 x 12 x 12 x 2 = 1728 triangles: they must not all be kept.
    assert len(mesh.surfaces["cavity"]) < 1000


def test_gmsh_makes_the_same_mesh_in_every_process() -> None:
    code = (
        "import hashlib; from mesh_samples import half_pair; "
        "from pagd.mesh.gmsh_mesher import GmshMesher; m = GmshMesher()(half_pair(), 2.0); "
        "print(hashlib.sha256(m.points.tobytes() + m.tets.tobytes()).hexdigest())"
    )
    folder = __file__.rpartition("/")[0]
    runs = [
        subprocess.run(
            [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=True
        ).stdout
        for _ in range(2)
    ]
    assert len(runs[0].strip()) == 64
    assert runs[0] == runs[1]


def test_solid_without_a_cavity_is_refused() -> None:
    pair = SurfacePair(box_surface((0, 0, 2), (8, 8, 6)), box_surface((0, 0, 0), (8, 8, 2)))
    with pytest.raises(StageFailure, match="has no cavity") as caught:
        mesher_named("gmsh")(pair, 4.0)
    assert caught.value.status is Status.mesh_failed


def test_unknown_mesher_is_refused_with_the_known_ones() -> None:
    with pytest.raises(InputError, match="'tetgen': must be gmsh or ftetwild"):
        mesher_named("tetgen")
    with pytest.raises(InputError, match=r"'pagd\.mesh:nothing'"):
        mesher_named("pagd.mesh:nothing")
