"""Input decks: an actuator, its materials and its pressures for CalculiX, or for Abaqus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pagd.deck.laws import hyperelastic
from pagd.deck.numbering import DECK_ORDER, face_numbers
from pagd.errors import InputError
from pagd.files import replaced_file
from pagd.materials import Elastomer, Sheet
from pagd.mesh.types import IntArray, Mesh

__all__ = ["HELD", "SHEET_ELEMENTS", "SOLID_ELEMENTS", "STRESS_UNITS", "write_deck"]

#: Ten-node tetrahedra: displacements only; Abaqus also has hybrid ones.
SOLID_ELEMENTS = ("C3D10", "C3D10H", "C3D10HS")
#: Six-node triangles: CalculiX's shell, the membrane of both programs, Abaqus' thin shell.
SHEET_ELEMENTS = ("S6", "M3D6", "STRI65")
#: Which components of displacement are held on which surface of an actuator.
HELD: Mapping[str, str] = {"fixed": "xyz", "symmetry": "y"}

#: Unit of stress → how many of them are a MPa, and the unit of force that goes with mm.
STRESS_UNITS: Mapping[str, tuple[float, str]] = {
    "MPa": (1.0, "N"),
    "kPa": (1e3, "mN"),
    "Pa": (1e6, "micronewton"),
}

_KPA = 1e-3  # MPa


def write_deck(
    path: Path,
    mesh: Mesh,
    material: Elastomer,
    paper: Sheet | None,
    pressures_kPa: Sequence[float],
    *,
    solid_element: str = "C3D10",
    sheet_element: str = "S6",
    held: Mapping[str, str] = HELD,
    first_increment: float = 0.25,
    stress_unit: str = "MPa",
    controls: Sequence[str] = (),
) -> None:
    """Write an input deck: quasi-static, finite strain, follower pressure on the cavity.

    Parameters
    ----------
    path
        File to write, mostly ``….inp``.
    mesh
        Quadratic tetrahedra with the surface ``cavity``; faces point out of the solid.
    material
        The elastomer; :func:`pagd.deck.laws.hyperelastic` tells which laws there are.
    paper
        The sheet at the surface ``paper``; None leaves it out, as does a mesh without one.
    pressures_kPa
        Pressures in the cavity, each the end of a step; displacements are printed there.
    solid_element, sheet_element
        One of :data:`SOLID_ELEMENTS` and of :data:`SHEET_ELEMENTS`.
    held
        Surface → components of displacement that are held, as in ``symmetry="y"``; surfaces
        that the mesh lacks are passed over. A shell is clamped where all three are held, and
        does not turn about the line in which it meets a plane of symmetry.
    first_increment
        First increment of a step as a share of it; the following ones are automatic.
    stress_unit
        One of :data:`STRESS_UNITS`; lengths are in mm.
    controls
        Lines to begin every step with, such as a ``*CONTROLS`` card and its numbers.

    Raises
    ------
    InputError
        For a mesh without a cavity or without anything held, no pressures, an unknown element or
        unit, or a law that the programs lack.

    Notes
    -----
    Keywords that the two programs understand differently:

    - Elements. ``C3D10`` locks in both as Poisson's ratio comes near to 1/2; Abaqus has
      ``C3D10H`` for that, CalculiX has nothing. CalculiX' six-node shell ``S6`` is called
      ``STRI65`` in Abaqus; ``M3D6`` is the membrane of both.
    - CalculiX expands shells and membranes to wedges of the sheet's thickness, whose middle
      follows the shared nodes, so that here the tetrahedra and the wedges overlap.
    - CalculiX makes those wedges anew in every step: with paper, the bending example ends after
      the first of steps of 5 kPa, while a single one goes to 50 kPa.
    - A compressibility D of zero is a missing term in Abaqus and a default of its own in
      CalculiX: those that are to be missing are written as large numbers.
    - ``*DLOAD`` and ``*DSLOAD`` act on the deformed faces in both, given ``NLGEOM``.
    - Printed displacements go to ``….dat`` in both.
    - CalculiX 2.20 leaves the stiffness of the follower load out of its tangent, measures what is
      left of the forces with the load of the iteration before, and takes forces under 1e-6 for
      zero. In N it therefore ends its iterations early: the tip of the bending example is 0.7 %
      short at 5 kPa in one increment. ``stress_unit="Pa"`` and tighter ``controls`` mend that, at
      the cost of tens of iterations; smaller increments reduce it.
    """
    _check(mesh, pressures_kPa, held)
    _check_choices(solid_element, sheet_element, stress_unit)
    sheet = paper if "paper" in mesh.surfaces else None
    sections = (
        _heading(material, sheet, stress_unit, (solid_element, sheet_element)),
        _nodes(mesh),
        _solid(mesh, material, solid_element, stress_unit),
        _sheet(mesh, sheet, sheet_element, stress_unit) if sheet else (),
        _cavity(mesh),
        _supports(mesh, held, shell=sheet is not None and sheet_element != "M3D6"),
        *(_step(p, first_increment, stress_unit, controls) for p in pressures_kPa),
    )
    with replaced_file(path) as temporary, temporary.open("w", encoding="ascii") as file:
        file.writelines(f"{line}\n" for section in sections for line in section)


def _check(mesh: Mesh, pressures_kPa: Sequence[float], held: Mapping[str, str]) -> None:
    mesh.nodes_of("cavity")  # says which surfaces there are where this is missing
    if not any(name in mesh.surfaces for name in held):
        raise InputError(f"The mesh has none of the surfaces to hold: {', '.join(held)}.")
    if len(pressures_kPa) == 0 or not np.isfinite(pressures_kPa).all():
        raise InputError(f"pressures are {list(pressures_kPa)}, but must be one or more numbers.")


def _check_choices(solid: str, sheet: str, unit: str) -> None:
    for what, chosen, known in (
        ("solid element", solid, SOLID_ELEMENTS),
        ("sheet element", sheet, SHEET_ELEMENTS),
        ("unit of stress", unit, tuple(STRESS_UNITS)),
    ):
        if chosen not in known:
            raise InputError(f"{what} is {chosen!r}, but must be one of {', '.join(known)}.")


#: Element type that suits CalculiX → what to name in its place in a deck for Abaqus.
_IN_ABAQUS = {"C3D10": "C3D10H", "S6": "STRI65"}


def _heading(
    material: Elastomer, sheet: Sheet | None, unit: str, elements: tuple[str, str]
) -> Iterator[str]:
    materials = " and ".join(_ascii(m.name) for m in (material, sheet) if m)
    yield "*HEADING"
    yield f"Pneumatic actuator of {materials}"
    yield f"** Units: mm, {STRESS_UNITS[unit][1]}, {unit}. Written by pagd."
    used = elements if sheet else elements[:1]
    others = [f"{_IN_ABAQUS[name]} for {name}" for name in used if name in _IN_ABAQUS]
    if others:
        yield f"** Element types for Abaqus would be {' and '.join(others)}."


def _ascii(name: str) -> str:
    return name.encode("ascii", "replace").decode()


def _nodes(mesh: Mesh) -> Iterator[str]:
    yield "*NODE, NSET=NODES"
    for number, (x, y, z) in enumerate(mesh.points.tolist(), start=1):
        yield f"{number}, {x:.12g}, {y:.12g}, {z:.12g}"


def _solid(mesh: Mesh, material: Elastomer, element: str, unit: str) -> Iterator[str]:
    yield f"*ELEMENT, TYPE={element}, ELSET=SOLID"
    yield from _numbered(mesh.tets[:, DECK_ORDER] + 1, first=1)
    yield "*MATERIAL, NAME=ELASTOMER"
    yield from hyperelastic(material, STRESS_UNITS[unit][0])
    yield "*SOLID SECTION, ELSET=SOLID, MATERIAL=ELASTOMER"


def _sheet(mesh: Mesh, sheet: Sheet, element: str, unit: str) -> Iterator[str]:
    section = "MEMBRANE" if element == "M3D6" else "SHELL"
    yield f"*ELEMENT, TYPE={element}, ELSET=PAPER"
    yield from _numbered(mesh.surfaces["paper"] + 1, first=len(mesh.tets) + 1)
    yield "*MATERIAL, NAME=SHEET"
    yield "*ELASTIC"
    modulus = sheet.youngs_modulus * STRESS_UNITS[unit][0]
    yield f"{modulus:.12g}, {sheet.poisson_ratio:.12g}"
    yield f"*{section} SECTION, ELSET=PAPER, MATERIAL=SHEET"
    yield f"{sheet.thickness:.12g}"


def _cavity(mesh: Mesh) -> Iterator[str]:
    yield "*SURFACE, NAME=CAVITY, TYPE=ELEMENT"
    tets, faces = face_numbers(mesh.tets, mesh.surfaces["cavity"])
    for tet, face in zip(tets.tolist(), faces.tolist(), strict=True):
        yield f"{tet + 1}, S{face}"


def _supports(mesh: Mesh, held: Mapping[str, str], *, shell: bool) -> Iterator[str]:
    for name, components in held.items():
        if name not in mesh.surfaces:
            continue
        nodes = mesh.nodes_of(name)
        yield from _node_set(name.upper(), nodes)
        yield "*BOUNDARY"
        for component in components:
            yield f"{name.upper()}, {_degree(component)}"
        if shell:
            yield from _rotations(name.upper(), nodes, mesh, components)


def _rotations(name: str, nodes: IntArray, mesh: Mesh, components: str) -> Iterator[str]:
    """Hold the shell's rotations where its edge is clamped or in a plane of symmetry."""
    shared = np.intersect1d(nodes, mesh.nodes_of("paper"))
    if len(shared) == 0:
        return
    # A plane of symmetry normal to an axis leaves only the rotation about that axis.
    free = components if len(components) == 1 else ""
    yield from _node_set(f"{name}_PAPER", shared)
    yield "*BOUNDARY"
    for component in "xyz":
        if component not in free:
            yield f"{name}_PAPER, {_degree(component) + 3}"


