"""One file of a whole data set, as repositories that give out DOIs take it."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from pagd import __version__
from pagd.archive.card import NAME
from pagd.errors import InputError
from pagd.files import must_exist, replaced_file

__all__ = ["pack", "unpacked"]

#: The folder in the file.
_ROOT: Final = f"{NAME}-{__version__}"
# The same files give the same bytes, whenever they were written. ZIP knows no earlier day.
_DATE: Final = (1980, 1, 1, 0, 0, 0)
_READABLE: Final = 0o644 << 16


def pack(archive: Path, out: Path) -> None:
    """Write a data set to a ZIP file, in a folder of its name and version."""
    files = sorted(path for path in archive.rglob("*") if path.is_file())
    with replaced_file(out) as temporary, zipfile.ZipFile(temporary, "w") as packed:
        for path in files:
            entry = zipfile.ZipInfo(f"{_ROOT}/{path.relative_to(archive).as_posix()}", _DATE)
            entry.external_attr, entry.compress_type = _READABLE, zipfile.ZIP_DEFLATED
            packed.writestr(entry, path.read_bytes())


@contextmanager
def unpacked(path: Path) -> Iterator[Path]:
    """Yield the folder of a data set: ``path``, or what the ZIP file ``path`` holds.

    Raises
    ------
    InputError
        If it is neither.
    """
    must_exist(path)
    if path.is_dir():
        yield path
        return
    with TemporaryDirectory(prefix="pagd-") as folder:
        try:
            with zipfile.ZipFile(path) as packed:
                packed.extractall(folder)
        except (zipfile.BadZipFile, OSError) as error:
            raise InputError(f"{path}: not a data set, nor a ZIP file of one ({error}).") from None
        roots = [one for one in Path(folder).iterdir() if one.is_dir()]
        if len(roots) != 1:
            raise InputError(f"{path}: a ZIP file of a data set holds one folder.")
        yield roots[0]
