"""Operations of a factorisation, memory that a solution reads, and the machine's own rates."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_info

from pagd import config as configuration
from pagd.actuation.body import Body
from pagd.actuation.settings import Actuation
from pagd.errors import InputError, Status
from pagd.fem.continuation import Continuation
from pagd.fem.linear_solver import PardisoSolver
from pagd.fem.newton import Newton, NewtonSettings
from pagd.mesh.msh import read_msh
from pagd.stages import geometry, mesh, repair
from pagd.stages.mesh import mesh_file
from pagd.stages.solve import materials_of
from performance.memory import Memory, memory_table
from performance.options import example_designs
from performance.page import table, wrapped

Int32Array = NDArray[np.int32]

__all__ = ["Bounds", "CountingSolver", "Rates", "body_of", "machine_rates", "measured", "text_of"]

# Far beyond every cache: rows of the dense matrices, and numbers that are copied.
_MATRIX_ROWS, _COPIED = 2400, 30_000_000

_NUMBER = 8  # bytes
#: Patient, as where walls touch.
_SETTINGS = NewtonSettings(iterations=14, growth=2.0, contraction=0.55, reuses=8)

_OPERATIONS = 18  # of Pardiso's parameters: −1 asks, and then it is the number in millions


@dataclass(frozen=True, slots=True)
class Rates:
    """What one core does at most: GFLOP/s of a dense product, GB/s of a copy, both ways counted."""

    operations: float
    memory: float


@dataclass(frozen=True, slots=True)
class Bounds:
    """One iteration of a body: sizes, GFLOP of a factorisation, and the parts' seconds."""

    unknowns: int
    touching: int
    factor_nonzeros: int
    operations: float
    assembly_s: float
    factorisation_s: float
    solution_s: float


class CountingSolver(PardisoSolver):
    """Pardiso, which counts its operations too."""

    def analyse(self, starts: Int32Array, columns: Int32Array, *, is_ring: bool = False) -> None:
        """Take a pattern, and ask for the operations of its factorisation."""
        super().analyse(starts, columns, is_ring=is_ring)
        self._parameters[_OPERATIONS] = -1

    @property
    def operations(self) -> float:
        """In 1e9, of a factorisation of the pattern analysed last."""
        return float(self._parameters[_OPERATIONS]) / 1e3


def machine_rates(repeats: int) -> Rates:
    """Measure the fastest of some products and copies, on one core.

    Raises
    ------
    InputError
        If more than one thread multiplies, which would be told as one.
    """
    pools = [pool for pool in threadpool_info() if pool["user_api"] == "blas"]
    if any(pool["num_threads"] > 1 for pool in pools):
        raise InputError("a rate of one core is wanted, but products of matrices use several.")
    generator = np.random.default_rng(1)
    a, b = generator.random((2, _MATRIX_ROWS, _MATRIX_ROWS))
    product = np.empty_like(a)
    source, target = np.ones(_COPIED), np.empty(_COPIED)
    copy = _fastest(lambda: np.copyto(target, source), repeats)
    return Rates(
        operations=2
        * _MATRIX_ROWS**3
        / _fastest(lambda: np.matmul(a, b, out=product), repeats)
        / 1e9,
        memory=2 * _NUMBER * _COPIED / copy / 1e9,
    )


def measured(name: str, pressure_kPa: float, repeats: int) -> Bounds:
    """Measure a design of Table 2 on its usual mesh, free, under a pressure.

    Raises
    ------
    InputError
        If it cannot be meshed, or does not come so far.
    """
    body = body_of(name)
    assembly, solver = body.assembly(), CountingSolver()
    newton = Newton(assembly, solver, 3 * body.nodes, _SETTINGS, body.pressure)
    path = Continuation(newton)
    end = path.follow([pressure_kPa * 1e-3], lambda step: None)
    if end.failure:
        raise InputError(f"--pressure = {pressure_kPa:g}: {name} ends before ({end.failure}).")
    state = path.states[-1]
    newton.linearise_at(state)
    _, residual, values = assembly.linearize(state)
    right = residual[assembly.free] + 1.0
    both = _fastest(lambda: solver.solve(values, right), repeats)
    solution = _fastest(lambda: solver.solve_again(right), repeats)
    return Bounds(
        unknowns=len(assembly.free),
        touching=sum(assembly.touching),
        factor_nonzeros=solver.factor_nonzeros or 0,
        operations=solver.operations,
        assembly_s=_fastest(lambda: assembly.linearize(state), repeats),
        factorisation_s=both - solution,
        solution_s=solution,
    )


