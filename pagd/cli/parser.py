"""The arguments of every subcommand. Light on purpose: ``pagd --help`` imports nothing heavy."""

from __future__ import annotations

import argparse
import functools

import shtab

from pagd import __version__
from pagd.cli.generative_parser import add_generative
from pagd.cli.results_parser import add_results
from pagd.cli.stages_parser import add_stages
from pagd.cli.usage import Parser

__all__ = ["make_parser"]

_EPILOG = """\
examples:
  pagd design check my_actuator.yaml               can it be built?
  pagd run my_actuator.yaml --out my_actuator      all stages for a design of your own
  pagd view my_actuator                            shape, curves and figures in the browser
  pagd solve my_actuator.yaml --vtu --out solved   as far as the solution, for ParaView too
  pagd mesh --body body.stl --base base.stl --size-mm 3 --out mesh
  pagd solve --mesh mesh --material dragon_skin_30 --pressure-kPa 30 --out solve
  pagd generate --mode mixed -n 100 --out mixed    new designs that bend and twist
  pagd screen mixed/designs.parquet --out screened what they would do, approximately
  pagd status                                      how far a run of the workflow is

`pagd COMMAND --help` tells all options of a command, with an example.

exit codes: 0 done, 1 the design failed (its record says why) or a check has found something,
2 bad input, 70 a fault of pagd, 75 the machine failed (disk, memory, time): the same may succeed
later, 130 interrupted
"""


# Heading to subcommands, in the order in which somebody new has use for them.
_HEADINGS = {
    "one design": ("run", "design"),
    "its stages, one by one": (
        "geometry",
        "repair",
        "mesh",
        "solve",
        "metrics",
        "figures",
        "export",
        "deck",
    ),
    "results of designs": ("view", "report", "summary"),
    "new designs": ("dataset", "embed", "generate", "diversity", "select", "sample"),
    "many designs, approximately": ("screen",),
    "runs of the workflow": ("status", "audit"),
    "public data sets": ("archive", "check-archive"),
}


@functools.cache
def make_parser() -> Parser:
    """Return the parser; each subcommand carries its ``handler(options) -> Answer``."""
    parser = Parser(
        prog="pagd",
        description="Design and simulate soft pneumatic actuators, from parameters to "
        "trajectories.\nUnits are mm, N, MPa; kPa and degrees where the name says so.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.headings = _HEADINGS
    parser.add_argument("--version", action="version", version=f"pagd {__version__}")
    shtab.add_argument_to(
        parser, "--print-completion", help="print what makes a shell complete words, and end"
    )
    commands = parser.add_subparsers(metavar="command", required=True)
    add_stages(commands)
    add_results(commands)
    add_generative(commands)
    return parser
