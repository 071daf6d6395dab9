"""What long jobs tell while they run."""

from __future__ import annotations

from collections.abc import Callable

__all__ = ["Progress", "silent"]

Progress = Callable[[str, str], None]
"""Called with a stage (read, derive, emit, verify) and a detail."""


def silent(stage: str, detail: str) -> None:
    """No progress."""