def text_of(
    rates: Rates,
    found: Mapping[str, Bounds],
    memory: Mapping[str, Memory],
    pressure_kPa: float,
) -> str:
    """Return the section without its first lines."""
    introduction = (
        f"One iteration of the free actuator at {pressure_kPa:g} kPa, one thread. One core "
        f"multiplies and adds dense matrices at {rates.operations:.0f} GFLOP/s and copies memory "
        f"at {rates.memory:.1f} GB/s, reading and writing counted. A factorisation cannot be "
        "faster than its operations at the one rate, nor a solution than the reading of the "
        "factors, forth and back, at the other."
    )
    rows = [[what, *(show(one, rates) for one in found.values())] for what, show in _ROWS]
    held = (
        "What the process of an analysis holds in memory after its first factorisation, each row "
        "with those above it:"
    )
    return "\n\n".join(
        [
            wrapped(introduction),
            table(["", *found], rows),
            wrapped(held),
            memory_table(memory),
        ]
    )


def _read_s(one: Bounds, rates: Rates) -> float:
    """The least seconds of a solution: to read the factors twice."""
    return 2 * _NUMBER * one.factor_nonzeros / rates.memory / 1e9


_Row = tuple[str, Callable[[Bounds, Rates], str]]
_ROWS: tuple[_Row, ...] = (
    ("unknowns", lambda one, _: f"{one.unknowns:,}"),
    ("contact points that touch", lambda one, _: f"{one.touching:,}"),
    ("non-zeros of the factors, millions", lambda one, _: f"{one.factor_nonzeros / 1e6:.1f}"),
    ("operations of a factorisation, GFLOP", lambda one, _: f"{one.operations:.1f}"),
    ("tangent, s", lambda one, _: f"{one.assembly_s:.3f}"),
    ("factorisation, s", lambda one, _: f"{one.factorisation_s:.3f}"),
    (
        "factorisation, GFLOP/s",
        lambda one, _: f"{one.operations / one.factorisation_s:.1f}",
    ),
    (
        "factorisation, share of the dense product's rate",
        lambda one, rates: f"{one.operations / one.factorisation_s / rates.operations:.0%}",
    ),
    ("solution, s", lambda one, _: f"{one.solution_s:.3f}"),
    (
        "solution, least time over time",
        lambda one, rates: f"{_read_s(one, rates) / one.solution_s:.0%}",
    ),
)


def body_of(name: str) -> Body:
    """A design of Table 2 on its usual mesh.

    Raises
    ------
    InputError
        If it cannot be meshed.
    """
    config = configuration.load("{}")
    named = example_designs()[name]
    with tempfile.TemporaryDirectory(prefix="pagd-bounds-") as folder:
        shape, repaired, meshed = (Path(folder, part) for part in ("geometry", "repair", "mesh"))
        geometry.run(named, shape, config)
        repair.run(shape, repaired, config)
        record = mesh.run(shape, repaired, meshed, config)
        if record.status is not Status.ok:
            raise InputError(f"--designs: {name} has no mesh ({record.reason}).")
        solid = read_msh(mesh_file(meshed))
    materials = materials_of(config)
    return Body(solid, materials.elastomer, materials.paper, Actuation())


def _fastest(work: Callable[[], object], repeats: int) -> float:
    """Processor seconds of the fastest call."""
    seconds = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        seconds.append(time.process_time() - start)
    return min(seconds)
