"""Tables without numbers: the constants to fill in."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ikgen.emit.solver_module import SolverModule
from ikgen.errors import UsageError
from ikgen.model.angle_function import AngleFunction, cosine_and_sine

__all__ = ["Blank", "blank_functions", "blanks"]


@dataclass(frozen=True, slots=True)
class Blank:
    """A constant without a number: `value` is what the emitted text gives it (NaN: to be filled in),
    `sample` what it was checked with (m or rad), `written` what it is in the table's own names ("": its
    name)."""

    name: str
    value: float
    sample: float
    written: str = ""


def blanks(module: SolverModule) -> tuple[Blank, ...]:
    """The constants to fill in; none where the table has numbers.

    Raises `UsageError` where the solver cannot be written in symbols.
    """
    names = module.dh.symbols
    if not names:
        return ()
    if module.plan is not None:
        raise UsageError(
            f"no numbers for {', '.join(names)}: only an elimination solves this arm, and it "
            "works with numbers",
            hint="give them under [parameters]; without numbers only a report can be written",
        )
    samples = module.dh.named_constants()
    written = dict(module.dh.written)
    return tuple(
        Blank(n, samples[n] if module.sample else math.nan, samples[n], written.get(n, ""))
        for n in names
    )


def blank_functions(module: SolverModule) -> tuple[AngleFunction, ...]:
    """Cosine and sine of every angle to fill in: constants of the program that follow from it."""
    parts = [x for row in module.dh.rows for x in (row.alpha, row.theta)]
    angles = dict.fromkeys(x.name for x in parts if x.symbolic and x.name is not None)
    return tuple(f for angle in angles for f in cosine_and_sine(angle))
