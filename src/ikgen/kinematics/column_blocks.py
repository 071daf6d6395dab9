"""In which order 3 x 3 blocks of an arm's derivatives are eliminated."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from ikgen.kinematics.file_frames import random_configurations
from ikgen.kinematics.forward import file_jacobian
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain

__all__ = ["column_blocks"]

_SAMPLES, _SEED = 200, 11
_RARE = 0.02
"""Share of the configurations that may be worse than a choice is judged by."""
_LEAST = 0.05
"""The least part of the whole pivot that the blocks' may be."""
_ENOUGH = 0.5
"""Part of the best choice's that is as good: the last joints are preferred."""


def column_blocks(dh: DHChain, moving: Sequence[int], size: float) -> tuple[int, ...]:
    """Six joints that move, the three whose angular velocities are eliminated last in the tuple; empty
    where there are not six, or no three that span all directions about as well as six span the velocities.

    The position rows, over `size` (m), are left to the first three: V = [A B; C D] has its inverse by those
    of D and A - B D^-1 C (Schur's complement).
    """
    if len(moving) != 6:
        return ()
    J = file_jacobian(dh, random_configurations(dh, _SAMPLES, _SEED))[..., list(moving)]
    J[:, :3] /= size
    with np.errstate(all="ignore"):
        whole = 1.0 / np.sqrt((np.linalg.pinv(J) ** 2).sum(axis=-1).max(axis=-1))
        orders = [_order(three) for three in reversed(list(combinations(range(6), 3)))]
        shares = [float(np.quantile(_pivot(J[..., o]) / whole, _RARE)) for o in orders]
    best = max(shares)
    if not best > _LEAST:
        return ()
    chosen = next(o for o, s in zip(orders, shares, strict=True) if s >= _ENOUGH * best)
    return tuple(moving[i] for i in chosen)


def _order(last: Sequence[int]) -> list[int]:
    return [*(i for i in range(6) if i not in last), *last]


def _pivot(V: Array) -> Array:
    """How far a column of a block (n, 6, 6) is at least from the span of its others (n,)."""
    last, far = _inverse(V[:, 3:, 3:])
    _, near = _inverse(V[:, :3, :3] - V[:, :3, 3:] @ last @ V[:, 3:, :3])
    return np.asarray(np.nan_to_num(1.0 / np.maximum(far, near)))


def _inverse(A: Array) -> tuple[Array, Array]:
    """Inverses of A (n, 3, 3) by cofactors, and the largest length of a row of each (n,)."""
    a, b, c = A[:, :, 0], A[:, :, 1], A[:, :, 2]
    rows = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    out = rows / (a * rows[:, 0]).sum(axis=1)[:, None, None]
    return out, np.sqrt((out**2).sum(axis=2).max(axis=1))
