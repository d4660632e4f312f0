from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml

from pagd.cli import main
from pagd.deck import write_deck
from pagd.deck.numbering import DECK_FACES, DECK_ORDER, face_numbers
from pagd.errors import InputError
from pagd.materials import Elastomer, Sheet, elastomer, find_material, sheet
from pagd.mesh.msh import write_msh
from pagd.mesh.primitives import box, hollow_block
from pagd.mesh.types import TET_EDGES, Mesh, corner_volumes

sys.path.insert(0, str(Path(__file__).parents[1] / "verification"))

import calculix

MATERIALS = Path(__file__).parents[2] / "config" / "materials.yaml"
PAPER = sheet("paper", find_material(MATERIALS, "paper", "paper"))
CELLS = (4, 4, 4)
VOID = ((1, 3), (1, 3), (2, 3))
SIZE = (8.0, 8.0, 8.0)

# Corners (counted from 1) that the nodes 5 to 10 of the deck's tetrahedron halve.
DECK_EDGES = ((1, 2), (2, 3), (3, 1), (1, 4), (2, 4), (3, 4))


def material(name: str = "elastosil_m4601") -> Elastomer:
    return elastomer(name, find_material(MATERIALS, name))


def actuator(half: bool = False) -> Mesh:
    void = (VOID[0], (0, 3), VOID[2]) if half else VOID
    return hollow_block(SIZE, CELLS, void, 1, half)


def sections(path: Path) -> list[tuple[str, list[str]]]:
    """Keyword lines and what follows each, comments left out."""
    found: list[tuple[str, list[str]]] = []
    for line in path.read_text(encoding="ascii").splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            found.append((line, []))
        else:
            found[-1][1].append(line)
    return found


def rows(path: Path, keyword: str) -> list[list[float]]:
    """Numbers of the one section whose keyword line starts so."""
    (lines,) = [lines for line, lines in sections(path) if line.startswith(keyword)]
    return [[float(x) for x in line.split(",")] for line in lines]


@pytest.fixture
def deck(tmp_path: Path) -> Path:
    path = tmp_path / "deck.inp"
    write_deck(path, actuator(), material(), PAPER, [5.0, 10.0])
    return path


def test_nodes_and_tetrahedra_are_those_of_the_mesh(deck: Path) -> None:
    mesh = actuator()
    nodes = np.array(rows(deck, "*NODE, NSET"))
    assert nodes[:, 0].tolist() == list(range(1, len(mesh.points) + 1))
    np.testing.assert_allclose(nodes[:, 1:], mesh.points, rtol=1e-11, atol=1e-12)
    tets = np.array(rows(deck, "*ELEMENT, TYPE=C3D10"), np.int64)[:, 1:] - 1
    volumes = corner_volumes(mesh.points, tets)
    assert volumes.min() > 0
    assert volumes.sum() == pytest.approx(8**3 - 4 * 4 * 2)


def test_edge_nodes_lie_between_the_corners_the_deck_means(deck: Path) -> None:
    mesh = actuator()
    tets = np.array(rows(deck, "*ELEMENT, TYPE=C3D10"), np.int64)[:, 1:] - 1
    for place, (a, b) in enumerate(DECK_EDGES, start=4):
        middle = (mesh.points[tets[:, a - 1]] + mesh.points[tets[:, b - 1]]) / 2
        np.testing.assert_allclose(mesh.points[tets[:, place]], middle, atol=1e-12)
    assert sorted(DECK_ORDER) == list(range(10))
    assert not np.array_equal(DECK_ORDER[4:], 4 + np.arange(6)), "gmsh's order is another"
    assert len(TET_EDGES) == 6


def test_pressed_faces_are_the_cavity_and_look_into_it(deck: Path) -> None:
    mesh = actuator()
    (lines,) = [lines for line, lines in sections(deck) if line.startswith("*SURFACE")]
    pairs = [line.split(",") for line in lines]
    tets = np.array([int(tet) - 1 for tet, _ in pairs])
    faces = np.array([int(name.strip()[1:]) - 1 for _, name in pairs])
    corners = mesh.points[mesh.tets[tets][np.arange(len(tets))[:, None], DECK_FACES[faces]]]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    sizes = np.linalg.norm(areas, axis=1)
    assert sizes.sum() == pytest.approx(2 * (4 * 4 + 4 * 2 + 4 * 2))
    np.testing.assert_allclose(areas.sum(axis=0), 0, atol=1e-12)
    # 1-2-3, 1-4-2 … turn so that the normal points into the tetrahedron, away from the void.
    inside = np.array([4.0, 4.0, 5.0]) - corners.mean(axis=1)
    np.testing.assert_array_less(0, -np.einsum("ki,ki->k", areas, inside))


