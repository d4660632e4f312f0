"""An actuator that touches itself: strips bent to spirals and helices, and what is no collision."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from pagd.errors import InputError, Status
from pagd.mesh.primitives import box, grid, hollow_block
from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.topology import boundary_faces
from pagd.mesh.types import Mesh
from pagd.self_collision import SelfCollision, self_collision_stop

FloatArray = NDArray[np.float64]

LENGTH, WIDTH, HEIGHT = 120.0, 9.0, 6.0


def strip(*, half: bool = False, cells: tuple[int, int, int] = (40, 3, 2)) -> Mesh:
    """A bar along x from ``fixed`` to ``tip``; as a half, its side y = 0 is ``symmetry``."""
    mesh = box((LENGTH, WIDTH, HEIGHT), cells)
    names = ["y1", "z0", "z1"] + ([] if half else ["y0"])
    surfaces = {
        "fixed": mesh.surfaces["x0"],
        "tip": mesh.surfaces["x1"],
        "outer": np.vstack([mesh.surfaces[name] for name in names]),
    }
    surfaces |= {"symmetry": mesh.surfaces["y0"]} if half else {}
    return Mesh(points=mesh.points, tets=mesh.tets, surfaces=surfaces)


def curled(points: FloatArray, degrees: float, inwards: float = 0.0) -> FloatArray:
    """Displacement that bends the bar downwards to an angle, ``inwards`` nearer per turn."""
    x, y, z = points.T
    angle = np.radians(degrees) * x / LENGTH
    radius = LENGTH / np.radians(degrees)
    height = radius - inwards * angle / (2 * np.pi) + z - HEIGHT / 2
    return np.column_stack([height * np.sin(angle), y, height * np.cos(angle) - radius]) - points


def wound(points: FloatArray, turns: float, pitch: float) -> FloatArray:
    """Displacement that winds the bar to a helix whose turns are ``pitch`` apart along y."""
    x, y, z = points.T
    angle = 2 * np.pi * turns * x / LENGTH
    height = LENGTH / (2 * np.pi * turns) + z
    along = y + pitch * angle / (2 * np.pi)
    return np.column_stack([height * np.sin(angle), along, height * np.cos(angle)]) - points


@pytest.fixture(scope="module")
def whole() -> Mesh:
    return strip()


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize("degrees", [1e-9, 90, 200, 300, 345])
def test_no_collision_below_a_full_turn(half: bool, degrees: float) -> None:
    mesh = strip(half=half)
    assert SelfCollision(mesh).find(curled(mesh.points, degrees)) is None


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize("degrees", [362, 371.3, 400])
def test_a_full_turn_collides(half: bool, degrees: float) -> None:
    mesh = strip(half=half)
    found = SelfCollision(mesh).find(curled(mesh.points, degrees, inwards=2.0))
    assert found is not None
    # The two places are one turn apart.
    apart = found.places[1, 0] - found.places[0, 0]
    assert apart == pytest.approx(LENGTH * 360 / degrees, abs=5.0)


def test_the_thickness_counts(whole: Mesh) -> None:
    """In a spiral the next turn is nearer by 5 mm, then by 7: the bar is 6 mm high."""
    collision = SelfCollision(whole)
    assert collision.find(curled(whole.points, 400, inwards=5.0)) is not None
    assert collision.find(curled(whole.points, 400, inwards=7.0)) is None


def test_where_it_meets(whole: Mesh) -> None:
    """A tip that has gone through the underside of the base, and nothing else."""
    displacement = curled(whole.points, 365, inwards=3.0)
    found = SelfCollision(whole).find(displacement)
    assert found is not None
    near, far = found.places[:, 0]
    assert near < 6
    assert far > LENGTH - 6
    # Where the bar begins, at the top of the curl.
    assert np.linalg.norm(found.point[[0, 2]]) < 6


@pytest.mark.parametrize("depth", [0.05, 0.5, 2.0, 5.0])
def test_it_is_found_however_deep(depth: float) -> None:
    """The tip, bent straight back by half a turn, pushed from below into the underside."""
    mesh = strip()
    x, y, z = mesh.points.T
    radius, middle = 10.0, 60.0
    bent = np.clip((x - middle) / radius, 0, np.pi)
    left = np.maximum(x - middle - np.pi * radius, 0)
    # The last piece leads back and up to the underside, which it meets near x = 35.
    along = np.minimum(x, middle) + (radius + z) * np.sin(bent) - left
    up = (radius + z) * np.cos(bent) - radius
    up[left > 0] += (left[left > 0] / left.max()) ** 2 * (2 * radius + depth)
    displacement = np.column_stack([along, y, up]) - mesh.points
    found = SelfCollision(mesh).find(displacement)
    assert found is not None
    assert found.places[1, 0] > LENGTH - 20


def test_a_helix_collides_only_where_its_turns_overlap(whole: Mesh) -> None:
    collision = SelfCollision(whole)
    assert collision.find(wound(whole.points, 2.0, pitch=WIDTH + 0.5)) is None
    found = collision.find(wound(whole.points, 2.0, pitch=WIDTH - 0.5))
    assert found is not None
    assert found.places[1, 0] - found.places[0, 0] == pytest.approx(LENGTH / 2, abs=8.0)


def comb() -> Mesh:
    """Ten chambers of 8 mm on a base, 4 mm apart."""
    solid = np.ones((59, 2, 3), dtype=np.bool_)
    solid[np.arange(59) % 6 >= 4, :, 1:] = False
    points, tets = grid((118.0, 8.0, 12.0), solid)
    return quadratic_mesh(points, tets, {"outer": boundary_faces(tets)})


def test_neighbouring_walls_may_overlap() -> None:
    """Walls that have gone through each other are for contact to deal with."""
    mesh = comb()
    x, _, z = mesh.points.T
    middles = 4 + 12 * np.round((x - 4) / 12)
    displacement = np.zeros_like(mesh.points)
    displacement[:, 0] = np.where(z > 4, 0.8 * (x - middles), 0.0)
    # A wall 4 mm from the middle of its chamber moves by 3.2 of the 4 mm between chambers.
    walls = displacement[np.isclose(np.abs(x - middles), 4) & (z > 4), 0]
    assert np.abs(walls).min() == pytest.approx(3.2)
    assert SelfCollision(mesh).find(displacement) is None


def test_nothing_collides_at_rest(whole: Mesh) -> None:
    for mesh in (whole, strip(half=True), comb()):
        assert SelfCollision(mesh).find(np.zeros_like(mesh.points)) is None


def test_faces_with_a_common_node_never_collide() -> None:
    """Of a short actuator, in large faces: their middles are far apart, they themselves are not."""
    short = hollow_block((12.0, 6.0, 6.0), (3, 3, 3), ((1, 2), (1, 2), (1, 2)), 1)
    moved = np.random.default_rng(0).uniform(-0.3, 0.3, short.points.shape)
    assert SelfCollision(short).find(moved) is None


def test_the_cavity_and_the_paper_are_not_outside(whole: Mesh) -> None:
    """A bar whose surface is the cavity's but for one end: that end meets nothing."""
    surfaces = {"cavity": whole.surfaces["outer"], "fixed": whole.surfaces["fixed"]}
    mesh = Mesh(points=whole.points, tets=whole.tets, surfaces=surfaces)
    assert SelfCollision(mesh).find(curled(mesh.points, 400, inwards=2.0)) is None


def test_the_stop_says_where(whole: Mesh) -> None:
    stop = self_collision_stop(whole)
    assert stop(30.0, curled(whole.points, 300)) is None
    ending = stop(41.23, curled(whole.points, 365, inwards=3.0))
    assert ending is not None
    status, reason = ending
    assert status is Status.self_collision
    assert reason.startswith("At 41.23 kPa the actuator touches itself: x = ")
    assert reason.endswith(" mm of the undeformed shape.")


def test_a_mesh_without_outside_is_refused(whole: Mesh) -> None:
    mesh = Mesh(points=whole.points, tets=whole.tets, surfaces={"cavity": whole.surfaces["outer"]})
    with pytest.raises(InputError, match=r"no surface that is outside.*cavity"):
        SelfCollision(mesh)
