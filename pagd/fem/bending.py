"""Bending stiffness of an embedded flat sheet without rotation unknowns.

A sheet that hardly stretches deforms isometrically, and for an isometry of a
flat sheet the square of the curvature is the square of the second derivative of
the position. The bending energy

    E = D/2 ∫ (1 − ν) |∇²x|² + ν |Δx|² dA

is then quadratic in the positions, does not change under rigid motions, and its
tangent is constant (Bonito, Nochetto, *SIAM J. Numer. Anal.* 56 (2018) 2719).

The positions are quadratic on each triangle and continuous; the kinks between
triangles are hinges that an interior penalty closes (Brenner, Sung, *J. Sci.
Comput.* 22 (2005) 83). Per edge, with [·] the jump and {·} the mean, g = ∂x/∂n
and m = D (ν Δx + (1 − ν) ∂²x/∂n²)::

    E_edge = ∫ −{m}·[g] + ½ η [g]·[g] ds

A clamped edge holds its slope the same way; an edge in a symmetry plane is half
of an edge whose other side is the mirror image; other edges are free.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pagd.errors import InputError
from pagd.fem import shapes
from pagd.fem.quadratic_energy import QuadraticEnergy
from pagd.materials import Sheet

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# The penalty times (edge length / triangle area) that makes the form coercive is
# at least 3/4 (Cauchy-Schwarz with three edges a triangle); twice that is used.
_PENALTY = 1.5

_GAUSS = (0.5 - 3**-0.5 / 2, 0.5 + 3**-0.5 / 2)


@dataclass(frozen=True)
class _Triangles:
    """Local geometry of flat, straight-sided triangles.

    frame (2, 3): orthonormal vectors of the plane. corners (T, 3, 2), areas (T,),
    inverse (T, 2, 2): d(reference)/d(local). hessians (T, 6, 2, 2) of the shape
    functions along the local axes.
    """

    frame: FloatArray
    corners: FloatArray
    areas: FloatArray
    inverse: FloatArray
    hessians: FloatArray


def _plane(points: FloatArray) -> FloatArray:
    """Two orthonormal vectors (2, 3) of the plane the points lie in."""
    centred = points - points.mean(axis=0)
    _, spread, axes = np.linalg.svd(centred, full_matrices=False)
    if spread[2] > 1e-6 * spread[0]:
        raise InputError(
            "the surface 'paper' is not flat; its bending stiffness needs a flat sheet"
        )
    return np.asarray(axes[:2])


def _triangles(points: FloatArray, faces: IntArray) -> _Triangles:
    frame = _plane(points[np.unique(faces)])
    corners = points[faces[:, :3]] @ frame.T
    jacobian = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
    inverse = np.asarray(np.linalg.inv(jacobian), dtype=np.float64)
    hessians = np.einsum(
        "apq,tpi,tqj->taij", shapes.triangle_hessians(), inverse, inverse, optimize=True
    )
    areas = np.asarray(np.abs(np.linalg.det(jacobian)) / 2, dtype=np.float64)
    return _Triangles(frame, corners, areas, inverse, hessians)


def _face_matrices(triangles: _Triangles, sheet: Sheet) -> FloatArray:
    """Matrices (T, 6, 6) of D [(1 − ν) ∇²v:∇²w + ν Δv Δw] · area."""
    nu = sheet.poisson_ratio
    laplacian = np.trace(triangles.hessians, axis1=2, axis2=3)
    full = np.einsum("taij,tbij->tab", triangles.hessians, triangles.hessians, optimize=True)
    product = (1 - nu) * full + nu * laplacian[:, :, None] * laplacian[:, None, :]
    return np.asarray(sheet.bending_stiffness * triangles.areas[:, None, None] * product)


@dataclass(frozen=True)
class _Sides:
    """One side per row: triangle, local edge, edge key (its two corners, sorted)."""

    triangle: IntArray
    edge: IntArray
    key: IntArray


def _sides(faces: IntArray) -> _Sides:
    pairs = np.array(shapes.TRIANGLE_EDGES)
    key = np.sort(faces[:, pairs], axis=2).reshape(-1, 2)
    triangle = np.repeat(np.arange(len(faces)), 3)
    return _Sides(triangle, np.tile(np.arange(3), len(faces)), key)


def _side_operators(
    triangles: _Triangles, sides: _Sides, faces: IntArray, sheet: Sheet
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Slopes ∂N/∂n (S, 2, 6) at two Gauss points, moments (S, 6), lengths (S,).

    The normal points out of the side's triangle; the Gauss points run from the
    corner with the smaller number to the other, so that both sides of an edge agree.
    """
    pairs = np.array(shapes.TRIANGLE_EDGES)[sides.edge]
    rows = np.arange(len(pairs))
    corners = triangles.corners[sides.triangle]
    along = corners[rows, pairs[:, 1]] - corners[rows, pairs[:, 0]]
    length = np.linalg.norm(along, axis=1)
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1) / length[:, None]
    outward = corners[rows, pairs[:, 0]] - corners.mean(axis=1)
    normal *= np.sign((normal * outward).sum(axis=1))[:, None]
    numbers = np.take_along_axis(faces[sides.triangle], pairs, axis=1)
    start = np.where(numbers[:, 0] < numbers[:, 1], pairs[:, 0], pairs[:, 1])
    end = pairs.sum(axis=1) - start
    slopes = np.empty((len(pairs), 2, 6))
    for g, position in enumerate(_GAUSS):
        barycentric = np.zeros((len(pairs), 3))
        barycentric[rows, start], barycentric[rows, end] = 1 - position, position
        reference = shapes.triangle_derivatives(barycentric)
        local = np.einsum("sap,spi->sai", reference, triangles.inverse[sides.triangle])
        slopes[:, g] = np.einsum("sai,si->sa", local, normal)
    hessians = triangles.hessians[sides.triangle]
    nu = sheet.poisson_ratio
    moments = nu * np.trace(hessians, axis1=2, axis2=3)
    moments = moments + (1 - nu) * np.einsum("saij,si,sj->sa", hessians, normal, normal)
    return slopes, sheet.bending_stiffness * moments, length


