"""pagd beside other programs: CalculiX, FElupe and NGSolve.

    python benchmarks/peers.py converged [--blocks 6] [--halvings 1] [--order P] [ANALYSES]
    python benchmarks/peers.py same-mesh [--sizes 5 3] [--blocks 6] [--page …] [ANALYSES]
    python benchmarks/peers.py equal-error [--finer 4 3 2.5 2 1.5] [--page …] [ANALYSES]
    python benchmarks/peers.py calculix [--finer …] [--page …] [ANALYSES]
    python benchmarks/peers.py iteration [--design bending] [--size 5] [--threads 1 2]
        [--pressure 0.25] [--iterations 10] [--repeats 3] [--page …]

where ANALYSES are [--designs bending twisting] [--mesher gmsh structured] [--element NAME]
[--half-model] [--threads 2] [--maximum-pressure 50] [--time-limit 3600] [--repeats 3], and all
commands know [--results FOLDER] [--fresh] [--out JSON]; ``--help`` after any of them says more.

``converged`` extrapolates the tip over a mesh and its halves: errors are measured against it.
``same-mesh`` runs pagd and CalculiX on the same meshes, ``equal-error`` runs CalculiX on finer
ones until it is as good as pagd, ``calculix`` does both. ``iteration`` times single Newton
iterations beside FElupe and NGSolve, in an environment of their own that it makes.

Runs are kept in results/benchmarks/peers: the same command goes on where it was interrupted.
"""

from __future__ import annotations

import argparse
import json
import logging
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from peers import iteration, page
from peers.bodies import Body
from peers.options import command_of, make_parser
from peers.solved import Load
from peers.studies import Study
from performance.page import publish

from pagd.errors import InputError
from pagd.files import write_text
from pagd.mesh.interface import STRUCTURED


def main() -> None:
    """Run what is missing, and print or write the sections."""
    parser = make_parser(__doc__ or "", _HANDLERS)
    options = parser.parse_args()
    logging.getLogger("pagd").setLevel(logging.WARNING)
    try:
        options.handler(options)
    except InputError as error:
        parser.error(str(error))
    except KeyboardInterrupt:
        sys.exit("interrupted; the same command goes on from here")


def _study(options: argparse.Namespace) -> Study:
    bodies = [
        Body(design, mesher, size, options.half_model, halvings)
        for design in options.designs
        for mesher in options.mesher
        for size in (options.blocks if mesher == STRUCTURED else options.sizes)
        for halvings in range(getattr(options, "halvings", 0) + 1)
    ]
    return Study(
        folder=options.results.resolve(),
        bodies=bodies,
        load=Load(
            maximum_kPa=options.maximum_pressure,
            threads=options.threads,
            time_limit_s=options.time_limit,
        ),
        element=options.element,
        repeats=options.repeats,
        fresh=options.fresh,
    )


def _converged(options: argparse.Namespace) -> None:
    tips = _study(options).converge(options.order)
    print(page.converged_text(tips, options.order))
    _write(options.out, {name: asdict(tip) for name, tip in tips.items()})


def _same_mesh(options: argparse.Namespace) -> None:
    study = _study(options)
    rows = list(study.same_mesh())
    text = page.same_mesh_text(command_of(options), rows, options.threads, study.exact())
    publish(options.page, "peers-same-mesh", text)
    _write(options.out, [asdict(row) for row in rows])


def _equal_error(options: argparse.Namespace) -> None:
    study = _study(options)
    rows = list(study.equal_error(options.finer))
    text = page.equal_error_text(command_of(options), rows, options.threads, study.exact())
    publish(options.page, "peers-equal-error", text)
    _write(options.out, [asdict(row) for row in rows])


def _calculix(options: argparse.Namespace) -> None:
    out = options.out
    options.command, options.out = "same-mesh", out and out.with_stem(f"{out.stem}-same-mesh")
    _same_mesh(options)
    options.command = "equal-error"
    options.out = out and out.with_stem(f"{out.stem}-equal-error")
    # The runs of the first part, if they were to be fresh, are so now.
    options.fresh = False
    _equal_error(options)


def _iteration(options: argparse.Namespace) -> None:
    rows = iteration.measured(options)
    publish(options.page, "peers-iteration", iteration.as_text(command_of(options), rows, options))
    _write(options.out, rows)


def _write(path: Path | None, content: Mapping[str, Any] | Sequence[Any]) -> None:
    if path is not None:
        write_text(path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")


_HANDLERS = {
    "converged": _converged,
    "same-mesh": _same_mesh,
    "equal-error": _equal_error,
    "calculix": _calculix,
    "iteration": _iteration,
}


if __name__ == "__main__":
    main()
