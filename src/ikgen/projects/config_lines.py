"""Where an entry of a config stands: TOML readers tell no lines."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

__all__ = ["ArmPlace", "line_of"]

_ARM = re.compile(r"^\s*\[\[\s*(tool\.ikgen\.)?arm\s*\]\]")


@dataclass(frozen=True, slots=True)
class ArmPlace:
    """The table of an arm in a config, by its index."""

    file: Path
    index: int

    def line_about(self, words: Iterable[str]) -> int | None:
        """The line (from 1) of the table that has the first of the words that one has, else where the table
        begins; None where that cannot be told."""
        lines = self.file.read_text("utf-8", errors="replace").splitlines()
        found = _table(lines, self.index)
        if found is None:
            return None
        start, end = found
        for word in words:
            whole = re.compile(rf"(?<![\w-]){re.escape(word)}(?![\w-])")
            for i in range(start + 1, end):
                if whole.search(lines[i].partition("#")[0]):
                    return i + 1
        return start + 1


def line_of(text: str, where: str) -> int | None:
    """The line (from 1) of an entry such as `arm[0].lock.elbow`: the nearest that is found of its key, its
    table's, the `[[arm]]`'s; None where there is none."""
    lines = text.splitlines()
    place = re.match(r"arm\[(\d+)\]", where)
    if place is None:
        return _key(lines, 0, len(lines), where)
    table = _table(lines, int(place.group(1)))
    if table is None:
        return None
    start, end = table
    keys = re.findall(r"\.([^.\[\]]+)", where)
    found = [line for key in keys if (line := _key(lines, start + 1, end, key)) is not None]
    return found[-1] if found else start + 1


def _table(lines: list[str], index: int) -> tuple[int, int] | None:
    """Where an `[[arm]]` begins and ends; None of one that is written as an inline table."""
    starts = [i for i, line in enumerate(lines) if _ARM.match(line)]
    if index >= len(starts):
        return None
    return starts[index], next(iter(starts[index + 1 :]), len(lines))


def _key(lines: list[str], start: int, end: int, key: str) -> int | None:
    """The line between two that sets a key, or holds it in an inline table."""
    name = rf"[\"']?{re.escape(key)}[\"']?"
    pattern = re.compile(rf"(^\s*|[{{,]\s*){name}\s*=|^\s*\[.*\b{name}\s*\]|^\s*{name}\.")
    for i in range(start, end):
        if pattern.search(lines[i]) and not _ARM.match(lines[i]):
            return i + 1
    return None
