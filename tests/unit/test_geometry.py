import dataclasses
import os
import re
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from pagd import geometry
from pagd.design import (
    PARAMETERS,
    Channel,
    Design,
    GeometryRules,
    base_volume,
    body_volume,
    cavity_volume,
    violations,
)
from pagd.errors import InputError, MachineError, StageFailure, Status
from pagd.geometry import Part, openscad_version, render, write_design_scad
from pagd.repair import repair

FloatArray = NDArray[np.float64]

RULES = GeometryRules()
MIXED = Design(
    L=8.01,
    W=15.12,
    H=12.98,
    t=1.49,
    t_n=2.8,
    t_h=4.07,
    t_ab=2.05,
    t_b=1.97,
    N=4,
    theta=27.2,
    alpha=0.5,
)
STRAIGHT = dataclasses.replace(MIXED, theta=0.0, alpha=0.0)
# Binary STL keeps coordinates to 6e-8 of themselves.
TOLERANCE = 1e-6


def random_designs(count: int) -> list[Design]:
    """Valid designs from the sampling box, bending, twisting and mixed in turn."""
    generator = np.random.default_rng(7)
    designs: list[Design] = []
    while len(designs) < count:
        values = {key: generator.uniform(p.low, p.high) for key, p in PARAMETERS.items()}
        values["N"] = 3 + len(designs) % 5
        kind = len(designs) % 3
        values |= ({"theta": 0.0, "alpha": 0.0}, {"alpha": 1.0}, {})[kind]
        design = Design.from_mapping(values)
        if not violations(design, RULES):
            designs.append(design)
    return designs


