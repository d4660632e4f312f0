"""Files of one's own: what is read, and what is said about what cannot be."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pagd.errors import InputError
from pagd.mesh.gmsh_session import gmsh_session
from pagd.mesh.msh import read_msh, write_msh
from pagd.mesh.primitives import hollow_block
from pagd.mesh.types import FloatArray, IntArray, Mesh

MESH = hollow_block((6.0, 4.0, 4.0), (6, 4, 4), ((1, 5), (1, 3), (2, 3)), 1)
HALF = hollow_block((6.0, 2.0, 4.0), (6, 2, 4), ((1, 5), (0, 1), (2, 3)), 1, half=True)


def write_as(
    path: Path, points: FloatArray, tets: IntArray, surfaces: dict[str, IntArray], version: float
) -> None:
    """Write elements of any order with numbers of their own, as other programs do."""
    types = {3: 2, 4: 4, 6: 9, 10: 11}
    numbers = 7 + 2 * np.arange(len(points))
    with gmsh_session({"Mesh.MshFileVersion": version}) as gmsh:
        gmsh.model.addDiscreteEntity(3, 5)
        gmsh.model.mesh.addNodes(3, 5, numbers, points.ravel())
        gmsh.model.mesh.addElementsByType(5, types[tets.shape[1]], [], numbers[tets].ravel())
        gmsh.model.addPhysicalGroup(3, [5], 5, "rubber")
        for tag, (name, faces) in enumerate(surfaces.items(), start=3):
            gmsh.model.addDiscreteEntity(2, tag)
            kind = types[faces.shape[1]]
            gmsh.model.mesh.addElementsByType(tag, kind, [], numbers[faces].ravel())
            gmsh.model.addPhysicalGroup(2, [tag], tag, name)
        gmsh.write(str(path))


def linear(mesh: Mesh) -> tuple[FloatArray, IntArray, dict[str, IntArray]]:
    return mesh.points, mesh.tets[:, :4], {n: f[:, :3] for n, f in mesh.surfaces.items()}


def assert_same(one: Mesh, other: Mesh) -> None:
    np.testing.assert_array_equal(one.points, other.points)
    np.testing.assert_array_equal(one.tets, other.tets)
    assert list(one.surfaces) == list(other.surfaces)
    for name, faces in one.surfaces.items():
        np.testing.assert_array_equal(faces, other.surfaces[name])


def refusal(path: Path, mesh: Mesh) -> str:
    write_msh(mesh, path)
    with pytest.raises(InputError) as caught:
        read_msh(path)
    assert str(caught.value).startswith(f"{path}: ")
    return str(caught.value)


@pytest.mark.parametrize("mesh", [MESH, HALF])
@pytest.mark.parametrize("binary", [True, False])
def test_what_is_written_is_read_back_to_the_last_bit(
    tmp_path: Path, mesh: Mesh, binary: bool
) -> None:
    write_msh(mesh, tmp_path / "a.msh", binary=binary)
    assert_same(read_msh(tmp_path / "a.msh"), mesh)
    assert [file.name for file in tmp_path.iterdir()] == ["a.msh"]


@pytest.mark.parametrize("version", [2.2, 4.1])
def test_linear_mesh_becomes_quadratic(tmp_path: Path, version: float) -> None:
    points, tets, surfaces = linear(MESH)
    write_as(tmp_path / "a.msh", points, tets, surfaces, version)
    mesh = read_msh(tmp_path / "a.msh")
    # Nodes at equal x may be numbered in another order.
    assert len(mesh.points) == len(MESH.points)
    assert mesh.tets.shape == MESH.tets.shape
    assert {n: len(f) for n, f in mesh.surfaces.items()} == {
        n: len(f) for n, f in MESH.surfaces.items()
    }
    for name in MESH.surfaces:
        mine = mesh.points[mesh.surfaces[name]].mean(axis=1).round(9)
        given = MESH.points[MESH.surfaces[name]].mean(axis=1).round(9)
        np.testing.assert_array_equal(np.unique(mine, axis=0), np.unique(given, axis=0))


def test_faces_are_turned_outwards_and_the_rest_of_the_boundary_becomes_outer(
    tmp_path: Path,
) -> None:
    rng = np.random.default_rng(0)
    surfaces = {}
    for name in ("fixed", "cavity", "paper"):
        faces = MESH.surfaces[name].copy()
        flipped = rng.random(len(faces)) < 0.5
        faces[flipped] = faces[flipped][:, [0, 2, 1, 5, 4, 3]]
        surfaces[name] = faces
    write_as(tmp_path / "a.msh", MESH.points, MESH.tets, surfaces, 4.1)
    mesh = read_msh(tmp_path / "a.msh")
    assert len(mesh.surfaces["outer"]) == len(MESH.surfaces["outer"]) + len(MESH.surfaces["tip"])
    for name, faces in surfaces.items():
        a, b, c = (mesh.points[mesh.surfaces[name][:, i]] for i in range(3))
        x, y, z = (MESH.points[MESH.surfaces[name][:, i]] for i in range(3))
        np.testing.assert_allclose(
            np.cross(b - a, c - a).sum(axis=0), np.cross(y - x, z - x).sum(axis=0), atol=1e-12
        )
        assert len(mesh.surfaces[name]) == len(faces)


def test_nodes_of_no_tetrahedron_are_dropped(tmp_path: Path) -> None:
    points = np.vstack((MESH.points, [[1.0, 1, 1], [50.0, 0, 0]]))
    write_as(tmp_path / "a.msh", points, MESH.tets, MESH.surfaces, 4.1)
    assert len(read_msh(tmp_path / "a.msh").points) == len(MESH.points)


def test_missing_names_are_named_with_those_found(tmp_path: Path) -> None:
    surfaces = {"paper": MESH.surfaces["paper"], "tip": MESH.surfaces["tip"]}
    message = refusal(tmp_path / "a.msh", replace(MESH, surfaces=surfaces))
    assert "lacks the surfaces fixed and cavity; it has: paper, tip." in message


def test_mistyped_names_are_not_ignored(tmp_path: Path) -> None:
    surfaces = {"papper" if n == "paper" else n: f for n, f in MESH.surfaces.items()}
    message = refusal(tmp_path / "a.msh", replace(MESH, surfaces=surfaces))
    assert "unknown physical surface papper; known: fixed, cavity, paper" in message


def test_inverted_elements_are_counted_and_located(tmp_path: Path) -> None:
    tets = MESH.tets.copy()
    tets[4] = tets[4][[0, 2, 1, 3, 6, 5, 4, 7, 8, 9]]
    message = refusal(tmp_path / "a.msh", replace(MESH, tets=tets))
    assert "1 inverted or flat tetrahedra, the first at (" in message


def test_curved_element_that_folds_over_is_found(tmp_path: Path) -> None:
    points = MESH.points.copy()
    tet = MESH.tets[0]
    points[tet[4]] = points[tet[0]] + 0.1 * (points[tet[1]] - points[tet[0]])
    message = refusal(tmp_path / "a.msh", replace(MESH, points=points))
    assert "inverted or flat" in message


def test_lengths_in_metres_are_suspected(tmp_path: Path) -> None:
    message = refusal(tmp_path / "a.msh", replace(MESH, points=1e-3 * MESH.points))
    assert "0.006 mm long" in message
    assert "must be in mm" in message


def test_open_cavity_is_refused(tmp_path: Path) -> None:
    surfaces = dict(MESH.surfaces)
    surfaces["outer"] = np.vstack((surfaces["outer"], surfaces["cavity"][:3]))
    surfaces["cavity"] = surfaces["cavity"][3:]
    message = refusal(tmp_path / "a.msh", replace(MESH, surfaces=surfaces))
    assert "'cavity' is not closed" in message


def test_bent_paper_is_refused(tmp_path: Path) -> None:
    points = MESH.points.copy()
    points[:, 2] += 0.01 * points[:, 0] ** 2
    message = refusal(tmp_path / "a.msh", replace(MESH, points=points))
    assert "'paper' is not flat" in message


def test_symmetry_plane_elsewhere_is_refused(tmp_path: Path) -> None:
    message = refusal(tmp_path / "a.msh", replace(HALF, points=HALF.points + np.array([0.0, 1, 0])))
    assert "'symmetry' must lie on y = 0, but nodes lie up to 1 mm off it" in message


def test_doubled_nodes_between_parts_are_found(tmp_path: Path) -> None:
    above = MESH.points[MESH.tets].mean(axis=1)[:, 2] > 1.0
    tets = MESH.tets.copy()
    tets[above] += len(MESH.points)
    points = np.vstack((MESH.points, MESH.points))
    names = ("fixed", "cavity")
    surfaces = {n: MESH.surfaces[n] for n in names}
    surfaces["cavity"] = surfaces["cavity"] + len(MESH.points)
    upper = points[surfaces["fixed"]].mean(axis=1)[:, 2] > 1.0
    surfaces["fixed"] = np.where(
        upper[:, None], surfaces["fixed"] + len(MESH.points), surfaces["fixed"]
    )
    write_as(tmp_path / "a.msh", points, tets, surfaces, 4.1)
    with pytest.raises(InputError, match="falls into 2 pieces"):
        read_msh(tmp_path / "a.msh")


def test_triangles_that_are_no_faces_are_counted(tmp_path: Path) -> None:
    surfaces = dict(MESH.surfaces)
    surfaces["tip"] = np.vstack((surfaces["tip"], MESH.tets[:1, [0, 1, 8, 4, 5, 6]]))
    message = refusal(tmp_path / "a.msh", replace(MESH, surfaces=surfaces))
    assert f"1 of the {len(surfaces['tip'])} triangles of surface 'tip' are not faces" in message


def test_face_with_two_names_is_refused(tmp_path: Path) -> None:
    surfaces = dict(MESH.surfaces)
    surfaces["tip"] = np.vstack((surfaces["tip"], surfaces["outer"][:2]))
    message = refusal(tmp_path / "a.msh", replace(MESH, surfaces=surfaces))
    assert "2 faces with more than one name" in message


def test_files_that_are_no_mesh_of_tetrahedra_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such mesh file"):
        read_msh(tmp_path / "none.msh")
    (tmp_path / "text.msh").write_text("this is no mesh\n")
    with pytest.raises(InputError, match=r"text\.msh"):
        read_msh(tmp_path / "text.msh")
    with gmsh_session() as gmsh:
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "shell.msh"))
    with pytest.raises(InputError, match="no volume elements"):
        read_msh(tmp_path / "shell.msh")
