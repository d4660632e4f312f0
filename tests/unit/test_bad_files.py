"""Meshes and surfaces as users may bring them: one sentence each, and nothing left behind."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pagd.cli import main
from pagd.mesh.msh import write_msh
from pagd.mesh.primitives import hollow_block

MESH = hollow_block((6.0, 4.0, 4.0), (6, 4, 4), ((1, 5), (1, 3), (2, 3)), 1)
CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
Triangle = np.ndarray


def cube(x: float, y: float, z: float, size: float = 10.0) -> list[Triangle]:
    """Twelve triangles of a cube with its lowest corner at a place, in mm."""
    points = size * CORNERS + (x, y, z)
    return [points[[a, *pair]] for a, b, c, d in SIDES for pair in ((b, c), (c, d))]


def stl(triangles: Iterable[Triangle]) -> bytes:
    """The triangles as a text file."""
    lines = ["solid some"]
    for triangle in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:g} {y:g} {z:g}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid some", ""]).encode()


def inverted(path: Path) -> None:
    tets = MESH.tets.copy()
    tets[0, [0, 1]] = tets[0, [1, 0]]
    write_msh(replace(MESH, tets=tets), path)


def without_cavity(path: Path) -> None:
    some = {name: faces for name, faces in MESH.surfaces.items() if name != "cavity"}
    write_msh(replace(MESH, surfaces=some), path)


def mistyped(path: Path) -> None:
    named = {("cavty" if name == "cavity" else name): f for name, f in MESH.surfaces.items()}
    write_msh(replace(MESH, surfaces=named), path)


def cut(path: Path) -> None:
    write_msh(MESH, path)
    path.write_bytes(path.read_bytes()[:2000])


MESHES: dict[str, tuple[Callable[[Path], object], str]] = {
    "metres": (
        lambda path: write_msh(replace(MESH, points=1e-3 * MESH.points), path),
        "coordinates must be in mm",
    ),
    "inverted": (inverted, "1 inverted or flat tetrahedra, the first at"),
    "without a surface": (without_cavity, "lacks the surface cavity; it has: "),
    "with a mistyped one": (mistyped, "cavty"),
    "cut off": (cut, "gmsh cannot read this as a mesh"),
    "text": (lambda path: path.write_text("hello"), "gmsh cannot read this as a mesh"),
    "empty": (lambda path: path.write_bytes(b""), "mesh"),
    "missing": (lambda path: None, "there is no such mesh file"),
}

#: What is in a cavity looks inwards.
HOLLOW = [*cube(0, 0, 10), *(triangle[::-1] for triangle in cube(2, 2, 12, 6.0))]
#: Surfaces of the body above a base that is a sound cube.
BODIES = {
    "two solids on one edge": (stl([*HOLLOW, *cube(10, 0, 20)]), "not that of a solid: 1 edges"),
    "a hole": (stl(HOLLOW[2:]), "body is not closed: 4 edges have one triangle"),
    "a fin": (
        stl([*HOLLOW, np.array([[0.0, 0, 20], [10, 0, 20], [5, 0, 30]])]),
        "not closed",
    ),
    "no cavity": (stl(cube(0, 0, 10)), "must be hollow"),
    "elsewhere": (stl(cube(0, 0, 50)), "must meet in one horizontal paper plane"),
    "not a number": (stl([*HOLLOW, np.full((3, 3), np.nan)]), "not finite"),
    "text": (b"hello", "holds no triangles"),
    "empty": (b"", "holds no triangles"),
    "a binary head alone": (b"\0" * 84, "holds no triangles"),
    "missing": (None, "does not exist"),
}

#: Surfaces of the base below a body that is sound.
BASES = {
    "two solids on one edge": (stl([*cube(0, 0, 0), *cube(10, 0, -10)]), "base is not that of a"),
    "a hole": (stl(cube(0, 0, 0)[2:]), "base is not closed: 4 edges have one triangle"),
    "smaller": (stl(cube(1, 1, 2, 8.0)), "must cover the same area of the paper plane"),
    "text": (b"hello", "holds no triangles"),
    "missing": (None, "does not exist"),
}


def refused(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *words: str
) -> str:
    """Give a command in a folder; its one sentence, after which nothing is there but before."""
    monkeypatch.chdir(folder)
    before = sorted(folder.rglob("*"))
    assert main([*words, "--out", "out"]) == 2
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1, told
    assert told[0].startswith("pagd: ")
    assert sorted(folder.rglob("*")) == before
    return told[0]


@pytest.mark.parametrize("name", MESHES)
def test_meshes_that_cannot_be_solved(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    make, words = MESHES[name]
    make(tmp_path / "own.msh")
    told = refused(tmp_path, capsys, monkeypatch, "solve", "--mesh", "own.msh")
    assert "own.msh" in told
    assert words in told


@pytest.mark.parametrize(
    ("which", "name"),
    [*(("body", name) for name in BODIES), *(("base", name) for name in BASES)],
)
def test_surfaces_that_cannot_be_meshed(
    which: str,
    name: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    content, words = (BODIES if which == "body" else BASES)[name]
    files: dict[str, bytes | None] = {"body": stl(HOLLOW), "base": stl(cube(0, 0, 0))}
    for part, sound in (files | {which: content}).items():
        if sound is not None:
            (tmp_path / f"{part}.stl").write_bytes(sound)
    told = refused(
        tmp_path, capsys, monkeypatch, "mesh", "--body", "body.stl", "--base", "base.stl"
    )
    assert f"{which}.stl" in told
    assert words in told


@pytest.mark.parametrize("factor", [1e-3, 1e6])
def test_surfaces_in_another_unit(
    factor: float,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for part, triangles in (("body", HOLLOW), ("base", cube(0, 0, 0))):
        (tmp_path / f"{part}.stl").write_bytes(stl(factor * one for one in triangles))
    told = refused(
        tmp_path, capsys, monkeypatch, "mesh", "--body", "body.stl", "--base", "base.stl"
    )
    assert "coordinates must be in mm" in told


def test_a_sound_mesh_is_no_bad_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What all of these are changes of is solved by the same command."""
    monkeypatch.chdir(tmp_path)
    write_msh(MESH, tmp_path / "own.msh")
    command = ["solve", "--mesh", "own.msh", "--pressure-kPa", "1", "--blocked-force", "none"]
    assert main([*command, "--out", "out"]) == 0
