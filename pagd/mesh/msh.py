"""Meshes in gmsh's file format (.msh 4.1), surfaces as physical groups."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from pagd.errors import InputError
from pagd.files import replaced_file
from pagd.mesh.checks import SURFACES, check_actuator, check_volumes, require_names
from pagd.mesh.gmsh_session import gmsh_session
from pagd.mesh.orientation import as_solid_faces
from pagd.mesh.quadratic import compact, quadratic_mesh, sort_along_axis
from pagd.mesh.topology import boundary_faces, row_numbers
from pagd.mesh.types import FloatArray, IntArray, Mesh

__all__ = ["read_msh", "write_msh"]

#: gmsh's numbers of the element types we know, and their node counts.
_TRI3, _TET4, _TRI6, _TET10 = 2, 4, 9, 11
_SOLID, _HEXAHEDRA, _WEDGES = "solid", "hexahedra", "wedges"
_NODES = {_TRI3: 3, _TET4: 4, _TRI6: 6, _TET10: 10}


def write_msh(mesh: Mesh, path: Path, binary: bool = True) -> None:
    """Write ``mesh`` to ``path`` (….msh), every surface a physical group of its name.

    All tetrahedra are in the group ``solid``; those that make up blocks, six or three on end, in
    the groups ``hexahedra`` and ``wedges`` too.
    """
    numbers = np.arange(1, len(mesh.points) + 1)
    with replaced_file(path) as temporary, gmsh_session({"Mesh.Binary": binary}) as gmsh:
        model = gmsh.model
        parts = _parts(mesh)
        for tag, tets in enumerate(parts.values(), start=1):
            model.addDiscreteEntity(3, tag)
            if tag == 1:
                model.mesh.addNodes(3, 1, numbers, mesh.points.ravel())
            model.mesh.addElementsByType(tag, _TET10, [], (tets + 1).ravel())
        model.addPhysicalGroup(3, list(range(1, len(parts) + 1)), 1, _SOLID)
        for tag, name in enumerate(parts, start=1):
            if name != _SOLID:
                model.addPhysicalGroup(3, [tag], tag + 1, name)
        for tag, (name, faces) in enumerate(mesh.surfaces.items(), start=1):
            model.addDiscreteEntity(2, tag)
            model.mesh.addElementsByType(tag, _TRI6, [], (faces + 1).ravel())
            model.addPhysicalGroup(2, [tag], tag, name)
        gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
        gmsh.write(str(temporary))


def _parts(mesh: Mesh) -> dict[str, IntArray]:
    """The tetrahedra by what they make up; all of them as the solid where they are no blocks."""
    behind = 6 * mesh.hexahedra
    parts = {_HEXAHEDRA: mesh.tets[:behind], _WEDGES: mesh.tets[behind:]}
    found = {name: tets for name, tets in parts.items() if len(tets)}
    return found if mesh.hexahedra or mesh.wedges else {_SOLID: mesh.tets}


def read_msh(path: Path) -> Mesh:
    """Read the mesh of an actuator, in mm, with physical surfaces ``fixed``, ``cavity``, ….

    Linear tetrahedra become quadratic, boundary faces without a name become ``outer``, nodes
    that belong to no tetrahedron are dropped, and faces are turned to point out of the solid.

    Raises
    ------
    InputError
        If the file cannot be read or :func:`pagd.mesh.checks.check_actuator` objects.
    """
    try:
        return _actuator(_load(path))
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


@dataclass(frozen=True, eq=False, slots=True)
class _RawMesh:
    """What the file holds: tets (m, 4 or 10), faces (k, 3 or 6) by physical name, blocks."""

    points: FloatArray
    tets: IntArray
    surfaces: dict[str, IntArray]
    hexahedra: int
    wedges: int


def _load(path: Path) -> _RawMesh:
    if not path.is_file():
        raise InputError("there is no such mesh file.")
    with gmsh_session() as gmsh:
        try:
            gmsh.open(str(path))
        except Exception as error:  # all that gmsh ever raises
            raise InputError(f"gmsh cannot read this as a mesh ({error}).") from error
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        tet_type = _tet_type(gmsh)
        order = np.argsort(tags)
        sorted_tags = tags[order]

        def numbers(nodes: Any, width: int) -> IntArray:
            found = np.searchsorted(sorted_tags, nodes)
            return np.asarray(found, dtype=np.int64).reshape(-1, width)

        blocks = _blocks(gmsh, tet_type)
        nodes = (
            np.concatenate(list(blocks.values()))
            if any(len(found) for found in blocks.values())
            else gmsh.model.mesh.getElementsByType(tet_type)[1]
        )
        face_type = _TRI3 if tet_type == _TET4 else _TRI6
        faces = _named_faces(gmsh, face_type)
        return _RawMesh(
            points=np.asarray(coordinates, dtype=np.float64).reshape(-1, 3)[order],
            tets=numbers(nodes, _NODES[tet_type]),
            surfaces={name: numbers(found, _NODES[face_type]) for name, found in faces.items()},
            hexahedra=len(blocks[_HEXAHEDRA]) // (6 * _NODES[tet_type]),
            wedges=len(blocks[_WEDGES]) // (3 * _NODES[tet_type]),
        )


def _tet_type(gmsh: Any) -> int:
    """Return the one type of volume element in the file: linear or quadratic tetrahedra."""
    types = [int(number) for number in gmsh.model.mesh.getElementTypes(3)]
    if types not in ([_TET4], [_TET10]):
        names = [gmsh.model.mesh.getElementProperties(number)[0] for number in types]
        raise InputError(
            "the solid must be meshed by tetrahedra of one kind, with 4 or with 10 nodes; found: "
            f"{', '.join(names) or 'no volume elements'}."
        )
    return types[0]


def _blocks(gmsh: Any, tet_type: int) -> dict[str, Any]:
    """Return the nodes of the tetrahedra that make up hexahedra and wedges; none in most files."""
    found: dict[str, Any] = {_HEXAHEDRA: np.zeros(0), _WEDGES: np.zeros(0)}
    for _, group in gmsh.model.getPhysicalGroups(3):
        name = gmsh.model.getPhysicalName(3, group)
        if name in found and tet_type == _TET10:
            entities = gmsh.model.getEntitiesForPhysicalGroup(3, group)
            nodes = [gmsh.model.mesh.getElementsByType(tet_type, int(e))[1] for e in entities]
            found[name] = np.concatenate(nodes)
    return found


def _named_faces(gmsh: Any, face_type: int) -> dict[str, Any]:
    """Return the nodes of the faces in each named physical surface."""
    found: dict[str, Any] = {}
    for _, group in gmsh.model.getPhysicalGroups(2):
        name = gmsh.model.getPhysicalName(2, group)
        entities = gmsh.model.getEntitiesForPhysicalGroup(2, group)
        nodes = [gmsh.model.mesh.getElementsByType(face_type, int(e))[1] for e in entities]
        found[name or f"number {group}"] = np.concatenate(nodes)
    return found


def _actuator(raw: _RawMesh) -> Mesh:
    """Return the checked, quadratic mesh with all of its boundary named."""
    require_names(raw.surfaces)
    unknown = sorted(set(raw.surfaces) - set(SURFACES))
    if unknown:
        raise InputError(
            f"unknown physical surface{'s' if len(unknown) > 1 else ''} {', '.join(unknown)}; "
            f"known: {', '.join(SURFACES)}."
        )
    points, tets, surfaces = compact(raw.points, raw.tets, raw.surfaces)
    check_volumes(points, tets)
    named = {name: _oriented(points, tets, name, faces) for name, faces in surfaces.items()}
    named["outer"] = np.vstack((named.get("outer", _none(tets)), _unnamed(points, tets, named)))
    if len(named["outer"]) == 0:
        del named["outer"]
    if tets.shape[1] == 4:
        mesh = quadratic_mesh(points, tets, named)
    else:
        mesh = sort_along_axis(
            Mesh(
                points=points,
                tets=tets,
                surfaces=named,
                hexahedra=raw.hexahedra,
                wedges=raw.wedges,
            )
        )
    check_actuator(mesh)
    return mesh


def _oriented(points: FloatArray, tets: IntArray, name: str, faces: IntArray) -> IntArray:
    solid, strangers = as_solid_faces(points, tets, faces)
    if len(strangers):
        raise InputError(
            f"{len(strangers)} of the {len(faces)} triangles of surface '{name}' are not faces "
            "of the tetrahedra."
        )
    return solid


def _none(tets: IntArray) -> IntArray:
    return np.empty((0, 3 if tets.shape[1] == 4 else 6), dtype=np.int64)


def _unnamed(points: FloatArray, tets: IntArray, named: dict[str, IntArray]) -> IntArray:
    """Return the boundary faces (k, 3 or 6) that no surface in ``named`` holds."""
    boundary = boundary_faces(tets)
    keys = [faces[:, :3] for faces in named.values()]
    numbers = row_numbers(np.sort(np.vstack((boundary, *keys)), axis=1))
    missing = ~np.isin(numbers[: len(boundary)], numbers[len(boundary) :])
    return as_solid_faces(points, tets, boundary[missing])[0]
