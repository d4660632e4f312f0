"""Picture of a design's pressure over the volume of its cavity, limit points and work included."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from pagd.figures.load import Steps, load_history, load_records
from pagd.figures.style import FREE, INK, kilopascals, new_figure, number, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw_pressure_volume", "pressure_volume_figure", "volume_controlled"]

_CONTROLLED, _WORK = "#d55e00", "#cfe2f0"


def draw_pressure_volume(design_folder: Path, out: Path) -> None:
    """Draw the curve of a design to a PNG file; InputError if it was not solved."""
    record = load_records(design_folder).get("solve")
    start = record.figures.get("volume_controlled_from_kPa") if record else None
    save(pressure_volume_figure(design_folder.name, load_history(design_folder), start), out)


def pressure_volume_figure(
    title: str, steps: Steps, controlled_from_kPa: float | None = None
) -> Figure:
    """Return the picture; `controlled_from_kPa` is where control of the volume began, if it did."""
    rest = float(steps.cavity_volume_mm3[0])
    volume, pressure = steps.cavity_volume_mm3 / rest, steps.pressure_kPa
    figure = new_figure(8.5, 4.2)
    axes = figure.add_subplot()
    work = f"work {number(float(steps.work_mJ[-1]), 1)} mJ"
    axes.fill_between(volume, pressure, color=_WORK, linewidth=0.0, label=work)
    axes.plot(volume, pressure, ".-", color=FREE, markersize=4, linewidth=1.4, label="steps")
    later = volume_controlled(pressure, controlled_from_kPa)
    if later is not None:
        label = "steps under control of the volume"
        axes.plot(volume[later], pressure[later], ".-", color=_CONTROLLED, label=label)
    kept = steps.recorded
    axes.plot(volume[kept], pressure[kept], "o", color=INK, markersize=5, label="recorded states")
    _mark_limits(axes, volume, pressure)
    axes.set(
        title=f"{title}: pressure and cavity volume",
        xlabel=f"cavity volume, in multiples of {number(rest, 0)} mm³ without pressure",
        ylabel="pressure, kPa",
    )
    axes.set_ylim(0.0, 1.12 * max(float(pressure.max()), 1e-9))
    figure.legend(loc="outside right upper")
    return figure


def volume_controlled(pressure_kPa: NDArray[np.float64], start_kPa: float | None) -> slice | None:
    """Return the steps under control of the volume, the last one before them included, or None.

    Up to there the pressure has risen: the first step at the pressure is where it began.
    """
    if start_kPa is None:
        return None
    reached = pressure_kPa >= start_kPa - 1e-6 * max(1.0, start_kPa)
    first = int(np.argmax(reached)) if reached.any() else len(pressure_kPa)
    return slice(first, None) if first < len(pressure_kPa) - 1 else None


def _mark_limits(axes: Axes, volume: NDArray[np.float64], pressure: NDArray[np.float64]) -> None:
    from pagd.actuation.limit_points import limit_points  # the package imports the solver

    for i, step in enumerate(limit_points(pressure)):
        label = "limit point" if i == 0 else None
        place = volume[step], pressure[step]
        axes.plot(*place, "v", color=_CONTROLLED, markersize=9, fillstyle="none", label=label)
        axes.annotate(
            kilopascals(pressure[step]),
            place,
            xytext=(0, 9),
            textcoords="offset points",
            ha="center",
            color=_CONTROLLED,
        )
