"""How much one expansion may compute: nothing in a description may keep ikgen busy for ever."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

from ikgen.importers.xacro.refusals import ExpansionLimitError

__all__ = ["MOST_CHARACTERS", "MOST_NODES", "MOST_SECONDS", "Budget"]

MOST_SECONDS = 5.0
"""Processor time of an expansion; the largest published files take 0.2 s."""

MOST_NODES = 200_000
"""Elements and texts that the files have and macros copy; the published files have some 5,000, and
one takes some 1.6 kB of memory."""

MOST_CHARACTERS = 50_000_000
"""Characters of all of them together."""

_STEPS_A_LOOK = 1000


@dataclass(slots=True)
class Budget:
    """What an expansion has used so far; every method raises `ExpansionLimitError` beyond a limit."""

    nodes: int = 0
    characters: int = 0
    steps: int = 0
    started: float = field(default_factory=time.process_time)

    def add_nodes(self, count: int) -> None:
        """Count nodes of a document that are read or copied."""
        self.nodes += count
        if self.nodes > MOST_NODES:
            raise ExpansionLimitError(f"expands to more than {MOST_NODES:,} elements")
        self.look_at_clock()

    def add_text(self, length: int) -> None:
        """Count an attribute or text of a length that was expanded."""
        self.characters += length
        if self.characters > MOST_CHARACTERS:
            raise ExpansionLimitError(f"expands to more than {MOST_CHARACTERS:,} characters")
        self.look_at_clock()

    def add_step(self) -> None:
        """Count a step of an expression, and look at the clock now and then."""
        self.steps += 1
        if self.steps % _STEPS_A_LOOK == 0:
            self.look_at_clock()

    def look_at_clock(self) -> None:
        """Raise where the time is up."""
        if time.process_time() - self.started > MOST_SECONDS:
            raise ExpansionLimitError(f"takes more than {MOST_SECONDS:g} s to expand")