def _degree(component: str) -> int:
    return "xyz".index(component) + 1


def _step(
    pressure_kPa: float, first_increment: float, unit: str, controls: Sequence[str]
) -> Iterator[str]:
    yield f"** {pressure_kPa:g} kPa"
    yield "*STEP, NLGEOM, INC=1000"
    yield from controls
    yield "*STATIC"
    yield f"{first_increment:g}, 1., 1e-4, 1."
    yield "*DSLOAD"
    yield f"CAVITY, P, {pressure_kPa * _KPA * STRESS_UNITS[unit][0]:.12g}"
    # Only the last increment of a step comes so late, or is the last.
    yield "*NODE PRINT, NSET=NODES, FREQUENCY=1000"
    yield "U"
    yield "*NODE FILE, FREQUENCY=1000"
    yield "U"
    yield "*END STEP"


def _node_set(name: str, nodes: IntArray) -> Iterator[str]:
    yield f"*NSET, NSET={name}"
    for start in range(0, len(nodes), 10):
        yield ", ".join(map(str, (nodes[start : start + 10] + 1).tolist()))


def _numbered(rows: NDArray[np.int64], first: int) -> Iterator[str]:
    for number, row in enumerate(rows.tolist(), start=first):
        yield f"{number}, " + ", ".join(map(str, row))
