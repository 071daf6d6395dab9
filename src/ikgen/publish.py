"""Put finished files into the user's folder: all of them or none."""

from __future__ import annotations

import errno
import shutil
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

__all__ = ["Content", "publish", "write_texts"]

Content = str | bytes
"""What a file holds: text (written as UTF-8, lines ended by a line feed) or bytes as they are."""

_PREFIX = ".ikgen-"
_LEFT_OVER = 3600.0
"""Age (s) from which a staging folder is one that a killed run left, not one of a run beside this."""


def publish(out: Path, files: Mapping[str, Content]) -> tuple[Path, ...]:
    """Write files (name -> content) into a folder, all of them or none; unchanged files keep their
    time. Staging folders that killed runs left there are removed."""
    out.mkdir(parents=True, exist_ok=True)
    _sweep(out)
    with tempfile.TemporaryDirectory(prefix=_PREFIX, dir=out, ignore_cleanup_errors=True) as name:
        new, old = Path(name, "new"), Path(name, "old")
        write_texts(new, files)
        changed = [name for name, content in files.items() if not _holds(out / name, content)]
        _move(new, out, changed, old)
    return tuple(out / name for name in files)


def write_texts(folder: Path, files: Mapping[str, Content]) -> None:
    """Write files (name -> content) into a folder, one after the other."""
    for file, content in files.items():
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(_bytes(content))


def _sweep(out: Path) -> None:
    """Remove old staging folders; one that cannot be removed is left alone."""
    for folder in out.glob(f"{_PREFIX}*"):
        try:
            old = time.time() - folder.stat().st_mtime > _LEFT_OVER
        except OSError:
            continue  # another run removed it
        if old and folder.is_dir() and not folder.is_symlink():
            shutil.rmtree(folder, ignore_errors=True)


def _move(staging: Path, out: Path, names: list[str], old: Path) -> None:
    """Move finished files into place, each in one step; the earlier ones come back if one fails."""
    for name in names:
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        if (out / name).is_dir():
            raise IsADirectoryError(errno.EISDIR, "is a directory", str(out / name))
        if (out / name).exists():
            (old / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(out / name, old / name)
    moved = []
    try:
        for name in names:
            (staging / name).replace(out / name)
            moved.append(name)
    except BaseException:  # an interrupt too must not leave half of the files
        for name in moved:
            _put_back(old / name, out / name)
        raise


def _put_back(earlier: Path, place: Path) -> None:
    """The file as it was before; none where there was none."""
    if earlier.exists():
        earlier.replace(place)
    else:
        place.unlink(missing_ok=True)


def _holds(path: Path, content: Content) -> bool:
    """Whether a file has exactly this content."""
    return path.is_file() and path.read_bytes() == _bytes(content)


def _bytes(content: Content) -> bytes:
    return content if isinstance(content, bytes) else content.encode()
