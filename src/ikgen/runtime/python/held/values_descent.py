"""Descent to better rows of a pose by values of several held joints that go together."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.held.solution_search import LEAST_STEP, tried_rows
from ikgen.runtime.python.rows.row_preference import Preference, preference_costs

__all__ = ["descended_rows"]

_SWEEPS = 100
_FARTHEST = 4.0  # steps that the model's minimum may be away
_ROUND_OFF = 1e-12  # of how much the model bends: less than that is none
_SHORTEST = 0.1  # of a step, that it makes of the next one
_LONGER = 2.0  # times a step in directions that have led to something better
_GOLDEN = 2.399963229728653  # rad, of which no two multiples are a whole turn apart


def descended_rows(
    arm: Arm, T: Array, held: Array, rows: Array, step: Array, preference: Preference, limits: bool
) -> tuple[Array, Array]:
    """From rows (n, dof) at values (n, held) the best ones that a compass search (Hooke, Jeeves 1961) with
    first steps (n, held) finds on their branches, all three in place, and their costs (n,). Each sweep
    looks at the minimum of the quadratic through its costs as well (Winfield 1973), which narrow valleys
    are followed by. Where one finds nothing the next goes in other directions (Abramson et al. 2009):
    limits of joints that are not held, and folds, run aslant of the values."""
    _, cost, _ = preference_costs(arm, preference, rows[:, None], limits)
    best, ways, first = cost[:, 0], _ways(held.shape[1]), step.copy()
    turns = np.zeros(len(held), dtype=np.intp)
    for _ in range(_SWEEPS):
        going = np.flatnonzero(step.max(axis=1) > LEAST_STEP)
        if not len(going):
            break
        at, row, size = held[going], rows[going], step[going]
        turned = _turned(held.shape[1], turns[going])
        wanted = at + np.einsum("sc,ncd->snd", ways, turned) * size
        trials, found, costs = tried_rows(arm, T, preference, limits, at, row, wanted)
        unbounded = (trials == wanted).all(axis=(0, 2))
        far = np.where(unbounded[:, None], _model_minimum(best[going], costs, held.shape[1]), 0.0)
        there = at + np.einsum("nc,ncd->nd", far, turned) * size
        last = tried_rows(arm, T, preference, limits, at, row, there[None])
        trials, found, costs = (np.concatenate(both) for both in zip((trials, found, costs), last))
        which, each = costs.argmin(axis=0), np.arange(len(going))
        better = costs[which, each] < best[going]
        some = which[better], each[better]
        held[going[better]], rows[going[better]] = trials[some], found[some]
        best[going[better]] = costs[some]
        length = np.clip(np.abs(far).max(axis=1), _SHORTEST, 1.0)
        length = np.where(which == len(ways), length, np.where(turns[going] > 0, _LONGER, 1.0))
        step[going] = np.minimum(size * np.where(better, length, 0.5)[:, None], first[going])
        turns[going[~better]] += 1
    return rows, best


def _turned(count: int, turns: Index) -> Array:
    """Directions (n, count, count), orthonormal, that differ from one of the `turns` (n,) to the next: the
    axes, then their reflections about directions spread evenly."""
    k = np.arange(count)
    v = np.cos(_GOLDEN * turns[:, None] * (k + 1) + k)
    v /= np.sqrt((v * v).sum(axis=1, keepdims=True))
    v[turns == 0] = 0.0
    return np.asarray(np.eye(count) - 2.0 * v[:, :, None] * v[:, None, :])


def _ways(count: int) -> Array:
    """Steps (s, count) of each value there and back, then of each two of them."""
    one = np.eye(count)
    first, second = np.triu_indices(count, 1)
    return np.concatenate([one, -one, one[first] + one[second]])


def _model_minimum(middle: Array, costs: Array, count: int) -> Array:
    """Where the quadratic through costs (n,) in the middle and (s, n) at `_ways` is least, in steps
    (n, count), as far as it may be; zeros where it is nowhere."""
    up, down, both = costs[:count], costs[count : 2 * count], costs[2 * count :]
    with np.errstate(invalid="ignore"):
        slope, H = 0.5 * (up - down).T, np.zeros((len(middle), count, count))
        first, second = np.triu_indices(count, 1)
        H[:, range(count), range(count)] = (up + down - 2.0 * middle).T
        H[:, first, second] = H[:, second, first] = (both - up[first] - up[second] + middle).T
    told = np.isfinite(costs).all(axis=0)
    H[~told], slope[~told] = np.eye(count), 0.0
    curved = np.linalg.eigvalsh(H)
    told &= curved[:, 0] > _ROUND_OFF * curved[:, -1]
    H[~told] = np.eye(count)
    far = -np.linalg.solve(H, slope[:, :, None])[:, :, 0]
    longest = np.abs(far).max(axis=1, keepdims=True)
    far *= np.minimum(1.0, _FARTHEST / np.maximum(longest, 1e-300))
    return np.where(told[:, None], far, 0.0)
