"""Contact in rows: slanted and mixed ones, fTetWild's meshes, half models."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from actuators import (
    default_elastomer,
    default_paper,
    mesh_of_design,
    mirrored,
    trajectory_of_design,
    whole_of,
)
from cases_contact import NARROW, SETTINGS
from figure import Figure
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from pagd.actuation import ActuationResult, blocked_force, free_actuation
from pagd.actuation.body import normals_of
from pagd.design import Design
from pagd.fem.contact import ContactLaw, FaceContact
from pagd.mesh.ftetwild_mesher import FTetWildMesher
from pagd.mesh.types import FloatArray, IntArray, Mesh
from pagd.metrics import energy_balance, first_contact_pressure, work_of_pressure

#: All chambers slanted; two slanted ones before two straight ones, with a gap of each kind.
SLANTED = replace(NARROW, theta=30.0, alpha=1.0)
MIXED = replace(SLANTED, N=4, alpha=0.5)
SIZE = 5.0  # mm
#: Of meshes that fTetWild draws, each time another: of four slanted rows of 5 mm, two elements up a
#: wall, one was penetrated by 2.1 % of the gap.
FINER = 4.0  # mm

MIRROR = "symmetry: slanted the other way, the mirror image"
GMSH = "the same row on a mesh of gmsh, 4 mm too"
HALVES = "symmetry: the whole made of two halves"


@dataclass(frozen=True, eq=False, slots=True, kw_only=True)
class Row:
    """A row of chambers on a mesh, and its way to 50 kPa."""

    design: Design
    mesh: Mesh
    result: ActuationResult

    @property
    def displacement(self) -> FloatArray:
        """(n, 3) at the last state, in mm."""
        return self.result.states[-1].displacement

    @property
    def angles(self) -> tuple[float, float]:
        """Bending and twist of the tip at the last state, in degrees."""
        path = trajectory_of_design(
            self.design,
            self.mesh,
            np.array([0.0, self.result.states[-1].pressure_kPa]),
            np.array([0 * self.displacement, self.displacement]),
        )
        return float(path.bending_deg[-1, -1]), float(path.twist_deg[-1, -1])

    @property
    def first_contact_kPa(self) -> float:
        """Pressure at which walls first push each other."""
        history = self.result.history
        found = first_contact_pressure(
            history["pressure_kPa"], history["smallest_gap_mm"], ContactLaw().width
        )
        assert found is not None, "no walls touch"
        return found

    @property
    def penetration(self) -> float:
        """Deepest penetration on the way by the initial gap, from whichever side it is deeper."""
        figures = self.result.figures
        slaves, masters = _facing(self.mesh)
        gaps = [
            _smallest_gap(self.mesh, masters, slaves, state.displacement)
            for state in self.result.states
        ]
        deepest = max(float(figures["deepest_penetration_mm"]), -min(gaps))
        return deepest / float(figures["initial_gap_mm"])

    @property
    def pressed_walls(self) -> int:
        """Walls, of those that look along the row, that press another one at the last state."""
        slaves, masters = _facing(self.mesh)
        walls, moved = _walls(slaves), self.displacement
        gaps = [_smallest_gap(self.mesh, wall, masters, moved) for wall in walls]
        return sum(gap < ContactLaw().width for gap in gaps)

    @property
    def imbalance(self) -> float:
        """|∫ p dV − U| / U at the last state."""
        history = self.result.history
        work = work_of_pressure(history["pressure_kPa"], history["cavity_volume_mm3"])
        return float(energy_balance(work, history["stored_energy_mJ"])[-1])


def _facing(mesh: Mesh) -> tuple[IntArray, IntArray]:
    """Outer faces that look along the actuator, and those that look back."""
    faces = mesh.surfaces["outer"]
    along = normals_of(mesh.points, faces)[:, 0]
    return faces[along > 0.5], faces[along < -0.5]


def _walls(faces: IntArray) -> Iterator[IntArray]:
    """Faces by the wall that they belong to: those of a wall are joined by their nodes."""
    rows = np.repeat(np.arange(len(faces)), faces.shape[1])
    nodes = csr_array((np.ones(faces.size), (rows, faces.ravel())))
    count, wall = connected_components(nodes @ nodes.T, directed=False)
    return (faces[wall == number] for number in range(count))


def _smallest_gap(mesh: Mesh, slaves: IntArray, masters: IntArray, moved: FloatArray) -> float:
    """Smallest gap (mm) of points of the slaves from the masters; infinite where none is near."""
    contact = FaceContact(mesh.points, slaves, masters)
    contact.update(moved.ravel())
    return contact.smallest_gap


def _free(design: Design, mesh: Mesh) -> Row:
    result = free_actuation(mesh, default_elastomer(), default_paper(), SETTINGS)
    assert result.reason is None, result.reason
    return Row(design=design, mesh=mesh, result=result)


def _held_force(mesh: Mesh) -> float:
    """Force in N at 50 kPa on the support of the tip's edge."""
    result = blocked_force(mesh, default_elastomer(), default_paper(), SETTINGS)
    assert result.reason is None, result.reason
    return float(result.figures["blocked_force_N"])


@lru_cache
def _by_gmsh(design: Design, size: float, half: bool = False) -> Row:
    return _free(design, mesh_of_design(design, size, half))


def _by_ftetwild(design: Design, size: float, half: bool = False) -> Row:
    return _free(design, mesh_of_design(design, size, half, FTetWildMesher()))


