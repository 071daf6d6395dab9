"""The files and commands that a page of the documentation shows."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Block", "blocks"]

_FENCE = re.compile(r'^```(\w+)(?: title="([^"]*)")?\n(.*?)^```$', re.M | re.S)


@dataclass(frozen=True, slots=True)
class Block:
    """One fenced block: its language, its title ("" where it has none) and its text."""

    language: str
    title: str
    text: str

    @property
    def is_file(self) -> bool:
        """Whether the title is the file that the text belongs in."""
        return "/" in self.title or "." in self.title


def blocks(page: Path) -> list[Block]:
    """All fenced blocks of a page in order."""
    return [Block(*match.groups(default="")) for match in _FENCE.finditer(page.read_text("utf-8"))]
