"""How the cost of a design grows.

    python benchmarks/growth.py unknowns [--design bending] [--sizes 5 3 2 1.5] [--pressure 10]
    python benchmarks/growth.py chambers [--design twisting] [--chambers 6 9 12 16 20 24]
        [--size 5] [--pressure 10]
    python benchmarks/growth.py cores [--design bending] [--size 5] [--pressure 10] [--each 4]
        [--cores N]

All with [--config JSON] [--page docs/performance.md] [--out results/benchmarks]
[--time-limit 7200] [--anew]. Every analysis has a process and a thread of its own; what is
measured is kept, and a command that is repeated goes on where it was. Give nothing else to do to
the machine meanwhile. Each also draws a picture: growth-unknowns.png, growth-chambers.png,
growth-cores.png in the folder of --out.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Iterable
from typing import Any

from performance import chambers, cores, pictures, unknowns
from performance.options import (
    add_common,
    command_of,
    example_designs,
    free_config,
    measured_in,
    must_be_positive,
)
from performance.origin import origin_lines
from performance.page import must_have_section, publish
from performance.runs import Run

from pagd.catalogue import NamedDesign
from pagd.errors import InputError

_NAME = "growth"


def main() -> None:
    """Measure what is not kept yet, draw it, and print the section or write it to the page."""
    parser = _parser()
    options = parser.parse_args()
    try:
        must_have_section(options.page, options.mode)
        text, commits = _MODES[options.mode](options)
        usual = vars(_parser().parse_args([options.mode]))
        command = command_of("benchmarks/growth.py", vars(options), usual, options.mode)
        first = origin_lines(command, commits=commits)
        publish(options.page, options.mode, f"{first}\n\n{text}")
    except InputError as error:
        parser.error(str(error))
    except KeyboardInterrupt:
        sys.exit("interrupted; the same command goes on from here")


Section = tuple[str, Iterable[str | None]]


def _unknowns(options: argparse.Namespace) -> Section:
    must_be_positive({"sizes": options.sizes, "pressure": options.pressure})
    named = _design(options)
    runs = {size: _run(named, options, size) for size in sorted(options.sizes, reverse=True)}
    found = measured_in(options, _NAME).of(list(runs.values()))
    series = {size: found[run.label] for size, run in runs.items()}
    if any(one.is_complete for one in series.values()):
        pictures.draw_unknowns(series, options.out / "growth-unknowns.png")
    text = unknowns.text_of(series, options.design, options.pressure)
    return text, [one.commit for one in series.values()]


def _chambers(options: argparse.Namespace) -> Section:
    must_be_positive({key: getattr(options, key) for key in ("chambers", "size", "pressure")})
    named = _design(options)
    runs = {
        number: _run(chambers.with_chambers(named, number), options, options.size)
        for number in sorted(options.chambers)
    }
    found = measured_in(options, _NAME).of(list(runs.values()))
    series = {number: found[run.label] for number, run in runs.items()}
    if any(one.is_complete for one in series.values()):
        pictures.draw_chambers(series, options.out / "growth-chambers.png")
    text = chambers.text_of(series, options.design, options.size, options.pressure)
    return text, [one.commit for one in series.values()]


def _cores(options: argparse.Namespace) -> Section:
    must_be_positive({key: getattr(options, key) for key in ("cores", "each", "size", "pressure")})
    named, folder = _design(options), measured_in(options, _NAME)
    config = free_config(options.config, size_mm=options.size, pressure_kPa=options.pressure)
    found = {
        crew: cores.throughput_of(
            *(crew, named, config, options.each, folder.folder),
            limit_s=folder.limit_s,
            anew=folder.anew,
        )
        for crew in cores.crews_of(options.cores)
    }
    pictures.draw_cores(found, options.out / "growth-cores.png")
    return cores.text_of(found, options.design, config), [one.commit for one in found.values()]


_MODES: dict[str, Callable[[argparse.Namespace], Section]] = {
    "unknowns": _unknowns,
    "chambers": _chambers,
    "cores": _cores,
}


def _design(options: argparse.Namespace) -> NamedDesign:
    return example_designs()[options.design]


def _run(named: NamedDesign, options: argparse.Namespace, size: float) -> Run:
    config = free_config(options.config, size_mm=size, pressure_kPa=options.pressure)
    return Run(f"{named.name}-{size:g}mm-{options.pressure:g}kPa", named, config)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    modes = parser.add_subparsers(dest="mode", required=True)
    by_unknowns = modes.add_parser("unknowns", help="time and memory against unknowns")
    by_chambers = modes.add_parser("chambers", help="time against the number of chambers")
    by_cores = modes.add_parser("cores", help="designs at once against cores")
    _add(by_unknowns, "--sizes", [5.0, 3.0, 2.0, 1.5], "mesh sizes in mm", nargs="+")
    _add(by_chambers, "--chambers", [6, 9, 12, 16, 20, 24], "numbers of chambers", nargs="+")
    _add(by_cores, "--cores", os.cpu_count() or 1, "up to so many processes at once")
    _add(by_cores, "--each", 4, "designs a process")
    for one, design in ((by_unknowns, "bending"), (by_chambers, "twisting"), (by_cores, "bending")):
        names = sorted(example_designs())
        one.add_argument("--design", choices=names, default=design, help="default: %(default)s")
        _add(one, "--pressure", 10.0, "last pressure in kPa")
        add_common(one)
    for one in (by_chambers, by_cores):
        _add(one, "--size", 5.0, "mesh size in mm")
    return parser


def _add(parser: argparse.ArgumentParser, name: str, default: Any, said: str, **more: Any) -> None:
    first = default[0] if isinstance(default, list) else default
    shown = " ".join(map(str, default)) if isinstance(default, list) else default
    text = f"{said} (default: {shown})"
    parser.add_argument(name, type=type(first), default=default, help=text, **more)


if __name__ == "__main__":
    main()
