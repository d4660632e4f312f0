"""Kernels of contact between six-node faces: closest points, gaps and their two derivatives.

A point x of the slave side has its closest point y(ξ) on a master face where the difference
d = x − y is normal to it, d · a_α = 0 with the tangents a_α = ∂y/∂ξ_α. The signed gap g = d · n
is positive outside of the master's solid. Its derivatives with respect to the positions q of the
twelve nodes, ξ following along (Konyukhov and Schweizerhof, *Computational Contact Mechanics*,
2013, chapter 4), are, with D the weights of the nodes in x − y, so that d = Σ D_a q_a,

    ∇g   = D n,
    ∇²g  = −c_α (A⁻¹ κ m⁻¹)^{αβ} c_β − c_α A^{αβ} b_β − b_α A^{αβ} c_β − g b_α A^{αβ} b_β,

with c_α = D a_α, b_α the derivative of n · a_α at fixed n, the metric m_{αβ} = a_α · a_β, the
curvature κ_{αβ} = n · ∂²y/∂ξ_α∂ξ_β and A = m − g κ.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange
from numpy.typing import NDArray

from pagd.fem.compiled import compiled, compiled_parallel

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

# The closest point on a flat face is found at once, on a curved one in a few iterations.
_ITERATIONS = 12
_PARAMETER_TOLERANCE = 1e-10
# A point counts as above a face up to so far beyond its edges, so that none falls in between, …
_BEYOND = 1e-6
# … and stays above the face it was found above up to so far beyond them: where two faces meet at
# an angle, Newton's method would go to and fro between them.
_STAYS_BEYOND = 0.2
# The flat corner triangle is a first guess for the curved face: how far outside it may lie.
_FLAT_BEYOND = 0.35


@compiled
def _shapes(r: float, s: float, values: FloatArray, slopes: FloatArray) -> None:
    """Values (6,) and derivatives (2, 6) of a six-node face at (r, s)."""
    t = 1.0 - r - s
    values[0], values[1], values[2] = t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1)
    values[3], values[4], values[5] = 4 * t * r, 4 * r * s, 4 * s * t
    slopes[0, 0], slopes[0, 1], slopes[0, 2] = 1 - 4 * t, 4 * r - 1, 0.0
    slopes[0, 3], slopes[0, 4], slopes[0, 5] = 4 * (t - r), 4 * s, -4 * s
    slopes[1, 0], slopes[1, 1], slopes[1, 2] = 1 - 4 * t, 0.0, 4 * s - 1
    slopes[1, 3], slopes[1, 4], slopes[1, 5] = -4 * r, 4 * r, 4 * (t - s)


@compiled
def _curvatures(positions: FloatArray, face: IntArray, result: FloatArray) -> None:
    """Second derivatives (3, 3) of a face along rr, rs and ss; they are constant."""
    for i in range(3):
        x0, x1, x2 = positions[face[0], i], positions[face[1], i], positions[face[2], i]
        x3, x4, x5 = positions[face[3], i], positions[face[4], i], positions[face[5], i]
        result[0, i] = 4 * (x0 + x1 - 2 * x3)
        result[1, i] = 4 * (x0 - x3 + x4 - x5)
        result[2, i] = 4 * (x0 + x2 - 2 * x5)


@compiled
def _flat_frame(positions: FloatArray, face: IntArray, frame: FloatArray) -> None:
    """Fill the frame (3, 3) of the plane of a face's corners: a corner, and two slopes.

    The slopes of the parameters r and s are those of a point that moves in that plane.
    """
    d11, d12, d22 = 0.0, 0.0, 0.0
    for i in range(3):
        origin = frame[0, i] = positions[face[0], i]
        u = frame[1, i] = positions[face[1], i] - origin
        v = frame[2, i] = positions[face[2], i] - origin
        d11 += u * u
        d12 += u * v
        d22 += v * v
    determinant = d11 * d22 - d12 * d12
    for i in range(3):
        u, v = frame[1, i], frame[2, i]
        frame[1, i] = (d22 * u - d12 * v) / determinant
        frame[2, i] = (d11 * v - d12 * u) / determinant


@compiled
def _flat_guess(x: float, y: float, z: float, frame: FloatArray) -> tuple[float, float]:
    """Parameters of a point projected on the plane of a face's corners."""
    x, y, z = x - frame[0, 0], y - frame[0, 1], z - frame[0, 2]
    r = x * frame[1, 0] + y * frame[1, 1] + z * frame[1, 2]
    return r, x * frame[2, 0] + y * frame[2, 1] + z * frame[2, 2]


