"""Rows of either convention as alternating links and screws, with the fixed rows merged exactly.

The modified convention is `link, screw, link, screw, ...` with link `Rx(alpha) Tx(a)` and screw
`Rz(theta) Tz(d)` (Craig, Introduction to Robotics, section 3.4); the standard one (Denavit and
Hartenberg, 1955) is `screw, link, screw, link, ...`. So one is the other shifted by a link.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ikgen.importers.dh.entry_expression import Quantity, number
from ikgen.importers.dh.table_entries import Entry
from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.forward import row_constant
from ikgen.model.arrays import Array
from ikgen.model.joint_tree import Limits

__all__ = ["Merged", "ModifiedRow", "merge", "modified_rows"]

ZERO = number(0.0)


@dataclass(frozen=True, slots=True)
class ModifiedRow:
    """One row in the modified convention; kind "fixed" is a constant. `reversed` turns the sense of
    the variable: an axis that ran against its predecessor was turned about."""

    kind: str
    name: str
    alpha: Quantity
    a: Quantity
    theta: Quantity
    d: Quantity
    limits: Limits
    reversed: bool = False


@dataclass(frozen=True, slots=True)
class Merged:
    """Moving rows between two constant transforms; `complete` if no fixed row is left between."""

    X_base: Array
    rows: tuple[ModifiedRow, ...]
    X_tip: Array
    complete: bool


def modified_rows(entries: Sequence[Entry], convention: str) -> list[ModifiedRow]:
    """The rows in the modified convention, exactly; a standard table ends with a fixed row more."""
    out: list[ModifiedRow] = []
    alpha, a = ZERO, ZERO
    for e in entries:
        if convention == "modified":
            alpha, a = e.alpha, e.a
        out.append(ModifiedRow(e.kind, e.name, alpha, a, e.theta, e.d, e.limits))
        alpha, a = e.alpha, e.a
    if convention == "standard":
        out.append(ModifiedRow("fixed", "", alpha, a, ZERO, ZERO, entries[-1].limits))
    return out


def merge(rows: Sequence[ModifiedRow], X_base: Array, X_tip: Array) -> Merged:
    """Fixed rows go into the ends, into their neighbours where that is exact, else they stay."""
    left = list(rows)
    while left and left[0].kind == "fixed":
        X_base = product(X_base, row_constant(left.pop(0)))
    tail = np.eye(4)
    while left and left[-1].kind == "fixed":
        tail = product(row_constant(left.pop()), tail)
    out: list[ModifiedRow] = []
    complete = True
    for row in left:
        while out and out[-1].kind == "fixed":
            pair = _absorb(out[-2], out[-1], row)
            if pair is None:
                complete = False
                break
            out[-2], row = pair
            out.pop()
        out.append(row)
    if complete:
        out, flip = _forward(out)
        tail = product(flip, tail)
    return Merged(X_base, tuple(out), product(tail, X_tip), complete)


def _absorb(
    before: ModifiedRow, fixed: ModifiedRow, after: ModifiedRow
) -> tuple[ModifiedRow, ModifiedRow] | None:
    """The neighbours of a fixed row with it merged in, or None where that is not exact."""
    if fixed.theta.is_near(math.pi) or fixed.theta.is_near(-math.pi):
        # Rz(pi) Rx(alpha) Tx(a) = Rx(-alpha) Tx(-a) Rz(pi)
        fixed = replace(fixed, theta=ZERO)
        after = replace(after, alpha=-after.alpha, a=-after.a, theta=after.theta + number(math.pi))
    if not fixed.d.is_near(0.0, 0.0) and fixed.alpha.is_near(0.0) and fixed.theta.is_near(0.0):
        before, fixed = replace(before, d=before.d + fixed.d), replace(fixed, d=ZERO)
    if fixed.theta.is_near(0.0) and fixed.d.is_near(0.0, 0.0):
        return before, replace(after, alpha=fixed.alpha + after.alpha, a=fixed.a + after.a)
    if fixed.alpha.is_near(0.0) and fixed.a.is_near(0.0, 0.0):
        return (
            replace(before, theta=before.theta + fixed.theta, d=before.d + fixed.d),
            after,
        )
    if after.alpha.is_near(0.0) and (after.a.is_near(0.0, 0.0) or fixed.theta.is_near(0.0)):
        return before, replace(
            after,
            alpha=fixed.alpha,
            a=fixed.a + after.a,
            theta=fixed.theta + after.theta,
            d=fixed.d + after.d,
        )
    return None


def _forward(rows: list[ModifiedRow]) -> tuple[list[ModifiedRow], Array]:
    """Antiparallel axes made parallel: `Rx(pi) Rz(v) Tz(d) = Rz(-v) Tz(-d) Rx(pi)`, which joins
    the next row's twist, and at last the tip's constant."""
    out: list[ModifiedRow] = []
    pending = ZERO
    for row in rows:
        row, pending = replace(row, alpha=row.alpha + pending), ZERO
        against = math.pi - abs(math.remainder(row.alpha.value, 2.0 * math.pi)) < 1e-9
        if out and against and not row.alpha.symbolic:
            row = replace(row, alpha=ZERO, theta=-row.theta, d=-row.d, reversed=True)
            pending = number(math.pi)
        out.append(row)
    return out, np.diag([1.0, -1.0, -1.0, 1.0]) if pending.value else np.eye(4)
