"""Put finished files into the user's folder: all of them or none."""

from __future__ import annotations

import errno
import tempfile
from collections.abc import Mapping
from pathlib import Path

__all__ = ["publish", "write_texts"]


def publish(out: Path, texts: Mapping[str, str]) -> tuple[Path, ...]:
    """Write texts (name -> text) into a folder, all of them or none; unchanged files keep their
    time."""
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".ikgen-", dir=out, ignore_cleanup_errors=True) as name:
        write_texts(Path(name), texts)
        return _move(Path(name), out, texts)


def write_texts(folder: Path, texts: Mapping[str, str]) -> None:
    """Write texts (name -> text) into a folder, one after the other."""
    for file, text in texts.items():
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")


def _move(staging: Path, out: Path, texts: Mapping[str, str]) -> tuple[Path, ...]:
    """Move finished files into place, each in one step."""
    changed = [name for name, text in texts.items() if not _holds(out / name, text)]
    for name in changed:
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        if (out / name).is_dir():
            raise IsADirectoryError(errno.EISDIR, "is a directory", str(out / name))
    for name in changed:
        (staging / name).replace(out / name)
    return tuple(out / name for name in texts)


def _holds(path: Path, text: str) -> bool:
    """Whether a file has exactly this text."""
    return path.is_file() and path.read_bytes() == text.encode()