@compiled
def _place(
    point: FloatArray,
    positions: FloatArray,
    face: IntArray,
    values: FloatArray,
    slopes: FloatArray,
    difference: FloatArray,
    tangents: FloatArray,
) -> None:
    """Difference (3,) from a place of the face to the point, and its tangents (2, 3)."""
    for i in range(3):
        y, a, b = 0.0, 0.0, 0.0
        for k in range(6):
            x = positions[face[k], i]
            y += values[k] * x
            a += slopes[0, k] * x
            b += slopes[1, k] * x
        difference[i], tangents[0, i], tangents[1, i] = point[i] - y, a, b


@compiled
def _dot(a: FloatArray, b: FloatArray) -> float:
    product: float = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


@compiled
def _normal(tangents: FloatArray, normal: FloatArray) -> None:
    a, b = tangents[0], tangents[1]
    normal[0] = a[1] * b[2] - a[2] * b[1]
    normal[1] = a[2] * b[0] - a[0] * b[2]
    normal[2] = a[0] * b[1] - a[1] * b[0]
    size = math.sqrt(_dot(normal, normal))
    for i in range(3):
        normal[i] /= size


@compiled
def project(
    point: FloatArray,
    positions: FloatArray,
    face: IntArray,
    parameters: FloatArray,
    work: FloatArray,
    beyond: float = _BEYOND,
) -> float:
    """Signed gap of a point above a face, and its parameters (2,); infinite where not above it.

    The point may lie so far ``beyond`` the edges, in parameters. ``work`` (10, 6) is scratch.
    """
    frame = work[6:9, :3]
    _flat_frame(positions, face, frame)
    r, s = _flat_guess(point[0], point[1], point[2], frame)
    if r < -_FLAT_BEYOND or s < -_FLAT_BEYOND or r + s > 1 + _FLAT_BEYOND:
        return math.inf
    return _project_from(r, s, point, positions, face, parameters, work, beyond)


@compiled
def _project_from(
    r: float,
    s: float,
    point: FloatArray,
    positions: FloatArray,
    face: IntArray,
    parameters: FloatArray,
    work: FloatArray,
    beyond: float,
) -> float:
    """The same from a first guess of the parameters."""
    values, slopes = work[0], work[1:3]
    difference, tangents, second = work[3, :3], work[4:6, :3], work[6:9, :3]
    normal = work[9, :3]
    _curvatures(positions, face, second)
    converged = False
    for _ in range(_ITERATIONS):
        _shapes(r, s, values, slopes)
        _place(point, positions, face, values, slopes, difference, tangents)
        f1, f2 = _dot(difference, tangents[0]), _dot(difference, tangents[1])
        a11 = _dot(tangents[0], tangents[0]) - _dot(difference, second[0])
        a12 = _dot(tangents[0], tangents[1]) - _dot(difference, second[1])
        a22 = _dot(tangents[1], tangents[1]) - _dot(difference, second[2])
        determinant = a11 * a22 - a12 * a12
        if determinant <= 0.0:
            return math.inf
        dr, ds = (a22 * f1 - a12 * f2) / determinant, (a11 * f2 - a12 * f1) / determinant
        r, s = r + dr, s + ds
        if abs(r - 0.5) > 2 or abs(s - 0.5) > 2:
            return math.inf
        if abs(dr) + abs(ds) < _PARAMETER_TOLERANCE:
            converged = True
            break
    if not converged or r < -beyond or s < -beyond or r + s > 1 + beyond:
        return math.inf
    _shapes(r, s, values, slopes)
    _place(point, positions, face, values, slopes, difference, tangents)
    _normal(tangents, normal)
    parameters[0], parameters[1] = r, s
    return _dot(difference, normal)


