"""Where in its files something stands that an expansion failed over: xacro's exceptions carry no
line."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from ikgen.importers.xml_document import LARGEST_FILE, line_at

__all__ = ["line_of", "place_of", "text_of"]


_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_IN_LINE = re.compile(r"[^\n]")


def text_of(file: Path) -> str:
    """The text of a file, blanks for its comments; empty where it cannot be read."""
    try:
        if not file.is_file() or file.stat().st_size > LARGEST_FILE:
            return ""
        text = file.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
    return _COMMENT.sub(lambda comment: _IN_LINE.sub(" ", comment[0]), text)


def line_of(file: Path, pattern: str) -> int | None:
    """The first line that matches."""
    text = text_of(file)
    found = re.search(pattern, text)
    return line_at(text, found.start()) if found else None


def place_of(pattern: str, files: Sequence[Path], name: str) -> tuple[str, int | None]:
    """The first of the files that matches, with its line; `name` is what the first one is called in
    messages, and the answer where none does."""
    for file in files:
        line = line_of(file, pattern)
        if line is not None:
            return (name if file == files[0] else str(file)), line
    return name, None