def test_every_face_of_a_tetrahedron_is_found() -> None:
    mesh = box((1.0, 1.0, 1.0), (1, 1, 1))
    for number, face in enumerate(DECK_FACES, start=1):
        triangles = np.tile(mesh.tets[:, face], 2)
        tets, numbers = face_numbers(mesh.tets, triangles)
        for k, (tet, found) in enumerate(zip(tets, numbers, strict=True)):
            assert set(mesh.tets[tet, DECK_FACES[found - 1]]) == set(mesh.tets[k, face])
        assert (numbers[tets == np.arange(len(tets))] == number).all()


def test_a_face_that_is_none_is_refused() -> None:
    mesh = box((1.0, 1.0, 1.0), (1, 1, 1))
    strange = mesh.tets[:1, 4:10]
    with pytest.raises(InputError, match="no faces of the tetrahedra"):
        face_numbers(mesh.tets, strange)


def test_paper_is_a_shell_on_the_nodes_of_the_solid(deck: Path) -> None:
    mesh = actuator()
    found = np.array(rows(deck, "*ELEMENT, TYPE=S6"), np.int64)
    assert found[:, 0].min() == len(mesh.tets) + 1
    np.testing.assert_array_equal(found[:, 1:] - 1, mesh.surfaces["paper"])
    assert rows(deck, "*ELASTIC") == [[6500, 0.2]]
    assert rows(deck, "*SHELL SECTION") == [[0.1]]


def test_yeoh_and_its_compressibility(deck: Path) -> None:
    ((c10, c20, c30, d1, d2, d3),) = rows(deck, "*HYPERELASTIC, YEOH")
    assert (c10, c20, c30) == (0.11, 0.02, 0)
    assert d1 == pytest.approx(2 / material().bulk_modulus)
    # 1/D of the terms we do not have must be small beside 1/D1, and not zero, which CalculiX
    # replaces.
    assert d2 == d3 == 1e9


@pytest.mark.parametrize(
    ("name", "card", "constants"),
    [
        ("smooth_sil_950", "POLYNOMIAL, N=2", [0.26057, 0.09755, 0.0575, 0, 0]),
        ("dragon_skin_10_ogden", "OGDEN, N=1", [0.07004, 2.7713]),
        (
            "ecoflex_00_30_ogden",
            "OGDEN, N=3",
            [0.001887, -3.848, 0.02225, 0.663, 0.003574, 4.225],
        ),
    ],
)
def test_other_laws(tmp_path: Path, name: str, card: str, constants: list[float]) -> None:
    path = tmp_path / "deck.inp"
    write_deck(path, actuator(), material(name), None, [1.0])
    numbers = [x for row in rows(path, f"*HYPERELASTIC, {card}") for x in row]
    assert all(len(row) <= 8 for row in rows(path, f"*HYPERELASTIC, {card}"))
    assert numbers[: len(constants)] == constants
    assert numbers[len(constants)] == pytest.approx(2 / material(name).bulk_modulus)


def test_units_of_stress(tmp_path: Path) -> None:
    path = tmp_path / "deck.inp"
    write_deck(path, actuator(), material(), PAPER, [5.0], stress_unit="Pa")
    ((c10, _, _, d1, _, _),) = rows(path, "*HYPERELASTIC")
    assert c10 == pytest.approx(0.11e6)
    assert d1 == pytest.approx(2e-6 / material().bulk_modulus)
    assert rows(path, "*ELASTIC") == [[6.5e9, 0.2]]
    assert "CAVITY, P, 5000" in path.read_text()
    ogden = tmp_path / "ogden.inp"
    write_deck(ogden, actuator(), material("dragon_skin_10_ogden"), None, [5.0], stress_unit="kPa")
    assert rows(ogden, "*HYPERELASTIC")[0][:2] == pytest.approx([70.04, 2.7713])