@compiled
def slave_point(
    positions: FloatArray, face: IntArray, values: FloatArray, point: FloatArray
) -> None:
    """Position (3,) of a quadrature point of a face."""
    for i in range(3):
        point[i] = 0.0
        for k in range(6):
            point[i] += values[k] * positions[face[k], i]


@compiled_parallel
def find_gaps(
    positions: FloatArray,
    slaves: IntArray,
    masters: IntArray,
    values: FloatArray,
    starts: IntArray,
    candidates: IntArray,
    deepest: float,
    keeps: float,
    gaps: FloatArray,
    entries: IntArray,
    parameters: FloatArray,
) -> None:
    """Nearest face of each slave point among its candidates.

    Fills gaps (S, Q), infinite where no candidate lies below the point; entries (S, Q), places in
    ``candidates``; parameters (S, Q, 2). A gap below −``deepest`` is the far side of a wall. A
    point whose gap was smaller than ``keeps`` keeps its face while it is above it or little beyond.
    """
    for e in prange(slaves.shape[0]):
        points, found = np.empty((values.shape[0], 3)), np.empty(2)
        frame, work = np.empty((3, 3)), np.empty((10, 6))
        kept = np.zeros(values.shape[0], np.bool_)
        for q in range(values.shape[0]):
            slave_point(positions, slaves[e], values[q], points[q])
            if entries[e, q] >= 0 and gaps[e, q] < keeps:
                face = masters[candidates[entries[e, q]]]
                gap = project(points[q], positions, face, found, work, _STAYS_BEYOND)
                if gap < math.inf:
                    gaps[e, q], kept[q] = gap, True
                    parameters[e, q, 0], parameters[e, q, 1] = found[0], found[1]
                    continue
            gaps[e, q], entries[e, q] = math.inf, -1
        for c in range(starts[e], starts[e + 1]):
            face = masters[candidates[c]]
            _flat_frame(positions, face, frame)
            for q in range(values.shape[0]):
                r, s = _flat_guess(points[q, 0], points[q, 1], points[q, 2], frame)
                far = r < -_FLAT_BEYOND or s < -_FLAT_BEYOND or r + s > 1 + _FLAT_BEYOND
                if far or kept[q]:
                    continue
                gap = _project_from(r, s, points[q], positions, face, found, work, _BEYOND)
                if gap > -deepest and abs(gap) < abs(gaps[e, q]):
                    gaps[e, q], entries[e, q] = gap, c
                    parameters[e, q, 0], parameters[e, q, 1] = found[0], found[1]


@compiled
def pressure_law(gap: float, stiffness: float, width: float) -> tuple[float, float, float]:
    """Energy by area of a gap, its first and its second derivative.

    Linear with ``stiffness`` (MPa/mm) below −``width`` (mm), a parabola up to ``width``, zero
    beyond: the pressure −∂/∂g has no kink where contact begins.
    """
    if gap >= width:
        return 0.0, 0.0, 0.0
    if gap <= -width:
        return stiffness * (0.5 * gap * gap + width * width / 6), stiffness * gap, stiffness
    left = width - gap
    factor = stiffness / (4 * width)
    return factor * left**3 / 3, -factor * left * left, 2 * factor * left


