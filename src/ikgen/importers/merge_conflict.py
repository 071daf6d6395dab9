"""What an unresolved merge leaves in files that are kept under version control."""

from __future__ import annotations

import re

__all__ = ["conflict_or"]

_MARKERS = re.compile(r"^(<{7}|>{7}) ", re.MULTILINE)


def conflict_or(text: str, hint: str) -> str:
    """What to do about a text that cannot be read: resolve the merge where it holds markers of one, else
    `hint`."""
    if _MARKERS.search(text):
        return "the file holds the markers of an unresolved merge conflict (<<<<<<<, >>>>>>>)"
    return hint
