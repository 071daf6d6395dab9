"""What an emitter gets: the Program and the facts of the arm around it."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.ir.program import Program
from ikgen.model.dh import DHChain

__all__ = ["CLOSE", "EXACT", "SolverModule"]

EXACT = 2e-11
"""Deviation (m or rad) of the solved geometry from the file's that counts as round-off."""

CLOSE = 8e-10
"""Deviation up to which a row that is exact for the solved geometry is right for the file (1e-9)."""


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
    def polish(self) -> str:
        """Which rows take Newton steps on the file's own chain: "never", "some" (those of a continuum
        or on the boundary, where the closed form gave way) or "all"."""
        deviation = max(self.dh.deviation)
        if deviation <= EXACT:
            return "never"
        return "some" if deviation <= CLOSE else "all"

    @property
    def max_solutions(self) -> int:
        """Rows of the solution at most (two whole turns of a joint count once)."""
        return self.program.max_solutions
