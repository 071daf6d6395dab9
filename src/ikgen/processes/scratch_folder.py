"""Temporary folders that the next run removes where a killed one left them.

A folder holds a file that its process keeps locked: the system takes the lock away however the process
ends, so that a folder without a lock is nobody's.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import secrets
import shutil
import tempfile
import time
import weakref
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from ikgen.errors import UsageError

try:
    import fcntl
except ImportError:  # pragma: no cover  (Windows: folders count by age alone)
    fcntl = None  # type: ignore[assignment]

__all__ = ["ScratchFolder", "abandoned", "remove_abandoned", "remove_own", "try_lock"]

_LOCK = ".lock"
_MAKER = re.compile(r"-(\d+)-[^-]*$")
_LOCKLESS = 3600.0
"""Age (s) from which a folder without a file to lock is one that a killed run left, whose process may
not be looked for."""

_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO)
"""What says that a place takes no more files, rather than that one file is in the way."""


_OWN: set[Path] = set()
"""Folders of this process that are there, or about to be made."""


class ScratchFolder:
    """A new folder `path` named `prefix` and more, in `place` (default: the system's for temporary
    files), removed at `close`, at the end of a `with` and of the process. Those that killed runs left
    beside it are removed first. Where the disk is full, read-only or broken, `UsageError` says which
    place that is."""

    def __init__(self, prefix: str, place: Path | None = None) -> None:
        remove_abandoned(prefix, place)
        try:
            root = Path(tempfile.gettempdir()) if place is None else place
            self.path = root / f"{prefix}{os.getpid()}-{secrets.token_hex(6)}"
            held = contextlib.ExitStack()
            _OWN.add(self.path)
            self._remove = weakref.finalize(self, _removed, self.path, held)
            self.path.mkdir(0o700)  # who is ended from here on leaves nothing
            held.enter_context(_locked(self.path))
        except OSError as error:
            raise _unwritable(place, error) from error
        self._place = place

    def close(self) -> None:
        """Remove the folder with all that is in it."""
        self._remove()

    def __enter__(self) -> Path:
        return self.path

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
        if isinstance(error, OSError) and error.errno in _NO_ROOM:
            raise _unwritable(self._place, error) from error


def _unwritable(place: Path | None, error: OSError) -> UsageError:
    """What to say where nothing more can be written to a place: the system's words name none."""
    where = place or os.environ.get("TMPDIR") or "/tmp"
    first = "make room there" if error.errno in _NO_ROOM else "make it writable"
    hint = f"{first}, or {'name another folder' if place else 'set TMPDIR'}"
    return UsageError(f"cannot write to '{where}': {error.strerror or error}", hint=hint)


def _locked(folder: Path) -> IO[Any]:
    """The folder's file, locked before it has its name: no other run finds it without its lock."""
    unnamed = folder / f"{_LOCK}-"
    file = unnamed.open("wb")
    try_lock(file)
    unnamed.rename(folder / _LOCK)
    return file


def _removed(path: Path, held: contextlib.ExitStack) -> None:
    shutil.rmtree(path, ignore_errors=True)
    _OWN.discard(path)
    held.close()


def remove_own() -> None:
    """Remove the folders of this process, for one that ends without unwinding, whatever it was at."""
    for path in list(_OWN):
        shutil.rmtree(path, ignore_errors=True)


def try_lock(file: IO[Any] | int, *, wait: bool = False) -> bool:
    """Lock an open file for this process; false where another one has it. True where the system or the
    file system knows no locks."""
    if fcntl is None:
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True


def remove_abandoned(prefix: str, place: Path | None = None) -> None:
    """Remove the folders that `abandoned` finds."""
    for folder in abandoned(prefix, place):
        shutil.rmtree(folder, ignore_errors=True)


def abandoned(prefix: str, place: Path | None = None) -> list[Path]:
    """Folders named `prefix` and more, of this user, whose process is gone."""
    try:
        root = Path(tempfile.gettempdir()) if place is None else place
        found = sorted(path for path in root.iterdir() if path.name.startswith(prefix))
    except OSError:
        return []
    return [path for path in found if _is_abandoned(path)]


def _is_abandoned(folder: Path) -> bool:
    try:
        status = folder.lstat()
        if folder.is_symlink() or not folder.is_dir() or not _is_ours(status):
            return False
        if fcntl is None or not (folder / _LOCK).is_file():
            return time.time() - status.st_mtime > _LOCKLESS or not _maker_lives(folder.name)
        with (folder / _LOCK).open("rb") as lock:
            return try_lock(lock)
    except OSError:  # gone meanwhile, or not ours to look into
        return False


def _maker_lives(name: str) -> bool:
    """Whether the process is there that a folder's name tells; true where that cannot be known."""
    number = _MAKER.search(name)
    if number is None or os.name == "nt":  # there a signal 0 ends the process
        return True
    try:
        os.kill(int(number.group(1)), 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _is_ours(status: os.stat_result) -> bool:
    return not hasattr(os, "geteuid") or status.st_uid == os.geteuid()
