"""What long jobs tell while they run."""

from __future__ import annotations

from collections.abc import Callable

__all__ = ["Progress", "Steps", "silent"]

Progress = Callable[[str, str], None]
"""Called with a stage (read, derive, emit, verify) and a detail."""


def silent(stage: str, detail: str) -> None:
    """No progress."""


class Steps:
    """Keeps what a job tells, for one whose steps are told elsewhere: `told` are stages and details."""

    def __init__(self) -> None:
        self.told: list[tuple[str, str]] = []

    def __call__(self, stage: str, detail: str) -> None:
        self.told.append((stage, detail))
