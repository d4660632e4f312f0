"""The folder of the data set: tables by split, the report of the checks, checksums."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import date
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from pagd.archive.card import CARD, DICTIONARY, card, dictionary
from pagd.archive.checks import Finding, check_tables
from pagd.archive.collecting import collected
from pagd.archive.croissant import CROISSANT, croissant
from pagd.archive.origin import made_of
from pagd.archive.reading import read_tables
from pagd.archive.splits import SPLITS, split_of
from pagd.files import replaced_folder
from pagd.inventory import sha256_of

__all__ = ["CHECKSUMS", "REPORT", "differing", "report_of", "write_archive"]

#: File of the SHA-256 of all others, as ``sha256sum --check`` reads it; it tells a data set.
CHECKSUMS = "SHA256SUMS"
REPORT = "CHECKS.md"


def write_archive(
    results: Path, out: Path, more: Sequence[Path] = (), published: date | None = None
) -> list[Finding]:
    """Write the data set that a run leaves, and check it.

    Parameters
    ----------
    results, more
        As of :func:`pagd.archive.collecting.collected`.
    out
        Folder to make, or to replace where it is a data set.
    published
        Date of publication; today's unless given.

    Returns
    -------
    list
        What the checks have found, also in the file ``CHECKS.md``.

    Raises
    ------
    InputError
        If the run has no data set or no screened designs, or what it has cannot be used.
    """
    origin = made_of(results)
    tables = collected(results, more)
    with replaced_folder(out, CHECKSUMS) as folder:
        for name, table in tables.items():
            _write_splits(folder / "data" / name, table)
        frames = read_tables(folder)
        found = check_tables(frames)
        texts = {
            CROISSANT: croissant(_digests(folder), published or date.today()),
            CARD: card(frames, origin),
            DICTIONARY: dictionary(),
            REPORT: report_of(found),
        }
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        lines = [f"{digest}  {name}" for name, digest in _digests(folder).items()]
        (folder / CHECKSUMS).write_text("\n".join([*lines, ""]), encoding="utf-8")
    return found


def _write_splits(folder: Path, table: pa.Table) -> None:
    folder.mkdir(parents=True)
    places = pa.array([split_of(one) for one in table.column("id").to_pylist()], pa.string())
    for split in SPLITS:
        part = table.filter(pc.equal(places, split))
        pq.write_table(part, folder / f"{split}.parquet", compression="zstd")


def report_of(found: Sequence[Finding]) -> str:
    """Return the findings as a page in Markdown."""
    lines = [
        "# Checks of the data set",
        "",
        "| rule | rows | broken | first |",
        "| --- | ---: | ---: | --- |",
    ]
    lines += [f"| {f.rule} | {f.rows:,} | {f.broken:,} | {f.first or '–'} |" for f in found]
    return "\n".join([*lines, ""])


def _digests(folder: Path) -> dict[str, str]:
    """SHA-256 of all files by their paths in the folder, in the order of these."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): sha256_of(path) for path in files}


def differing(folder: Path) -> list[str]:
    """Return the files of a data set that are missing, or not what their checksum says."""
    lines = (folder / CHECKSUMS).read_text(encoding="utf-8").splitlines()
    told = {name: digest for digest, _, name in (line.partition("  ") for line in lines)}
    return [
        name
        for name, digest in told.items()
        if not (folder / name).is_file() or sha256_of(folder / name) != digest
    ]
