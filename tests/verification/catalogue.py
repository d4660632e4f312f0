"""All cases of the verification, in the order of the page."""

from __future__ import annotations

from cases_actuators import balance_of_energy, element_table, other_library, resultants, symmetries
from cases_blocked import balance_of_forces, plate_and_edge, small_pressure
from cases_blocks import convergence_of_blocks, no_locking
from cases_calculix import (
    bending_on_finer_meshes,
    laws_in_a_deck,
    same_element,
    twisting_on_finer_meshes,
)
from cases_cells import closed_tubes, rows_of_parts
from cases_composite import bent_strip, twisted_strip
from cases_contact import narrow_row, two_blocks
from cases_contact_rows import (
    half_row,
    mixed_row,
    slanted_row,
    slanted_row_by_ftetwild,
    straight_row_by_ftetwild,
)
from cases_hexahedra import bending_hexahedra, twisting_hexahedra
from cases_inflation import moved_walls, walls_under_pressure
from cases_material import balloon, homogeneous_states
from cases_meshes import bending_meshes, mixed_meshes, twisting_meshes
from cases_nested import nested_meshes
from cases_paper import circle, elastica
from cases_solid import block_bending, convergence, cook_membrane, patch_test, rigid_rotation
from cases_stability import heavy_column
from cases_supports import block_on_plane, own_weight
from cases_tangents import tangents
from figure import Case, Group

CASES: tuple[Case, ...] = (
    Case(rows=patch_test, group=Group.solids),
    Case(rows=rigid_rotation, group=Group.solids),
    Case(rows=tangents, group=Group.solids),
    Case(rows=homogeneous_states, group=Group.solids),
    Case(rows=moved_walls, group=Group.solids),
    Case(rows=walls_under_pressure, group=Group.solids),
    Case(rows=balloon, group=Group.solids),
    Case(rows=block_bending, group=Group.solids),
    Case(rows=no_locking, group=Group.solids),
    Case(rows=cook_membrane, group=Group.solids),
    Case(rows=convergence, group=Group.rates),
    Case(rows=convergence_of_blocks, group=Group.rates),
    Case(rows=circle, group=Group.paper),
    Case(rows=elastica, group=Group.paper),
    Case(rows=bent_strip, group=Group.paper),
    Case(rows=twisted_strip, group=Group.paper),
    Case(rows=resultants, group=Group.pressure),
    Case(rows=balance_of_energy, group=Group.pressure),
    Case(rows=two_blocks, group=Group.contact),
    Case(rows=narrow_row, group=Group.contact),
    Case(rows=half_row, group=Group.contact),
    Case(rows=slanted_row, group=Group.contact),
    Case(rows=mixed_row, group=Group.contact),
    Case(rows=straight_row_by_ftetwild, group=Group.contact),
    Case(rows=slanted_row_by_ftetwild, group=Group.contact, costly=True),
    Case(rows=block_on_plane, group=Group.supports),
    Case(rows=own_weight, group=Group.supports),
    Case(rows=heavy_column, group=Group.supports, program="MKL"),
    Case(rows=small_pressure, group=Group.supports),
    Case(rows=balance_of_forces, group=Group.supports),
    Case(rows=plate_and_edge, group=Group.supports),
    Case(rows=symmetries, group=Group.symmetry),
    Case(rows=closed_tubes, group=Group.cells),
    Case(rows=rows_of_parts, group=Group.cells, costly=True),
    Case(rows=other_library, group=Group.programs),
    Case(rows=element_table, group=Group.programs, costly=True),
    Case(rows=laws_in_a_deck, group=Group.programs, program="ccx"),
    Case(rows=same_element, group=Group.programs, program="ccx", costly=True),
    Case(rows=bending_on_finer_meshes, group=Group.programs, program="ccx", costly=True),
    Case(rows=twisting_on_finer_meshes, group=Group.programs, program="ccx", costly=True),
    Case(rows=nested_meshes, group=Group.meshes, costly=True),
    Case(rows=bending_meshes, group=Group.meshes, costly=True),
    Case(rows=twisting_meshes, group=Group.meshes, costly=True),
    Case(rows=mixed_meshes, group=Group.meshes, costly=True),
    Case(rows=bending_hexahedra, group=Group.meshes, costly=True),
    Case(rows=twisting_hexahedra, group=Group.meshes, costly=True),
)


def find(names: list[str]) -> list[Case]:
    """The cases of these names, all of them where there are no names.

    Raises
    ------
    ValueError
        If there is no case of a name.
    """
    known = {case.name: case for case in CASES}
    unknown = [name for name in names if name not in known]
    if unknown:
        raise ValueError(f"{unknown[0]!r} is no case; they are {', '.join(known)}")
    return [case for case in CASES if not names or case.name in names]


def quick(*groups: Group) -> list[Case]:
    """The cases of these groups that are cheap, and whose programs are there."""
    return [case for case in CASES if case.group in groups and not case.costly and case.is_possible]