def _edge_matrices(
    jumps: FloatArray, moments: FloatArray, penalty: FloatArray, length: FloatArray
) -> FloatArray:
    """Matrices (S, k, k) of −{m}[g] − [g]{m} + η [g][g], integrated along the edge."""
    mean_jump = jumps.mean(axis=1)
    crossed = moments[:, :, None] * mean_jump[:, None, :]
    squared = np.einsum("sga,sgb->sab", jumps, jumps, optimize=True) / 2
    matrices = penalty[:, None, None] * squared - crossed - crossed.transpose(0, 2, 1)
    return np.asarray(length[:, None, None] * matrices)


def _pair_up(sides: _Sides) -> tuple[IntArray, IntArray, IntArray]:
    """Rows of the two sides of every interior edge, and rows of the boundary sides."""
    _, inverse, counts = np.unique(sides.key, axis=0, return_inverse=True, return_counts=True)
    inverse = inverse.ravel()
    if counts.max() > 2:
        raise InputError("the surface 'paper' has edges with more than two triangles")
    order = np.argsort(inverse, kind="stable")
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    paired = starts[counts == 2]
    return order[paired], order[paired + 1], order[starts[counts == 1]]


def _joined_nodes(
    first: IntArray, second: IntArray
) -> tuple[IntArray, Callable[[FloatArray, FloatArray], FloatArray]]:
    """The nine nodes (S, 9) of two triangles (S, 6) with a common edge.

    Also a function that adds up two rows (S, 6) of node values into one (S, 9).
    """
    shared = second[:, :, None] == first[:, None, :]
    alone = ~shared.any(axis=2)

    def join(a: FloatArray, b: FloatArray) -> FloatArray:
        return np.hstack([a + np.einsum("sk,ska->sa", b, shared), b[alone].reshape(-1, 3)])

    return np.hstack([first, second[alone].reshape(-1, 3)]), join


def bending_terms(
    points: FloatArray,
    faces: IntArray,
    sheet: Sheet,
    clamped: IntArray | None = None,
    symmetry: IntArray | None = None,
    symmetry_axis: int = 1,
    beyond: IntArray | None = None,
    coupled: bool = False,
) -> list[QuadraticEnergy]:
    """The bending energy of a flat sheet as terms of the potential.

    Parameters
    ----------
    points, faces
        Coordinates (n, 3) in mm and six-node faces (T, 6), straight-sided.
    sheet
        Its elastic constants.
    clamped, symmetry
        Numbers of the nodes on the clamped part and on the symmetry plane.
    symmetry_axis
        The axis (0, 1, 2) normal to the symmetry plane.
    beyond
        Faces (B, 6) of a sheet that goes on where this one ends: of their energy only that of the
        hinges between both counts.
    coupled
        See :class:`QuadraticEnergy`.

    Raises
    ------
    InputError
        Where the sheet is not flat or three triangles share an edge.
    """
    own = len(faces)
    if beyond is not None:
        faces = np.vstack([faces, beyond])
    triangles = _triangles(points, faces)
    sides = _sides(faces)
    slopes, moments, length = _side_operators(triangles, sides, faces, sheet)
    stiffness = _PENALTY * sheet.bending_stiffness * length / triangles.areas[sides.triangle]
    first, second, boundary = _pair_up(sides)
    counts = np.minimum(sides.triangle[first], sides.triangle[second]) < own
    first, second = first[counts], second[counts]
    boundary = boundary[sides.triangle[boundary] < own]
    bending = _face_matrices(triangles, sheet)[:own]
    terms = [QuadraticEnergy("bending", faces[:own], bending, coupled=coupled)]

    nodes, join = _joined_nodes(faces[sides.triangle[first]], faces[sides.triangle[second]])
    # The outward normal of the second side is minus that of the first, so that the
    # sum of both slopes is the jump; the moment is even in the normal.
    jumps = np.stack([join(slopes[first][:, g], slopes[second][:, g]) for g in (0, 1)], axis=1)
    means = join(moments[first], moments[second]) / 2
    penalty = stiffness[first] + stiffness[second]
    matrices = _edge_matrices(jumps, means, penalty, length[first])
    terms.append(QuadraticEnergy("hinges", nodes, matrices, coupled=coupled))

    for held, components in (
        (clamped, (0, 1, 2)),
        (symmetry, tuple(i for i in range(3) if i != symmetry_axis)),
    ):
        if held is None:
            continue
        on = boundary[np.isin(sides.key[boundary], held).all(axis=1)]
        if len(on):
            # One-sided: the mean is the moment of the one triangle, twice the share
            # it has in an interior edge, hence four times the penalty.
            matrices = _edge_matrices(slopes[on], moments[on], 4 * stiffness[on], length[on])
            nodes = faces[sides.triangle[on]]
            terms.append(QuadraticEnergy("held edges", nodes, matrices, components, coupled))
    return terms
