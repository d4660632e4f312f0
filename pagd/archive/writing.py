"""The folder of the data set: tables by split, the report of the checks, checksums."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from datetime import date
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from pagd.archive.card import CARD, DICTIONARY, card, dictionary
from pagd.archive.checks import Finding, check_tables
from pagd.archive.collecting import collected
from pagd.archive.croissant import CROISSANT, croissant
from pagd.archive.datacite import DATACITE, datacite
from pagd.archive.origin import made_of
from pagd.archive.pictures import draw_sample, sample_of
from pagd.archive.provenance import PROVENANCE
from pagd.archive.reading import read_tables
from pagd.archive.splits import SPLITS, split_of
from pagd.files import must_exist, replaced_folder
from pagd.inventory import sha256_of

__all__ = ["CHECKSUMS", "REPORT", "differing", "report_of", "write_archive"]

#: File of the SHA-256 of all others, as ``sha256sum --check`` reads it; it tells a data set.
CHECKSUMS = "SHA256SUMS"
REPORT = "CHECKS.md"


def write_archive(
    results: Path,
    out: Path,
    more: Sequence[Path] = (),
    published: date | None = None,
    pictures: int = 12,
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
    pictures
        How many of the simulated designs are drawn.

    Returns
    -------
    list
        What the checks have found, also in the file ``CHECKS.md``.

    Raises
    ------
    InputError
        If the run has no data set or no screened designs, or what it has cannot be used.
    """
    origin, published = made_of(results), published or date.today()
    found = collected(results, more)
    sample = sample_of(found.folders, pictures)
    with replaced_folder(out, CHECKSUMS) as folder:
        for name, table in found.tables.items():
            _write_splits(folder / "data" / name, table)
        frames, tables = read_tables(folder), _files(folder)
        findings = check_tables(frames)
        made_by = json.dumps(found.provenance, indent=2, ensure_ascii=False)
        texts = {
            CROISSANT: croissant(_digests(tables), published),
            PROVENANCE: f"{made_by}\n",
            CARD: card(frames, origin, list(sample)),
            DICTIONARY: dictionary(),
            REPORT: report_of(findings),
        }
        for name, text in texts.items():
            (folder / name).write_text(text, encoding="utf-8")
        draw_sample(sample, folder)
        sizes = {name: path.stat().st_size for name, path in _files(folder).items()}
        (folder / DATACITE).write_text(datacite(published, sizes), encoding="utf-8")
        lines = [f"{digest}  {name}" for name, digest in _digests(_files(folder)).items()]
        (folder / CHECKSUMS).write_text("\n".join([*lines, ""]), encoding="utf-8")
    return findings


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


def _files(folder: Path) -> dict[str, Path]:
    """All files of a folder by their paths in it, in the order of these."""
    found = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*")}
    return {name: found[name] for name in sorted(found) if found[name].is_file()}


def _digests(files: Mapping[str, Path]) -> dict[str, str]:
    return {name: sha256_of(path) for name, path in files.items()}


def differing(folder: Path) -> list[str]:
    """Return the files of a data set that are missing, unknown, or not what their checksum says.

    Raises
    ------
    InputError
        If it has no checksums: it is no data set.
    """
    path = folder / CHECKSUMS
    must_exist(path)
    lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    told = {name: digest for digest, _, name in (line.partition("  ") for line in lines)}
    there = _files(folder)
    wrong = [n for n, digest in told.items() if n not in there or sha256_of(there[n]) != digest]
    return wrong + [name for name in there if name not in told and name != CHECKSUMS]
