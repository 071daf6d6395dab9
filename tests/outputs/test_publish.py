"""Files appear together or not at all, and nothing is left behind."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ikgen.errors import UsageError
from ikgen.outputs.journal import interrupted
from ikgen.outputs.publish import check_folder, publish
from ikgen.processes.scratch_folder import ScratchFolder

pytestmark = pytest.mark.usefixtures("solved_once")

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
        if target == tmp_path / "c.py" and self.parent.name == "new":
            raise error
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises(error):
        publish(tmp_path, {"a.py": "two\n", "new.py": "two\n", "c.py": "two\n"})
    assert content(tmp_path) == {"a.py": "one\n", "c.py": "one\n"}


def test_what_killed_runs_left_is_removed(tmp_path: Path) -> None:
    running = ScratchFolder(".ikgen-", tmp_path)
    for name, age in (("killed", 2 * HOUR), ("begun", 0.1 * HOUR), ("also-killed", 0.0)):
        folder = tmp_path / f".ikgen-{name}"
        folder.mkdir()
        (folder / "arm_ik.py").write_text("")
        if name == "also-killed":
            (folder / ".lock").write_text("")  # which no process has locked
        os.utime(folder, (time.time() - age,) * 2)
    publish(tmp_path, {"a.py": "one\n"})
    left = {p.name for p in tmp_path.iterdir()}
    assert left == {".ikgen-begun", running.path.name, "a.py"}


FILES = ("arm_ik.py", "arm_ik.hpp", "arm_ik.json", "gone.py")
KILLED = """
import os, signal, sys
from pathlib import Path
from ikgen.outputs.publish import publish
left = int(sys.argv[1])
def counted(function):
    def call(*arguments, **named):
        global left
        left -= 1
        if not left:
            os.kill(os.getpid(), signal.SIGKILL)
        return function(*arguments, **named)
    return call
for name in ("replace", "unlink", "mkdir", "write_bytes", "write_text", "rmdir"):
    setattr(Path, name, counted(getattr(Path, name)))
out = Path("out")
publish(out, {name: "two" for name in sys.argv[2:5]}, [out / sys.argv[5]])
"""


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
def test_a_kill_at_any_moment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Before each of the calls that change files: never two runs' files side by side, and the next run
    finds all of them."""
    monkeypatch.chdir(tmp_path)
    before, after = dict.fromkeys(FILES, "one"), dict.fromkeys(FILES[:3], "two")
    seen = set()
    for moment in range(1, 100):
        publish(tmp_path / "out", before)
        done = subprocess.run([sys.executable, "-c", KILLED, str(moment), *FILES])
        if done.returncode == 0:
            break
        assert done.returncode == -signal.SIGKILL
        now = visible(tmp_path / "out")
        solvers = {text for name, text in now.items() if not name.endswith(".json")}
        assert len(solvers) <= 1, (moment, now)
        half = bool(interrupted(tmp_path / "out"))
        assert half or now in (before, after)
        publish(tmp_path / "out", {})
        now = visible(tmp_path / "out")
        assert now in (before, after) and (not half or now == after)
        assert not list((tmp_path / "out").glob(".ikgen-*"))
        seen.add(half)
    assert done.returncode == 0 and seen == {True, False}
    assert visible(tmp_path / "out") == after


def visible(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.glob("[!.]*")}


def test_a_journal_moves_nothing_outside_its_folder(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    (tmp_path / "out").mkdir()
    (tmp_path / "out/link").symlink_to(tmp_path)
    for number, name in enumerate(("../mine.txt", str(tmp_path / "mine.txt"), "link/mine.txt")):
        staging = tmp_path / f"out/.ikgen-{number}"
        staging.mkdir()
        (staging / ".lock").write_text("")
        (staging / "journal.json").write_text(json.dumps({"put": [], "remove": [name]}))
    publish(tmp_path / "out", {"a.py": "one"})
    assert (tmp_path / "mine.txt").read_text() == "mine"


def test_a_folder_that_cannot_be_written_is_refused_at_once(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    check_folder(tmp_path / "not" / "there" / "yet")
    assert not (tmp_path / "not").exists()
    for out in (tmp_path / "file", tmp_path / "file" / "below"):
        with pytest.raises(UsageError, match="is no directory"):
            check_folder(out)


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs /proc")
def test_where_nobody_can_make_a_folder() -> None:
    with pytest.raises(UsageError, match=r"cannot write to '/proc'|no permission"):
        check_folder(Path("/proc/out"))


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="needs a user without all rights")
def test_a_folder_without_permission(tmp_path: Path) -> None:
    (tmp_path / "locked").mkdir(mode=0o500)
    with pytest.raises(UsageError, match="no permission"):
        check_folder(tmp_path / "locked" / "out")


def test_removed_files_leave_no_empty_folders(tmp_path: Path) -> None:
    publish(tmp_path, {"package/src/a.py": "", "package/b.py": "", "other/c.py": ""})
    (tmp_path / "other/own.txt").write_text("")
    gone = [tmp_path / n for n in ("package/src/a.py", "package/b.py", "other/c.py")]
    publish(tmp_path, {}, gone)
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["other", "own.txt"]
