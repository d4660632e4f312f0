"""Arguments that several subcommands share."""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pagd.cli.examples import EXAMPLES

if TYPE_CHECKING:
    from pagd.cli.answer import Answer

__all__ = [
    "add_command",
    "add_config",
    "add_folder",
    "add_materials",
    "add_out",
    "add_stage_options",
    "add_verbose",
    "override",
]


def add_command(commands: Any, name: str, handler: str, text: str) -> argparse.ArgumentParser:
    """Add a subcommand; its handler is a function of ``commands``, or ``module:function``."""
    command: argparse.ArgumentParser = commands.add_parser(
        name,
        help=text,
        description=text[0].upper() + text[1:] + ".",
        epilog=f"example:\n  {EXAMPLES[name]}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    command.set_defaults(handler=_lazy(handler), parser=command)
    command.add_argument(
        "--json",
        action="store_true",
        help="one JSON document to stdout, all else to stderr",
    )
    return command


def _lazy(handler: str) -> Callable[[argparse.Namespace], Answer]:
    home, _, function = handler.rpartition(":")

    def call(options: argparse.Namespace) -> Answer:
        module = importlib.import_module(f"pagd.cli.{home or 'commands'}")
        answer: Answer = getattr(module, function)(options)
        return answer

    return call


def add_folder(command: argparse.ArgumentParser, stage: str, *, required: bool) -> None:
    """Add the option that names the folder of a stage before."""
    command.add_argument(
        f"--{stage}", type=Path, required=required, metavar="DIR", help=f"folder of stage {stage}"
    )


def override(group: Any, section: str, key: str, kind: type, text: str) -> None:
    """Add an option that stands for a key of the configuration."""
    option = f"--{key.replace('_', '-')}"
    metavar = "NAME" if kind is str else "NUMBER"
    group.add_argument(option, dest=f"{section}.{key}", type=kind, metavar=metavar, help=text)


def add_materials(command: argparse.ArgumentParser) -> Any:
    """Add materials and pressure; return the group for more."""
    group = command.add_argument_group("analysis (instead of the configuration's values)")
    for use, what in (("material", "elastomer"), ("paper", "sheet in the base")):
        group.add_argument(
            f"--{use}",
            metavar="NAME",
            help=f"{what}: a name in the file of materials, or a JSON entry with a name",
        )
    group.add_argument(
        "--material-file", metavar="FILE", help="file of materials (default: pagd's own)"
    )
    group.add_argument(
        "--pressure-kPa",
        dest="solve.maximum_pressure_kPa",
        type=float,
        metavar="P",
        help="pressure at the end",
    )
    return group


def add_stage_options(command: argparse.ArgumentParser) -> None:
    """Add what every stage of one design takes."""
    add_out(command)
    command.add_argument(
        "--keep-going",
        action="store_true",
        help="exit with 0 also when the design fails as designs may: its record tells",
    )
    add_config(command)
    add_verbose(command)
    _add_limits(command)


def _add_limits(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--allotted",
        nargs=3,
        type=float,
        metavar=("MIN", "MB", "TRIES"),
        help="minutes and memory of the job, of which the stage may take nine tenths and all but "
        "500 MB; beyond them the design has failed or, if tries with more are to follow, the exit "
        "code is 75",
    )


def add_out(command: argparse.ArgumentParser) -> None:
    """Add the option of the stage's own folder."""
    command.add_argument(
        "--out", type=Path, required=True, metavar="DIR", help="folder to make or replace"
    )


def add_config(command: argparse.ArgumentParser) -> None:
    """Add the option of the configuration."""
    command.add_argument(
        "--config",
        metavar="FILE",
        help="configuration: a YAML file or JSON text; what it lacks keeps its default, of "
        "config/README.md",
    )


def add_verbose(command: argparse.ArgumentParser) -> None:
    """Add the option to say more."""
    command.add_argument("-v", "--verbose", action="store_true", help="say more")
