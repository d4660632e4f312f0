"""Files that are either complete or absent: written beside their target, then renamed.

What is written is on the disk before it is renamed, so that a power cut leaves the old or the new
and never a file without its content: a file system may keep a new name and lose what it stands for.
"""

from __future__ import annotations

import errno
import os
import platform
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pagd.errors import InputError

__all__ = [
    "SCRATCH",
    "emptied",
    "is_abandoned",
    "must_exist",
    "replaced_file",
    "replaced_folder",
    "write_text",
]


#: Environment variable that names a folder on a disk of the machine itself: folders are made there,
#: and carried to where they belong as a whole, where that is a disk of a network.
SCRATCH = "PAGD_SCRATCH"


def must_exist(file: Path) -> None:
    """Refuse a file that is not there, with ``InputError``; it names the folder if that is not."""
    if not file.parent.exists():
        raise InputError(f"{file.parent}: there is no such folder.")
    if not file.exists():
        raise InputError(f"{file}: there is no such file.")


@contextmanager
def replaced_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path``; it replaces ``path`` unless the block raises.

    Raises
    ------
    InputError
        If its folder cannot be made: something on the way is a file, or not the user's.
    """
    _make_folder_of(path)
    _remove_abandoned(path, path.suffix)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=_own(path), suffix=path.suffix)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o666 & ~_umask())
        _flush(temporary)
        temporary.replace(path)
        _flush(path.parent)
    finally:
        temporary.unlink(missing_ok=True)


def emptied(folder: Path) -> Path:
    """Remove all that is in a folder; return it."""
    for one in folder.iterdir():
        if one.is_dir() and not one.is_symlink():
            shutil.rmtree(one)
        else:
            one.unlink()
    return folder


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
        If ``path`` exists and is neither empty nor marked, or cannot be made.
    """
    _refuse_foreign(path, marker)
    _make_folder_of(path)
    _remove_abandoned(path)
    temporary = Path(tempfile.mkdtemp(dir=path.parent, prefix=_own(path)))
    older: Path | None = None
    try:
        with _place_to_work(temporary) as work:
            yield work
            if work != temporary:
                shutil.copytree(work, temporary, dirs_exist_ok=True)
        temporary.chmod(0o777 & ~_umask())
        for one in (*temporary.rglob("*"), temporary):
            _flush(one)
        # An older one is put aside first, so that none is ever seen half removed.
        if path.exists():
            path.rename(older := Path(tempfile.mkdtemp(dir=path.parent, prefix=_own(path))))
        temporary.rename(path)
        _flush(path.parent)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        if older is not None:
            shutil.rmtree(older, ignore_errors=True)


def _make_folder_of(path: Path) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError, PermissionError) as error:
        raise InputError(f"{path}: cannot be made ({error.strerror}: {error.filename}).") from None


def _flush(path: Path) -> None:
    """Wait until a file's content, or a folder's names, are on the disk."""
    if path.is_symlink():
        return
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as error:
        # Some file systems of networks have no such thing for folders.
        if error.errno != errno.EINVAL:
            raise
    finally:
        os.close(descriptor)


@contextmanager
def _place_to_work(temporary: Path) -> Iterator[Path]:
    """The temporary folder itself, or one on the disk of the machine where ``SCRATCH`` names it."""
    scratch = os.environ.get(SCRATCH)
    if not scratch:
        yield temporary
        return
    if not Path(scratch).is_dir():
        raise InputError(f"{SCRATCH} = {scratch}: must be a folder, but there is none.")
    with tempfile.TemporaryDirectory(dir=scratch, prefix="pagd-") as name:
        yield Path(name)


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


def is_abandoned(path: Path) -> bool:
    """Whether a file or folder is what a killed process of this host has left of an attempt."""
    host = re.escape(re.sub("[^A-Za-z0-9-]", "-", platform.node()))
    found = re.fullmatch(rf"\..+\.{host}\.(\d{{1,9}})\.[a-z0-9_]{{8}}(\.[a-z0-9]+)?", path.name)
    return found is not None and not _is_alive(int(found[1]))


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
