"""What long jobs tell while they run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

__all__ = ["Progress", "Stage", "Steps", "silent"]

Stage = Literal[
    "build", "read", "derive", "try", "emit", "typeset", "verify", "prove", "compile", "map"
]
"""What a job does: `build` looks at an arm of a config, `try` at other options for one that is unsolved."""

Progress = Callable[[Stage, str], None]
"""Called with a stage and a detail."""


def silent(stage: Stage, detail: str) -> None:
    """No progress."""


class Steps:
    """Keeps what a job tells, for one whose steps are told elsewhere: `told` are stages and details."""

    def __init__(self) -> None:
        self.told: list[tuple[Stage, str]] = []

    def __call__(self, stage: Stage, detail: str) -> None:
        self.told.append((stage, detail))
