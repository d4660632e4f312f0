"""What a process holds in memory, from the imports to the factors."""

from __future__ import annotations

import re
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

from performance.page import table

__all__ = ["Memory", "memory_of", "memory_table"]

_MB = 1e6
_NUMBER = 8  # bytes


@dataclass(frozen=True, slots=True)
class Memory:
    """Resident memory in MB of a process, after each of its parts was added to those before.

    imports: Python, libraries and compiled kernels. body: mesh and terms. tangent: pattern,
    elements' matrices and their sum. factors: what Pardiso holds after a factorisation.
    nonzeros: of the factors, 8 bytes each, of what Pardiso holds. peak: the largest of all times.
    """

    imports: float
    body: float
    tangent: float
    factors: float
    nonzeros: float
    peak: float


def memory_of(name: str) -> Memory:
    """Measure the first iteration of a design of Table 2, in a process of its own."""
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        return pool.submit(_measured, name).result()


def memory_table(found: Mapping[str, Memory]) -> str:
    """One column a design."""
    rows = [
        [what, *(f"{getattr(one, field):,.0f}" for one in found.values())] for what, field in _ROWS
    ]
    return table(["MB", *found], rows)


_ROWS = (
    ("Python, libraries, kernels", "imports"),
    ("and mesh and terms", "body"),
    ("and pattern, elements' matrices, tangent", "tangent"),
    ("and what Pardiso holds", "factors"),
    ("non-zeros of the factors among it", "nonzeros"),
    ("largest at any time, Pardiso's analysis among it", "peak"),
)


def _measured(name: str) -> Memory:
    import psutil

    from pagd.actuation import use_threads
    from pagd.fem.compiled import load_kernels
    from pagd.fem.linear_solver import PardisoSolver
    from performance.bounds import body_of

    use_threads(1)
    load_kernels()
    process = psutil.Process()

    def resident() -> float:
        return float(process.memory_info().rss) / _MB

    # Meshing is a stage of its own, and what it has loaded is not of an analysis.
    body_of(name)
    imports = resident()
    body = body_of(name)
    assembly, solver = body.assembly(), PardisoSolver()
    state = assembly.at_rest()
    assembly.look_around(state)
    with_body = resident()
    _, residual, values = assembly.linearize(state)
    pattern = assembly.pattern
    with_tangent = resident()
    solver.analyse(pattern.starts, pattern.columns)
    solver.solve(values, residual[assembly.free] + 1.0)
    with_factors = resident()
    return Memory(
        imports=imports,
        body=with_body,
        tangent=with_tangent,
        factors=with_factors,
        nonzeros=_NUMBER * (solver.factor_nonzeros or 0) / _MB,
        peak=_largest(),
    )


def _largest() -> float:
    """The largest resident memory of this process so far, in MB.

    Not by getrusage: its maximum is that of the process which has started this one, too.
    """
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(re.findall(r"VmHWM:\s*(\d+) kB", status)[0]) * 1024 / _MB
