"""Single Newton iterations: pagd beside FElupe and NGSolve, in drivers of their own."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from performance.origin import LIBRARIES, origin_lines
from performance.page import table, wrapped

from pagd import config as configuration
from pagd.errors import InputError
from pagd.files import write_text
from pagd.mesh.msh import read_msh
from pagd.stages.mesh import mesh_file
from pagd.stages.solve import Materials, materials_of
from peers.bodies import Body, made
from peers.child import thread_settings
from peers.environment import peer_python, pinned

__all__ = ["PROGRAMS", "Program", "as_text", "measured", "summarized"]

_DRIVERS = Path(__file__).parent / "drivers"
_LIMIT_S = 1800.0

Row = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Program:
    """A driver and what it solves; ``beside`` is the name of pagd's with the same formulation."""

    name: str
    driver: str
    formulation: str
    paper: bool
    beside: str
    element: str = ""

    @property
    def is_ours(self) -> bool:
        """Whether it is pagd."""
        return self.name == self.beside


PROGRAMS = (
    Program("pagd P2–P1", "with_pagd", "P2–P1, paper", True, "pagd P2–P1", "taylor_hood"),
    Program("NGSolve", "with_ngsolve", "P2–P1, paper", True, "pagd P2–P1"),
    Program("pagd P2–P0", "with_pagd", "P2–P0, no paper", False, "pagd P2–P0", "element_pressure"),
    Program("FElupe", "with_felupe", "P2–P0, no paper", False, "pagd P2–P0"),
)


def measured(options: argparse.Namespace) -> list[Row]:
    """Run every program with each number of threads, in turns, and return a row for each."""
    results = options.results.resolve()
    python = peer_python(results / "peer-environment")
    folder = results / "peers"
    mesh = _write_mesh(Body(options.design, "gmsh", options.size), folder)
    rows = []
    for threads in options.threads:
        runs: dict[str, list[Row]] = {program.name: [] for program in PROGRAMS}
        # In turns, so that whatever else slows the machine down meets all of them.
        for turn in range(options.repeats):
            for program in PROGRAMS:
                print(f"{program.name}, {threads} threads, run {turn + 1}", flush=True)
                job = _job(program, options.pressure, options.iterations, threads)
                runs[program.name].append(_run(program, python, mesh, job))
        rows += summarized(runs, threads)
    return rows


def summarized(runs: dict[str, list[Row]], threads: int) -> list[Row]:
    """Return the rows of one number of threads: medians in seconds, and ratios to pagd.

    The first iteration of a run analyses the pattern and stands apart.
    """
    rows = {program.name: _row(program, runs[program.name], threads) for program in PROGRAMS}
    for program in PROGRAMS:
        beside = rows[program.beside]
        for part in ("assembly_s", "solve_s", "iteration_s", "first_s"):
            rows[program.name][f"{part}_ratio"] = rows[program.name][part] / beside[part]
    return list(rows.values())


def _row(program: Program, runs: Sequence[Row], threads: int) -> Row:
    assembly = [second for run in runs for second in run["assembly_s"][1:]]
    solve = [second for run in runs for second in run["solve_s"][1:]]
    return {
        "program": program.name,
        "formulation": program.formulation,
        "threads": threads,
        "solver": runs[-1]["solver"],
        "unknowns": runs[-1]["unknowns"],
        "tip_mm": runs[-1]["tip_mm"],
        "last_correction_mm": runs[-1]["correction_mm"][-1],
        "assembly_s": median(assembly),
        "solve_s": median(solve),
        "iteration_s": median(a + b for a, b in zip(assembly, solve, strict=True)),
        "first_s": median(run["assembly_s"][0] + run["solve_s"][0] for run in runs),
    }


def _write_mesh(body: Body, folder: Path) -> Path:
    solid = read_msh(mesh_file(made(body, folder / "meshes")))
    path = folder / "iteration.npz"
    surfaces = {f"surface_{name}": faces for name, faces in solid.surfaces.items()}
    np.savez(path, points=solid.points, tets=solid.tets, **surfaces)  # type: ignore[arg-type]
    return path


