import os
import subprocess
import sys
from pathlib import Path

import pytest

from pagd.errors import InputError
from pagd.files import SCRATCH, replaced_file, replaced_folder, write_text


def test_a_file_replaces_the_older_one(tmp_path: Path) -> None:
    target = tmp_path / "new" / "a.txt"
    write_text(target, "one")
    write_text(target, "two")
    assert target.read_text() == "two"
    assert list(target.parent.iterdir()) == [target]


def crash_in_file(target: Path) -> None:
    with replaced_file(target) as temporary:
        temporary.write_text("half")
        raise RuntimeError


def crash_in_folder(target: Path) -> None:
    with replaced_folder(target, "mark") as folder:
        (folder / "half").touch()
        raise RuntimeError


def test_a_crash_keeps_the_older_file(tmp_path: Path) -> None:
    target = tmp_path / "a.txt"
    write_text(target, "one")
    with pytest.raises(RuntimeError):
        crash_in_file(target)
    assert target.read_text() == "one"
    assert list(tmp_path.iterdir()) == [target]


def test_a_folder_replaces_an_older_marked_one(tmp_path: Path) -> None:
    target = tmp_path / "stage"
    for content in ("one", "two"):
        with replaced_folder(target, "mark") as folder:
            (folder / "mark").touch()
            (folder / content).touch()
    assert sorted(p.name for p in target.iterdir()) == ["mark", "two"]
    assert list(tmp_path.iterdir()) == [target]


def test_a_crash_leaves_no_folder(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError):
        crash_in_folder(tmp_path / "stage")
    assert list(tmp_path.iterdir()) == []


def test_a_foreign_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(InputError, match=r"holds no mark"), replaced_folder(tmp_path, "mark"):
        pass
    assert (tmp_path / "thesis.tex").exists()


def test_what_lies_under_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for path in (tmp_path / "file/folder/here", tmp_path / "file/here"):
        with pytest.raises(InputError, match=r"here: cannot be made \(.*file"):
            write_text(path, "text")
        with (
            pytest.raises(InputError, match=r"here: cannot be made \(.*file"),
            replaced_folder(path, "marker"),
        ):
            pass


def test_files_follow_the_umask(tmp_path: Path) -> None:
    plain = tmp_path / "plain"
    plain.touch()
    write_text(tmp_path / "a.txt", "")
    with replaced_folder(tmp_path / "stage", "mark"):
        pass
    (tmp_path / "folder").mkdir()
    assert (tmp_path / "a.txt").stat().st_mode == plain.stat().st_mode
    assert (tmp_path / "stage").stat().st_mode == (tmp_path / "folder").stat().st_mode


KILLED = """
import os, signal, sys
from pathlib import Path
from pagd.files import SCRATCH, replaced_file, replaced_folder
root = Path(sys.argv[1])
with replaced_folder(root / "solve", "mark") as folder, replaced_file(root / "a.csv") as file:
    (folder / "half").touch()
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_what_a_killed_process_left_is_removed(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], check=False)
    assert len(list(tmp_path.iterdir())) == 2
    with replaced_folder(tmp_path / "solve", "mark"):
        pass
    write_text(tmp_path / "a.csv", "")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.csv", "solve"]


def test_what_others_write_is_left_alone(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], check=False)
    (left,) = tmp_path.glob(".solve.*")
    _, _, host, process, random = left.name.split(".")
    foreign = [
        tmp_path / f".solve.{host}.{os.getpid()}.{random}",  # alive
        tmp_path / f".solve.elsewhere.{process}.{random}",  # another host
        tmp_path / f".solve-2.{host}.{process}.{random}",  # another target
        tmp_path / f".solve.{host}.{process}.thesis",  # no name of ours
    ]
    for folder in foreign:
        folder.mkdir()
    with replaced_folder(tmp_path / "solve", "mark"):
        pass
    assert not left.exists()
    assert all(folder.is_dir() for folder in foreign)


def test_a_folder_is_made_on_the_scratch_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scratch, target = tmp_path / "scratch", tmp_path / "far" / "stage"
    scratch.mkdir()
    monkeypatch.setenv(SCRATCH, str(scratch))
    with replaced_folder(target, "mark") as folder:
        assert folder.parent == scratch
        (folder / "mark").touch()
        (folder / "inner").mkdir()
        (folder / "inner" / "file").write_text("carried")
    assert (target / "inner" / "file").read_text() == "carried"
    assert list(scratch.iterdir()) == []
    with pytest.raises(RuntimeError):
        crash_in_folder(target)
    assert list(scratch.iterdir()) == []
    assert [path.name for path in target.parent.iterdir()] == ["stage"]


def test_what_is_renamed_is_on_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every file and folder is flushed before the rename, and the name after it."""
    seen: list[str] = []
    sync, rename = os.fsync, Path.rename

    def note_sync(descriptor: int) -> None:
        seen.append(Path(f"/proc/self/fd/{descriptor}").readlink().name)
        sync(descriptor)

    def note_rename(self: Path, target: Path) -> Path:
        seen.append("renamed")
        return rename(self, target)

    monkeypatch.setattr(os, "fsync", note_sync)
    monkeypatch.setattr(Path, "rename", note_rename)
    with replaced_folder(tmp_path / "stage", "mark") as folder:
        (folder / "mark").touch()
        (folder / "inner").mkdir()
        (folder / "inner" / "file").touch()
    before, after = seen[: seen.index("renamed")], seen[seen.index("renamed") + 1 :]
    assert {"mark", "inner", "file", folder.name} <= set(before)
    assert after == [tmp_path.name]
