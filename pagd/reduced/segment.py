"""A part of a row between two cuts as a finite-element model: its energy, and who follows whom.

What lies beyond a cut is seen through nodes that belong to no element of the part: those of the
neighbour's wall, which the last wall may touch, and of the neighbour's first triangles of paper,
whose hinge with the last ones is stiff. The air's cross section closes the channel at a cut.

A cut at the right is tied by a screw motion, which is unknown, to nodes whose shape is given or
that of the part's own left cut. How its cap is spanned does not matter then: one cap is the image
of another, and their volumes differ by what the rim alone decides. Where the energy is stationary
in the motion, the cut carries no force and no moment beyond the air's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.body import element_of, facing_walls, solids_of
from pagd.actuation.settings import Actuation
from pagd.errors import InputError
from pagd.fem.assembly import Assembly
from pagd.fem.bending import bending_terms
from pagd.fem.contact import ContactLaw, FaceContact
from pagd.fem.follower_pressure import FollowerPressure
from pagd.fem.gravity import Gravity
from pagd.fem.membrane import Membrane
from pagd.fem.screw import ScrewTie
from pagd.fem.term import EnergyTerm
from pagd.fem.tied_assembly import TiedAssembly
from pagd.materials import Elastomer, Sheet
from pagd.mesh.blocks import block_faces
from pagd.mesh.types import Mesh

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

__all__ = ["NO_FACES", "Beyond", "Segment", "paper_along"]

NO_FACES: IntArray = np.zeros((0, 6), np.int64)


@dataclass(frozen=True, eq=False, slots=True)
class Beyond:
    """What is seen beyond a cut, in the numbers of the segment's rows.

    walls: (k, 6) faces of the neighbour's wall that looks here.
    column: (m, 6) faces of the neighbour's paper along the cut.
    """

    walls: IntArray
    column: IntArray


def paper_along(mesh: Mesh, cut: IntArray) -> IntArray:
    """Faces (k, 6) of the paper with an edge on a cut."""
    faces = mesh.surfaces.get("paper", NO_FACES)
    return np.asarray(faces[np.isin(faces[:, :3], cut).sum(axis=1) == 2])


class Segment:
    """The terms of the potential of a part of a row, what is held and what is tied.

    To be followed as a :class:`pagd.actuation.Body` is.

    Parameters
    ----------
    mesh
        The part.
    points
        Coordinates (n, 3) in mm of all rows of three unknowns: the mesh's nodes first.
    caps
        Triangles (c, 6) that close the channel at the cuts.
    left, right
        What is seen beyond the cuts, if anything.
    fixed
        Which rows' unknowns (n, 3) are held.
    tie
        What ties the right cut, if anything.
    material, paper
        The elastomer, and the sheet at the surface ``paper``.
    actuation
        Element and contact; there is no gravity, which no two chambers would feel alike.
    law
        How contact is enforced.

    Raises
    ------
    InputError
        Where gravity is wanted, or an element whose pressures are continuous.
    """

    gravity: Gravity | None = None

    def __init__(
        self,
        mesh: Mesh,
        points: FloatArray,
        caps: IntArray,
        left: Beyond | None,
        right: Beyond | None,
        fixed: BoolArray,
        tie: ScrewTie | None,
        material: Elastomer,
        paper: Sheet,
        actuation: Actuation | None = None,
        law: ContactLaw | None = None,
    ) -> None:
        wanted = actuation or Actuation()
        if any(wanted.gravity_m_s2):
            raise InputError("Under gravity the cells of a row are not alike: gravity must be 0.")
        self.mesh, self.points, self.material = mesh, points, material
        self.nodes, self.size = len(points), 3 * len(points)
        self.tie, self.fixed = tie, fixed.ravel()
        self.copies = 2 if "symmetry" in mesh.surfaces else 1
        self.element = element_of(mesh, wanted.element)
        if self.element == "taylor_hood":
            raise InputError(
                "element is 'taylor_hood', but parts of a row take elements with pressures of "
                "their own: auto, hexahedron or element_pressure."
            )
        self.solids = solids_of(mesh, material, self.element)
        self.pressure = self._pressure(caps)
        sides = [side for side in (left, right) if side is not None]
        self.contact = self._contact(left, right, law) if wanted.contact else None
        self.initial_gap = self.contact.gap_at_rest() if self.contact else np.inf
        terms: list[EnergyTerm] = [*self.solids, self.pressure, *self._paper_terms(sides, paper)]
        self.terms = tuple([*terms, self.contact] if self.contact else terms)

    def _pressure(self, caps: IntArray) -> FollowerPressure:
        if self.element == "hexahedron":
            quadrilaterals, triangles = block_faces(self.mesh, "cavity")
            faces = np.vstack([triangles, caps])
            return FollowerPressure(self.points, faces, quadrilaterals=quadrilaterals)
        return FollowerPressure(self.points, np.vstack([self.mesh.surfaces["cavity"], caps]))

    def _paper_terms(self, sides: Sequence[Beyond], paper: Sheet) -> list[EnergyTerm]:
        mesh = self.mesh
        if "paper" not in mesh.surfaces:
            return []
        faces, named = mesh.surfaces["paper"], mesh.surfaces
        bending = bending_terms(
            self.points,
            faces,
            paper,
            clamped=mesh.nodes_of("fixed") if "fixed" in named else None,
            symmetry=mesh.nodes_of("symmetry") if "symmetry" in named else None,
            beyond=np.vstack([NO_FACES, *(side.column for side in sides)]),
            coupled=True,
        )
        return [Membrane(self.points, faces, paper), *bending]

    def _contact(
        self, left: Beyond | None, right: Beyond | None, law: ContactLaw | None
    ) -> FaceContact | None:
        """Contact of walls in the part with each other, and with those beyond the cuts."""
        forward, back = facing_walls(self.mesh)
        slaves = np.vstack([forward, left.walls if left else NO_FACES])
        masters = np.vstack([back, right.walls if right else NO_FACES])
        if len(slaves) == 0 or len(masters) == 0:
            return None
        contact = FaceContact(self.points, slaves, masters, law)
        return contact if np.isfinite(contact.gap_at_rest()) else None

    def assembly(self) -> Assembly:
        """The terms as one system."""
        if self.tie is None:
            return Assembly(self.terms, self.size, self.fixed)
        return TiedAssembly(self.terms, self.size, self.fixed, self.tie)

    def displacement(self, unknowns: FloatArray) -> FloatArray:
        """The rows (n, 3): displacements in mm, and where there is a motion last its θ and d."""
        return np.asarray(unknowns.reshape(-1, 3).copy())

    def volume(self, unknowns: FloatArray) -> float:
        """Volume of the part's air, in mm³."""
        return self.copies * self.pressure.volume(unknowns)

    def stored_energy(self, unknowns: FloatArray, load: float) -> float:
        """All that the work of the pressure has become, in mJ."""
        terms = (term for term in self.terms if term is not self.pressure)
        return self.copies * sum(term.energy(unknowns, load) for term in terms)

    @property
    def solid_volume(self) -> float:
        """Volume of the part's elastomer, in mm³."""
        return self.copies * float(sum(solid.weights.sum() for solid in self.solids))