@compiled
def gap_derivatives(
    positions: FloatArray,
    face: IntArray,
    slave_values: FloatArray,
    parameters: FloatArray,
    gap: float,
    normal: FloatArray,
    weights: FloatArray,
    along: FloatArray,
    turning: FloatArray,
    coefficients: FloatArray,
    work: FloatArray,
) -> None:
    """Everything ∇g and ∇²g are made of.

    Fills normal (3,), weights D (12,), along c_α (2, 36), turning b_α (2, 36), and coefficients
    (2, 2, 2): A⁻¹ κ m⁻¹ and A⁻¹.
    """
    values, slopes = work[0], work[1:3]
    tangents, second, difference = work[4:6, :3], work[6:9, :3], work[3, :3]
    _shapes(parameters[0], parameters[1], values, slopes)
    # The difference is not needed: any point serves.
    _place(normal, positions, face, values, slopes, difference, tangents)
    _normal(tangents, normal)
    _curvatures(positions, face, second)
    for k in range(6):
        weights[k], weights[6 + k] = slave_values[k], -values[k]
    for alpha in range(2):
        for k in range(12):
            slope = slopes[alpha, k - 6] if k >= 6 else 0.0
            for i in range(3):
                along[alpha, 3 * k + i] = weights[k] * tangents[alpha, i]
                turning[alpha, 3 * k + i] = slope * normal[i]
    m11, m12 = _dot(tangents[0], tangents[0]), _dot(tangents[0], tangents[1])
    m22 = _dot(tangents[1], tangents[1])
    k11, k12, k22 = _dot(normal, second[0]), _dot(normal, second[1]), _dot(normal, second[2])
    a11, a12, a22 = m11 - gap * k11, m12 - gap * k12, m22 - gap * k22
    area, metric = a11 * a22 - a12 * a12, m11 * m22 - m12 * m12
    inverse = coefficients[1]
    inverse[0, 0], inverse[0, 1] = a22 / area, -a12 / area
    inverse[1, 0], inverse[1, 1] = -a12 / area, a11 / area
    # κ m⁻¹
    p11, p12 = (k11 * m22 - k12 * m12) / metric, (k12 * m11 - k11 * m12) / metric
    p21, p22 = (k12 * m22 - k22 * m12) / metric, (k22 * m11 - k12 * m12) / metric
    coefficients[0, 0, 0] = inverse[0, 0] * p11 + inverse[0, 1] * p21
    coefficients[0, 0, 1] = inverse[0, 0] * p12 + inverse[0, 1] * p22
    coefficients[0, 1, 0] = inverse[1, 0] * p11 + inverse[1, 1] * p21
    coefficients[0, 1, 1] = inverse[1, 0] * p12 + inverse[1, 1] * p22


@compiled
def add_force(slope: float, normal: FloatArray, weights: FloatArray, residual: FloatArray) -> None:
    """Add slope ∇g to the residual (36,)."""
    for i in range(36):
        residual[i] += slope * weights[i // 3] * normal[i % 3]


@compiled
def add_stiffness(
    curvature: float,
    shown: float,
    gap: float,
    normal: FloatArray,
    weights: FloatArray,
    along: FloatArray,
    turning: FloatArray,
    coefficients: FloatArray,
    tangent: FloatArray,
) -> None:
    """Add curvature ∇g ∇g + shown ∇²g to the packed tangent (666,)."""
    bent, inverse = coefficients[0], coefficients[1]
    left, right, entry = np.empty(2), np.empty(2), 0
    for i in range(36):
        gi = weights[i // 3] * normal[i % 3]
        for b in range(2):
            # Rows of c A⁻¹ κ m⁻¹ + b A⁻¹, against c; and of c A⁻¹ + g b A⁻¹, against b.
            left[b] = bent[0, b] * along[0, i] + bent[1, b] * along[1, i]
            left[b] += inverse[0, b] * turning[0, i] + inverse[1, b] * turning[1, i]
            right[b] = inverse[0, b] * (along[0, i] + gap * turning[0, i])
            right[b] += inverse[1, b] * (along[1, i] + gap * turning[1, i])
        for j in range(i, 36):
            second = -left[0] * along[0, j] - left[1] * along[1, j]
            second -= right[0] * turning[0, j] + right[1] * turning[1, j]
            gj = weights[j // 3] * normal[j % 3]
            tangent[entry] += curvature * gi * gj + shown * second
            entry += 1
