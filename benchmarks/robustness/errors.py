"""Discretisation errors of the tip: some designs of a study with every edge halved too."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from performance.figures import tips_of
from performance.fits import EDGE_ORDER, FloatArray, extrapolated, relative_distance

from pagd.catalogue import NamedDesign
from pagd.errors import InputError
from pagd.record import read_record
from robustness.study import Study

__all__ = ["ALLOWED_ERROR", "USUAL_ORDER", "TipError", "every_kth", "finer_study", "tip_error"]

#: Discretisation error of the tip that is allowed, by its displacement.
ALLOWED_ERROR: Final = 0.03

#: Order of the error on meshes of these sizes: benchmarks/elements.py finds about 2.
USUAL_ORDER: Final = 2.0


@dataclass(frozen=True, slots=True)
class TipError:
    """How far the tip of a design is from that on a finer mesh, and from its limit.

    Attributes
    ----------
    design_id, mode
        The design.
    pressure_kPa
        The last one that both meshes have reached.
    unknowns, finer_unknowns
        Of the two meshes.
    difference, error, largest_error
        Distance of the tips of both meshes, and its estimated distance to the limit; by the
        displacement of the limit. Estimates are with the orders :data:`USUAL_ORDER` and, for
        the largest, that of the inward edges.
    """

    design_id: str
    mode: str
    pressure_kPa: float
    unknowns: int | None
    finer_unknowns: int | None
    difference: float
    error: float
    largest_error: float

    def as_dict(self) -> dict[str, Any]:
        """All attributes, ready for JSON."""
        return asdict(self)


def every_kth(designs: Sequence[NamedDesign], count: int) -> list[NamedDesign]:
    """Return ``count`` designs at most, evenly spread, of both modes.

    Modes take turns in a study: of an even distance the designs would all be of one mode, so
    that every other one of them is the next.
    """
    if count <= 0:
        return []
    step = max(len(designs) // count, 1)
    places = [k * step + (k % 2 if step % 2 == 0 else 0) for k in range(count)]
    return [designs[place] for place in places if place < len(designs)]


def finer_study(study: Study, count: int) -> Study:
    """Return the study of ``count`` designs with every edge halved, free actuation alone.

    A mesh of half the size would not do: walls that are one element thick would stay so.
    """
    config = {**study.config, "solve": study.config["solve"] | {"blocked_force": "none"}}
    return Study(study.out / "halved", every_kth(study.designs, count), config, halvings=1)


def tip_error(named: NamedDesign, folder: Path, finer: Path) -> TipError | None:
    """Return the error of a design's tip from the folders of its mesh and of the halves of that.

    None where they have no state under pressure in common.
    """
    tips = [_displacements(tips_of(one)) for one in (folder, finer)]
    unknowns = [_unknowns(one) for one in (folder, finer)]
    common = [pressure for pressure in tips[0] if pressure in tips[1]]
    if not common:
        return None
    coarse, fine = (tip[max(common)] for tip in tips)
    limits = [extrapolated(coarse, fine, 2.0, order) for order in (USUAL_ORDER, EDGE_ORDER)]
    return TipError(
        named.name,
        named.design.mode,
        max(common),
        unknowns[0],
        unknowns[1],
        float(np.linalg.norm(coarse - fine) / np.linalg.norm(limits[0])),
        *(relative_distance(coarse, limit) for limit in limits),
    )


def _displacements(tips: Sequence[Sequence[float]] | None) -> Mapping[float, FloatArray]:
    """Displacement (3,) of the tip by pressure, the unloaded state left out.

    A path may pass a pressure more than once: the first time counts.
    """
    if not tips:
        return {}
    rest, found = np.array(tips[0][1:]), dict[float, FloatArray]()
    for pressure, *place in tips[1:]:
        found.setdefault(round(pressure, 6), np.array(place) - rest)
    return found


def _unknowns(folder: Path) -> int | None:
    try:
        return read_record(folder / "solve").figures.get("unknowns")
    except InputError:
        return None
