"""What the stages of a design load, loaded before a process is asked for them."""

from __future__ import annotations

import gc
import importlib

__all__ = ["preload"]

_MODULES = (
    "pagd.cli.execute",
    "pagd.cli.commands",
    "pagd.stages.geometry",
    "pagd.stages.repair",
    "pagd.stages.mesh",
    "pagd.stages.solve",
    "pagd.stages.metrics",
    "pagd.stages.export",
)


def preload() -> int:
    """Import the stages, read what they ask for each time, load solver and compiled kernels.

    Starts no thread, so that the process may fork afterwards. Returns how many kernels there are.
    """
    for module in _MODULES:
        importlib.import_module(module)
    from pagd import config, validation
    from pagd.cli.parser import make_parser
    from pagd.fem.compiled import load_kernels
    from pagd.fem.linear_solver import linear_solver
    from pagd.machine import machine_class
    from pagd.record import versions

    make_parser()
    versions(1)
    machine_class()
    for name in ("config", "designs", "record"):
        list(validation.faults({}, name))
    linear_solver(config.load(None)["solve"]["linear_solver"]).free()
    kernels = load_kernels()
    # Objects that are never freed are left out of the collections of the forked processes, whose
    # marks would copy every page that they lie on.
    gc.collect()
    gc.freeze()
    return kernels
