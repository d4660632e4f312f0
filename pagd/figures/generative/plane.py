"""The plane that points of the reduced space are shown in."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

from pagd.figures.generative.results import NothingToDraw
from pagd.figures.style import FAINT, INK, MODE_LOOKS, mode_look

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = [
    "Gaussian",
    "draw_background",
    "draw_gaussian",
    "frame_axes",
    "in_plane",
    "modes_of",
    "scatter_modes",
]

#: Names of the two coordinates shown, by the method of the embedding.
_AXES: Final = {
    "tsne": ("t-SNE 1", "t-SNE 2"),
    "pca": ("principal component 1", "principal component 2"),
    "none": ("principal component 1 of all parameters", "principal component 2"),
}


@dataclass(frozen=True, slots=True)
class Gaussian:
    """One Gaussian in the plane: mean (2,), covariance (2, 2), weight, whether it bridges."""

    mean: NDArray[np.float64]
    covariance: NDArray[np.float64]
    weight: float
    bridges: bool


def in_plane(frame: pd.DataFrame) -> pd.DataFrame:
    """Return the rows that have a point (z1, z2) in the plane.

    Raises
    ------
    NothingToDraw
        If the reduced space has no two coordinates, or no row has a point.
    """
    if not {"z1", "z2"} <= set(frame.columns):
        raise NothingToDraw("The reduced space has no two coordinates that make a plane.")
    coordinates = frame[["z1", "z2"]].to_numpy(dtype=np.float64)
    found: pd.DataFrame = frame[np.isfinite(coordinates).all(axis=1)]
    if found.empty:
        raise NothingToDraw("No design has a point in the plane.")
    return found.astype({"z1": np.float64, "z2": np.float64})


def modes_of(frame: pd.DataFrame) -> list[str]:
    """Return the modes that occur, the usual ones first."""
    there = set(frame["mode"].dropna().astype(str))
    return [mode for mode in MODE_LOOKS if mode in there] + sorted(there - set(MODE_LOOKS))


def scatter_modes(
    axes: Axes,
    frame: pd.DataFrame,
    x: str,
    y: str,
    *,
    size: float,
    alpha: float = 1.0,
    counted: bool = True,
) -> None:
    """Draw the rows as points in the colour and shape of their mode; the legend may count them."""
    for mode in modes_of(frame):
        rows = frame[frame["mode"] == mode]
        look = mode_look(mode)
        axes.scatter(
            rows[x],
            rows[y],
            s=size,
            c=look.colour,
            marker=look.marker,
            alpha=alpha,
            linewidths=0,
            label=f"{mode} ({len(rows):,})" if counted else mode,
        )


def draw_background(axes: Axes, points: NDArray[np.float64], label: str) -> None:
    """Draw the training designs (n, 2) faintly, as what everything else lies on."""
    axes.scatter(
        points[:, 0], points[:, 1], s=5, c="#d5dbe1", linewidths=0, label=label, zorder=0.5
    )


def draw_gaussian(axes: Axes, gaussian: Gaussian, deviations: Iterable[float]) -> None:
    """Draw the ellipses of a Gaussian at some standard deviations; a bridging one is dashed."""
    values, vectors = np.linalg.eigh(gaussian.covariance)
    lengths = np.sqrt(np.maximum(values, 0.0))
    angle = float(np.degrees(np.arctan2(vectors[1, 1], vectors[0, 1])))
    for deviation in deviations:
        width, height = 2.0 * deviation * lengths[::-1]
        axes.add_patch(
            Ellipse(
                (float(gaussian.mean[0]), float(gaussian.mean[1])),
                float(width),
                float(height),
                angle=angle,
                fill=False,
                edgecolor=INK,
                linewidth=1.3 / deviation + 0.3,
                linestyle=(0, (5, 3)) if gaussian.bridges else "-",
                zorder=4,
            )
        )


def frame_axes(axes: Axes, method: str | None) -> None:
    """Name the coordinates; in a t-SNE plane their values mean nothing, so they have no ticks."""
    x, y = _AXES.get(method or "", ("reduced coordinate 1", "reduced coordinate 2"))
    axes.set(xlabel=x, ylabel=y, aspect="equal", adjustable="datalim")
    if method == "tsne":
        axes.set(xticks=[], yticks=[])
    axes.xaxis.label.set_color(FAINT)
    axes.yaxis.label.set_color(FAINT)
