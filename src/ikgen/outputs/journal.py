"""Moving files into place so that no moment is fatal: a kill leaves what the next run completes.

The files wait in a staging folder beside their places, with a journal of what is to be moved. From the
moment that the journal is there the publishing counts as done, and whoever finds it without its process
does the rest. Files that belong together never stand mixed: where several change, the old ones are moved
out of the way before the first new one comes.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from ikgen.processes.scratch_folder import abandoned, remove_abandoned, try_lock
from ikgen.records.record import SUFFIX

__all__ = ["PREFIX", "Publishing", "complete", "complete_folder", "interrupted", "publishing_alone"]

PREFIX = ".ikgen-"
"""How staging folders begin."""

_JOURNAL = "journal.json"


@dataclass(frozen=True, slots=True)
class Publishing:
    """Files to `put` into `out` from the folder `new` of `staging`, and files of `out` to `remove`: paths
    relative to these, with slashes. The old ones are kept in the folder `old`."""

    out: Path
    staging: Path
    put: tuple[str, ...]
    remove: tuple[str, ...] = ()

    def run(self) -> None:
        """Move everything; whatever stops it, an interrupt too, puts all back as it was."""
        if not self.put and not self.remove:
            return
        self._write_journal()
        try:
            self.finish()
        except BaseException:
            self._undo()
            raise

    def finish(self) -> None:
        """Do what is left; files of `new` are those that are not in place yet."""
        waiting = [name for name in self._ordered() if self._new(name).exists()]
        gone = [name for name in self.remove if self._place(name).exists()]
        together = [name for name in (*self.put, *self.remove) if not name.endswith(SUFFIX)]
        for name in (*waiting, *gone):
            if self._place(name).exists():
                self._keep(name, aside=name in gone or len(together) > 1)
        for name in waiting:
            self._place(name).parent.mkdir(parents=True, exist_ok=True)
            self._new(name).replace(self._place(name))
        (self.staging / _JOURNAL).unlink()
        for name in self.remove:
            _remove_empty(self._place(name).parent, self.out)

    def _ordered(self) -> list[str]:
        """Records last: where one is, its files are."""
        return sorted(self.put, key=lambda name: name.endswith(SUFFIX))

    def _undo(self) -> None:
        for name in reversed(self._ordered()):
            if not self._new(name).exists():
                self._place(name).replace(self._new(name))
        for name in (*self.put, *self.remove):
            if self._old(name).exists():
                self._old(name).replace(self._place(name))
        (self.staging / _JOURNAL).unlink(missing_ok=True)

    def _keep(self, name: str, *, aside: bool) -> None:
        """Keep an old file; out of the way, or a copy of it."""
        self._old(name).parent.mkdir(parents=True, exist_ok=True)
        if aside:
            self._place(name).replace(self._old(name))
        else:
            shutil.copy2(self._place(name), self._old(name))

    def _write_journal(self) -> None:
        draft = self.staging / f"{_JOURNAL}-"
        draft.write_text(json.dumps({"put": self.put, "remove": self.remove}), encoding="utf-8")
        draft.replace(self.staging / _JOURNAL)

    def _new(self, name: str) -> Path:
        return self.staging / "new" / name

    def _old(self, name: str) -> Path:
        return self.staging / "old" / name

    def _place(self, name: str) -> Path:
        return self.out / name


@contextlib.contextmanager
def publishing_alone(out: Path) -> Iterator[None]:
    """No other process publishes into the folder meanwhile, where the system can lock folders."""
    try:
        folder = os.open(out, os.O_RDONLY)
    except OSError:
        yield
        return
    try:
        try_lock(folder, wait=True)
        yield
    finally:
        os.close(folder)


def interrupted(out: Path) -> tuple[str, ...]:
    """The files of the folder that a killed run left half in place, by their paths in it."""
    return tuple(name for publishing in _begun(out) for name in publishing.put)


def half_in_place(record: Path, out: Path | None = None) -> bool:
    """Whether a killed run left the outputs of a record so, which it put into `out` (default: the record's
    folder)."""
    return record.name in {Path(name).name for name in interrupted(out or record.parent)}


def complete(out: Path) -> None:
    """Put in place what killed runs had begun to put into the folder, and remove what else they left; for
    who publishes there alone."""
    for publishing in _begun(out):
        publishing.finish()
    remove_abandoned(PREFIX, out)


def complete_folder(out: Path) -> None:
    """Like `complete`, for a folder that may not be there."""
    if out.is_dir():
        with publishing_alone(out):
            complete(out)


def _begun(out: Path) -> list[Publishing]:
    """What has a journal and no process. One that names places outside the folder is none of ours."""
    found = []
    for staging in abandoned(PREFIX, out):
        try:
            journal = json.loads((staging / _JOURNAL).read_text(encoding="utf-8"))
            put, remove = (tuple(map(str, journal[key])) for key in ("put", "remove"))
        except (OSError, ValueError, KeyError, TypeError):
            continue
        if all(_is_inside(out, name) for name in (*put, *remove)):
            found.append(Publishing(out, staging, put, remove))
    return found


def _is_inside(out: Path, name: str) -> bool:
    parts = PurePosixPath(name).parts
    if not parts or PurePosixPath(name).is_absolute() or ".." in parts:
        return False
    return (out / name).parent.resolve().is_relative_to(out.resolve())


def _remove_empty(folder: Path, out: Path) -> None:
    """Remove a folder below `out`, and those around it, that nothing is in."""
    while folder != out and folder.is_dir() and not any(folder.iterdir()):
        folder.rmdir()
        folder = folder.parent
