"""Tables without numbers: the constants to fill in, and the chain's frames written in them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.emit.solver_module import SolverModule
from ikgen.errors import UsageError
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.program.ops import Op, Operand

__all__ = ["Blank", "blanks", "frame_entries", "pairs"]


@dataclass(frozen=True, slots=True)
class Blank:
    """A constant without a number: `value` is what the emitted text gives it (NaN: to be filled in),
    `sample` what it was checked with (m or rad)."""

    name: str
    value: float
    sample: float


def blanks(module: SolverModule) -> tuple[Blank, ...]:
    """The constants to fill in; none where the table has numbers.

    Raises `UsageError` where the solver cannot be written in symbols.
    """
    names = module.dh.symbols
    if not names:
        return ()
    if module.plan is not None:
        raise UsageError(
            f"no numbers for {', '.join(names)}: only the 6R elimination solves this arm, and it "
            "works with numbers",
            hint="give them under [parameters]; without numbers only a report can be written",
        )
    samples = _samples(module.dh)
    return tuple(Blank(n, samples[n] if module.sample else math.nan, samples[n]) for n in names)


def _samples(dh: DHChain) -> dict[str, float]:
    parts = [x for row in dh.rows for x in (row.alpha, row.a, row.d, row.theta)]
    return {
        x.name: x.sign * x.value if isinstance(x, Length) else x.value
        for x in parts
        if x.symbolic and x.name is not None
    }


def pairs(module: SolverModule) -> tuple[str, ...]:
    """Names of the angles to fill in: their cosines and sines are constants of the program."""
    parts = [x for row in module.dh.rows for x in (row.alpha, row.theta)]
    return tuple(dict.fromkeys(x.name for x in parts if x.symbolic and x.name is not None))


def frame_entries(dh: DHChain) -> list[list[list[Operand]]]:
    """The frames of `dh.file_frames` (n + 1, 3, 4) with names where the table has no numbers."""
    out = [_numbers(F) for F in dh.file_frames]
    for i, row in enumerate(dh.rows):
        if any(x.symbolic for x in (row.alpha, row.a, row.d, row.theta)):
            before = dh.X_base if i == 0 else np.eye(4)
            out[i] = _frame(before, row, out[i])
    return out


def _numbers(F: NDArray[np.float64]) -> list[list[Operand]]:
    return [[float(x) for x in row] for row in F[:3]]


def _frame(
    before: NDArray[np.float64], row: DHRow, given: list[list[Operand]]
) -> list[list[Operand]]:
    """`before * Rx(alpha) Tx(a) Rz(theta) Tz(d)` in names; what does not depend on any is `given`."""
    turn = [given_row[:3] for given_row in given]
    if row.alpha.symbolic or row.theta.symbolic:
        (ca, sa), (ct, st) = _pair(row.alpha), _pair(row.theta)
        twist: list[list[Operand]] = [[1.0, 0.0, 0.0], [0.0, ca, _neg(sa)], [0.0, sa, ca]]
        about: list[list[Operand]] = [[ct, _neg(st), 0.0], [st, ct, 0.0], [0.0, 0.0, 1.0]]
        turn = _product(_product([line[:3] for line in _numbers(before)], twist), about)
    a, d = _length(row.a), _length(row.d)
    out = []
    for i in range(3):
        along = _add(_mul(float(before[i, 0]), a), _mul(turn[i][2], d))
        out.append([*turn[i], _add(float(before[i, 3]), along)])
    return out


def _pair(angle: Angle) -> tuple[Operand, Operand]:
    if angle.symbolic:
        return f"cos_{angle.name}", f"sin_{angle.name}"
    return math.cos(angle.value), math.sin(angle.value)


def _length(length: Length) -> Operand:
    if not length.symbolic or length.name is None:
        return length.value
    return length.name if length.sign > 0 else _neg(length.name)


def _product(A: list[list[Operand]], B: list[list[Operand]]) -> list[list[Operand]]:
    return [
        [
            _add(_add(_mul(r[0], B[0][j]), _mul(r[1], B[1][j])), _mul(r[2], B[2][j]))
            for j in (0, 1, 2)
        ]
        for r in A
    ]


def _neg(x: Operand) -> Operand:
    return -x if isinstance(x, float) else Op("neg", (x,))


def _add(x: Operand, y: Operand) -> Operand:
    if isinstance(x, float) and isinstance(y, float):
        return x + y
    return y if x == 0.0 else x if y == 0.0 else Op("add", (x, y))


def _mul(x: Operand, y: Operand) -> Operand:
    if isinstance(x, float) and isinstance(y, float):
        return x * y
    for one, other in ((x, y), (y, x)):
        if isinstance(one, float) and one in (0.0, 1.0, -1.0):
            return 0.0 if one == 0.0 else other if one == 1.0 else _neg(other)
    return Op("mul", (x, y))
