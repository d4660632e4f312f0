"""Where the tip goes on an infinitely fine mesh: finer meshes, extrapolated."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pagd.errors import InputError
from pagd.files import write_text
from peers.solved import Solved

__all__ = [
    "FEWEST_MESHES",
    "FILE_NAME",
    "ORDER",
    "Converged",
    "extrapolated",
    "read_converged",
    "write_converged",
]

FloatArray = NDArray[np.float64]

FILE_NAME = "converged_tips.json"

#: Fewer give no limit.
FEWEST_MESHES = 2

#: Order of the error in the size of the elements: near inward edges of 90°, such as those of the
#: cavities, the displacement goes with the distance to the power 0.5445 (Williams 1952), and a
#: displacement far from them gains twice that.
ORDER = 2 * 0.5445

#: On meshes that do not resolve those edges yet, the smooth part of the error may outweigh theirs;
#: of displacements far from them, a quadratic element gains so much at least.
_SMOOTH_ORDER = 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Converged:
    """The tip of a design on an infinitely fine mesh.

    Attributes
    ----------
    design
        Name of the design.
    pressure_kPa
        Recorded pressures (p,).
    tip_mm
        Displacement (p, 3) of the tip.
    spread_mm
        How far (p,) that would be off, at most, with one of the meshes left out, or with the order
        of edges, or of a smooth displacement.
    meshes
        What it is made of: size, tetrahedra, unknowns, displacement at the last pressure in mm.
    """

    design: str
    pressure_kPa: Sequence[float]
    tip_mm: Sequence[Sequence[float]]
    spread_mm: Sequence[float]
    meshes: Sequence[Mapping[str, Any]]

    def tip(self, pressure_kPa: float) -> FloatArray | None:
        """Displacement (3,) of the tip at a pressure; None if there is none."""
        for known, tip in zip(self.pressure_kPa, self.tip_mm, strict=True):
            if abs(known - pressure_kPa) < 1e-6:
                return np.array(tip)
        return None

    def error(self, solved: Solved, pressure_kPa: float) -> float | None:
        """Distance of a tip from this one, as a share of this displacement; None if unknown."""
        found = solved.tip(pressure_kPa)
        return None if found is None else self.error_of(found, pressure_kPa)

    def error_of(self, tip: ArrayLike, pressure_kPa: float) -> float | None:
        """The same of a displacement (3,) in mm."""
        exact = self.tip(pressure_kPa)
        if exact is None:
            return None
        return float(np.linalg.norm(np.asarray(tip) - exact) / np.linalg.norm(exact))


def extrapolated(
    design: str, sizes_mm: Sequence[float], runs: Sequence[Solved], order: float = ORDER
) -> Converged:
    """Extrapolate the tip over meshes, by least squares of u + c hᵒʳᵈᵉʳ.

    Parameters
    ----------
    design
        Name of the design.
    sizes_mm
        Size asked for, of each mesh; h is the cube root of the mean volume of its tetrahedra.
    runs
        Of the meshes, the coarsest first.
    order
        Of the error in h.

    Raises
    ------
    InputError
        If there are fewer than two different meshes, or they have no pressure in common.
    """
    different = len({run.tets for run in runs})
    if different < FEWEST_MESHES:
        told = ", ".join(f"{size:g}" for size in sizes_mm)
        raise InputError(
            f"{design}: {told} mm give {different} different meshes, but there must be at least "
            f"{FEWEST_MESHES} meshes to extrapolate over."
        )
    common = sorted(set.intersection(*({p for p, _ in run.tips} for run in runs)))
    if not common:
        raise InputError(f"{design}: the meshes reached no recorded pressure in common.")
    h = np.array([run.tets for run in runs], np.float64) ** (-1 / 3)
    tips = np.array([[run.tip(p) for p in common] for run in runs])
    limit = _limit(h, tips, order)
    others = [_limit(h, tips, another) for another in (ORDER, _SMOOTH_ORDER)]
    if different > FEWEST_MESHES:
        kept = [np.arange(len(runs)) != i for i in range(len(runs))]
        others += [_limit(h[which], tips[which], order) for which in kept]
    spread = np.max([np.linalg.norm(limit - other, axis=1) for other in others], axis=0)
    return Converged(
        design=design,
        pressure_kPa=common,
        tip_mm=np.round(limit, 6).tolist(),
        spread_mm=np.round(spread, 6).tolist(),
        meshes=[
            {
                "size_mm": size,
                "tets": run.tets,
                "unknowns": run.unknowns,
                "wall_s": run.wall_s,
                "tip_mm": tips[i, -1].tolist(),
                "commit": run.commit,
            }
            for i, (size, run) in enumerate(zip(sizes_mm, runs, strict=True))
        ],
    )


def _limit(h: FloatArray, values: FloatArray, order: float) -> FloatArray:
    """The values (p, 3) for h = 0, of those (m, p, 3) for h (m,)."""
    powers = np.column_stack((np.ones(len(h)), h**order))
    found = np.linalg.lstsq(powers, values.reshape(len(h), -1))[0]
    return np.asarray(found[0].reshape(values.shape[1:]))


def write_converged(folder: Path, tips: Mapping[str, Converged]) -> Path:
    """Write the tips of designs to a folder, beside those of others that are there."""
    path = folder / FILE_NAME
    known = {**read_converged(folder), **tips}
    content = {name: asdict(tip) for name, tip in known.items()}
    write_text(path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
    return path


def read_converged(folder: Path) -> dict[str, Converged]:
    """Read the tips of a folder; none if there are none.

    Raises
    ------
    InputError
        If the file does not hold them.
    """
    path = folder / FILE_NAME
    if not path.is_file():
        return {}
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return {name: Converged(**tip) for name, tip in content.items()}
    except (ValueError, TypeError, AttributeError) as error:
        raise InputError(f"{path}: does not hold converged tips ({error}).") from None