def test_each_pressure_ends_a_step(deck: Path) -> None:
    loads = [lines for line, lines in sections(deck) if line.startswith("*DSLOAD")]
    assert loads == [["CAVITY, P, 0.005"], ["CAVITY, P, 0.01"]]
    assert deck.read_text().count("*STEP, NLGEOM") == 2
    assert deck.read_text().count("*NODE PRINT, NSET=NODES") == 2


def test_supports_of_a_half(tmp_path: Path) -> None:
    path, mesh = tmp_path / "deck.inp", actuator(half=True)
    write_deck(path, mesh, material(), PAPER, [5.0])
    sets = {
        line.split("NSET=")[1]: {int(x) for row in lines for x in row.split(",")}
        for line, lines in sections(path)
        if line.startswith("*NSET")
    }
    assert sets["FIXED"] == set(mesh.nodes_of("fixed") + 1)
    assert sets["SYMMETRY"] == set(mesh.nodes_of("symmetry") + 1)
    paper = set(mesh.nodes_of("paper") + 1)
    assert sets["FIXED_PAPER"] == sets["FIXED"] & paper
    assert sets["SYMMETRY_PAPER"] == sets["SYMMETRY"] & paper
    held = [row for line, lines in sections(path) if line == "*BOUNDARY" for row in lines]
    assert held == [
        *(f"FIXED, {n}" for n in (1, 2, 3)),
        *(f"FIXED_PAPER, {n}" for n in (4, 5, 6)),
        "SYMMETRY, 2",
        *(f"SYMMETRY_PAPER, {n}" for n in (4, 6)),
    ]


def test_a_membrane_has_no_rotations(tmp_path: Path) -> None:
    path = tmp_path / "deck.inp"
    write_deck(path, actuator(), material(), PAPER, [5.0], sheet_element="M3D6")
    assert rows(path, "*MEMBRANE SECTION") == [[0.1]]
    assert "FIXED_PAPER" not in path.read_text()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"pressures_kPa": []}, "one or more numbers"),
        ({"pressures_kPa": [float("nan")]}, "one or more numbers"),
        ({"solid_element": "C3D4"}, "solid element is 'C3D4', but must be one of C3D10"),
        ({"sheet_element": "S8"}, "sheet element is 'S8', but must be one of S6"),
        ({"stress_unit": "bar"}, "unit of stress is 'bar', but must be one of MPa"),
        ({"held": {"left": "x"}}, "none of the surfaces to hold: left"),
        ({"mesh": box((1.0, 1.0, 1.0), (1, 1, 1))}, "no surface 'cavity'"),
    ],
)
def test_what_cannot_be_written_is_refused(
    tmp_path: Path, change: dict[str, object], sentence: str
) -> None:
    given: dict[str, object] = {
        "mesh": actuator(),
        "material": material(),
        "paper": PAPER,
        "pressures_kPa": [5.0],
    }
    with pytest.raises(InputError, match=sentence):
        write_deck(tmp_path / "deck.inp", **(given | change))  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_a_law_without_a_card_is_refused(tmp_path: Path) -> None:
    gent = replace(material(), law="gent", coefficients={"mu": 0.2, "Jm": 20.0})
    with pytest.raises(InputError, match="law is 'gent', but a deck can only hold mooney_rivlin"):
        write_deck(tmp_path / "deck.inp", actuator(), gent, None, [5.0])
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("solid_element", "sheet_element", "paper", "others"),
    [
        ("C3D10", "S6", PAPER, ["C3D10H for C3D10 and STRI65 for S6"]),
        ("C3D10H", "S6", PAPER, ["STRI65 for S6"]),
        ("C3D10", "M3D6", PAPER, ["C3D10H for C3D10"]),
        ("C3D10", "S6", None, ["C3D10H for C3D10"]),
        ("C3D10H", "S6", None, []),
        ("C3D10H", "STRI65", PAPER, []),
        ("C3D10HS", "M3D6", PAPER, []),
    ],
)
def test_element_types_for_abaqus_are_told_where_others_are_chosen(
    solid_element: str, sheet_element: str, paper: Sheet | None, others: list[str], tmp_path: Path
) -> None:
    path = tmp_path / "deck.inp"
    chosen = {"solid_element": solid_element, "sheet_element": sheet_element}
    write_deck(path, actuator(), material(), paper, [5.0], **chosen)
    comments = [line for line in path.read_text().splitlines() if line.startswith("**")]
    assert "** Units: mm, N, MPa. Written by pagd." in comments
    told = [line for line in comments if "Abaqus" in line]
    assert told == [f"** Element types for Abaqus would be {types}." for types in others]


