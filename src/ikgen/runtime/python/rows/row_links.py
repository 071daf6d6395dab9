"""Which rows at one value of a held joint go on as which at the next."""

from __future__ import annotations

from math import inf

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.angles import within_periods
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index

__all__ = ["differences", "linked_rows", "neighbouring_rows", "origins", "slide_scale"]

_NEAR = 0.3  # rad or m that a row of a branch may be from its own before


def differences(arm: Arm, a: Array, b: Array) -> Array:
    """b - a (..., dof), of turning joints on the shortest way."""
    return within_periods(b - a, arm.period)


def neighbouring_rows(arm: Arm, a: Array, b: Array) -> Flags:
    """Which rows a (n, dof) are nearly b (n, dof); see `policy.neighbouring`."""
    return np.asarray(np.abs(differences(arm, a, b)).max(axis=1) < arm.policy.neighbouring)


def slide_scale(values: Array) -> Array:
    """What gaps between values (...) of slides count relative to: the longer ones' lengths."""
    return np.asarray(np.maximum(np.abs(values), 1.0))


def linked_rows(arm: Arm, q: Array, real: Flags, guarded: bool = False) -> Index:
    """For rows (n, m, dof) of which some are real (n, m): the index (n - 1, m) of the row at the next value
    that each is nearest to and that is nearest to it; -1 where there is none. `guarded`: rows stay in
    their columns, where those come and go together and no row is far from its own before."""
    order = np.argsort(~real, axis=1, kind="stable")[:, : real.sum(axis=1).max(initial=1)]
    rows = np.take_along_axis(q, order[:, :, None], axis=1)
    some = np.take_along_axis(real, order, axis=1)
    gap = np.abs(differences(arm, rows[:-1, :, None], rows[1:, None])).max(axis=3)
    gap = np.where(some[:-1, :, None] & some[1:, None], gap, inf)
    there, back = gap.argmin(axis=2), gap.argmin(axis=1)
    mutual = np.take_along_axis(back, there, axis=1) == np.arange(order.shape[1])
    near = np.take_along_axis(gap, there[:, :, None], axis=2)[:, :, 0] < inf
    following = np.where(mutual & near, np.take_along_axis(order[1:], there, axis=1), -1)
    out = np.full((len(order) - 1, real.shape[1]), -1)
    np.put_along_axis(out, order[:-1], following, axis=1)
    return _in_columns(arm, q, real, out) if guarded else out


def _in_columns(arm: Arm, q: Array, real: Flags, links: Index) -> Index:
    """Links within columns where these leave no doubt, as where two curves of rows cross; the others."""
    stays = real[:-1] & real[1:]
    gap = np.abs(differences(arm, q[:-1], q[1:])).max(axis=2)
    plain = np.where(stays, gap < _NEAR, real[:-1] == real[1:]).all(axis=1, keepdims=True)
    return np.where(plain, np.where(stays, np.arange(real.shape[1]), -1), links)


def origins(following: Index) -> Index:
    """For each row at the upper end of a cell, the row at its lower end that goes on as it; -1 for none."""
    out = np.full_like(following, -1)
    cell, row = np.nonzero(following >= 0)
    out[cell, following[cell, row]] = row
    return out
