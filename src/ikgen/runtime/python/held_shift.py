"""Held joints moved along a branch so that its row stays inside the limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, pi

import numpy as np

from ikgen.runtime.python.array_types import Array
from ikgen.runtime.python.batch_solving import rows_batch
from ikgen.runtime.python.row_links import differences
from ikgen.runtime.python.solved_arm import Arm

__all__ = ["Shift", "limit_excess", "shifted"]

_FAN_STEP = 0.02  # rad or m between the values that are looked at
_FAN_COUNT = 16  # of them to each side
_CLEAR = 0.1  # rad or m that is kept from where the branch ends, where there is room


@dataclass(frozen=True)
class Shift:
    """`search(pose, start, limits)`: the row nearest to a start over all values of the held joints."""

    search: Callable[[Array, Array, bool], Array | None]


def limit_excess(arm: Arm, q: Array) -> float:
    """How far a row (dof,) is outside the limits at most; negative inside."""
    return float(np.maximum(np.array(arm.lower) - q, q - np.array(arm.upper)).max())


def shifted(arm: Arm, shift: Shift, pose: Array, q: Array, limits: bool) -> Array:
    """The row of the same branch with each held joint moved as little as keeps it clear of the ends; the row
    itself where there is none inside."""
    for j in arm.free:
        values, rows = _fan(arm, pose, q, j)
        excess = [limit_excess(arm, row) if limits else -inf for row in rows]
        inside = [k for k, x in enumerate(excess) if x <= 0.0]
        if not inside:
            continue
        here = int(np.abs(values - q[j]).argmin())
        first = min(inside, key=lambda k: abs(k - here))
        low = high = first
        while low - 1 in inside:
            low -= 1
        while high + 1 in inside:
            high += 1
        a = _run_end(values, excess, low, -1)
        b = _run_end(values, excess, high, 1)
        clear = min(_CLEAR, 0.5 * (b - a))
        wanted = min(max(float(q[j]), a + clear), b - clear)
        if wanted != q[j] or first != here:
            q = _moved(arm, pose, rows[int(np.abs(values - wanted).argmin())], j, wanted)
    return q


def _run_end(values: Array, excess: list[float], k: int, way: int) -> float:
    """Where a run of values ends: where the excess over the limits vanishes on the line to the next value."""
    n = k + way
    if not 0 <= n < len(values) or excess[k] == -inf:
        return float(values[k])
    share = excess[k] / (excess[k] - excess[n])
    return float(values[k] + share * (values[n] - values[k]))


def _fan(arm: Arm, pose: Array, q: Array, j: int) -> tuple[Array, list[Array]]:
    """Values of a held joint about its own, ascending, and the branch's rows there: as far as there are some."""
    values = q[j] + _FAN_STEP * np.arange(-_FAN_COUNT, _FAN_COUNT + 1)
    values = values[(values >= arm.lower[j]) & (values <= arm.upper[j])]
    values = np.union1d(
        values, [x for x in (arm.lower[j], arm.upper[j]) if abs(x - q[j]) < _FAN_STEP * _FAN_COUNT]
    )
    held = np.tile(q[list(arm.free)], (len(values), 1))
    held[:, arm.free.index(j)] = values
    found, real, _ = rows_batch(arm, np.broadcast_to(pose, (len(values), 4, 4)), held, None)
    middle = int(np.abs(values - q[j]).argmin())
    rows: dict[int, Array] = {}
    for way in (1, -1):
        last, k = q, middle
        while 0 <= k < len(values):
            gap = differences(arm, last, found[k])
            size = np.where(real[k], np.abs(gap).max(axis=1), inf)
            nearest = int(size.argmin())
            if size[nearest] > 0.3:
                break
            rows[k] = last = last + gap[nearest]
            k += way
    kept = sorted(rows)
    return values[kept], [rows[k] for k in kept]


def _moved(arm: Arm, pose: Array, near: Array, j: int, value: float) -> Array:
    """The row at a value of a held joint next to another one, whole turns as there."""
    held = near.copy()
    held[j] = value
    found, real, _ = rows_batch(arm, pose[None], held[list(arm.free)][None], None)
    gap = differences(arm, near, found[0])
    size = np.where(real[0], np.abs(gap).max(axis=1), inf)
    nearest = int(size.argmin())
    return near if size[nearest] > 0.3 else near + gap[nearest]