def test_command_writes_the_recorded_pressures(tmp_path: Path) -> None:
    mesh, out = tmp_path / "mesh.msh", tmp_path / "deck.inp"
    write_msh(actuator(), mesh)
    arguments = ["deck", "--mesh", str(mesh), "--out", str(out)]
    assert main([*arguments, "--material", "dragon_skin_30", "--pressure-kPa", "12"]) == 0
    loads = [lines[0] for line, lines in sections(out) if line.startswith("*DSLOAD")]
    assert loads == ["CAVITY, P, 0.005", "CAVITY, P, 0.01", "CAVITY, P, 0.012"]
    assert rows(out, "*HYPERELASTIC, YEOH")[0][0] == 0.09217
    assert main([*arguments, "--solid-element", "C3D10H", "--sheet-element", "STRI65"]) == 0
    assert "TYPE=C3D10H" in out.read_text()
    assert out.read_text().count("*STEP") == 10
    assert main([*arguments, "--one-step"]) == 0
    loads = [lines[0] for line, lines in sections(out) if line.startswith("*DSLOAD")]
    assert loads == ["CAVITY, P, 0.05"]
    assert rows(out, "*STATIC")[0][0] == 0.025


def test_command_tells_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mesh = tmp_path / "mesh.msh"
    write_msh(actuator(), mesh)
    for arguments, sentence in (
        (["--mesh", str(tmp_path / "absent.msh")], "there is no such mesh file"),
        (["--mesh", str(mesh), "--material", "ecoflex"], "material is 'ecoflex', but must be one"),
        (["--mesh", str(mesh), "--solid-element", "C3D4"], "solid element is 'C3D4', but must"),
        (["--mesh", str(mesh), "--pressure-kPa", "0"], "maximum_pressure_kPa"),
    ):
        assert main(["deck", *arguments, "--out", str(tmp_path / "deck.inp")]) == 2
        assert sentence in capsys.readouterr().err
    assert not (tmp_path / "deck.inp").exists()


def test_materials_of_the_configuration(tmp_path: Path) -> None:
    mesh, out, config = (tmp_path / name for name in ("mesh.msh", "deck.inp", "config.yaml"))
    write_msh(actuator(), mesh)
    config.write_text(yaml.safe_dump({"material": "ecoflex_00_50"}))
    assert main(["deck", "--mesh", str(mesh), "--out", str(out), "--config", str(config)]) == 0
    assert rows(out, "*HYPERELASTIC, YEOH")[0][0] == 0.01041


@pytest.mark.skipif(not calculix.is_there(), reason="CalculiX (ccx) is not installed")
def test_calculix_stretches_a_block_as_the_law_says() -> None:
    """Cauchy stress 0.1 MPa along x: stretches of the compressible Yeoh law."""
    block = box((4.0, 3.0, 2.0), (1, 1, 1))
    pulled = replace(block, surfaces=block.surfaces | {"cavity": block.surfaces["x1"]})
    held = {"x0": "x", "y0": "y", "z0": "z"}
    (moved,) = calculix.displacements(
        pulled, material(), None, [-100.0], held=held, first_increment=1.0, **calculix.TIGHT
    )
    along, across = 1 + np.ptp(moved, axis=0)[:2] / [4.0, 3.0] * [1, -1]
    volume = along * across**2
    invariant = (along**2 + 2 * across**2) / volume ** (2 / 3)
    slope = 0.11 + 0.04 * (invariant - 3)
    stress = 2 * slope / volume ** (5 / 3) * (along**2 - across**2)
    assert stress == pytest.approx(0.1, rel=1e-3)
    assert along > 1.1


def test_a_job_that_fails_shows_what_was_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "program"
    program.write_text("#!/bin/sh\necho '*ERROR: something is missing'\nexit 201\n")
    program.chmod(0o755)
    monkeypatch.setattr(calculix, "PROGRAM", str(program))
    with pytest.raises(calculix.CalculixError, match="0 of 1 steps were solved") as caught:
        calculix.displacements(actuator(), material(), None, [1.0])
    assert "something is missing" in str(caught.value)
    program.write_text("#!/bin/sh\nexec sleep 60\n")
    with pytest.raises(calculix.CalculixError, match=r"More than 0\.2 s"):
        calculix.displacements(actuator(), material(), None, [1.0], time_limit_s=0.2)
