"""What the options of a subcommand say together: the configuration, a number of threads."""

from __future__ import annotations

from argparse import Namespace
from typing import Any

from pagd import config as configuration
from pagd.errors import InputError
from pagd.limits import Limits

__all__ = ["checked_threads", "config_of", "design_of", "limits_of", "refuse_beside"]

# Of what a job has been allotted, what is around the stage takes the rest: pagd itself, and on a
# cluster Snakemake twice.
_SHARE_OF_TIME = 0.9
_AROUND_MB = 500.0


def config_of(options: Namespace) -> dict[str, Any]:
    """Return the configuration, with the options that stand for single keys put in."""
    config = configuration.load(options.config)
    given = {name: value for name, value in vars(options).items() if value is not None}
    for name, value in given.items():
        # The parser names an option that stands for a key of a section "section.key".
        section, _, key = name.rpartition(".")
        if section:
            config[section][key] = value
    if given.get("material_file"):
        config["material_file"] = given["material_file"]
    return configuration.checked(config, "command line")


def checked_threads(count: int, option: str = "--threads") -> int:
    """Return a number of threads or processes; ``InputError`` if it is none."""
    if count < 1:
        raise InputError(f"{option} = {count} must be at least 1.")
    return count


def limits_of(options: Namespace) -> Limits | None:
    """Return the limits for a stage; none where the options tell of nothing allotted."""
    given = vars(options).get("allotted")
    if given is None:
        return None
    minutes, memory, tries = given
    if not (minutes > 0 and memory > 0 and tries >= 0):
        raise InputError(
            f"--allotted = {minutes:g} {memory:g} {tries:g} must be minutes and megabytes greater "
            "than 0, and a number of tries of at least 0."
        )
    return Limits(
        time_s=60 * _SHARE_OF_TIME * minutes,
        memory_MB=max(memory - _AROUND_MB, _AROUND_MB),
        final=tries == 0,
    )


def design_of(options: Namespace) -> str:
    """Return the design, given as an argument or as an option; ``InputError`` unless by one."""
    given = [one for one in (options.design, options.design_option) if one]
    if len(given) != 1:
        raise InputError("a design must be given once: a YAML or JSON file, or JSON text.")
    return str(given[0])


def refuse_beside(options: Namespace, what: str, *names: str) -> None:
    """Refuse options that have no meaning beside ``what`` is given; ``names`` as parsed."""
    for name in names:
        if vars(options)[name]:
            option = f"--{name.rpartition('.')[2].replace('_', '-')}"
            raise InputError(f"{option} has no meaning beside {what}.")
