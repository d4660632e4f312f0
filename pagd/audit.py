"""Whether what a run has left is still what it was, and what has to be made again where not."""

from __future__ import annotations

import shutil
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from pagd.errors import InputError
from pagd.files import is_abandoned
from pagd.inventory import damages
from pagd.long_work import counted
from pagd.record import read_record

__all__ = ["Finding", "abandoned", "discard", "findings", "wanted_again"]

#: Stages of a design, and of a study, in the order in which each makes use of those before.
OF_DESIGN = ("geometry", "repair", "mesh", "solve", "metrics", "figures")
OF_STUDY = ("dataset", "embedding", "generated", "diversity", "selection")
#: Where the stage export leaves its folders, one a design.
EXPORTS = Path("report", "designs")
# These are made by one job, which Snakemake does as a whole or not at all.
_TOGETHER = ("geometry", "repair", "mesh")


@dataclass(frozen=True, slots=True)
class Finding:
    """A folder that has to be made again, and why."""

    folder: Path
    why: str


def findings(results: Path, *, thorough: bool) -> Iterator[Finding]:
    """Yield the folders of stages whose record or files are damaged, each once.

    Parameters
    ----------
    results
        Folder of a run.
    thorough
        Read every file, to compare its SHA-256; otherwise compare sizes alone.

    Raises
    ------
    InputError
        If there is no such folder.
    """
    folders = list(_stage_folders(results))
    for folder in counted(folders, "files of a run", len(folders), "folders"):
        try:
            record = read_record(folder)
        except InputError as error:
            yield Finding(folder, str(error))
            continue
        first = next(damages(folder, record, thorough=thorough), None)
        if first is not None:
            yield Finding(folder, first)


def wanted_again(results: Path, statuses: Collection[str]) -> Iterator[Finding]:
    """Yield the folder of the first stage of every design that ended with one of the statuses."""
    told = set()
    for folder in _stage_folders(results):
        if folder.parent == results / EXPORTS:  # passes on how the stages before have ended
            continue
        try:
            record = read_record(folder)
        except InputError:  # a finding of its own
            continue
        if record.status in statuses and folder.parent not in told:
            told.add(folder.parent)
            yield Finding(folder, f"{record.status}: {record.reason}")


def abandoned(results: Path) -> list[Path]:
    """Return the temporary files and folders that killed processes of this host have left."""
    return [path for path in sorted(results.rglob(".*")) if is_abandoned(path)]


def discard(results: Path, found: Iterable[Finding]) -> list[Path]:
    """Remove folders, and those made of them, so that the next run makes them again.

    Parameters
    ----------
    results
        Folder of the run.
    found
        What to remove; see :func:`findings`.

    Returns
    -------
    list
        What was removed.
    """
    gone = []
    for finding in found:
        for folder in _made_with(results, finding.folder):
            if folder.is_dir():
                shutil.rmtree(folder)
                gone.append(folder)
    return gone


def _stage_folders(results: Path) -> Iterator[Path]:
    """The folders of stages: those that should have a record, in the order of their names."""
    if not results.is_dir():
        raise InputError(f"{results}: there is no such folder.")
    one_by_one = [results / name for name in OF_STUDY]
    designs = [folder / stage for folder in _folders(results / "designs") for stage in OF_DESIGN]
    screened = [*_folders(results / "screening"), *_folders(results / "screening" / "parts")]
    for folder in (*one_by_one, *screened, *designs, *_folders(results / EXPORTS)):
        if folder.is_dir() and folder.name != "parts":
            yield folder


def _folders(parent: Path) -> list[Path]:
    if not parent.is_dir():
        return []
    return sorted(p for p in parent.iterdir() if p.is_dir() and not p.name.startswith("."))


def _made_with(results: Path, folder: Path) -> list[Path]:
    """A folder and those that are made of it, or by the same job."""
    name, parent = folder.name, folder.parent
    if parent == results:
        return [results / stage for stage in OF_STUDY[OF_STUDY.index(name) :]]
    if parent == results / "screening" / "parts":
        return [folder, results / "screening" / name.rpartition("_")[0]]
    if parent in (results / "screening", results / EXPORTS):
        return [folder]
    first = 0 if name in _TOGETHER else OF_DESIGN.index(name)
    return [*(parent / stage for stage in OF_DESIGN[first:]), results / EXPORTS / parent.name]
