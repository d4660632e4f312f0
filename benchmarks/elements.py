"""Elements and mesh sizes: error of the tip and seconds, in one table.

    python benchmarks/elements.py [--designs bending twisting mixed] [--pressures 10 50]
        [--tetrahedra 6 4 3] [--element-pressure 6 4 3] [--hexahedra 6 4 3 2]
        [--halved-tetrahedra 4] [--halved-hexahedra 6] [--order P] [--config JSON]
        [--page docs/performance.md] [--out results/benchmarks] [--time-limit 7200] [--anew]

Every analysis has a process and a thread of its own; its figures are kept in elements/ in the
folder of --out, so that a command that is repeated goes on where it was. Give nothing else to do
to the machine meanwhile.
"""

from __future__ import annotations

import argparse
import sys

from performance import elements
from performance.element_page import Solved, text_of
from performance.elements import Case
from performance.options import (
    add_common,
    command_of,
    example_designs,
    measured_in,
    must_be_positive,
)
from performance.origin import origin_lines
from performance.page import must_have_section, publish
from performance.runs import Measured

from pagd.errors import InputError

_SECTION = "elements"

#: Families with a mesh that is halved for the limit, and its usual size in mm.
_HALVED = {"tetrahedra": 4.0, "hexahedra": 6.0}


def main() -> None:
    """Run what is not kept yet, and print the section or write it to the page."""
    parser = _parser()
    options = parser.parse_args()
    try:
        _check(options)
        must_have_section(options.page, _SECTION)
        measured = measured_in(options, _SECTION)
        cases: dict[Case, Solved] = {}
        commits: set[str | None] = set()
        for case in _cases(options):
            cases[case], made = _solved(case, measured, options)
            commits |= made
        usual = vars(_parser().parse_args([]))
        first = origin_lines(
            command_of("benchmarks/elements.py", vars(options), usual), commits=commits
        )
        text = text_of(cases, is_given=options.order is not None)
        publish(options.page, _SECTION, f"{first}\n\n{text}")
    except InputError as error:
        parser.error(str(error))
    except KeyboardInterrupt:
        sys.exit("interrupted; the same command goes on from here")


def _check(options: argparse.Namespace) -> None:
    sizes = {key.replace("_", "-"): getattr(options, key) for key in elements.FAMILIES}
    order = [] if options.order is None else [options.order]
    must_be_positive({**sizes, "pressures": options.pressures, "order": order})
    for key in _HALVED:
        if not (size := getattr(options, f"halved_{key}")) >= 0:
            raise InputError(f"--halved-{key} = {size:g} must be at least 0.")


def _cases(options: argparse.Namespace) -> list[Case]:
    designs = example_designs()
    sizes = {key: tuple(sorted(getattr(options, key), reverse=True)) for key in elements.FAMILIES}
    halves = {key: size for key in _HALVED if (size := getattr(options, f"halved_{key}"))}
    return [
        Case(designs[name], pressure, sizes, halves)
        for name in options.designs
        for pressure in options.pressures
    ]


def _solved(
    case: Case, measured: Measured, options: argparse.Namespace
) -> tuple[Solved, set[str | None]]:
    """The points of a case, and the commits that they are of."""
    runs = elements.runs_of(case, options.config)
    print(f"{case.title}: {len(runs)} meshes", file=sys.stderr, flush=True)
    by_label = measured.of(list(runs.values()))
    found = {key: by_label[run.label] for key, run in runs.items()}
    order = options.order or elements.order_of(case, found)
    solved = Solved(elements.points_of(case, found, order), order)
    return solved, {one.commit for one in found.values()}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add, names = parser.add_argument, list(example_designs())
    add("--designs", nargs="+", choices=names, default=names, help="default: all three")
    _add_numbers(parser, "--pressures", [10.0, 50.0], "last pressures in kPa")
    for key, sizes in (
        ("tetrahedra", [6.0, 4.0, 3.0]),
        ("element-pressure", [6.0, 4.0, 3.0]),
        ("hexahedra", [6.0, 4.0, 3.0, 2.0]),
    ):
        family = elements.FAMILIES[key.replace("-", "_")]
        _add_numbers(parser, f"--{key}", sizes, f"mesh sizes in mm, {family.name}")
    for key, size in _HALVED.items():
        add(
            f"--halved-{key}",
            type=float,
            default=size,
            help=f"size of the mesh of {key} that is solved with every edge halved too, for the "
            "limit; 0: none (default: %(default)g)",
        )
    add(
        "--order",
        type=float,
        metavar="P",
        help="of the error (default: that with which both kinds of elements have the same limit)",
    )
    add_common(parser)
    return parser


def _add_numbers(
    parser: argparse.ArgumentParser, name: str, default: list[float], said: str
) -> None:
    text = f"{said} (default: {' '.join(f'{one:g}' for one in default)})"
    parser.add_argument(name, type=float, nargs="*", default=default, help=text)


if __name__ == "__main__":
    main()
