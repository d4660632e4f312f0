"""What a run has left of all designs, as the tables of the data set."""

from __future__ import annotations

import logging
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from pagd.archive.provenance import Provenance, key_of, of_screening, of_simulation
from pagd.archive.tables import PROVENANCE, TABLES
from pagd.dataset import designs_of, frame_of, read_frame
from pagd.design import Design, identity
from pagd.errors import InputError
from pagd.inventory import read_sound_record
from pagd.record import RECORD_NAME, read_record
from pagd.stages.geometry import read_design
from pagd.stages.novelty import novelty_of
from pagd.summary import GATHERED, write_gathered, write_summary

__all__ = ["Collected", "collected"]

log = logging.getLogger(__name__)

#: Tables of designs of a run by the set that they are, and the folder of their screening.
_SETS: Final = {
    "training": ("dataset/designs.parquet", "screening/training"),
    "generated": ("generated/designs.parquet", "screening/generated"),
}
_OTHER: Final = "other"
#: What must be the same in all of a data set: keys of the records of two stages.
_SAME: Final = {"mesh": ("mesh",), "solve": ("solve", "material", "paper")}
#: Tables of analyses by name, and their files in a screening or a summary.
_FILES: Final = {"performance": "performance.parquet"} | {
    name.removesuffix(".parquet"): name for name, _, _ in GATHERED
}


@dataclass(frozen=True, slots=True)
class Collected:
    """All that a run has left.

    ``tables`` by name, with the columns of :data:`pagd.archive.tables.TABLES`; ``provenance`` by
    the key that the table ``performance`` has; ``folders`` of simulated designs by id.
    """

    tables: dict[str, pa.Table]
    provenance: dict[str, Provenance]
    folders: dict[str, Path]


@dataclass(frozen=True, slots=True)
class _Part:
    """Tables of analyses in a folder: ids of the designs by name, keys of what made them by id."""

    folder: Path
    ids: Mapping[str, str]
    made_by: Mapping[str, str]


def collected(results: Path, more: Sequence[Path] = ()) -> Collected:
    """Return the tables of the data set: each design once, and every analysis of it.

    Parameters
    ----------
    results
        Folder of a run, with its data set.
    more
        Folders of designs that were simulated elsewhere, such as ``designs`` of another run.

    Returns
    -------
    Collected
        Designs are in the order of their sets; analyses by a chamber come first, then those in
        full.

    Raises
    ------
    InputError
        If the run has no data set, a record or its files are damaged, or two simulated designs
        have one name or were solved with different configurations.
    """
    frames = {name: _frame(results / path, name) for name, (path, _) in _SETS.items()}
    simulated = _simulated([results / "designs", *more])
    others = _others(simulated, {i for frame in frames.values() for i in frame["id"]})
    designs = pd.concat([*frames.values(), others]).drop_duplicates("id")
    parts, provenance = _screened(results, frames)
    with tempfile.TemporaryDirectory(prefix="pagd-") as folder:
        _sum_up(list(simulated.values()), results / "dataset", Path(folder))
        full = _in_full(Path(folder), simulated, provenance)
        analyses = {name: _joined(name, [*parts, full]) for name in _FILES}
    table = pa.Table.from_pandas(designs, _schema("designs"), preserve_index=False)
    folders = {full.ids[name]: simulated[name] for name in simulated}
    return Collected({"designs": table} | analyses, provenance, folders)


def _screened(
    results: Path, frames: Mapping[str, pd.DataFrame]
) -> tuple[list[_Part], dict[str, Provenance]]:
    """The screenings that are there, and what made them."""
    parts, provenance = [], {}
    for name, (_, screening) in _SETS.items():
        if not (results / screening / RECORD_NAME).is_file():
            continue
        made_by = of_screening(results / screening)
        provenance[key_of(made_by)] = made_by
        ids = _ids(frames[name])
        keys = dict.fromkeys(ids.values(), key_of(made_by))
        parts.append(_Part(results / screening, ids, keys))
    return parts, provenance


def _in_full(
    folder: Path, simulated: Mapping[str, Path], provenance: dict[str, Provenance]
) -> _Part:
    """The simulated designs, with tables in ``folder``; what made them is added."""
    ids = {name: _identity_of(path) for name, path in simulated.items()}
    keys = {}
    for name, path in simulated.items():
        made_by = of_simulation(path)
        keys[ids[name]] = key_of(made_by)
        provenance.setdefault(keys[ids[name]], made_by)
    return _Part(folder, ids, keys)


