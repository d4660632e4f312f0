"""The first two lines of a section: the command that prints it again, and what it ran on."""

from __future__ import annotations

import importlib.metadata
import platform
from collections.abc import Iterable, Mapping

from robustness.machine import machine
from robustness.study import commit

from pagd import __version__
from performance.page import wrapped

__all__ = ["LIBRARIES", "origin_lines", "ran_on"]

#: Packages that the time of an analysis depends on.
LIBRARIES = ("gmsh", "mkl", "numba", "numpy", "pypardiso", "scipy")

_LONGEST_COMMAND = 98


def origin_lines(
    command: str, libraries: Iterable[str] = LIBRARIES, commits: Iterable[str | None] = ()
) -> str:
    """Return how a section begins: its command, then machine, versions and commit.

    Parameters
    ----------
    command
        That prints the section again, with all options that change it.
    libraries
        Packages whose versions are named, those that are installed.
    commits
        Of the repository, that the figures are of, where they were kept; the one at hand else.
    """
    named = {name: _installed(name) for name in libraries}
    versions = {name: version for name, version in named.items() if version}
    return f"{_shown(command)}\n\n{wrapped(ran_on(versions, commits))}"


def ran_on(versions: Mapping[str, str], commits: Iterable[str | None] = ()) -> str:
    """Return one sentence each of the machine, the versions and the commit."""
    here = machine((), 1)
    known = sorted({one or "unknown" for one in commits}) or [commit() or "unknown"]
    told = {"pagd": __version__, "python": platform.python_version(), **versions}
    return (
        f"{here['processor']}, {here['cores']} cores, {here['memory_GB']:.0f} GB, "
        f"{here['system']}. {', '.join(f'{name} {told[name]}' for name in sorted(told))}. "
        f"Commit {', '.join(known)}."
    )


def _shown(command: str) -> str:
    """A command as code, an option a line where it would be too long for one."""
    if len(command) <= _LONGEST_COMMAND:
        return f"`{command}`"
    return "```sh\n" + command.replace(" --", " \\\n  --") + "\n```"


def _installed(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None
