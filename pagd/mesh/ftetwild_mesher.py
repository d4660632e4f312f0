"""Tetrahedra by fTetWild: slower than gmsh, but it meshes any triangles whatever.

fTetWild (Hu et al. 2020) moves the surface within an envelope of ``epsilon``. Thin walls and
narrow gaps survive if that is small against them. No two runs give the same mesh (its issue 72).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pagd.errors import StageFailure, Status
from pagd.mesh.draws import first_good_mesh
from pagd.mesh.joining import Complex, Patch, join
from pagd.mesh.quadratic import quadratic_mesh
from pagd.mesh.surfaces import SurfacePair
from pagd.mesh.tagging import name_surfaces
from pagd.mesh.topology import boundary_faces, interface_faces
from pagd.mesh.types import FloatArray, IntArray, Mesh, corner_volumes
from pagd.mesh.winding import inside

__all__ = ["FTetWildMesher"]


@dataclass(frozen=True, slots=True)
class FTetWildMesher:
    """Mesher by fTetWild, through pytetwild.

    Parameters
    ----------
    epsilon
        How far (mm) the surface may move. fTetWild wants it relative to the diagonal of the
        bounding box; it is divided by that here, so that a long actuator keeps its walls. A
        tenth of the narrowest gap (0.5 mm) is enough; 0.02 takes 3 to 5 times as long.
    stop_energy
        Quality (conformal AMIPS energy, 3 for a regular tetrahedron) at which it stops.
    wanted_scaled_jacobian, size_factors
        As for gmsh: another draw where putting nodes on the planes has flattened an element.
    """

    epsilon: float = 0.05
    stop_energy: float = 10.0
    wanted_scaled_jacobian: float = 0.01
    size_factors: tuple[float, ...] = (1.0, 0.95, 0.9)

    name = "ftetwild"

    def __call__(self, surfaces: SurfacePair, size: float) -> Mesh:
        """Mesh the solid with elements of about ``size`` (mm); StageFailure if it cannot."""
        complex_ = join(surfaces)
        return first_good_mesh(
            lambda drawn: self._mesh(complex_, drawn),
            (factor * size for factor in self.size_factors),
            self.wanted_scaled_jacobian,
        )

    def _mesh(self, complex_: Complex, size: float) -> Mesh:
        points, tets = self._tetrahedra(complex_, size)
        tets = _solid_part(points, tets, complex_)
        points = _snapped(points, tets, complex_, 2.0 * self.epsilon)
        named = name_surfaces(points, tets, complex_.plane_z, complex_.half, complex_.tolerance)
        return quadratic_mesh(points, tets, named)

    def _tetrahedra(self, complex_: Complex, size: float) -> tuple[FloatArray, IntArray]:
        """Fill the bounding box with tetrahedra (m, 4) that conform to all triangles."""
        from pytetwild.pytetwild import tetrahedralize

        diagonal = float(np.linalg.norm(np.ptp(complex_.points, axis=0)))
        try:
            points, tets = tetrahedralize(
                complex_.points,
                complex_.triangles.astype(np.int32),
                edge_length_abs=size,
                epsilon=self.epsilon / diagonal,
                stop_energy=self.stop_energy,
                # Its own filter takes the paper for a part of the outside.
                disable_filtering=True,
                # More threads would make the mesh depend on the machine.
                num_threads=1,
            )
        except Exception as error:
            raise StageFailure(Status.mesh_failed, f"fTetWild failed: {error}.") from error
        return np.asarray(points, dtype=np.float64), np.asarray(tets, dtype=np.int64)


def _solid_part(points: FloatArray, tets: IntArray, complex_: Complex) -> IntArray:
    """Keep the tetrahedra in the solid, turned to positive volume; drop cavity and outside."""
    hull = complex_.triangles[complex_.patches != Patch.paper]
    kept = tets[inside(points[tets].mean(axis=1), complex_.points, hull)]
    if len(kept) == 0:
        raise StageFailure(Status.mesh_failed, "fTetWild left no tetrahedra inside the solid.")
    turned = corner_volumes(points, kept) < 0.0
    kept[turned] = kept[turned][:, [0, 2, 1, 3]]
    return kept


def _snapped(points: FloatArray, tets: IntArray, complex_: Complex, distance: float) -> FloatArray:
    """Put nodes on the planes they belong to: the paper, the two ends, the plane of symmetry.

    The surface may be off by the envelope, but supports and sections need exact planes.
    """
    points = points.copy()
    above = points[tets].mean(axis=1)[:, 2] > complex_.plane_z
    boundary = np.unique(boundary_faces(tets))
    ends = (float(complex_.points[:, 0].min()), float(complex_.points[:, 0].max()))
    planes = [(np.unique(interface_faces(tets, above)), 2, complex_.plane_z)]
    planes += [(boundary, 0, end) for end in ends]
    if complex_.half:
        planes.append((boundary, 1, 0.0))
    for nodes, axis, value in planes:
        near = nodes[np.abs(points[nodes, axis] - value) <= distance]
        points[near, axis] = value
    return points
