"""How many threads an analysis uses."""

from __future__ import annotations

import os

from threadpoolctl import threadpool_limits

__all__ = ["threads_are_started", "use_threads"]


def threads_are_started() -> bool:
    """Whether the kernels have started their threads, which do not survive a fork."""
    from numba.np.ufunc import parallel

    return bool(parallel._is_initialized)  # Numba has no call for it


def use_threads(count: int) -> None:
    """Let the kernels and the linear solver use ``count`` threads.

    To be called before the first analysis: MKL reads its setting when it is loaded.
    """
    import numba
    from numba import config

    for variable in ("MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ[variable] = str(count)
    # What is loaded has read its setting. Small products in a kernel on more threads than one wait
    # for each other ten times as long as they take.
    threadpool_limits(count, user_api="blas")
    numba.set_num_threads(min(count, config.NUMBA_NUM_THREADS))  # type: ignore[attr-defined]
