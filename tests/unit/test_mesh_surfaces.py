from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from mesh_samples import box_surface

from pagd.errors import InputError
from pagd.mesh.surfaces import Surface, SurfacePair, merge_points, read_stl

CUBE = box_surface((0, 0, 0), (2, 2, 2))


def write_text_stl(path: Path, surface: Surface) -> None:
    lines = ["solid test"]
    for triangle in surface.points[surface.triangles]:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.6g} {y:.6g} {z:.6g}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid test"]) + "\n")


def write_binary_stl(path: Path, surface: Surface) -> None:
    records = np.zeros(len(surface.triangles), [("n", "<f4", 3), ("v", "<f4", 9), ("c", "<u2")])
    records["v"] = surface.points[surface.triangles].reshape(-1, 9)
    path.write_bytes(bytes(80) + np.uint32(len(records)).tobytes() + records.tobytes())


@pytest.mark.parametrize("write", [write_text_stl, write_binary_stl])
def test_stl_is_read_with_shared_vertices_and_its_orientation(
    tmp_path: Path, write: Callable[[Path, Surface], None]
) -> None:
    write(tmp_path / "cube.stl", CUBE)
    surface = read_stl(tmp_path / "cube.stl")
    assert surface.points.shape == (8, 3)
    assert surface.triangles.shape == (12, 3)
    assert surface.volume() == pytest.approx(8.0)


def test_rounding_does_not_open_a_surface() -> None:
    rng = np.random.default_rng(0)
    loose = CUBE.points[CUBE.triangles].reshape(-1, 3) + rng.uniform(-1e-6, 1e-6, (36, 3))
    merged = merge_points(loose, np.arange(36).reshape(-1, 3), 1e-5)
    assert merged.points.shape == (8, 3)
    assert merged.volume() == pytest.approx(8.0, rel=1e-5)


def test_triangles_that_collapse_are_dropped() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1e-7, 0, 0]])
    merged = merge_points(points, np.array([[0, 1, 2], [0, 3, 2]]), 1e-5)
    assert merged.triangles.shape == (1, 3)


def test_unusable_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        read_stl(tmp_path / "none.stl")
    (tmp_path / "text.stl").write_text("no surface at all\n")
    with pytest.raises(InputError, match=r"text\.stl holds no triangles"):
        read_stl(tmp_path / "text.stl")
    lost = CUBE.points.copy()
    lost[3, 1] = np.nan
    for write in (write_text_stl, write_binary_stl):
        write(tmp_path / "lost.stl", Surface(lost, CUBE.triangles))
        with pytest.raises(InputError, match="not finite"):
            read_stl(tmp_path / "lost.stl")


def test_pair_knows_its_volume_and_tolerance(tmp_path: Path) -> None:
    base = box_surface((0, 0, -1), (2, 2, 0))
    write_binary_stl(tmp_path / "body.stl", CUBE)
    write_binary_stl(tmp_path / "base.stl", base)
    pair = SurfacePair.from_stl(tmp_path / "body.stl", tmp_path / "base.stl", half=True)
    assert pair.half
    assert pair.volume() == pytest.approx(12.0)
    assert pair.tolerance() == pytest.approx(1e-5 * np.sqrt(17.0))
