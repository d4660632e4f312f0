"""What the subcommands do that make a public data set of a run, and check one."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from dataclasses import asdict
from datetime import date
from pathlib import Path
from typing import TYPE_CHECKING

from pagd.cli.answer import Answer
from pagd.errors import InputError

if TYPE_CHECKING:
    from pagd.archive.checks import Finding

__all__ = ["archive", "check_archive"]


# The picture of all of them together grows with their number.
_MOST_PICTURES = 100


def archive(options: Namespace) -> Answer:
    """Write the data set that a run leaves; 1 if it breaks a rule."""
    from pagd.archive.packing import check_target, pack
    from pagd.archive.writing import write_archive

    if not 0 <= options.pictures <= _MOST_PICTURES:
        raise InputError(f"--pictures = {options.pictures} must be 0 to {_MOST_PICTURES}.")
    if options.zip is not None:
        check_target(options.zip, options.out)
    found = write_archive(
        options.results, options.out, options.more, _date(options.date), options.pictures
    )
    if options.zip is not None:
        pack(options.out, options.zip)
    code = _told(found, f"{options.out} is written")
    return Answer(code, {"folder": options.out, "zip": options.zip, "rules": _rules(found)})


def _date(text: str | None) -> date | None:
    try:
        return None if text is None else date.fromisoformat(text)
    except ValueError:
        raise InputError(f"--date = {text!r} must be a date such as 2026-01-31.") from None


def check_archive(options: Namespace) -> Answer:
    """Check a data set: its checksums, its metadata and its tables; 1 if anything is wrong."""
    from pagd.archive.packing import unpacked

    with unpacked(options.archive) as folder:
        return _checked(folder, options.archive)


def _checked(folder: Path, told: Path) -> Answer:
    from pagd.archive.checks import check_tables
    from pagd.archive.provenance import PROVENANCE
    from pagd.archive.reading import read_tables
    from pagd.archive.validating import faults_of_metadata, faults_of_provenance
    from pagd.archive.writing import differing

    changed = differing(folder)
    for name in changed:
        print(f"{name} is missing, or not what its checksum says.")
    if any(name == PROVENANCE or name.startswith("data/") for name in changed):
        print(f"{told} is damaged: what it says is not looked at.")
        return Answer(1, {"changed": changed})
    faults = faults_of_metadata(folder)
    for fault in faults:
        print(f"croissant.json: {fault}")
    tables = read_tables(folder)
    unknown = faults_of_provenance(folder, tables["performance"])
    for fault in unknown:
        print(f"provenance.json: {fault}")
    found = check_tables(tables)
    code = _told(found, f"{told} is read")
    document = {"changed": changed, "faults": [*faults, *unknown], "rules": _rules(found)}
    return Answer(1 if changed or faults or unknown else code, document)


def _rules(found: Sequence[Finding]) -> list[dict[str, object]]:
    return [asdict(one) for one in found]


def _told(found: Sequence[Finding], done: str) -> int:
    for one in found:
        verdict = f"broken by {one.broken:,}, {one.first} the first" if one.broken else "kept"
        print(f"{one.rule}: {verdict} (of {one.rows:,})")
    broken = sum(1 for one in found if one.broken)
    print(f"{done}: {len(found) - broken} of {len(found)} rules are kept.")
    return 1 if broken else 0
