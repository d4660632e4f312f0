"""The actuator as a finite-element model."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.settings import ELEMENTS, Actuation
from pagd.errors import InputError
from pagd.fem.assembly import Assembly
from pagd.fem.bending import bending_terms
from pagd.fem.contact import ContactLaw, FaceContact
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.gravity import Gravity
from pagd.fem.membrane import Membrane
from pagd.fem.solid import ElementPressureSolid, TaylorHoodSolid
from pagd.fem.term import EnergyTerm
from pagd.materials import Elastomer, Sheet
from pagd.mesh.blocks import block_faces, hexahedra, wedges
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# Share of a face's normal along the actuator from which on the face is a wall. Walls may be slanted
# by 60° (limits.theta_deg in the schema of the configuration), which leaves them cos 60° = 0.5; the
# sides, the tops and the base have none.
_LOOKS_ALONG = 0.4


class Body:
    """The terms of the potential, and the unknowns that are held.

    Parameters
    ----------
    mesh
        Quadratic tetrahedra with the surfaces ``fixed`` and ``cavity``; ``outer``, ``paper`` and
        ``symmetry`` where there are such.
    material, paper
        The elastomer, and the sheet at the surface ``paper``.
    actuation
        Element, contact and gravity.
    law
        How contact is enforced; the default of :class:`ContactLaw` unless given.

    Attributes
    ----------
    solids
        The elastomer, by the kinds of its elements.
    terms, size
        The energy terms and the number of unknowns, displacements (3 a node) first.
    fixed
        Which unknowns (size,) the clamp and the plane of symmetry hold.
    element
        The element of the elastomer, one of :data:`pagd.actuation.ELEMENTS` but ``auto``.
    copies
        2 for a half model, 1 for a whole one.
    contact
        Contact of facing walls, where there are any and it is wanted.
    initial_gap
        Smallest gap (mm) between facing walls of the undeformed body; infinite without contact.

    Raises
    ------
    InputError
        Where a surface is missing, the element unknown, the paper not flat, or gravity would act
        across a plane of symmetry.
    """

    def __init__(
        self,
        mesh: Mesh,
        material: Elastomer,
        paper: Sheet,
        actuation: Actuation | None = None,
        law: ContactLaw | None = None,
    ) -> None:
        wanted = actuation or Actuation()
        self.mesh, self.material = mesh, material
        self.nodes = len(mesh.points)
        self.copies = 2 if "symmetry" in mesh.surfaces else 1
        self.element = element_of(mesh, wanted.element)
        self.solids = solids_of(mesh, material, self.element)
        self.size = 3 * self.nodes
        self.size += sum(s.pressures for s in self.solids if isinstance(s, TaylorHoodSolid))
        self.pressure = _pressure(mesh, self.element)
        self.gravity = _gravity(mesh, material, wanted.gravity_m_s2)
        contact = _contact(mesh, law) if wanted.contact else None
        self.initial_gap = contact.gap_at_rest() if contact else np.inf
        self.contact = contact if np.isfinite(self.initial_gap) else None
        terms: list[EnergyTerm] = [*self.solids, self.pressure, *_paper_terms(mesh, paper)]
        terms += [term for term in (self.gravity, self.contact) if term is not None]
        self.terms = tuple(terms)
        self.fixed = self._fixed(mesh)

    def _fixed(self, mesh: Mesh) -> BoolArray:
        fixed = np.zeros(self.size, dtype=np.bool_)
        fixed[(3 * mesh.nodes_of("fixed")[:, None] + np.arange(3)).ravel()] = True
        if "symmetry" in mesh.surfaces:
            fixed[3 * mesh.nodes_of("symmetry") + 1] = True
        return fixed

    def assembly(self) -> Assembly:
        """The terms as one system, nothing but the clamp and the symmetry held."""
        return Assembly(self.terms, self.size, self.fixed)

    def displacement(self, unknowns: FloatArray) -> FloatArray:
        """Displacements (n, 3) in mm."""
        return np.asarray(unknowns[: 3 * self.nodes].reshape(-1, 3).copy())

    def volume(self, unknowns: FloatArray) -> float:
        """Cavity volume of the whole actuator, in mm³."""
        return self.copies * self.pressure.volume(unknowns)

    @property
    def solid_volume(self) -> float:
        """Volume of elastomer of the whole actuator, in mm³."""
        return self.copies * float(sum(solid.weights.sum() for solid in self.solids))


def facing_walls(mesh: Mesh) -> tuple[IntArray, IntArray]:
    """Outer faces (k, 6) that look along the actuator, and those (m, 6) that look back."""
    faces = mesh.surfaces.get("outer", np.zeros((0, 6), np.int64))
    along = normals_of(mesh.points, faces)[:, 0]
    return faces[along > _LOOKS_ALONG], faces[along < -_LOOKS_ALONG]


def normals_of(points: FloatArray, faces: IntArray) -> FloatArray:
    """Unit normals (F, 3) of the flat corner triangles of faces, out of the solid."""
    corners = points[faces[:, :3]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


def element_of(mesh: Mesh, wanted: str) -> str:
    """The element that is wanted, or the best that the mesh is made for."""
    if wanted not in ELEMENTS:
        raise InputError(f"element is {wanted!r}, but must be one of {', '.join(ELEMENTS)}")
    in_blocks = mesh.hexahedra + mesh.wedges > 0
    if wanted == "auto":
        return "hexahedron" if in_blocks else "taylor_hood"
    if wanted == "hexahedron" and not in_blocks:
        raise InputError(
            "element is 'hexahedron', but the mesh has none: it must be made by the mesher "
            "'structured'."
        )
    return wanted


def solids_of(
    mesh: Mesh, material: Elastomer, element: str
) -> tuple[TaylorHoodSolid | ElementPressureSolid, ...]:
    """The elastomer, by the kinds of its elements."""
    if element == "taylor_hood":
        return (TaylorHoodSolid(mesh.points, mesh.tets, material, 3 * len(mesh.points)),)
    cells = (hexahedra(mesh), wedges(mesh)) if element == "hexahedron" else (mesh.tets,)
    return tuple(
        ElementPressureSolid(mesh.points, nodes, material) for nodes in cells if len(nodes)
    )


def _pressure(mesh: Mesh, element: str) -> FollowerPressure:
    """Pressure on the faces that the elements have in the cavity."""
    if element != "hexahedron":
        mesh.nodes_of("cavity")  # says which surfaces there are where this is missing
        return FollowerPressure(mesh.points, mesh.surfaces["cavity"])
    quadrilaterals, triangles = block_faces(mesh, "cavity")
    return FollowerPressure(mesh.points, triangles, quadrilaterals=quadrilaterals)


def _paper_terms(mesh: Mesh, paper: Sheet) -> list[EnergyTerm]:
    """Membrane and bending of the paper; nothing where the mesh has no such surface."""
    if "paper" not in mesh.surfaces:
        return []
    faces = mesh.surfaces["paper"]
    symmetry = mesh.nodes_of("symmetry") if "symmetry" in mesh.surfaces else None
    bending = bending_terms(
        mesh.points, faces, paper, clamped=mesh.nodes_of("fixed"), symmetry=symmetry
    )
    return [Membrane(mesh.points, faces, paper), *bending]


def _gravity(
    mesh: Mesh, material: Elastomer, acceleration: tuple[float, float, float]
) -> Gravity | None:
    if not any(acceleration):
        return None
    if "symmetry" in mesh.surfaces and acceleration[1]:
        raise InputError(
            f"gravity_m_s2 = {list(acceleration)}: its second number must be 0 where half of a "
            "symmetric actuator is solved (mesh.half_model = true)."
        )
    return Gravity(mesh.points, mesh.tets, material.density_kg_m3, np.array(acceleration))


def _contact(mesh: Mesh, law: ContactLaw | None) -> FaceContact | None:
    """Contact of facing walls, where there are any."""
    slaves, masters = facing_walls(mesh)
    if len(slaves) == 0 or len(masters) == 0:
        return None
    return FaceContact(mesh.points, slaves, masters, law)
