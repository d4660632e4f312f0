"""What the stages of a design load, loaded before a process is asked for them."""

from __future__ import annotations

import gc
import importlib
import sys
from typing import Any

__all__ = ["load_kernels", "preload"]

_MODULES = (
    "pagd.cli.execute",
    "pagd.cli.commands",
    "pagd.stages.geometry",
    "pagd.stages.repair",
    "pagd.stages.mesh",
    "pagd.stages.solve",
    "pagd.stages.metrics",
)


def preload() -> int:
    """Import the stages, read the schemas, find the linear solver, load the compiled kernels.

    Starts no thread, so that the process may fork afterwards. Returns how many kernels there are.
    """
    for module in _MODULES:
        importlib.import_module(module)
    from pagd import config, validation
    from pagd.cli.parser import make_parser
    from pagd.fem.linear_solver import linear_solver

    make_parser()
    for name in ("config", "designs", "record"):
        list(validation.faults({}, name))
    linear_solver(config.load(None)["solve"]["linear_solver"]).free()
    kernels = load_kernels()
    # Objects that are never freed are left out of the collections of the forked processes, whose
    # marks would copy every page that they lie on.
    gc.collect()
    gc.freeze()
    return kernels


def load_kernels() -> int:
    """Load the kernels of one thread that Numba has on disk; return how many there are.

    Those with parallel loops start threads when they are loaded, and are left to the forked
    processes. Numba has no call for this: where what is used here has changed, nothing is loaded.
    """
    from numba.core.registry import CPUDispatcher

    found: dict[int, Any] = {
        id(value): value
        for name, module in list(sys.modules.items())
        if name.startswith("pagd.")
        for value in list(vars(module).values())
        if isinstance(value, CPUDispatcher) and not value.targetoptions.get("parallel")
    }
    return sum(_load(dispatcher) for dispatcher in found.values())


def _load(dispatcher: Any) -> int:
    try:
        signatures = [key[0] for key in dispatcher._cache._cache_file._load_index()]
        for signature in signatures:
            dispatcher.compile(signature)
    except Exception:  # the worker that needs it will tell
        return 0
    return len(signatures)
