"""Many designs by the reduced-order analysis, a few at a time, in all processes that are given.

What is done is kept in batches beside the folder to make, so that a run that was ended goes on
where it was; a batch counts only if it was made of the same designs, configuration and versions.
"""

from __future__ import annotations

import hashlib
import json
import logging
import shutil
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from pagd import __version__
from pagd.catalogue import NamedDesign
from pagd.config import part, refusal_of_cells
from pagd.errors import InputError, MachineError, StageFailure, Status
from pagd.files import replaced_folder, write_text
from pagd.inventory import read_sound_record
from pagd.limits import Limits, run_apart
from pagd.long_work import is_shown, long_work
from pagd.record import Meter, Record
from pagd.stages import STAGE_VERSIONS
from pagd.stages.gate import FAULTS, doubt_of, gated
from pagd.stages.reduced import CELLS, PIECES, Reduced, analyse
from pagd.stages.solve import Materials
from pagd.stages.stage import ALL_DESIGNS, Outcome, run_stage
from pagd.summary import GATHERED
from pagd.tables import PERFORMANCE, Column, concatenate, read_table, write_rows
from pagd.tables import write_table as write_columns

__all__ = ["FIDELITIES", "TABLES", "gather", "run"]

GATED = "gated"
#: What a screening may consist of.
FIDELITIES = (CELLS, PIECES, GATED)

#: Tables of a screening: file, columns.
TABLES: dict[str, tuple[Column, ...]] = {
    "performance.parquet": PERFORMANCE,
    **{name: columns for name, _, columns in GATHERED},
}

# Designs of a batch: some ten seconds of work are what an end without warning costs.
_BATCH = 10
# Seconds a design, and megabytes of all: far more than any takes, to tell what hangs or swells.
_LONGEST_S = {CELLS: 120.0, PIECES: 240.0, GATED: 1800.0}
_LARGEST_MB = {CELLS: 1800.0, PIECES: 1800.0, GATED: 6000.0}
_KEY_NAME = "key.json"
# Part of the meaning of parts, not a draw of the science.
_SEED_OF_PARTS = 0
# The stages whose meaning is that of a screening too, and those of full analyses.
_OF_STAGES = ("screening", "mesh", "solve", "metrics")
_OF_FULL_ANALYSES = ("geometry", "repair")
_LIBRARIES = ("mkl", "numba", "numpy", "pypardiso", "scipy")
# Seconds between two lines that tell how far it is.
_TELL = 10.0

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class _Batch:
    """Designs that are analysed together, and the folder that keeps their tables."""

    designs: list[NamedDesign]
    folder: Path
    key: str


def run(
    designs: Sequence[NamedDesign],
    out: Path,
    config: Mapping[str, Any],
    materials: Materials,
    *,
    fidelity: str = CELLS,
    processes: int = 1,
    part_of: tuple[int, int] = (1, 1),
) -> Record:
    """Analyse designs by their cells: performance, by pressure, trajectories and chambers.

    Parameters
    ----------
    designs
        The designs, in the order of the rows.
    out
        Folder of the stage. Batches that are done are kept in a folder beside it until all are.
    config
        Completed configuration; uses what the stage ``screening`` depends on.
    materials
        Elastomer and paper.
    fidelity
        One of :data:`FIDELITIES`: cells alone; with pieces, the ends and where chambers change; or
        gated, the simplest analysis that is trusted, see :mod:`pagd.stages.gate`.
    processes
        How many at once; each has one thread.
    part_of
        (k, n): the k-th of n parts that share the work, k from 1. Each is a random sample of all
        designs, always the same one, in their order.

    Raises
    ------
    InputError
        If the configuration rules cells out.
    """
    refused = refusal_of_cells(config["solve"])
    if refused is not None:
        raise InputError(refused)
    mine = _part_of(designs, *part_of)
    in_full = _OF_FULL_ANALYSES if fidelity == GATED else ()
    made_of = {
        **part(config, "screening"),
        **{key: value for stage in in_full for key, value in part(config, stage).items()},
        "material": asdict(materials.elastomer),
        "paper": asdict(materials.paper),
        "fidelity": fidelity,
    }
    kept = out.with_name(f".{out.name}.batches")
    batches = list(_batches(mine, kept, made_of, (*_OF_STAGES, *in_full)))

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        left = [batch for batch in batches if not _is_done(batch)]
        if len(left) < len(batches):
            log.info("%d of %d batches are done already", len(batches) - len(left), len(batches))
        _solve(left, len(mine), config, materials, fidelity, processes)
        outcome.figures |= _gathered([batch.folder for batch in batches], folder)

    record = run_stage(
        "screening",
        out,
        work,
        design_id=ALL_DESIGNS,
        configuration=made_of,
        libraries=_LIBRARIES,
    )
    _discard(kept)
    return record


