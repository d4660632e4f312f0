"""One file of a whole data set, as repositories that give out DOIs take it."""

from __future__ import annotations

import lzma
import shutil
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from pagd.archive.card import NAME
from pagd.archive.croissant import version_of
from pagd.errors import InputError
from pagd.files import must_exist, replaced_file

__all__ = ["check_target", "pack", "unpacked"]

# The same files give the same bytes, whenever they were written. ZIP knows no earlier day.
_DATE: Final = (1980, 1, 1, 0, 0, 0)
_READABLE: Final = 0o644 << 16
# What reading a ZIP file raises that is damaged, locked, or packed in an unknown way.
_DAMAGED: Final = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, RuntimeError, NotImplementedError
)  # fmt: skip
# Folders that some programs add.
_OF_PACKERS: Final = ("__MACOSX",)
# Of the free disk, what a data set may take.
_SHARE: Final = 0.9


def pack(archive: Path, out: Path) -> None:
    """Write a data set to a ZIP file, in a folder of its name and version.

    Raises
    ------
    InputError
        If the folder is no data set.
    """
    root = f"{NAME}-{version_of(archive)}"
    files = sorted(path for path in archive.rglob("*") if path.is_file())
    with replaced_file(out) as temporary, zipfile.ZipFile(temporary, "w") as packed:
        for path in files:
            entry = zipfile.ZipInfo(f"{root}/{path.relative_to(archive).as_posix()}", _DATE)
            entry.external_attr, entry.compress_type = _READABLE, zipfile.ZIP_DEFLATED
            packed.writestr(entry, path.read_bytes())


@contextmanager
def unpacked(path: Path) -> Iterator[Path]:
    """Yield the folder of a data set: ``path``, or what the ZIP file ``path`` holds.

    Raises
    ------
    InputError
        If it is neither, is damaged, or does not fit on the disk of temporary files.
    """
    must_exist(path)
    if path.is_dir():
        yield path
        return
    with TemporaryDirectory(prefix="pagd-") as folder:
        try:
            with zipfile.ZipFile(path) as packed:
                _must_fit(packed, Path(folder))
                packed.extractall(folder)
        except _DAMAGED as error:
            raise InputError(f"{path}: not a data set, nor a ZIP file of one ({error}).") from None
        roots = [one for one in Path(folder).iterdir() if one.name not in _OF_PACKERS]
        if len(roots) != 1 or not roots[0].is_dir():
            raise InputError(f"{path}: a ZIP file of a data set holds one folder, and no more.")
        yield roots[0]


def _must_fit(packed: zipfile.ZipFile, folder: Path) -> None:
    """Refuse what would fill the disk, by the sizes that the file itself tells."""
    size, free = sum(one.file_size for one in packed.infolist()), shutil.disk_usage(folder).free
    if size > _SHARE * free:
        raise InputError(
            f"{packed.filename}: holds {size / 1e6:,.0f} MB, of {free / 1e6:,.0f} MB that are free "
            f"in {folder.parent}."
        )


def check_target(packed: Path, archive: Path) -> None:
    """Refuse a file that :func:`pack` must not write, before the work.

    Raises
    ------
    InputError
        If it is a folder, lies in the data set, or is there and no ZIP file.
    """
    if packed.is_dir():
        raise InputError(f"{packed}: is a folder, not a ZIP file.")
    if packed.resolve().is_relative_to(archive.resolve()):
        raise InputError(f"{packed}: must not lie in the data set itself.")
    if packed.exists() and not zipfile.is_zipfile(packed):
        raise InputError(f"{packed}: is there, and no ZIP file; it is not replaced.")
