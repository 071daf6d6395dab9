"""The matrix between motors and joints as text of a language."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ikgen.emit.solver_module import SolverModule

__all__ = ["GearText", "gear_text"]


@dataclass(frozen=True, slots=True)
class GearText:
    """The rows of the matrix and of its inverse, and the offset: numbers as text, a comma between."""

    matrix: tuple[str, ...]
    inverse: tuple[str, ...]
    offset: str


def gear_text(module: SolverModule, number: Callable[[float], str]) -> GearText | None:
    """What templates say of motors, or None where each joint has one of its own."""
    transmission = module.dh.transmission
    if transmission is None:
        return None
    offset = ", ".join(number(float(x)) for x in transmission.offset)
    matrix, inverse = (
        tuple(", ".join(number(float(x)) for x in row) for row in rows)
        for rows in (transmission.matrix, transmission.inverse)
    )
    return GearText(matrix, inverse, offset)
