"""The arguments of the generative half: data set, embedding, generator, diversity, selection."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from pagd.cli.arguments import (
    add_command,
    add_config,
    add_folder,
    add_materials,
    add_out,
    add_verbose,
    override,
)
from pagd.design import MODES

__all__ = ["add_generative"]

_GENERATORS = ("gmm", "gmm_plain", "gmm_full", "kde", "random", "resample")


def add_generative(commands: Any) -> None:
    """Add the subcommands that work on many designs at once."""
    _add_dataset(commands)
    _add_embed(commands)
    _add_generate(commands)
    _add_diversity(commands)
    _add_select(commands)
    _add_screen(commands)
    _add_sample(commands)


def _add_dataset(commands: Any) -> None:
    command = add_command(
        commands, "dataset", "generative:dataset", "training designs: random, and around known ones"
    )
    group = _overrides(command)
    override(group, "dataset", "size", int, "number of designs")
    override(group, "dataset", "sampling", str, "random, sobol or latin_hypercube")
    override(group, "dataset", "seed", int, "seed of all draws")
    _add_set_options(command)


def _add_embed(commands: Any) -> None:
    command = add_command(
        commands, "embed", "generative:embed", "training designs → places in a reduced space"
    )
    add_folder(command, "dataset", required=True)
    group = _overrides(command)
    override(group, "embedding", "method", str, "tsne, pca or none")
    override(group, "embedding", "perplexity", float, "effective number of neighbours in t-SNE")
    override(group, "embedding", "seed", int, "seed of t-SNE")
    _add_threads(command)
    _add_set_options(command)


def _add_generate(commands: Any) -> None:
    command = add_command(
        commands,
        "generate",
        "generative:generate",
        "new designs, all of them buildable and none a copy",
    )
    # Without them they are made, in the folder of the command.
    add_folder(command, "dataset", required=False)
    add_folder(command, "embedding", required=False)
    command.add_argument(
        "--mode",
        choices=MODES,
        help="take designs of this mode only (default: as they come)",
    )
    group = _overrides(command)
    for names, key, kind, metavar, text in (
        (("-n", "--designs"), "designs", int, "N", "number of designs"),
        (
            ("--generator",),
            "method",
            str,
            "NAME",
            "gmm, gmm_plain, gmm_full, kde, random or resample",
        ),
        (("--seed",), "seed", int, "NUMBER", "seed of the fit and the draws"),
    ):
        group.add_argument(*names, dest=f"generator.{key}", type=kind, metavar=metavar, help=text)
    _add_threads(command)
    _add_set_options(command)


def _add_diversity(commands: Any) -> None:
    command = add_command(
        commands,
        "diversity",
        "generative:diversity",
        "how new and varied generated designs are",
    )
    for stage in ("dataset", "embedding", "generated"):
        add_folder(command, stage, required=True)
    override(_overrides(command), "diversity", "seed", int, "seed of all draws")
    _add_threads(command)
    _add_set_options(command)


def _add_select(commands: Any) -> None:
    command = add_command(
        commands,
        "select",
        "generative:select",
        "generated designs to simulate, far from each other",
    )
    for stage in ("dataset", "generated"):
        add_folder(command, stage, required=True)
    group = _overrides(command)
    group.add_argument(
        "-n", "--designs", dest="selection.designs", type=int, metavar="N", help="number of designs"
    )
    override(group, "selection", "seed", int, "seed of the first choice")
    _add_set_options(command)


def _add_screen(commands: Any) -> None:
    command = add_command(
        commands,
        "screen",
        "generative:screen",
        "performance of a table of designs, by single chambers",
    )
    command.add_argument(
        "designs",
        type=Path,
        metavar="TABLE",
        help="table of designs: CSV, or Parquet as pagd writes it",
    )
    command.add_argument(
        "--fidelity",
        choices=("cells", "pieces", "gated"),
        default="cells",
        help="cells alone; pieces: the ends too, and where chambers change, nearer to the full"
        " model; gated: the simplest one that is trusted, up to the full model (default: cells)",
    )
    command.add_argument(
        "--processes",
        type=int,
        default=1,
        metavar="N",
        help="designs at once, with one thread each (default: 1)",
    )
    command.add_argument(
        "--part",
        type=_part,
        default=(1, 1),
        metavar="K/N",
        help="only the K-th of N parts that N jobs share, each a sample of all (default: 1/1)",
    )
    add_materials(command)
    _add_set_options(command)


def _add_sample(commands: Any) -> None:
    command = add_command(
        commands, "sample", "generative:sample", "random designs of a family, as a table"
    )
    command.add_argument(
        "--family", required=True, metavar="NAME", help="half_bellows, pneunet or module:class"
    )
    command.add_argument(
        "-n", "--designs", type=int, default=100, metavar="N", help="how many (default: 100)"
    )
    command.add_argument("--seed", type=int, default=1, metavar="N", help="of all draws (1)")
    command.add_argument(
        "--sampling",
        default="random",
        metavar="NAME",
        help="random, sobol or latin_hypercube (default: random)",
    )
    command.add_argument("--out", type=Path, required=True, metavar="FILE", help="CSV to write")
    add_config(command)
    add_verbose(command)


def _part(text: str) -> tuple[int, int]:
    """The two numbers of K/N."""
    try:
        number, count = (int(word) for word in text.split("/"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form K/N, as 2/10") from None
    if not 1 <= number <= count:
        raise argparse.ArgumentTypeError(f"{text!r}: K must be from 1 to N")
    return number, count


def _overrides(command: argparse.ArgumentParser) -> Any:
    return command.add_argument_group("instead of the configuration's values")


def _add_threads(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--threads", type=int, default=1, metavar="N", help="threads of t-SNE (default: 1)"
    )


def _add_set_options(command: argparse.ArgumentParser) -> None:
    add_out(command)
    add_config(command)
    add_verbose(command)
