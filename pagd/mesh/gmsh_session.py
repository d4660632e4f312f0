"""One place that starts and ends gmsh, so that every use sees the same, repeatable state."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

#: Single thread and fixed seed: the same input gives the same mesh on every machine.
_REPEATABLE: Mapping[str, float] = {
    "General.Terminal": 0,
    "General.NumThreads": 1,
    "Mesh.RandomSeed": 1,
    # Errors become exceptions instead of lines on the screen.
    "General.AbortOnError": 2,
}


@contextmanager
def gmsh_session(options: Mapping[str, float] | None = None) -> Iterator[Any]:
    """Yield the gmsh module with an empty model and `options` set; gmsh is ended afterwards.

    gmsh raises a plain Exception on errors inside.
    """
    import gmsh

    # Options in the user's home must not change results.
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        for key, value in {**_REPEATABLE, **(options or {})}.items():
            gmsh.option.setNumber(key, value)
        yield gmsh
    finally:
        gmsh.finalize()