def _frame(path: Path, which: str) -> pd.DataFrame:
    frame = read_frame(path)
    frame["id"] = [identity(design) for design in designs_of(frame)]
    frame["set"] = which
    return frame


def _ids(frame: pd.DataFrame) -> dict[str, str]:
    return dict(zip(frame["design_id"], frame["id"], strict=True))


def _simulated(folders: Sequence[Path]) -> dict[str, Path]:
    """Folders of pneu-nets that came as far as a record of their metrics, by name."""
    found = [
        path.parent.parent
        for folder in folders
        if folder.is_dir()
        for path in sorted(folder.glob(f"*/metrics/{RECORD_NAME}"))
        if _is_pneunet(path.parent.parent)
    ]
    twice = [name for name, count in Counter(path.name for path in found).items() if count > 1]
    if twice:
        raise InputError(f"Two simulated designs are named {twice[0]}, in different folders.")
    for path in found:
        read_sound_record(path / "metrics")
    _refuse_different(found)
    return {path.name: path for path in found}


def _is_pneunet(folder: Path) -> bool:
    """Tell whether a folder is of a pneu-net; of what is left out, the log tells."""
    design = read_design(folder / "geometry").design
    if isinstance(design, Design):
        return True
    log.warning("%s: left out, as a %s; the data set is of pneu-nets.", folder, design.family)
    return False


def _refuse_different(folders: Sequence[Path]) -> None:
    """Refuse designs whose results cannot be compared: of other material, pressure or mesh."""
    made = [_made_of(folder) for folder in folders]
    for folder, one in zip(folders, made, strict=True):
        key = next((key for key in one if one[key] != made[0][key]), None)
        if key is not None:
            raise InputError(
                f"{folder}: made with another '{key}' than {folders[0]}; a data set has one."
            )


def _made_of(folder: Path) -> dict[str, Any]:
    found = {}
    for stage, keys in _SAME.items():
        configuration = read_record(folder / stage).configuration
        for key in keys:
            value = configuration.get(key)
            # Where a material's numbers are from changes none of them.
            found[key] = {k: v for k, v in value.items() if k != "source"} if value else None
    return found


def _identity_of(folder: Path) -> str:
    return identity(read_design(folder / "geometry").pneunet)


def _others(simulated: Mapping[str, Path], known: set[str]) -> pd.DataFrame:
    """Designs that were simulated and are of no set of the run."""
    named = [read_design(folder / "geometry") for folder in simulated.values()]
    rest = [one for one in named if identity(one.pneunet) not in known]
    frame = frame_of([r.pneunet for r in rest], [r.name for r in rest], [r.origin for r in rest])
    frame["id"] = [identity(one.pneunet) for one in rest]
    frame["set"] = _OTHER
    return frame


def _sum_up(simulated: Sequence[Path], dataset: Path, out: Path) -> None:
    """Write the tables of simulated designs as a summary has them."""
    metrics = [folder / "metrics" for folder in simulated]
    novelty = novelty_of([folder / "geometry" for folder in simulated], dataset)
    write_summary(metrics, out / _FILES["performance"], out / "summary.csv", novelty)
    write_gathered(metrics, out)


def _joined(name: str, parts: Sequence[_Part]) -> pa.Table:
    """A table of analyses: the rows of all folders that have it, by the ids of their designs."""
    schema, found = _schema(name), []
    for part in parts:
        path = part.folder / _FILES[name]
        if not path.is_file():
            continue
        table = pq.read_table(path)
        own = [part.ids[one] for one in table.column("design_id").to_pylist()]
        table = table.add_column(0, "id", pa.array(own, pa.string()))
        if PROVENANCE.name in schema.names:
            keys = pa.array([part.made_by[one] for one in own], pa.string())
            table = table.append_column(PROVENANCE.name, keys)
        found.append(table.select(schema.names).cast(schema))
    return pa.concat_tables(found) if found else schema.empty_table()


def _schema(name: str) -> Any:
    return pa.schema(
        pa.field(
            column.name,
            pa.type_for_alias(column.type),
            metadata={"unit": column.unit, "description": column.description},
        )
        for column in TABLES[name].columns
    )
