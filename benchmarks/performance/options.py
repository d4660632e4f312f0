"""Options that the commands share, and the command that a section names."""

from __future__ import annotations

import argparse
import shlex
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from robustness.sizes import sized

from pagd import config as configuration
from pagd.catalogue import NamedDesign, read_designs
from pagd.errors import InputError
from performance.runs import Measured

__all__ = [
    "add_common",
    "add_examples",
    "command_of",
    "example_designs",
    "free_config",
    "measured_in",
    "must_be_positive",
    "must_not_be_negative",
]

#: Options that say how a command is run and not what it prints.
_OF_THE_RUN = ("out", "time_limit", "anew")


def add_common(parser: argparse.ArgumentParser) -> None:
    """Add ``--page``, ``--config``, ``--out``, ``--time-limit`` and ``--anew``."""
    add = parser.add_argument
    add("--page", type=Path, help="page whose section is replaced; printed unless given")
    add("--config", help="file or JSON text: meshers, element, contact, material …")
    add(
        "--out",
        type=Path,
        default=Path("results/benchmarks"),
        help="folder of kept measurements and pictures (default: %(default)s)",
    )
    add(
        "--time-limit",
        type=float,
        default=7200.0,
        metavar="SECONDS",
        help="a run that takes longer is ended (default: %(default)g)",
    )
    add("--anew", action="store_true", help="measure again what is kept from an earlier run")


def add_examples(parser: argparse.ArgumentParser) -> None:
    """Add ``--designs``, all of Table 2 unless given, and ``--page``."""
    names = list(example_designs())
    parser.add_argument("--designs", nargs="+", choices=names, default=names, help="of Table 2")
    parser.add_argument("--page", type=Path, help="page whose section is replaced")


def command_of(
    script: str, given: Mapping[str, Any], usual: Mapping[str, Any], mode: str | None = None
) -> str:
    """Return the command that prints the same again: with every option that is not as usual.

    Parameters
    ----------
    script
        Path of the script.
    given, usual
        Options as they are and as they are by default.
    mode
        First argument of the script, if it takes one.
    """
    words = ["python", script, *([mode] if mode else [])]
    for name, value in given.items():
        if name in _OF_THE_RUN or name == "mode" or value == usual.get(name):
            continue
        words.append(f"--{name.replace('_', '-')}")
        words += [_text(one) for one in (value if isinstance(value, list) else [value])]
    return " ".join(words)


def measured_in(options: argparse.Namespace, name: str) -> Measured:
    """Return the folder of kept runs of a benchmark.

    Raises
    ------
    InputError
        If the time limit is not greater than 0.
    """
    must_be_positive({"time-limit": options.time_limit})
    return Measured(options.out / name, options.time_limit, options.anew)


def must_be_positive(values: Mapping[str, float | Iterable[float]]) -> None:
    """Refuse options (names without dashes) that are not greater than 0, with ``InputError``."""
    for name, value in values.items():
        for one in value if isinstance(value, Iterable) else (value,):
            if not one > 0:
                raise InputError(f"--{name} = {one:g} must be greater than 0.")


def example_designs() -> dict[str, NamedDesign]:
    """Return the designs of the paper's Table 2 by name."""
    return read_designs({"table2": configuration.packaged_tables()["table2"]})


def free_config(
    source: str | None, *, size_mm: float, pressure_kPa: float, step_kPa: float | None = None
) -> configuration.Config:
    """Return a completed configuration of a free actuation alone.

    Parameters
    ----------
    source
        Configuration that the rest is taken from: file, JSON text, or None for all defaults.
    size_mm
        Mesh size, of whichever mesher.
    pressure_kPa
        Last pressure.
    step_kPa
        Pressure between recorded states; the last pressure alone unless given.
    """
    config = sized(configuration.load(source), size_mm)
    config["solve"] |= {
        "maximum_pressure_kPa": pressure_kPa,
        "recorded_step_kPa": step_kPa or pressure_kPa,
        "blocked_force": "none",
        # What is looked at is an iteration of the whole model, and what it costs along its path.
        "first_guess": "path",
    }
    return config


def _text(value: Any) -> str:
    return shlex.quote(f"{value:.12g}" if isinstance(value, float) else str(value))


def must_not_be_negative(numbers: Mapping[str, float]) -> None:
    """Refuse options, by name, that are less than 0, in one sentence (``InputError``)."""
    for name, number in numbers.items():
        if not number >= 0:
            raise InputError(f"--{name} = {number:g} must be at least 0.")