def corners(path: Path) -> FloatArray:
    """Corners of the triangles of a binary STL file, shape (m, 3, 3)."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("colour", "<u2")])
    return np.frombuffer(path.read_bytes()[84:], record)["corners"].astype(np.float64)


def volume(path: Path) -> float:
    a, b, c = np.moveaxis(corners(path), 1, 0)
    return float(np.sum(np.cross(a, b) * c) / 6)


def fake_openscad(folder: Path, script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    program = folder / "openscad"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")


@pytest.mark.parametrize("design", random_designs(6), ids=lambda design: design.mode)
def test_random_designs_have_their_exact_volume_in_two_closed_components(
    design: Design, tmp_path: Path
) -> None:
    body = tmp_path / "body.stl"
    render(design, RULES, "body", body)
    report = repair(body, body, components=2)
    assert report.repairs == 0
    assert report.euler_numbers == (2, 2)
    assert report.volume == pytest.approx(body_volume(design, RULES), rel=TOLERANCE)


@pytest.mark.parametrize("half", [False, True])
def test_parts_of_a_straight_design(half: bool, tmp_path: Path) -> None:
    share = 0.5 if half else 1.0
    volumes: dict[Part, float] = {
        "body": body_volume(STRAIGHT, RULES),
        "base": base_volume(STRAIGHT),
        "cavity": cavity_volume(STRAIGHT, RULES),
    }
    for part, expected in volumes.items():
        path = tmp_path / f"{part}.stl"
        render(STRAIGHT, RULES, part, path, half=half)
        repair(path, path, components=2 if part == "body" and not half else 1)
        assert volume(path) == pytest.approx(share * expected, rel=TOLERANCE)
        assert corners(path)[..., 1].min() >= (0 if half else -STRAIGHT.W)


@pytest.mark.parametrize("design", [MIXED, random_designs(2)[1]], ids=["mixed", "twisting"])
def test_body_and_base_share_the_corners_of_the_paper_plane(design: Design, tmp_path: Path) -> None:
    parts: tuple[Part, Part] = ("body", "base")
    rectangles = []
    for part in parts:
        render(design, RULES, part, tmp_path / "part.stl")
        points = corners(tmp_path / "part.stl").reshape(-1, 3)
        plane = points[np.isclose(points[:, 2], -design.t_b / 2)]
        rectangles.append(np.unique(plane, axis=0))
    np.testing.assert_array_equal(rectangles[0], rectangles[1])
    x, y = design.L_T, design.W / 2
    np.testing.assert_allclose(rectangles[0][:, :2], [[0, -y], [0, y], [x, -y], [x, y]], rtol=1e-6)


def test_extent_and_levels(tmp_path: Path) -> None:
    render(MIXED, RULES, "body", tmp_path / "body.stl")
    points = corners(tmp_path / "body.stl").reshape(-1, 3)
    np.testing.assert_allclose(points.min(axis=0), [0, -MIXED.W / 2, -MIXED.t_b / 2], atol=1e-5)
    np.testing.assert_allclose(points.max(axis=0), [MIXED.L_T, MIXED.W / 2, MIXED.H], rtol=1e-6)
    levels = np.unique(points[:, 2].round(5))
    np.testing.assert_allclose(levels, [-0.985, 0, 2, 3.5, MIXED.H - MIXED.t_h, MIXED.H])


@pytest.mark.parametrize(
    "change",
    [
        {"N": 1},
        {"N": 2, "theta": 45.0, "t_ab": 1.5},
        {"W": 3.76, "t": 0.88, "theta": 45.0, "t_ab": 1.5},  # cavity as wide as the channel
        {"t_ab": 3.05},  # a cavity shorter than the slanted channel is wide
        {"H": 4.0, "t_h": 1.0},
    ],
)
def test_limiting_designs(change: dict[str, float], tmp_path: Path) -> None:
    design = Design.from_mapping(MIXED.as_dict() | change)
    body = tmp_path / "body.stl"
    render(design, RULES, "body", body)
    report = repair(body, body, components=2)
    assert report.repairs == 0
    assert report.volume == pytest.approx(body_volume(design, RULES), rel=TOLERANCE)


def test_the_channel_is_configuration(tmp_path: Path) -> None:
    rules = GeometryRules(channel=Channel(width=3.5, height=1.2, roof=0.8))
    render(MIXED, rules, "body", tmp_path / "body.stl")
    assert volume(tmp_path / "body.stl") == pytest.approx(body_volume(MIXED, rules), rel=TOLERANCE)


class Tapered(Design):
    """A row whose gaps and base thicknesses change along the length."""

    __slots__ = ()

    def gaps(self) -> FloatArray:
        return np.linspace(1.0, 3.5, self.N - 1)

    def base_thicknesses(self) -> FloatArray:
        return np.linspace(3.0, 1.5, self.N)


def test_gaps_and_base_may_change_along_the_row(tmp_path: Path) -> None:
    design = Tapered(**dataclasses.asdict(MIXED))
    render(design, RULES, "cavity", tmp_path / "cavity.stl")
    expected = cavity_volume(design, RULES)
    assert volume(tmp_path / "cavity.stl") == pytest.approx(expected, rel=TOLERANCE)
    assert expected != pytest.approx(cavity_volume(MIXED, RULES), rel=1e-3)
    render(design, RULES, "base", tmp_path / "base.stl")
    middles = design.chamber_starts() + design.L / 2
    x = np.linspace(0, design.L_T, 200_001)
    thickness = np.interp(x, middles, design.base_thicknesses())
    expected = float(np.trapezoid(thickness, x)) * design.W / 2
    assert volume(tmp_path / "base.stl") == pytest.approx(expected, rel=TOLERANCE)


def test_the_model_for_people_has_the_values_and_nothing_else_changed(tmp_path: Path) -> None:
    default, own = tmp_path / "default.scad", tmp_path / "own.scad"
    write_design_scad(MIXED, RULES, default)
    wide = dataclasses.replace(MIXED, L=25.123456789, t_b=0.9)
    write_design_scad(wide, RULES, own)
    pairs = zip(default.read_text().splitlines(), own.read_text().splitlines(), strict=True)
    changed = [after for before, after in pairs if before != after]
    assert changed == [
        "L = 25.123456789; // [3:0.01:25.123456789]",
        "t_b = 0.9; // [0.9:0.01:12]",
    ]


def test_every_parameter_of_the_model_is_set(tmp_path: Path) -> None:
    # Values that occur nowhere in the model: what is not found was not replaced.
    values = {key: 3 + 0.0137 * k for k, key in enumerate(PARAMETERS)} | {"N": 17}
    channel = Channel(width=2.0391, height=2.0392, roof=2.0393)
    write_design_scad(Design.from_mapping(values), GeometryRules(channel=channel), tmp_path / "a")
    text = (tmp_path / "a").read_text()
    values |= {f"channel_{key}": value for key, value in dataclasses.asdict(channel).items()}
    for key, value in values.items():
        assert re.search(rf"^{key} = {value!r};", text, flags=re.MULTILINE), key


def test_an_invalid_design_is_refused_before_anything_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake_openscad(tmp_path, "touch ran", monkeypatch)
    monkeypatch.chdir(tmp_path)
    with pytest.raises(StageFailure, match=r"t_n = 0\.1"):
        render(dataclasses.replace(MIXED, t_n=0.1), RULES, "body", tmp_path / "body.stl")
    assert not (tmp_path / "ran").exists()


def test_a_slanted_design_has_no_half(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not symmetric"):
        render(MIXED, RULES, "body", tmp_path / "body.stl", half=True)


def test_without_openscad_the_message_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match="install OpenSCAD"):
        render(MIXED, RULES, "body", tmp_path / "body.stl")


def test_a_failure_of_openscad_is_passed_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake_openscad(tmp_path, "echo first >&2; echo 'ERROR: no solid.' >&2; exit 1", monkeypatch)
    with pytest.raises(
        StageFailure, match=r"could not make the body: first \| ERROR: no solid\.$"
    ) as caught:
        render(MIXED, RULES, "body", tmp_path / "body.stl")
    assert caught.value.status is Status.invalid_geometry
    assert not list(tmp_path.glob("*.stl"))


def test_openscad_that_does_not_start_is_not_blamed_on_the_design(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake_openscad(tmp_path, "echo 'libGL.so.1: cannot open' >&2; exit 127", monkeypatch)
    with pytest.raises(InputError, match="does not start: libGL"):
        render(MIXED, RULES, "body", tmp_path / "body.stl")


@pytest.mark.parametrize(
    ("script", "words"),
    [
        # This is all that OpenSCAD says, and it ends well.
        ("echo 'ERROR: \"body.stl\" write error. (Disk full?)' >&2", "could not write the body"),
        ("kill -9 $$", "killed from outside"),
    ],
)
def test_a_fault_of_the_machine_is_not_blamed_on_the_design(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str, words: str
) -> None:
    fake_openscad(tmp_path, script, monkeypatch)
    with pytest.raises(MachineError, match=words):
        render(MIXED, RULES, "body", tmp_path / "body.stl")
    assert not list(tmp_path.glob("*.stl"))


def test_a_hung_openscad_and_its_children_are_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    late = tmp_path / "late"
    fake_openscad(tmp_path, f"(sleep 1.5; touch {late}) & sleep 60", monkeypatch)
    start = time.monotonic()
    with pytest.raises(StageFailure, match=r"within 0\.3 s"):
        render(MIXED, RULES, "body", tmp_path / "body.stl", time_limit=0.3)
    assert time.monotonic() - start < 30
    time.sleep(1.8)
    assert not late.exists()
    assert not list(tmp_path.glob("*.stl"))


def test_the_same_design_gives_the_same_file_whatever_the_order_of_facets(tmp_path: Path) -> None:
    paths = [tmp_path / "first.stl", tmp_path / "second.stl"]
    for path in paths:
        render(MIXED, RULES, "body", path)
    written = paths[0].read_bytes()
    assert paths[1].read_bytes() == written
    facets = np.frombuffer(written[84:], dtype=geometry._STL_FACET)
    shuffled = facets[np.random.default_rng(0).permutation(len(facets))].copy()
    shuffled["corners"] = np.roll(shuffled["corners"], 1, axis=1)
    paths[1].write_bytes(written[:84] + shuffled.tobytes())
    assert paths[1].read_bytes() != written
    geometry._sort_facets(paths[1])
    assert paths[1].read_bytes() == written


def test_version() -> None:
    assert re.match(r"20\d\d\.\d\d", openscad_version())