def _part_of(designs: Sequence[NamedDesign], number: int, parts: int) -> list[NamedDesign]:
    if parts == 1:
        return list(designs)
    # Every n-th design would not do: a table may have an order, as a Sobol sequence has.
    order = np.random.default_rng(_SEED_OF_PARTS).permutation(len(designs))
    return [designs[k] for k in sorted(order[number - 1 :: parts])]


def gather(parts: Sequence[Path], out: Path) -> Record:
    """Put the tables of several screenings into one folder, in their order.

    Parameters
    ----------
    parts
        Folders of screenings, made with the same configuration.
    out
        Folder of the stage.

    Raises
    ------
    InputError
        If a folder is no screening, they were not made with the same configuration, or a design is
        in two of them.
    """
    records = [read_sound_record(part) for part in parts]
    made_of = records[0].configuration if records else {}
    for one, record in zip(parts, records, strict=True):
        if record.stage != "screening":
            raise InputError(f"{one}: a folder of the stage {record.stage}, not of a screening.")
        if record.configuration != made_of:
            raise InputError(f"{one}: screened with another configuration than {parts[0]}.")

    names = Counter(
        str(name) for one in parts for name in read_table(one / "performance.parquet")["design_id"]
    )
    twice = next((name for name, count in names.items() if count > 1), None)
    if twice is not None:
        raise InputError(f"Design {twice} is in more than one of the parts {parts[0]} and so on.")

    def work(folder: Path, outcome: Outcome, meter: Meter) -> None:
        outcome.figures |= _gathered(parts, folder)
        outcome.figures["made_by"] = _made_by(records)

    return run_stage(
        "screening",
        out,
        work,
        design_id=ALL_DESIGNS,
        configuration=made_of,
        libraries=_LIBRARIES,
    )


def _gathered(parts: Sequence[Path], folder: Path) -> dict[str, Any]:
    """Write the tables of all parts, in order; the figures of what they hold."""
    for name, columns in TABLES.items():
        concatenate(folder / name, [one / name for one in parts], columns)
    return _figures(folder)


def _made_by(records: Sequence[Record]) -> list[dict[str, Any]]:
    """Versions and machines of the parts, each pair of them once."""
    pairs = [{"versions": record.versions, "machine": record.machine} for record in records]
    return [pair for place, pair in enumerate(pairs) if pair not in pairs[:place]]


def _discard(kept: Path) -> None:
    shutil.rmtree(kept, ignore_errors=True)


def _batches(
    designs: Sequence[NamedDesign],
    kept: Path,
    made_of: Mapping[str, Any],
    stages: Sequence[str],
) -> Iterator[_Batch]:
    for start in range(0, len(designs), _BATCH):
        some = list(designs[start : start + _BATCH])
        content = {
            "designs": [named.as_json() for named in some],
            "made_of": made_of,
            "versions": [__version__, *(STAGE_VERSIONS[stage] for stage in stages)],
        }
        text = json.dumps(content, sort_keys=True, default=str)
        key = hashlib.sha256(text.encode()).hexdigest()
        yield _Batch(some, kept / f"{start:06d}", key)


