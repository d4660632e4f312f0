"""What files a stage has left, and whether they are still what they were."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import Path

from pagd.errors import InputError
from pagd.limits import in_force
from pagd.record import RECORD_NAME, Record, read_record

__all__ = ["damages", "inventory", "read_sound_record", "sha256_of"]


_OF_DAMAGED = "record-of-damaged-files.json"


def inventory(folder: Path) -> dict[str, dict[str, str | int]]:
    """Return size and SHA-256 of every file of a folder but its record, by its path in it."""
    return {
        path.relative_to(folder).as_posix(): {
            "bytes": path.stat().st_size,
            "sha256": sha256_of(path),
        }
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path != folder / RECORD_NAME
    }


def damages(folder: Path, record: Record, *, thorough: bool) -> Iterator[str]:
    """Tell what is wrong with the files of a stage, a sentence each.

    Parameters
    ----------
    folder
        Folder of the stage.
    record
        Its record. One that was written before records told of files passes.
    thorough
        Read every file; otherwise only its size is looked at, which tells of most damages by a
        power cut or a full disk.
    """
    for name, told in record.files.items():
        path = folder / name
        if not path.is_file():
            yield f"{path} is missing."
        elif path.stat().st_size != told["bytes"]:
            yield f"{path} has {path.stat().st_size} bytes, but was made with {told['bytes']}."
        elif thorough and sha256_of(path) != told["sha256"]:
            yield f"{path} is not what it was made as (by its SHA-256)."


def read_sound_record(folder: Path) -> Record:
    """Read the record of a stage whose files another one is about to use.

    Raises
    ------
    InputError
        If there is no record, or the files are not those that it tells of. In a workflow, the
        record is renamed then, so that the next run finds the folder damaged and makes it again.
    """
    record = read_record(folder)
    for damage in damages(folder, record, thorough=True):
        if in_force() is not None:
            (folder / RECORD_NAME).rename(folder / _OF_DAMAGED)
        raise InputError(
            f"{damage} Remove {folder}, or have it found and removed by: pagd audit --discard."
        )
    return record


def sha256_of(path: Path) -> str:
    """Return the SHA-256 of a file's content in hexadecimal digits."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