def slanted_row() -> list[Figure]:
    """Three chambers slanted by 30°, 1 mm apart along the row, to 50 kPa; and their mirror image.

    Slanted walls press and slide on each other while the row twists. Penetration is looked for at
    points of either wall, though the law acts at those of one of them only; it is that of elements
    of 5 mm, and less on finer ones. The mirror image is that of the mesh: one drawn anew for −30°
    would be another one.
    """
    row = _by_gmsh(SLANTED, SIZE)
    image = _free(SLANTED, mirrored(row.mesh))
    return [*_pressed("slanted row", row), *_mirror("slanted row, mirror image", row, image)]


def mixed_row() -> list[Figure]:
    """Two chambers slanted by 30° before two straight ones, at least 1 mm apart, to 50 kPa.

    The gap between the two kinds is a wedge, which opens as the row bends: its walls do not touch,
    those of the gaps on either side of it do.
    """
    return _pressed("mixed row", _by_gmsh(MIXED, SIZE), wedges=1)


def straight_row_by_ftetwild() -> list[Figure]:
    """The half of the narrow row on a mesh of fTetWild, to 50 kPa, beside one of gmsh.

    Walls of fTetWild are flat to within its envelope of 0.05 mm only, and it draws another mesh
    each time: angles on two meshes of 4 mm differ by some percent, first contact, which is put
    between the steps of the pressure, by some ten.
    """
    name = "narrow row, half, fTetWild"
    row, other = _by_ftetwild(NARROW, FINER, half=True), _by_gmsh(NARROW, FINER, half=True)
    return [*_pressed(name, row), *_beside_gmsh(name, row, other)]


def slanted_row_by_ftetwild() -> list[Figure]:
    """The same for the slanted row."""
    name = "slanted row, fTetWild"
    row, other = _by_ftetwild(SLANTED, FINER), _by_gmsh(SLANTED, FINER)
    return [*_pressed(name, row), *_beside_gmsh(name, row, other)]


def half_row() -> list[Figure]:
    """The half of the narrow row, and the whole made of it and its mirror image, to 50 kPa.

    Walls press each other right at the plane of symmetry, where a point of one may lie above a face
    that only the whole has. Angle, first contact and blocked force are one solution's.
    """
    half = _by_gmsh(NARROW, SIZE, half=True)
    whole = _free(NARROW, whole_of(half.mesh))
    nodes = len(half.mesh.points)
    lowest, ours = (float(row.displacement[:nodes, 2].min()) for row in (whole, half))
    found = (
        ("lowest displacement", "mm", lowest, ours),
        ("bending", "°", whole.angles[0], half.angles[0]),
        ("first contact", "kPa", whole.first_contact_kPa, half.first_contact_kPa),
        ("blocked force", "N", _held_force(whole.mesh), _held_force(half.mesh)),
    )
    return [*_pressed("narrow row, half", half), *_same("narrow row, half", HALVES, 1e-5, found)]


def _pressed(name: str, row: Row, wedges: int = 0) -> list[Figure]:
    """That walls touch, by how much too far, and that no work is lost; wedges stay open."""
    return [
        Figure(
            name=f"{name}: walls that press the next one at 50 kPa",
            source="count: all gaps between parallel walls",
            reference=row.design.N - 1 - wedges,
            value=row.pressed_walls,
            tolerance=0.0,
        ),
        Figure(
            name=f"{name}: first contact / 50 kPa",
            source="rule: walls touch long before",
            reference=0.0,
            value=row.first_contact_kPa / SETTINGS.maximum_pressure_kPa,
            tolerance=0.5,
            scale=1.0,
        ),
        Figure(
            name=f"{name}: deepest penetration / initial gap, points of either wall",
            source="rule: no deeper than 2 % of the gap",
            reference=0.0,
            value=row.penetration,
            tolerance=0.02,
            scale=1.0,
        ),
        Figure(
            name=f"{name}: energy balance",
            source="identity: a conservative load stores its work",
            reference=0.0,
            value=row.imbalance,
            # By trapezoids over the steps, which are few, and others on another mesh.
            tolerance=0.01,
            scale=1.0,
        ),
    ]


def _mirror(name: str, row: Row, image: Row) -> list[Figure]:
    (bending, twist), (other_bending, other_twist) = row.angles, image.angles
    found = (
        ("bending", "°", bending, other_bending),
        ("twist", "°", -twist, other_twist),
        ("first contact", "kPa", row.first_contact_kPa, image.first_contact_kPa),
    )
    return _same(name, MIRROR, 1e-6, found)


def _beside_gmsh(name: str, row: Row, other: Row) -> list[Figure]:
    bending = ("bending", "°", other.angles[0], row.angles[0])
    # First contact is read off steps of 1 to 3 kPa: seven meshes gave -18 to 12 %.
    contact = ("first contact", "kPa", other.first_contact_kPa, row.first_contact_kPa)
    return [*_same(name, GMSH, 0.06, [bending]), *_same(name, GMSH, 0.3, [contact])]


def _same(
    name: str, source: str, tolerance: float, found: Iterable[tuple[str, str, float, float]]
) -> list[Figure]:
    """Rows of what was found: what, unit, reference, value."""
    return [
        Figure(
            name=f"{name}: {what}",
            source=source,
            reference=reference,
            value=value,
            tolerance=tolerance,
            unit=unit,
        )
        for what, unit, reference, value in found
    ]
