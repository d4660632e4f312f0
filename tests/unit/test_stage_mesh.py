from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mesh_samples import block_pair, box_surface, half_pair

from pagd.config import load
from pagd.errors import InputError
from pagd.mesh.surfaces import Surface, SurfacePair
from pagd.mesh.types import Mesh
from pagd.record import Record
from pagd.stages import mesh as stage


def write_stl(surface: Surface, path: Path) -> Path:
    """Write a text STL file."""
    corners = surface.points[surface.triangles].reshape(-1, 3)
    path.write_text("solid\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in corners))
    return path


def run(pair: SurfacePair, folder: Path) -> Record:
    """Mesh a pair; no mesher gets any time, so that what comes back at once was checked before."""
    own = stage.OwnSurfaces(
        body=write_stl(pair.body, folder / "body.stl"),
        base=write_stl(pair.base, folder / "base.stl"),
        half=pair.half,
    )
    settings = '{"mesh": {"meshers": ["gmsh"], "time_limit_s": 0.001}}'
    return stage.run_own(own, folder / "mesh", load(settings))


def swapped(pair: SurfacePair) -> SurfacePair:
    return replace(pair, body=pair.base, base=pair.body)


@pytest.mark.parametrize(
    ("pair", "words"),
    [
        (swapped(block_pair()), "must meet in one horizontal paper plane"),
        (replace(block_pair(), base=block_pair().body), "must meet in one horizontal paper plane"),
        (replace(block_pair(), body=box_surface((0, 0, 2), (20, 10, 10))), "must be hollow"),
        (replace(half_pair(), half=False), "must be hollow"),
        (replace(half_pair(), body=box_surface((0, 0, 2), (20, 5, 10))), "must be hollow"),
    ],
    ids=["swapped", "twice the body", "massive", "half as whole", "massive half"],
)
def test_surfaces_of_no_actuator_are_bad_input(
    pair: SurfacePair, words: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=words):
        run(pair, tmp_path)
    assert not (tmp_path / "mesh").exists()


def test_a_whole_pair_is_no_half(tmp_path: Path) -> None:
    pair = block_pair()
    middle = np.array([0.0, 5.0, 0.0])
    body, base = (replace(part, points=part.points - middle) for part in (pair.body, pair.base))
    with pytest.raises(InputError, match=r"must begin at y = 0, not at -5 mm"):
        run(SurfacePair(body, base, half=True), tmp_path)


@pytest.mark.parametrize("pair", [block_pair(), half_pair()], ids=["whole", "half"])
def test_surfaces_of_an_actuator_go_to_the_meshers(pair: SurfacePair, tmp_path: Path) -> None:
    record = run(pair, tmp_path)
    assert record.status == "mesh_failed"
    assert "0.001 s" in str(record.reason)


def test_a_mesh_is_told_from_another() -> None:
    points, tets = np.random.default_rng(1).normal(size=(10, 3)), np.arange(10)[None]
    one = stage.identity(Mesh(points=points, tets=tets, surfaces={}))
    assert one == stage.identity(Mesh(points=points.copy(), tets=tets.copy(), surfaces={"a": tets}))
    assert one["nodes"] == 10
    moved = points.copy()
    moved[3, 1] += 1e-9
    assert stage.identity(Mesh(points=moved, tets=tets, surfaces={})) != one
    assert stage.identity(Mesh(points=points, tets=tets[:, ::-1], surfaces={})) != one
