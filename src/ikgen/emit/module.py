"""What an emitter gets: the Program and the facts of the arm around it."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.ir.program import Program
from ikgen.model.dh import DHChain

__all__ = ["POLISH_THRESHOLD", "SolverModule"]

POLISH_THRESHOLD = 2e-11
"""Deviation (m or rad) of the solved geometry from the file's above which Newton steps follow."""


@dataclass(frozen=True, slots=True)
class SolverModule:
    """One solver to emit.

    `name` is the prefix of the emitted files (`<name>_ik.py`), `free` the indices of joints held free,
    `free_defaults` their default values inside the limits (rad or m). `source_name` and
    `source_sha256` tell what it was made from, `geometry` is the geometry class in words.
    """

    name: str
    program: Program
    dh: DHChain
    task: str
    free: tuple[int, ...]
    free_defaults: tuple[float, ...]
    source_name: str
    source_sha256: str
    generator_version: str
    geometry: str = ""
    order: tuple[str, ...] = ()

    @property
    def polish(self) -> bool:
        """Whether the closed form is followed by Newton steps on the file's own chain."""
        return max(self.dh.deviation) > POLISH_THRESHOLD

    @property
    def max_solutions(self) -> int:
        """Rows of the solution at most (two whole turns of a joint count once)."""
        return self.program.max_solutions
