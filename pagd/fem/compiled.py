"""The one place where the solver's kernels meet the compiler."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba.core import event
from numba.core.registry import CPUDispatcher

log = logging.getLogger(__name__)

Function = TypeVar("Function", bound=Callable[..., Any])

# Everything of fastmath but "no NaN" and "no infinity": the step control
# relies on an infinite energy to recognise an inverted element.
_FAST = {"reassoc", "contract", "arcp", "nsz"}


class _Notice(event.Listener):
    """Says once why nothing seems to happen: kernels that are on disk raise no such event."""

    said = False

    def on_start(self, event: Any) -> None:
        """Say it of kernels of our own."""
        if self.said or not event.data["dispatcher"].py_func.__module__.startswith("pagd."):
            return
        self.said = True
        log.info("compiling the solver, which takes a minute and is kept for later runs")

    def on_end(self, event: Any) -> None:
        """Nothing to do."""


event.register("numba:compile", _Notice())  # type: ignore[no-untyped-call]


def compiled(function: Function) -> Function:
    """Compile ``function`` for one thread; the machine code is cached on disk."""
    return _compile(function, parallel=False)


def compiled_parallel(function: Function) -> Function:
    """Compile ``function`` with its ``prange`` loops spread over the threads of Numba."""
    return _compile(function, parallel=True)


def _compile(function: Function, parallel: bool) -> Function:
    # A compiled function is called as the plain one is, and typed as such.
    decorate = numba.njit(cache=True, fastmath=_FAST, error_model="numpy", parallel=parallel)
    return cast(Function, decorate(function))


def load_kernels() -> int:
    """Load the kernels of one thread that Numba has on disk; return how many there are.

    Those with parallel loops start threads when they are loaded, and are left to the processes that
    are forked from this one. Numba has no call for this: where what is used here has changed,
    nothing is loaded.
    """
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
