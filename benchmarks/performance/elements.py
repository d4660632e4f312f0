"""Elements and mesh sizes: which runs there are, and how far each tip is from the limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from pagd.catalogue import NamedDesign
from performance.fits import EDGE_ORDER, FloatArray, common_order, extrapolated
from performance.options import free_config
from performance.runs import Measurement, Run

__all__ = [
    "FAMILIES",
    "REFERENCES",
    "Case",
    "Family",
    "Point",
    "order_of",
    "points_of",
    "reference_of",
    "runs_of",
]


@dataclass(frozen=True, slots=True)
class Family:
    """Meshes that differ by their size alone; ``is_extrapolated``: pairs of them are too."""

    name: str
    mesher: str
    element: str
    is_extrapolated: bool = True


#: By the option that names its sizes.
FAMILIES: Final[Mapping[str, Family]] = {
    "tetrahedra": Family("tetrahedra P2–P1", "gmsh", "taylor_hood"),
    "element_pressure": Family("tetrahedra P2–P0", "gmsh", "element_pressure", False),
    "hexahedra": Family("hexahedra, 27 nodes", "structured", "hexahedron"),
}

#: Families whose limits errors are measured from: the first that is known.
REFERENCES: Final = ("hexahedra", "tetrahedra")


@dataclass(frozen=True, eq=False, slots=True)
class Case:
    """A design, a last pressure, and the sizes (mm) of each family, coarse to fine.

    ``halves``: by family, a size whose mesh is solved with every edge halved too: the limit of
    these two, which differ by nothing but their size, is what errors are measured from.
    """

    named: NamedDesign
    pressure_kPa: float
    sizes: Mapping[str, tuple[float, ...]]
    halves: Mapping[str, float]

    @property
    def title(self) -> str:
        """Name for people."""
        return f"{self.named.name}, {self.pressure_kPa:g} kPa"


@dataclass(frozen=True, eq=False, slots=True)
class Point:
    """One way to the tip: a mesh, or the limit of two of them.

    Attributes
    ----------
    family
        Its key in :data:`FAMILIES`.
    name
        Mesh size or sizes, for people.
    unknowns, solve_s, all_s
        Number, and processor seconds of the analysis and of the whole process; sums for a limit.
    tip
        Displacement (3,) of the tip in mm; None where the analysis ended early, for the reason
        in ``trouble``.
    is_limit
        Whether it is the limit of two meshes.
    """

    family: str
    name: str
    unknowns: int | None = None
    solve_s: float | None = None
    all_s: float | None = None
    tip: FloatArray | None = None
    trouble: str | None = None
    is_limit: bool = False


def runs_of(case: Case, config: str | None) -> dict[tuple[str, str], Run]:
    """Return the runs of a case by family and name of the mesh, coarse to fine."""
    found = {}
    for family, sizes in case.sizes.items():
        for size in sizes:
            found[family, f"{size:g}"] = _run(case, family, size, config)
    for family, size in case.halves.items():
        # The mesh that is halved is solved as it is too: a limit needs both.
        whole = _run(case, family, size, config)
        found[family, f"{size:g}"] = whole
        halves = Run(f"{whole.label}-halved", whole.named, whole.config, halvings=1)
        found[family, _halved(size)] = halves
    return found


def order_of(case: Case, measured: Mapping[tuple[str, str], Measurement]) -> float:
    """Return the order with which both families have the same limit, of a mesh and its halves.

    That of the inward edges where these are not known, or where there is no such order.
    """
    pairs = []
    for family in REFERENCES:
        single = [_point(family, name, one) for (of, name), one in measured.items() if of == family]
        for coarse, fine in _halves_of(case, single, family):
            if coarse.tip is not None and fine.tip is not None:
                pairs.append((coarse.tip, fine.tip))
    if len(pairs) < len(REFERENCES):
        return EDGE_ORDER
    found = common_order(pairs[0], pairs[1], 2.0)
    return EDGE_ORDER if found is None else found


def points_of(
    case: Case, measured: Mapping[tuple[str, str], Measurement], order: float
) -> list[Point]:
    """Return every mesh and the limits of neighbouring ones, family by family.

    Parameters
    ----------
    case
        The design and its sizes.
    measured
        By family and name of the mesh.
    order
        Of the error in the element size.
    """
    points: list[Point] = []
    for key, family in FAMILIES.items():
        single = [_point(key, name, one) for (of, name), one in measured.items() if of == key]
        points += single
        plain = [point for point in single if "halved" not in point.name]
        pairs = [*pairwise(_descending(plain)), *_halves_of(case, single, key)]
        points += [_limit(*pair, order) for pair in pairs if family.is_extrapolated]
    return points


def reference_of(case: Case, points: Sequence[Point], family: str, order: float) -> Point | None:
    """Return the limit of a family, of a mesh and its halves; None where these are not known."""
    pairs = _halves_of(case, [point for point in points if not point.is_limit], family)
    limits = [_limit(*pair, order) for pair in pairs]
    return limits[0] if limits and limits[0].tip is not None else None


def _halves_of(case: Case, single: Sequence[Point], family: str) -> list[tuple[Point, Point]]:
    """The mesh of a family that is halved, with its halves; empty where there is none."""
    if family not in case.halves:
        return []
    by_name = {point.name: point for point in single if point.family == family}
    size = case.halves[family]
    return [(by_name[f"{size:g}"], by_name[_halved(size)])]


def _run(case: Case, key: str, size: float, config: str | None) -> Run:
    family = FAMILIES[key]
    made = free_config(config, size_mm=size, pressure_kPa=case.pressure_kPa)
    made["mesh"]["meshers"] = [family.mesher]
    made["solve"]["element"] = family.element
    label = f"{case.named.name}-{case.pressure_kPa:g}kPa-{key}-{size:g}mm"
    return Run(label, case.named, made)


def _point(family: str, name: str, found: Measurement) -> Point:
    figures = found.figures
    if not found.is_complete:
        return Point(family, name, trouble=found.trouble)
    tips = np.array(figures["tip_mm"], np.float64)
    return Point(
        family,
        name,
        figures["unknowns"],
        figures["free_cpu_s"],
        _seconds(figures),
        tips[-1, 1:] - tips[0, 1:],
    )


def _seconds(figures: Mapping[str, Any]) -> float:
    whole = figures["process_cpu_s"]
    return float(sum(figures["stages_cpu_s"].values()) if whole is None else whole)


def _limit(coarse: Point, fine: Point, order: float) -> Point:
    name = f"{coarse.name} and {fine.name}"
    trouble = coarse.trouble or fine.trouble
    if trouble or coarse.tip is None or fine.tip is None:
        return Point(coarse.family, name, trouble=trouble, is_limit=True)
    ratio = 2.0 if fine.name == f"{coarse.name} halved" else _ratio(coarse, fine)
    if ratio <= 1:
        reason = f"{fine.name} mm gives no finer mesh than {coarse.name} mm."
        return Point(coarse.family, name, trouble=reason, is_limit=True)
    tip = extrapolated(coarse.tip, fine.tip, ratio, order)
    return Point(
        coarse.family,
        name,
        (coarse.unknowns or 0) + (fine.unknowns or 0),
        _sum(coarse.solve_s, fine.solve_s),
        _sum(coarse.all_s, fine.all_s),
        tip,
        is_limit=True,
    )


def _ratio(coarse: Point, fine: Point) -> float:
    """Ratio of the element sizes as the unknowns tell it: a wanted size is not always met."""
    return float(((fine.unknowns or 1) / (coarse.unknowns or 1)) ** (1 / 3))


def _sum(first: float | None, second: float | None) -> float | None:
    return None if first is None or second is None else first + second


def _descending(points: Sequence[Point]) -> list[Point]:
    """Coarse to fine, by the wanted size."""
    return sorted(points, key=lambda point: -float(point.name))


def _halved(size: float) -> str:
    return f"{size:g} halved"
