"""What running emitted code has to know of its arm; a derivation tells it, and so does a record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.emit.solver_module import SolverModule
    from ikgen.model.dh import DHChain

__all__ = ["EmittedArm"]


@dataclass(frozen=True, slots=True)
class EmittedArm:
    """An arm whose solver was emitted: `name` is the prefix of the files."""

    name: str
    dh: DHChain
    task: str
    max_solutions: int

    @classmethod
    def of(cls, module: SolverModule) -> EmittedArm:
        """The arm of a module that is about to be emitted."""
        return cls(module.name, module.dh, module.task, module.max_solutions)
