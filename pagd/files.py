"""Files that are either complete or absent: written beside their target, then renamed."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pagd.errors import InputError

__all__ = ["replaced_file", "replaced_folder", "write_text"]


@contextmanager
def replaced_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path``; it replaces ``path`` unless the block raises."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=path.suffix)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write ``text`` (UTF-8) to ``path``, which is never seen half written."""
    with replaced_file(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextmanager
def replaced_folder(path: Path, marker: str) -> Iterator[Path]:
    """Yield a new, empty folder beside ``path``; it replaces ``path`` unless the block raises.

    Parameters
    ----------
    path
        Folder to make. An older one is removed, but only if it is empty or holds ``marker``:
        a mistyped name must not cost anybody a folder of their own.
    marker
        Name of a file that only folders made here hold.

    Raises
    ------
    InputError
        If ``path`` exists and is neither empty nor marked.
    """
    _refuse_foreign(path, marker)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}."))
    try:
        yield temporary
        temporary.chmod(0o777 & ~_umask())
        if path.exists():
            shutil.rmtree(path)
        temporary.rename(path)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _refuse_foreign(path: Path, marker: str) -> None:
    if not path.exists() or (path / marker).is_file():
        return
    if not path.is_dir() or any(path.iterdir()):
        raise InputError(
            f"{path}: exists and holds no {marker}, so it is not replaced; "
            "name a new or an empty folder."
        )


def _umask() -> int:
    # There is no call that only reads it. Nothing else runs in this process meanwhile.
    mask = os.umask(0)
    os.umask(mask)
    return mask
