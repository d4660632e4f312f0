"""Picture of the mixture and of the three modes drawn from it: Fig. 4b of the paper."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.ticker import MaxNLocator

from pagd.figures.generative.labels import legend_below
from pagd.figures.generative.plane import (
    Gaussian,
    draw_background,
    draw_gaussian,
    frame_axes,
    scatter_modes,
)
from pagd.figures.generative.projection import gaussians_of, load_generated_plane, load_plane
from pagd.figures.generative.results import GenerativePaths, load_mixture
from pagd.figures.style import FAINT, INK, MODE_LOOKS, new_figure, number, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_mixture", "draw_plane", "mixture_figure", "name_gaussians"]


def draw_mixture(paths: GenerativePaths, out: Path) -> None:
    """Draw the generated designs in the plane, with the Gaussians they come from.

    Raises
    ------
    NothingToDraw
        If nothing was generated, or not in a plane.
    """
    plane, mixture = load_plane(paths), load_mixture(paths)
    figure = mixture_figure(
        plane.training,
        load_generated_plane(paths, plane),
        gaussians_of(mixture, plane),
        {int(count): float(value) for count, value in (mixture.get("bic") or {}).items()},
        mixture.get("components"),
        plane.method,
    )
    save(figure, out)


def mixture_figure(
    training: pd.DataFrame,
    generated: pd.DataFrame,
    gaussians: Sequence[Gaussian] = (),
    bic: Mapping[int, float] | None = None,
    components: int | None = None,
    method: str | None = None,
) -> Figure:
    """Return the picture: the plane, BIC by number of Gaussians, α of the mixed designs.

    Parameters
    ----------
    training, generated
        Designs with ``z1``, ``z2``, ``mode`` and ``alpha``.
    gaussians
        What the generated ones are drawn from; empty for a generator without any.
    bic
        Bayesian information criterion by number of Gaussians; lower is better.
    components
        Number of Gaussians that was used, a bridging one among them.
    method
        Method of the embedding, which names the coordinates.
    """
    figure = new_figure(11.0, 6.6)
    grid = figure.add_gridspec(2, 2, width_ratios=[1.9, 1.0])
    plane, curve, shares = (figure.add_subplot(grid[cell]) for cell in _CELLS)
    draw_plane(plane, training, generated, gaussians)
    frame_axes(plane, method)
    legend_below(plane, 4)
    name_gaussians(plane, gaussians)
    _draw_bic(curve, bic or {}, components, bridged=any(g.bridges for g in gaussians))
    _draw_alpha(shares, generated)
    return figure


_MOST_NAMES = 4
_USED = "#e69f00"
_CELLS = ((slice(None), 0), (0, 1), (1, 1))
# α is a fraction n/N. With bins of this width, one of them around 1/2, no fraction with N up to 16
# lies on an edge, each bin holds about as many fractions, and α and 1 − α are treated alike.
_BINS, _BIN = 9, 0.106
_ALPHA_EDGES = 0.5 + _BIN * (np.arange(_BINS + 1) - _BINS / 2)


def draw_plane(
    axes: Axes,
    training: pd.DataFrame,
    generated: pd.DataFrame,
    gaussians: Sequence[Gaussian],
    *,
    counted: bool = True,
) -> None:
    """Draw training designs faintly, generated ones by mode, and the Gaussians' ellipses.

    The legend says how many of each there are, if they are to be counted.
    """
    label = f"training ({len(training):,})" if counted else "training"
    draw_background(axes, training[["z1", "z2"]].to_numpy(), label)
    scatter_modes(axes, generated, "z1", "z2", size=13, alpha=0.85, counted=counted)
    for gaussian in gaussians:
        draw_gaussian(axes, gaussian, (1.0, 2.0))
    axes.autoscale_view()
    axes.set_title(f"{len(generated):,} generated designs, by mode")


def name_gaussians(axes: Axes, gaussians: Sequence[Gaussian]) -> None:
    """Write its weight above each outer ellipse; the bridging Gaussian is named below its own."""
    for gaussian in gaussians:
        if gaussian.bridges:
            _write_at_ellipse(axes, gaussian, f"bridging Gaussian, {gaussian.weight:.0%}", -1)
        elif len(gaussians) <= _MOST_NAMES:
            _write_at_ellipse(axes, gaussian, f"Gaussian, {gaussian.weight:.0%}", 1)


def _write_at_ellipse(axes: Axes, gaussian: Gaussian, text: str, side: int) -> None:
    height = 2.0 * np.sqrt(gaussian.covariance[1, 1])
    axes.annotate(
        text,
        (float(gaussian.mean[0]), float(gaussian.mean[1] + side * height)),
        xytext=(0, 5 * side),
        textcoords="offset points",
        ha="center",
        va="bottom" if side > 0 else "top",
        color=INK,
        fontweight="bold" if gaussian.bridges else "normal",
        bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "alpha": 0.75, "linewidth": 0},
        zorder=6,
    )


def _draw_bic(
    axes: Axes, bic: Mapping[int, float], components: int | None, *, bridged: bool
) -> None:
    """Draw the criterion of EM; a bridging Gaussian is not fitted, and so not on the curve."""
    axes.set_title("how many Gaussians: BIC, lower is better")
    if not bic:
        _say(axes, "this generator has no Gaussians to count")
        return
    counts = np.array(sorted(bic))
    values = np.array([bic[int(count)] for count in counts]) / 1000.0
    axes.plot(counts, values, "o-", color=FAINT, markersize=4, linewidth=1.2)
    axes.set(xlabel="Gaussians K", ylabel="BIC, thousands")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    least = int(counts[values.argmin()])
    _mark(axes, (least, values.min()), "v", INK, f"least: K = {least}")
    fitted = None if components is None else components - bridged
    if fitted is not None and fitted in bic:
        value = values[counts == fitted][0]
        label = f"used: K = {fitted}{' + bridge' if bridged else ''}"
        _mark(axes, (fitted, value), "o", _USED, label)


def _mark(axes: Axes, at: tuple[int, float], marker: str, colour: str, label: str) -> None:
    axes.plot(*at, marker, color=colour, markersize=8, linestyle="", label=label)
    axes.legend(loc="best")


def _draw_alpha(axes: Axes, generated: pd.DataFrame) -> None:
    mixed = generated.loc[generated["mode"] == "mixed", "alpha"].to_numpy(dtype=np.float64)
    axes.set_title(f"α of the mixed designs ({_share(len(mixed), len(generated))})")
    if len(mixed) == 0:
        _say(axes, f"no mixed design among {len(generated):,}")
        return
    axes.hist(
        mixed, bins=_ALPHA_EDGES.tolist(), color=MODE_LOOKS["mixed"].colour, edgecolor="white"
    )
    axes.set(xlabel="share of helical chambers α", ylabel="designs", xlim=(0.0, 1.0))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))


def _share(part: int, whole: int) -> str:
    return f"{number(100.0 * part / whole, 0)} % of all" if whole else "none"


def _say(axes: Axes, text: str) -> None:
    axes.set_axis_off()
    axes.text(0.5, 0.5, text, ha="center", va="center", color=FAINT, transform=axes.transAxes)
