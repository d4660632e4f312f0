"""The one place where the solver's kernels meet the compiler."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba

Function = TypeVar("Function", bound=Callable[..., Any])

# Everything of fastmath but "no NaN" and "no infinity": the step control
# relies on an infinite energy to recognise an inverted element.
_FAST = {"reassoc", "contract", "arcp", "nsz"}


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
