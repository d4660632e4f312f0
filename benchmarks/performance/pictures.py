"""The tables of growth as pictures, PNG files beside the kept measurements."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.ticker import LogFormatter

from pagd.figures.style import FAINT, new_figure, save
from performance.chambers import powers_of
from performance.cores import Crew, Throughput
from performance.parts import parts_of, per_iteration
from performance.runs import Measurement

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["draw_chambers", "draw_cores", "draw_unknowns"]

_SIZE = (11.0, 3.6)

#: Parts of the time that are drawn, where they are known.
_PARTS = ("all", "factorisation", "assembly", "solution", "mesh", "rest")


def draw_unknowns(series: Mapping[float, Measurement], out: Path) -> None:
    """Draw seconds by part, and memory, against unknowns."""
    figures = [one.figures for one in series.values() if one.is_complete]
    unknowns = [one["unknowns"] for one in figures]
    figure = new_figure(*_SIZE)
    times, memory = figure.subplots(1, 2)
    parts = [parts_of(one) for one in figures]
    for part in _PARTS:
        _curve(times, unknowns, [one[part] for one in parts], part)
    _curve(memory, unknowns, [one["peak_memory_MB"] for one in figures], "peak memory")
    _dress(times, unknowns, ("unknowns", "core-seconds", "Time of the whole process"))
    _dress(memory, unknowns, ("unknowns", "MB", "Peak memory"))
    _explain(times)
    save(figure, out)


def draw_chambers(series: Mapping[int, Measurement], out: Path) -> None:
    """Draw the time of an iteration and of its parts, and what fills the factor, against N."""
    complete = {number: one.figures for number, one in series.items() if one.is_complete}
    figure = new_figure(*_SIZE)
    times, factors = figure.subplots(1, 2)
    each = [per_iteration(one) for one in complete.values()]
    for part in ("free actuation", "factorisation", "assembly", "solution"):
        name = "iteration" if part == "free actuation" else part
        _curve(times, list(complete), [one[part] for one in each], name)
    _curve(factors, list(complete), [one["unknowns"] for one in complete.values()], "unknowns")
    nonzeros = [one.get("factor_nonzeros") for one in complete.values()]
    _curve(factors, list(complete), nonzeros, "factor non-zeros")
    power = powers_of(series).get("time of an iteration")
    title = "Newton iteration" + ("" if power is None else f": time ∝ N to the {power:.2f}")
    _dress(times, list(complete), ("chambers N", "core-seconds", title))
    _dress(factors, list(complete), ("chambers N", "number", "Size of the system"))
    _explain(times)
    _explain(factors)
    save(figure, out)


def draw_cores(found: Mapping[Crew, Throughput], out: Path) -> None:
    """Draw designs an hour against cores, with the line of equal efficiency."""
    figure = new_figure(_SIZE[0] / 2, _SIZE[1])
    axes = figure.subplots()
    alone = {crew: each for crew, each in found.items() if crew.threads == 1}
    cores = [crew.cores for crew in alone]
    axes.plot(cores, [each.per_hour for each in alone.values()], "o-", label="one thread each")
    for crew, each in found.items():
        if crew.threads > 1:
            label = f"one process, {crew.threads} threads"
            axes.plot([crew.cores], [each.per_hour], "D", label=label)
    first = next(iter(alone.values())).per_hour
    axes.plot(cores, [first * one for one in cores], "--", color=FAINT, label="in proportion")
    axes.set(xlabel="cores", ylabel="designs an hour", title="Designs at once", ylim=(0, None))
    axes.set_xticks(cores)
    axes.legend()
    save(figure, out)


def _curve(axes: Axes, x: Sequence[float], y: Sequence[Any], label: str) -> None:
    if y and all(y):
        axes.plot(x, y, "o-", label=label)


def _dress(axes: Axes, x: Sequence[float], said: tuple[str, str, str]) -> None:
    """Logarithmic axes with plain numbers, those along at what was measured."""
    along, up, title = said
    axes.set(xlabel=along, ylabel=up, title=title, xscale="log", yscale="log")
    axes.set_xticks(x, [f"{value:,.0f}" for value in x])
    axes.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
    axes.yaxis.set_major_formatter("{x:,g}")
    axes.yaxis.set_minor_formatter(LogFormatter(minor_thresholds=(1.5, 0.5)))


def _explain(axes: Axes) -> None:
    """Say beside the axes which line is which."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
