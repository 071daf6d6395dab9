"""Where an entry of a config stands: TOML readers tell no lines."""

from __future__ import annotations

import re

__all__ = ["line_of"]

_ARM = re.compile(r"^\s*\[\[\s*(tool\.ikgen\.)?arm\s*\]\]")


def line_of(text: str, where: str) -> int | None:
    """The line (from 1) of an entry such as `arm[0].lock.elbow`: the nearest that is found of its key, its
    table's, the `[[arm]]`'s; None where there is none."""
    lines = text.splitlines()
    place = re.match(r"arm\[(\d+)\]", where)
    if place is None:
        return _key(lines, 0, len(lines), where)
    starts = [i for i, line in enumerate(lines) if _ARM.match(line)]
    if int(place.group(1)) >= len(starts):
        return None  # written as an inline table
    start = starts[int(place.group(1))]
    end = next((i for i in starts if i > start), len(lines))
    keys = re.findall(r"\.([^.\[\]]+)", where)
    found = [line for key in keys if (line := _key(lines, start + 1, end, key)) is not None]
    return found[-1] if found else start + 1


def _key(lines: list[str], start: int, end: int, key: str) -> int | None:
    """The line between two that sets a key, or holds it in an inline table."""
    name = rf"[\"']?{re.escape(key)}[\"']?"
    pattern = re.compile(rf"(^\s*|[{{,]\s*){name}\s*=|^\s*\[.*\b{name}\s*\]|^\s*{name}\.")
    for i in range(start, end):
        if pattern.search(lines[i]) and not _ARM.match(lines[i]):
            return i + 1
    return None
