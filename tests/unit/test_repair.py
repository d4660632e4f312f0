from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from pagd.errors import InputError, StageFailure, Status
from pagd.repair import RepairReport, repair

Triangles = NDArray[np.float64]

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("colour", "<u2")])


def box(low: float, high: float) -> Triangles:
    """The twelve triangles of a cube, outward, shape (12, 3, 3)."""
    x = np.array([[i, j, k] for i in (low, high) for j in (low, high) for k in (low, high)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return np.asarray(x[np.array(faces)], dtype=np.float64)


def turned(triangles: Triangles) -> Triangles:
    return triangles[:, ::-1]


def write_stl(path: Path, triangles: Triangles) -> None:
    records = np.zeros(len(triangles), RECORD)
    records["corners"] = triangles
    count = np.uint32(len(triangles)).tobytes()
    path.write_bytes(bytes(80) + count + records.tobytes())


def read_stl(path: Path) -> Triangles:
    records = np.frombuffer(path.read_bytes()[84:], RECORD)
    return np.asarray(records["corners"], dtype=np.float64)


def repaired(folder: Path, triangles: Triangles, components: int | None = None) -> RepairReport:
    """Repair and check against the file: what is reported is what was written."""
    write_stl(folder / "in.stl", triangles)
    report = repair(folder / "in.stl", folder / "out.stl", components)
    a, b, c = np.moveaxis(read_stl(folder / "out.stl"), 1, 0)
    assert len(a) == report.faces
    assert np.sum(a * np.cross(b, c)) / 6 == pytest.approx(report.volume)
    return report


def refused(folder: Path, triangles: Triangles, components: int | None = None) -> str:
    write_stl(folder / "in.stl", triangles)
    with pytest.raises(StageFailure) as caught:
        repair(folder / "in.stl", folder / "out.stl", components)
    assert caught.value.status is Status.invalid_geometry
    assert not (folder / "out.stl").exists()
    return caught.value.reason


HOLLOW = np.concatenate((box(0, 4), turned(box(1, 2))))
CUBE = box(0, 1)


def test_a_sound_surface_is_left_alone(tmp_path: Path) -> None:
    report = repaired(tmp_path, HOLLOW, components=2)
    assert report.repairs == 0
    assert (report.outside, report.cavities, report.components) == (1, 1, 2)
    assert report.euler_numbers == (2, 2)
    assert (report.vertices, report.faces, report.merged_vertices) == (16, 24, 56)
    assert report.volume == pytest.approx(63)
    assert report.as_dict()["components"] == 2


def test_numbers_survive_to_the_last_bit(tmp_path: Path) -> None:
    triangles = box(-1.234567, 130.690625).astype(np.float32)
    repaired(tmp_path, triangles.astype(np.float64))
    written = read_stl(tmp_path / "out.stl").reshape(-1, 3).astype(np.float32)
    expected = np.unique(triangles.reshape(-1, 3), axis=0)
    np.testing.assert_array_equal(np.unique(written, axis=0), expected)


def test_a_text_file_is_read_too(tmp_path: Path) -> None:
    facets = (
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x} {y} {z}\n" for x, y, z in triangle)
        + "endloop\nendfacet\n"
        for triangle in CUBE
    )
    (tmp_path / "in.stl").write_text("solid a\n" + "".join(facets) + "endsolid a\n")
    report = repair(tmp_path / "in.stl", tmp_path / "out.stl", components=1)
    assert report.repairs == 0
    assert report.volume == pytest.approx(1)


def test_duplicate_triangles(tmp_path: Path) -> None:
    report = repaired(tmp_path, np.concatenate((CUBE, CUBE[:2])))
    assert (report.duplicate_faces, report.repairs, report.faces) == (2, 2, 12)


def test_a_duplicate_that_is_turned(tmp_path: Path) -> None:
    report = repaired(tmp_path, np.concatenate((CUBE, turned(CUBE[5:6]))))
    assert (report.duplicate_faces, report.faces) == (1, 12)
    assert report.volume == pytest.approx(1)


def test_turned_triangles(tmp_path: Path) -> None:
    triangles = HOLLOW.copy()
    triangles[[0, 5, 15]] = turned(triangles[[0, 5, 15]])
    report = repaired(tmp_path, triangles, components=2)
    assert (report.flipped_faces, report.repairs) == (3, 3)
    assert report.volume == pytest.approx(63)


def test_inside_out(tmp_path: Path) -> None:
    report = repaired(tmp_path, turned(HOLLOW), components=2)
    assert report.flipped_faces == 24
    assert report.volume == pytest.approx(63)


def test_a_cavity_that_looks_outwards_is_turned(tmp_path: Path) -> None:
    report = repaired(tmp_path, np.concatenate((box(1, 2), box(0, 4))), components=2)
    assert (report.flipped_faces, report.outside, report.cavities) == (12, 1, 1)
    assert report.volume == pytest.approx(63)


def test_a_solid_inside_a_cavity_looks_outwards(tmp_path: Path) -> None:
    report = repaired(tmp_path, np.concatenate((box(0, 9), box(1, 8), box(3, 4))))
    assert (report.outside, report.cavities) == (2, 1)
    assert report.volume == pytest.approx(9**3 - 7**3 + 1)


def test_vertices_apart_by_rounding(tmp_path: Path) -> None:
    noise = np.random.default_rng(0).uniform(-1e-5, 1e-5, CUBE.shape)
    report = repaired(tmp_path, CUBE + noise, components=1)
    assert report.moved_vertices > 0
    assert (report.vertices, report.faces) == (8, 12)
    assert report.volume == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize("missing", [[3], [2, 3]], ids=["triangle", "square"])
def test_a_small_hole_is_closed(missing: list[int], tmp_path: Path) -> None:
    report = repaired(tmp_path, np.delete(CUBE, missing, axis=0), components=1)
    assert report.closed_holes == 1
    assert report.faces == 12
    assert report.volume == pytest.approx(1)


def test_a_corner_that_is_not_a_number(tmp_path: Path) -> None:
    triangles = CUBE.copy()
    triangles[4, 1, 2] = np.nan
    triangles[6, 0, 0] = np.inf
    report = repaired(tmp_path, triangles, components=1)
    assert (report.nonfinite_faces, report.closed_holes) == (2, 2)
    assert report.volume == pytest.approx(1)


def fan(corners: int) -> Triangles:
    """A pyramid over a regular polygon, without its base."""
    angles = 2 * np.pi * np.arange(corners) / corners
    ring = np.stack((np.cos(angles), np.sin(angles), np.zeros(corners)), axis=1)
    apex = np.tile([0.0, 0.0, 1.0], (corners, 1))
    return np.stack((ring, np.roll(ring, -1, axis=0), apex), axis=1)


def test_a_large_hole_is_not_guessed_at(tmp_path: Path) -> None:
    assert repaired(tmp_path, fan(8)).closed_holes == 1
    (tmp_path / "out.stl").unlink()
    reason = refused(tmp_path, fan(9))
    assert "not closed: 9 edge(s) border on one triangle only, the first at (" in reason


def test_a_null_triangle_in_a_t_junction(tmp_path: Path) -> None:
    a, b, c = CUBE[0]
    middle = (a + b) / 2
    split = np.array([[a, middle, c], [middle, b, c]])
    cracked = np.concatenate((CUBE[1:], split))
    flat = np.array([[a, b, middle]])
    for triangles in (np.concatenate((cracked, flat)), cracked):
        report = repaired(tmp_path, triangles, components=1)
        assert report.sliver_faces == 1
        assert (report.vertices, report.faces) == (9, 14)
        assert report.volume == pytest.approx(1)
        areas = np.linalg.norm(
            np.cross(*np.moveaxis(np.diff(read_stl(tmp_path / "out.stl"), axis=1), 1, 0)), axis=1
        )
        assert areas.min() > 0.1


def test_a_triangle_with_two_equal_corners(tmp_path: Path) -> None:
    a, b, _ = CUBE[0]
    report = repaired(tmp_path, np.concatenate((CUBE, [[a, a, b]])), components=1)
    assert (report.null_faces, report.repairs, report.faces) == (1, 1, 12)


def test_solids_that_touch_along_an_edge(tmp_path: Path) -> None:
    reason = refused(tmp_path, np.concatenate((CUBE, CUBE + np.array([1.0, 1.0, 0.0]))))
    assert "touches itself at 1 edge(s), the first at (1, 1, 0.5) mm" in reason


def test_solids_that_touch_at_a_corner(tmp_path: Path) -> None:
    reason = refused(tmp_path, np.concatenate((CUBE, CUBE + 1.0)))
    assert "touches itself at 1 corner(s)" in reason


def test_a_fin(tmp_path: Path) -> None:
    fin = np.array([[CUBE[0, 0], CUBE[0, 1], [0.0, 0.0, 3.0] - CUBE[0, 2]]])
    assert "touches itself" in refused(tmp_path, np.concatenate((CUBE, fin)))


def test_solids_that_overlap(tmp_path: Path) -> None:
    assert "passes through itself" in refused(tmp_path, np.concatenate((CUBE, box(0.5, 2))))


def test_a_lone_sheet(tmp_path: Path) -> None:
    refused(tmp_path, CUBE[:1])


def test_wrong_number_of_components(tmp_path: Path) -> None:
    apart = np.concatenate((CUBE, box(2, 3)))
    assert "2 closed components, 2 of them outside, instead of 1" in refused(tmp_path, apart, 1)
    assert "instead of 2 with 1 outside" in refused(tmp_path, apart, 2)
    assert "1 closed components" in refused(tmp_path, CUBE, 2)
    assert repaired(tmp_path, apart).components == 2


@pytest.mark.parametrize(
    "content",
    [b"", b"solid a\nendsolid a\n", b"words", bytes(84)],
    ids=["empty", "text", "words", "binary"],
)
def test_a_file_without_triangles(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "in.stl").write_bytes(content)
    with pytest.raises(StageFailure, match="no triangles"):
        repair(tmp_path / "in.stl", tmp_path / "out.stl")


def test_triangles_without_an_area(tmp_path: Path) -> None:
    assert "no triangles" in refused(tmp_path, np.zeros((3, 3, 3)))
    assert "no triangles" in refused(tmp_path, np.full((3, 3, 3), np.nan))


def test_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not exist"):
        repair(tmp_path / "in.stl", tmp_path / "out.stl")