def _is_done(batch: _Batch) -> bool:
    try:
        found = json.loads((batch.folder / _KEY_NAME).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return bool(found == batch.key)


def _solve(
    left: Sequence[_Batch],
    count: int,
    config: Mapping[str, Any],
    materials: Materials,
    fidelity: str,
    processes: int,
) -> None:
    """Analyse the designs of the batches that are ``left``, and tell how far it is."""
    done = count - sum(len(batch.designs) for batch in left)
    begun, first, told = time.monotonic(), done, 0.0
    ended: Counter[str] = Counter()
    with long_work("screening", count, "designs") as shown:
        shown.reach(done)
        for statuses in _statuses(left, (config, materials, fidelity), processes):
            ended.update(statuses)
            done += len(statuses)
            shown.reach(done)
            now = time.monotonic()
            # Whoever sees how far it is need not read it as well, but at the end.
            if (now - told > _TELL and not is_shown()) or done == count:
                told, rate = now, (done - first) / max(now - begun, 1e-9)
                log.info(
                    "%d of %d designs, %.0f an hour, %.0f min left (%s)",
                    done,
                    count,
                    3600 * rate,
                    (count - done) / rate / 60,
                    ", ".join(f"{status} {number}" for status, number in ended.most_common()),
                )


def _statuses(
    left: Sequence[_Batch], how: tuple[Mapping[str, Any], Materials, str], processes: int
) -> Iterator[list[str]]:
    """How the designs of the batches end, batch by batch as they come."""
    if processes == 1:
        _prepare()
        yield from (_batch(batch, *how) for batch in left)
        return
    # Threads of OpenMP do not survive a fork.
    context = get_context("spawn")
    with ProcessPoolExecutor(processes, context, initializer=_prepare) as pool:
        for future in as_completed([pool.submit(_batch, batch, *how) for batch in left]):
            yield future.result()


def _prepare() -> None:
    """Load what is compiled, for the forks that do the work."""
    import pagd.stages.solve  # noqa: F401
    from pagd.fem.compiled import load_kernels

    load_kernels()


def _batch(
    batch: _Batch, config: Mapping[str, Any], materials: Materials, fidelity: str
) -> list[str]:
    """Analyse the designs of a batch; the statuses they end with."""
    found = _analysed(batch.designs, (config, materials, fidelity))
    with replaced_folder(batch.folder, _KEY_NAME) as folder:
        write_rows(
            folder / "performance.parquet",
            PERFORMANCE,
            [{key: r.row.get(key) for key in _NAMES} for r in found],
        )
        for name, tables in (
            ("by_pressure.parquet", [r.by_pressure for r in found]),
            ("trajectories.parquet", [r.trajectory for r in found]),
            ("chambers.parquet", [r.chambers for r in found]),
        ):
            write_columns(folder / name, TABLES[name], _stacked(tables))
        write_text(folder / _KEY_NAME, json.dumps(batch.key))
    return [str(r.row["status"]) for r in found]


_NAMES = tuple(column.name for column in PERFORMANCE)


def _analysed(
    designs: Sequence[NamedDesign], how: tuple[Mapping[str, Any], Materials, str]
) -> list[Reduced]:
    """The results of designs: by a fork, and one by one where one of them ends it."""
    from pagd.actuation import threads_are_started, use_threads

    def all_of(some: Sequence[NamedDesign]) -> list[Reduced]:
        use_threads(1)
        return [_safely(named, *how) for named in some]

    if threads_are_started():  # in a process that has had other work: it cannot be forked
        return all_of(designs)
    try:
        return run_apart(lambda: all_of(designs), _of_so_many(len(designs), how[2]))
    except (StageFailure, MachineError) as failure:
        if len(designs) == 1:
            return [_ended(designs[0], how[2], failure)]
    return [result for named in designs for result in _analysed([named], how)]


def _of_so_many(designs: int, fidelity: str) -> Limits:
    return Limits(time_s=_LONGEST_S[fidelity] * designs, memory_MB=_LARGEST_MB[fidelity])


def _ended(named: NamedDesign, fidelity: str, failure: StageFailure | MachineError) -> Reduced:
    """The row of a design whose process has crashed, or was ended: twice, once by itself."""
    status = failure.status if isinstance(failure, StageFailure) else Status.crashed
    return Reduced(_row_of(named, fidelity, status, str(failure)), {}, {}, {})


def _safely(
    named: NamedDesign, config: Mapping[str, Any], materials: Materials, fidelity: str
) -> Reduced:
    """A design's result; a fault of the analysis is one design's, not the end of all."""
    try:
        if fidelity == GATED:
            return gated(named, config, materials)
        found = analyse(named, config, materials, pieces=fidelity == PIECES)
        held = config["solve"]["blocked_force"]
        found.row["doubt"] = doubt_of(found.row, named.pneunet, held)
        return found
    except FAULTS as error:
        told = f"A fault of the analysis: {type(error).__name__}: {error}"
        return Reduced(_row_of(named, fidelity, Status.not_converged, told), {}, {}, {})


def _row_of(named: NamedDesign, fidelity: str, status: Status, told: str) -> dict[str, Any]:
    """The row of a design of which nothing is known but how it has ended."""
    return {
        "design_id": named.name,
        "name": named.name,
        "origin": named.origin,
        "mode": named.pneunet.mode,
        "fidelity": CELLS if fidelity == GATED else fidelity,
        "status": status.value,
        "reason": told,
        "doubt": told,
    }


def _stacked(tables: Sequence[Mapping[str, Any]]) -> dict[str, list[Any]]:
    """The rows of several tables, one after the other; null where one has no such column."""
    known = [table for table in tables if table]
    lengths = [len(table["pressure_kPa"]) for table in known]
    return {
        name: [
            value
            for table, length in zip(known, lengths, strict=True)
            for value in table.get(name, [None] * length)
        ]
        for name in dict.fromkeys(name for table in known for name in table)
    }


def _figures(folder: Path) -> dict[str, Any]:
    table = read_table(folder / "performance.parquet")
    seconds = table["cpu_s"].astype(float)
    statuses = Counter(str(status) for status in table["status"])
    modes = Counter(str(mode) for mode in table["mode"])
    fidelities = Counter(str(fidelity) for fidelity in table["fidelity"])
    return {
        "designs": len(seconds),
        "statuses": dict(sorted(statuses.items())),
        "modes": dict(sorted(modes.items())),
        "doubted": sum(1 for doubt in table["doubt"] if isinstance(doubt, str)),
        "fidelities": dict(sorted(fidelities.items())),
        "cpu_s_median": float(_median(seconds)),
        "cpu_s_total": float(seconds[seconds == seconds].sum()),
    }


def _median(values: Any) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else 0.0
