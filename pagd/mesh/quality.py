"""Figures that tell whether a mesh can be trusted."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from pagd.mesh.blocks import hexahedra, wedges
from pagd.mesh.types import TET_EDGES, FloatArray, IntArray, Mesh, corner_volumes

__all__ = [
    "MeshQuality",
    "block_jacobians",
    "element_jacobians",
    "mesh_quality",
    "node_jacobians",
    "scaled_jacobians",
]


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshQuality:
    """Size, shape and accuracy of a mesh.

    The scaled Jacobian is that of :func:`scaled_jacobians`, or of :func:`block_jacobians` where
    the tetrahedra make up blocks; ``volume_error`` is relative, and None where no exact volume
    was given.
    """

    tets: int
    hexahedra: int
    wedges: int
    nodes: int
    scaled_jacobian_min: float
    scaled_jacobian_p01: float
    scaled_jacobian_median: float
    volume_mm3: float
    volume_error: float | None

    def as_dict(self) -> dict[str, float | int | None]:
        """All figures by name, ready for a record."""
        return asdict(self)


def mesh_quality(mesh: Mesh, exact_volume: float | None = None) -> MeshQuality:
    """Figures of a mesh; ``exact_volume`` (mm^3) is that of the solid it stands for.

    Volumes are those of the tetrahedra between the corner nodes, which is exact where the
    elements are straight-sided.
    """
    jacobians = element_jacobians(mesh)
    volume = float(corner_volumes(mesh.points, mesh.tets).sum())
    error = None if exact_volume is None else volume / exact_volume - 1.0
    smallest, low, median = np.percentile(jacobians, [0.0, 1.0, 50.0])
    return MeshQuality(
        tets=len(mesh.tets),
        hexahedra=mesh.hexahedra,
        wedges=mesh.wedges,
        nodes=len(mesh.points),
        scaled_jacobian_min=float(smallest),
        scaled_jacobian_p01=float(low),
        scaled_jacobian_median=float(median),
        volume_mm3=volume,
        volume_error=error,
    )


def scaled_jacobians(points: FloatArray, tets: IntArray) -> FloatArray:
    """Scaled Jacobian (m,) of the tetrahedra between the corner nodes.

    sqrt(2) * 6 V divided by the largest product of the three edge lengths at a corner, as in
    Verdict (Stimpson et al. 2007, SAND2007-1751, section 6.14): 1 for the regular tetrahedron,
    0 for a flat one, negative for an inverted one. 0 too where an edge has no length.
    """
    corners = points[tets[:, :4]]
    lengths = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=3)
    lengths[:, range(4), range(4)] = 1.0
    product = lengths.prod(axis=2).max(axis=1)
    jacobians = 6.0 * corner_volumes(points, tets) * np.sqrt(2.0)
    return np.asarray(np.divide(jacobians, product, out=np.zeros_like(product), where=product > 0))


def element_jacobians(mesh: Mesh) -> FloatArray:
    """Scaled Jacobian of each block, or of each tetrahedron where there are no blocks."""
    in_blocks = mesh.hexahedra + mesh.wedges > 0
    return block_jacobians(mesh) if in_blocks else scaled_jacobians(mesh.points, mesh.tets)


def block_jacobians(mesh: Mesh) -> FloatArray:
    """Scaled Jacobian (hexahedra + wedges,) of blocks: the smallest over their corners.

    The volume that the unit vectors along the three edges of a corner span, as in Verdict
    (SAND2007-1751, sections 7.11 and 8): 1 for a cuboid; of a wedge 2/√3 times that, which is 1
    for an upright prism on an equilateral triangle.
    """
    six = _corner_jacobians(mesh.points, hexahedra(mesh), _HEXAHEDRON_CORNERS)
    three = _corner_jacobians(mesh.points, wedges(mesh), _WEDGE_CORNERS)
    return np.concatenate([six, three * 2.0 / np.sqrt(3.0)])


# A corner of a block and the ends of its edges, right-handed; numbers as in pagd.mesh.blocks.
_HEXAHEDRON_CORNERS: IntArray = np.array(
    [
        (0, 18, 6, 2),
        (18, 24, 0, 20),
        (24, 6, 18, 26),
        (6, 0, 24, 8),
        (2, 8, 20, 0),
        (20, 2, 26, 18),
        (26, 20, 8, 24),
        (8, 26, 2, 6),
    ]
)
_WEDGE_CORNERS: IntArray = np.array(
    [(0, 1, 2, 12), (1, 2, 0, 13), (2, 0, 1, 14), (12, 14, 13, 0), (13, 12, 14, 1), (14, 13, 12, 2)]
)


def _corner_jacobians(points: FloatArray, nodes: IntArray, corners: IntArray) -> FloatArray:
    places = points[nodes[:, corners]]
    edges = places[:, :, 1:] - places[:, :, :1]
    edges /= np.linalg.norm(edges, axis=3, keepdims=True)
    return np.asarray(np.linalg.det(edges).min(axis=1))


def node_jacobians(points: FloatArray, tets: IntArray) -> FloatArray:
    """Jacobian determinants (m, 10) in mm^3 of ten-node tetrahedra at their nodes.

    For straight-sided ones all are 6 V; where one is negative a curved element is inverted.
    """
    gradients = _gradients_at_nodes().transpose(2, 1, 0).reshape(3, 10, 10)
    columns = [np.matmul(points[tets].transpose(2, 0, 1), gradient) for gradient in gradients]
    a, b, c = columns
    return np.asarray(
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def _gradients_at_nodes() -> FloatArray:
    """Shape function gradients (node, function, 3) at the nodes of the reference element."""
    corners = np.eye(4)
    barycentric = np.vstack((corners, corners[TET_EDGES].mean(axis=1)))
    slopes = np.vstack((-np.ones(3), np.eye(3)))
    first, second = TET_EDGES.T
    at_corners = (4.0 * barycentric - 1.0)[:, :, None] * slopes
    at_edges = 4.0 * (
        barycentric[:, first, None] * slopes[second] + barycentric[:, second, None] * slopes[first]
    )
    return np.concatenate((at_corners, at_edges), axis=1)
