"""The options of ``benchmarks/peers.py``, and the command that says them again."""

from __future__ import annotations

import argparse
import math
import shlex
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from peers.converged import ORDER

__all__ = ["command_of", "make_parser"]

Handler = Callable[[argparse.Namespace], None]

#: Commands with whole analyses: what they do, sizes of tetrahedra and of blocks (mm), and whether
#: symmetric designs are halved.
_ANALYSES: Mapping[str, tuple[str, list[float], list[float], bool]] = {
    "converged": ("extrapolate the tip over finer meshes", [4], [6], True),
    "same-mesh": ("pagd and CalculiX on the same meshes", [5, 3], [6], False),
    "equal-error": ("CalculiX on finer meshes until it is as good", [5, 3], [6], False),
    "calculix": ("same-mesh, then equal-error", [5, 3], [6], False),
}

#: Options that change neither the figures nor where they are written to.
_SILENT = ("command", "handler", "fresh", "results", "out")


def make_parser(text: str, handlers: Mapping[str, Handler]) -> argparse.ArgumentParser:
    """Return the parser; each subcommand carries its ``handler(options)``."""
    parser = argparse.ArgumentParser(
        description=text, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(dest="command", metavar="command", required=True)
    for name, (what, sizes, blocks, half) in _ANALYSES.items():
        sub = commands.add_parser(name, help=what)
        _add_sizes(sub, sizes, blocks)
        _add_analyses(sub, half)
        if name == "converged":
            # Its hexahedra are nearer to the limit than tetrahedra of as many unknowns.
            sub.set_defaults(mesher=["structured"])
            help_text = "so often every edge is halved (default: %(default)s)"
            sub.add_argument("--halvings", type=int, choices=range(4), default=1, help=help_text)
            help_text = "of the error in the element size (default: %(default).4g)"
            sub.add_argument("--order", type=_positive, default=ORDER, help=help_text)
        if name in ("equal-error", "calculix"):
            help_text = "sizes in mm that CalculiX tries (default: 4 3 2.5 2 1.5)"
            finer = [4.0, 3.0, 2.5, 2.0, 1.5]
            sub.add_argument("--finer", nargs="+", type=_positive, default=finer, help=help_text)
    sub = commands.add_parser("iteration", help="one Newton iteration, beside FElupe and NGSolve")
    _add_iteration(sub)
    for name, sub in commands.choices.items():
        _add_common(sub, page=name != "converged")
        sub.set_defaults(handler=handlers.get(name))
    return parser


def _add_sizes(sub: argparse.ArgumentParser, sizes: list[float], blocks: list[float]) -> None:
    what = {"--sizes": ("tetrahedra", sizes), "--blocks": ("blocks of mesher structured", blocks)}
    for option, (of, usual) in what.items():
        told = f"of the {of} (default: {' '.join(f'{size:g}' for size in usual)})"
        default = [float(size) for size in usual]
        sub.add_argument(
            option, nargs="+", type=_positive, default=default, metavar="MM", help=told
        )


def _add_analyses(sub: argparse.ArgumentParser, half: bool) -> None:
    add = sub.add_argument
    add("--designs", nargs="+", default=["bending", "twisting"], help="of config/table2.csv")
    mesher = "gmsh or structured, or several (default: gmsh; of converged: structured)"
    add("--mesher", nargs="+", default=["gmsh"], metavar="NAME", help=mesher)
    add("--element", help="of pagd (default: that of the configuration)")
    add(
        "--half-model",
        action=argparse.BooleanOptionalAction,
        default=half,
        help="solve half of symmetric designs",
    )
    add("--threads", type=_count, default=2, help="of each program (default: %(default)s)")
    add(
        "--maximum-pressure",
        type=_positive,
        default=50.0,
        metavar="KPA",
        help="pressure at the end (default: %(default)g)",
    )
    add(
        "--time-limit",
        type=_positive,
        default=3600.0,
        metavar="SECONDS",
        help="a run that takes longer is ended (default: %(default)g)",
    )
    repeats = "runs of pagd, of which the median counts (default: %(default)s)"
    add("--repeats", type=_count, default=3, help=repeats)


def _add_iteration(sub: argparse.ArgumentParser) -> None:
    add = sub.add_argument
    add("--design", default="bending", help="of config/table2.csv (default: %(default)s)")
    add("--size", type=_positive, default=5.0, metavar="MM", help="of the mesh (default: 5)")
    add("--threads", nargs="+", type=_count, default=[1, 2], help="(default: 1 2)")
    add(
        "--pressure",
        type=_positive,
        default=0.25,
        metavar="KPA",
        help="of the step from rest (default: %(default)g)",
    )
    add("--iterations", type=_count, default=10, help="of a run (default: %(default)s)")
    add("--repeats", type=_count, default=3, help="of each program (default: %(default)s)")


def _add_common(sub: argparse.ArgumentParser, page: bool) -> None:
    add = sub.add_argument
    add(
        "--results",
        type=Path,
        default=Path("results/benchmarks"),
        metavar="DIR",
        help="folder of all that is kept (default: %(default)s)",
    )
    add("--fresh", action="store_true", help="run again what is kept")
    add("--out", type=Path, metavar="FILE", help="also write all figures as JSON")
    if page:
        add("--page", type=Path, metavar="FILE", help="page whose section is replaced")


def command_of(options: argparse.Namespace) -> str:
    """Return the command with all options that are not as by default."""
    usual = vars(make_parser("", {}).parse_args([options.command]))
    words = ["python benchmarks/peers.py", options.command]
    for name, value in vars(options).items():
        if name in usual and name not in _SILENT and value != usual[name]:
            words += _said(name, value)
    return " ".join(words)


def _said(name: str, value: Any) -> list[str]:
    option = f"--{name.replace('_', '-')}"
    if isinstance(value, bool):
        return [option if value else f"--no-{option[2:]}"]
    values = value if isinstance(value, list) else [value]
    return [option, *(f"{v:g}" if isinstance(v, float) else shlex.quote(str(v)) for v in values)]


def _positive(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value > 0):
        raise argparse.ArgumentTypeError(f"{text} must be greater than 0")
    return value


def _count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} must be at least 1")
    return value