def _job(program: Program, pressure_kPa: float, iterations: int, threads: int) -> Row:
    materials: Materials = materials_of(configuration.completed({}))
    rubber, paper = materials.elastomer, materials.paper
    sheet = {
        "youngs_modulus": paper.youngs_modulus,
        "poisson_ratio": paper.poisson_ratio,
        "thickness": paper.thickness,
    }
    coefficients = dict(rubber.coefficients)
    return {
        "C10": coefficients["C10"],
        "C20": coefficients["C20"],
        "bulk": rubber.bulk_modulus,
        "paper": sheet if program.paper else None,
        "pressure_MPa": 1e-3 * pressure_kPa,
        "iterations": iterations,
        "threads": threads,
        "element": program.element,
        "material": {
            "law": rubber.law,
            "coefficients": coefficients,
            "poisson_ratio": rubber.poisson_ratio,
        },
        "sheet": sheet,
    }


def _run(program: Program, python: Path, mesh: Path, job: Row) -> Row:
    settings = mesh.with_name("iteration-job.json")
    write_text(settings, json.dumps(job))
    env = os.environ | thread_settings(job["threads"])
    if not program.is_ours:
        env.pop("PYTHONPATH", None)
    executable = sys.executable if program.is_ours else str(python)
    driver = _DRIVERS / f"{program.driver}.py"
    command = [executable, str(driver), str(mesh), str(settings)]
    try:
        answer = subprocess.run(
            command, env=env, capture_output=True, text=True, check=False, timeout=_LIMIT_S
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"{program.name}: took more than {_LIMIT_S:g} s.") from None
    if answer.returncode:
        said = answer.stderr.strip().splitlines()[-1:] or ["no message"]
        raise InputError(f"{program.name}: ended with code {answer.returncode} ({said[0]}).")
    return dict(json.loads(answer.stdout.strip().splitlines()[-1]))


def as_text(command: str, rows: Sequence[Row], options: argparse.Namespace) -> str:
    """Return the section as Markdown."""
    peers = {name: version for name, version in pinned().items() if name in ("felupe", "ngsolve")}
    named = ", ".join(f"{name} {version}" for name, version in peers.items())
    text = (
        f"{named}. The {options.design} example at {options.size:g} mm, whole, on the same "
        f"tetrahedra; {options.iterations} iterations at {options.pressure:g} kPa from rest, "
        f"{options.repeats} runs of each program in turns: medians in ms, the first iteration of a "
        "run apart, since it analyses the pattern. In brackets, how many times longer than pagd "
        "with the same element. Equal formulations: NGSolve has P2–P1 by a symbolic energy, "
        "follower pressure, and the paper as a membrane, without pagd's stiffness of the sheet to "
        "bending; FElupe has P2–P0 as its nearly incompressible solid, condensed, follower "
        "pressure, the Yeoh law built on its neo-Hookean one, and no paper, so that pagd has none "
        "beside it. Assembly is residual and tangent of the free unknowns; the solve is "
        "factorisation and solution."
    )
    headings = [f"program, {'/'.join(map(str, options.threads))} threads", "element", "unknowns"]
    headings += ["assembly", "solve", "iteration", "first", "tip z, mm"]
    solvers = dict.fromkeys(f"{row['program']}: {row['solver']}" for row in rows)
    parts = [origin_lines(command, LIBRARIES), wrapped(text), table(headings, _cells(rows))]
    return "\n\n".join([*parts, wrapped(f"Linear solvers: {'; '.join(solvers)}.")])


def _cells(rows: Sequence[Row]) -> Iterator[list[str]]:
    for row in rows:
        name = f"{row['program']}, {row['threads']}"
        times = [_timed(row, part) for part in ("assembly_s", "solve_s", "iteration_s", "first_s")]
        size = f"{row['unknowns']:,}"
        yield [name, row["formulation"], size, *times, f"{row['tip_mm'][2]:z.4f}"]


def _timed(row: Row, part: str) -> str:
    ratio = row[f"{part}_ratio"]
    return f"{1e3 * row[part]:.0f}" + ("" if ratio == 1 else f" ({ratio:.1f})")
