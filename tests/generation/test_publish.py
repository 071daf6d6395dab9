"""Files appear together or not at all, and nothing is left behind."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from ikgen.errors import UsageError
from ikgen.generation.publish import check_folder, publish, remove

HOUR = 3600.0


def content(folder: Path) -> dict[str, str]:
    return {p.relative_to(folder).as_posix(): p.read_text() for p in folder.rglob("*.*")}


def test_unchanged_files_keep_their_time(tmp_path: Path) -> None:
    publish(tmp_path, {"a.py": "one\n", "sub/b.py": "two\n"})
    os.utime(tmp_path / "a.py", (1.0, 1.0))
    files = publish(tmp_path, {"a.py": "one\n", "sub/b.py": "three\n", "c.pdf": b"\r\n"})
    assert files == (tmp_path / "a.py", tmp_path / "sub/b.py", tmp_path / "c.pdf")
    assert (tmp_path / "a.py").stat().st_mtime == 1.0
    assert (tmp_path / "c.pdf").read_bytes() == b"\r\n"
    assert content(tmp_path)["sub/b.py"] == "three\n"


def test_a_folder_in_the_way_leaves_all_as_it_was(tmp_path: Path) -> None:
    publish(tmp_path, {"a.py": "one\n"})
    (tmp_path / "b.py").mkdir()
    with pytest.raises(IsADirectoryError):
        publish(tmp_path, {"a.py": "two\n", "b.py": "two\n"})
    assert (tmp_path / "a.py").read_text() == "one\n"


@pytest.mark.parametrize("error", [PermissionError, KeyboardInterrupt])
def test_earlier_files_come_back_when_a_move_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: type[BaseException]
) -> None:
    publish(tmp_path, {"a.py": "one\n", "c.py": "one\n"})
    replace = Path.replace

    def failing(self: Path, target: Path) -> Path:
        if target == tmp_path / "c.py":
            raise error
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises(error):
        publish(tmp_path, {"a.py": "two\n", "new.py": "two\n", "c.py": "two\n"})
    assert content(tmp_path) == {"a.py": "one\n", "c.py": "one\n"}


def test_what_killed_runs_left_is_removed(tmp_path: Path) -> None:
    for name, age in (("killed", 2 * HOUR), ("running", 0.1 * HOUR)):
        folder = tmp_path / f".ikgen-{name}"
        folder.mkdir()
        (folder / "arm_ik.py").write_text("")
        os.utime(folder, (time.time() - age,) * 2)
    publish(tmp_path, {"a.py": "one\n"})
    assert sorted(p.name for p in tmp_path.iterdir()) == [".ikgen-running", "a.py"]


def test_a_folder_that_cannot_be_written_is_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    check_folder(tmp_path / "not" / "there" / "yet")
    assert not (tmp_path / "not").exists()
    for out in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(UsageError, match="is no directory"):
            check_folder(out)


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="needs a user without all rights")
def test_a_folder_without_permission(tmp_path: Path) -> None:
    (tmp_path / "locked").mkdir(mode=0o500)
    with pytest.raises(UsageError, match="no permission"):
        check_folder(tmp_path / "locked" / "out")


def test_removed_files_leave_no_empty_folders(tmp_path: Path) -> None:
    publish(tmp_path, {"package/src/a.py": "", "package/b.py": "", "other/c.py": ""})
    (tmp_path / "other/own.txt").write_text("")
    remove([tmp_path / n for n in ("package/src/a.py", "package/b.py", "other/c.py")], tmp_path)
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["other", "own.txt"]
