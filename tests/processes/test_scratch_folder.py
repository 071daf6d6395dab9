"""Temporary folders: removed by who made them, or by the next run."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ikgen.errors import UsageError
from ikgen.processes.scratch_folder import ScratchFolder, abandoned

KILLED = """
import os, signal, sys
from pathlib import Path
from ikgen.processes.scratch_folder import ScratchFolder
folder = ScratchFolder("x-", Path(sys.argv[1]))
(folder.path / "file").write_text("")
os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
def test_what_a_killed_process_left_is_removed(tmp_path: Path) -> None:
    mine = ScratchFolder("x-", tmp_path)
    done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)])
    assert done.returncode == -signal.SIGKILL
    (left,) = abandoned("x-", tmp_path)
    assert (left / "file").exists()
    with ScratchFolder("x-", tmp_path) as other:
        assert set(tmp_path.iterdir()) == {mine.path, other}
    del mine  # goes with the object
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.name == "nt", reason="needs process numbers")
def test_one_whose_process_was_killed_before_it_had_a_lock(tmp_path: Path) -> None:
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    for number in (ended.pid, os.getpid()):
        (tmp_path / f"x-{number}-abc").mkdir()
    assert abandoned("x-", tmp_path) == [tmp_path / f"x-{ended.pid}-abc"]


def test_links_and_other_names_are_left_alone(tmp_path: Path) -> None:
    real = tmp_path / "real"
    real.mkdir()
    (real / ".lock").write_text("")
    (tmp_path / "x-link").symlink_to(real)
    (tmp_path / "x-file").write_text("")
    assert abandoned("x-", tmp_path) == []


def test_no_room_for_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(UsageError, match="cannot write to"):
        ScratchFolder("x-", tmp_path / "not there")


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EIO])
def test_a_full_disk_is_told_by_its_place(tmp_path: Path, number: int) -> None:
    """The system's words do not say where."""
    with pytest.raises(UsageError, match="cannot write to") as told, ScratchFolder("x-", tmp_path):
        raise OSError(number, os.strerror(number))
    assert str(tmp_path) in told.value.message and os.strerror(number) in told.value.message
    assert not list(tmp_path.iterdir())


def test_other_errors_stay_as_they_are(tmp_path: Path) -> None:
    with pytest.raises(BrokenPipeError), ScratchFolder("x-", tmp_path):
        raise BrokenPipeError(errno.EPIPE, "gone")


def test_one_that_is_ended_while_it_is_made_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ended(folder: Path) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("ikgen.processes.scratch_folder._locked", ended)
    with pytest.raises(KeyboardInterrupt):
        ScratchFolder("x-", tmp_path)
    assert not list(tmp_path.iterdir())
