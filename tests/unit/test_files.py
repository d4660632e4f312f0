from pathlib import Path

import pytest

from pagd.errors import InputError
from pagd.files import replaced_file, replaced_folder, write_text


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


def test_files_follow_the_umask(tmp_path: Path) -> None:
    plain = tmp_path / "plain"
    plain.touch()
    write_text(tmp_path / "a.txt", "")
    with replaced_folder(tmp_path / "stage", "mark"):
        pass
    (tmp_path / "folder").mkdir()
    assert (tmp_path / "a.txt").stat().st_mode == plain.stat().st_mode
    assert (tmp_path / "stage").stat().st_mode == (tmp_path / "folder").stat().st_mode
