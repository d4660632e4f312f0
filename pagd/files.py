"""Files that are either complete or absent: written beside their target, then renamed."""

from __future__ import annotations

import os
import platform
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pagd.errors import InputError

__all__ = ["must_exist", "replaced_file", "replaced_folder", "write_text"]


def must_exist(file: Path) -> None:
    """Refuse a file that is not there, with ``InputError``; it names the folder if that is not."""
    if not file.parent.exists():
        raise InputError(f"{file.parent}: there is no such folder.")
    if not file.exists():
        raise InputError(f"{file}: there is no such file.")


@contextmanager
def replaced_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path``; it replaces ``path`` unless the block raises."""
    path.parent.mkdir(parents=True, exist_ok=True)
    _remove_abandoned(path, path.suffix)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=_own(path), suffix=path.suffix)
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
        What killed processes left of their attempts at ``path`` is removed as well.
    marker
        Name of a file that only folders made here hold.

    Raises
    ------
    InputError
        If ``path`` exists and is neither empty nor marked.
    """
    _refuse_foreign(path, marker)
    path.parent.mkdir(parents=True, exist_ok=True)
    _remove_abandoned(path)
    temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=_own(path)))
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


# Temporary names: .NAME.HOST.PROCESS.RANDOM. Whoever comes next for the same target can tell
# what a killed process has left from what another one still writes.


def _host(path: Path) -> str:
    return f".{path.name}.{re.sub('[^A-Za-z0-9-]', '-', platform.node())}."


def _own(path: Path) -> str:
    return f"{_host(path)}{os.getpid()}."


def _remove_abandoned(path: Path, suffix: str = "") -> None:
    """Remove what processes of this host that are no more have left beside ``path``."""
    name = re.compile(rf"{re.escape(_host(path))}(\d{{1,9}})\.[a-z0-9_]{{8}}{re.escape(suffix)}")
    for other in list(path.parent.iterdir()):
        found = name.fullmatch(other.name)
        if found is None or _is_alive(int(found[1])):
            continue
        if other.is_dir() and not other.is_symlink():
            shutil.rmtree(other, ignore_errors=True)
        else:
            other.unlink(missing_ok=True)


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:  # somebody else's
        return True
    return True


def _umask() -> int:
    # There is no call that only reads it. Nothing else runs in this process meanwhile.
    mask = os.umask(0)
    os.umask(mask)
    return mask
