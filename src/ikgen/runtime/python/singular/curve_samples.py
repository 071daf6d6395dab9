"""Samples of curves along which the other joints take the pose's error away but for one direction."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.newton.arm_newton import linearized, moved_rows
from ikgen.runtime.python.singular.fold_pair import Reduced, correct, generic, still_directions

__all__ = ["SOLVED", "aside", "sampled", "samples_beside"]

SOLVED = 4e-15
"""What is left (rad, or m over the arm's size) at a solution, at most, by round-off."""

_CORRECTIONS = 6
_NEAR = 1e-8  # rad or m off the curve at which what is left is that of the curve: it is off by the square
_SHARE = 3e-2  # over what is left: as little as that off the curve changes neither
_ALMOST = 1e-3  # rad or m off the curve at which corrections may end if they change nothing of what is left
_SAME = 4e-15  # rad or m: corrections that change what is left by less change nothing of it
_ASIDE = 0.4  # rad or m: so far from where they cross curves are apart
_STRAY = 1.0  # rad or m: larger corrections show that no curve is near


def aside(direction: Array) -> Array:
    """Ways (k, n) from where curves cross to where they are apart, along directions (k, n)."""
    return np.asarray(_ASIDE / np.abs(direction).max(axis=1)[:, None] * direction)


def samples_beside(arm: Arm, q: Array, T: Array) -> Reduced:
    """The configurations of curves beside rows q (k, dof), towards aims T (k, ...)."""
    error, slope = linearized(arm, q, T)
    nothing, still = np.zeros(len(q)), still_directions(arm, slope)
    unknown = 0.1 * generic(len(q), error.shape[1])  # shorter than what has a sense
    first = Reduced(q, still, unknown, nothing, nothing)
    at = sampled(arm, first, T)[0]
    if arm.rounded:
        _take_aside(arm, at, first, T)
    return at


def _take_aside(arm: Arm, at: Reduced, first: Reduced, T: Array) -> None:
    """Takes samples from beside where they first were, along the still direction, if corrections from there
    led astray: another curve nearly crosses."""
    step = aside(first.still)
    for way in (step, -step):
        astray = np.flatnonzero(~(np.abs(at.left) < arm.policy.fold_reach))
        some = some_of(first._replace(q=moved_rows(arm, first.q, way)), astray)
        for whole, part in zip(at, sampled(arm, some, T[astray])[0]):
            whole[astray] = part


def sampled(arm: Arm, at: Reduced, T: Array) -> tuple[Reduced, Flags, Flags]:
    """The configurations of curves beside some (k,), of which one direction of the error is left towards
    aims T (k, ...); which seem to have a curve near (k,), and which are on one (k,)."""
    near, going, before = np.ones(len(T), dtype=bool), np.arange(len(T)), np.full(len(T), np.inf)
    for _ in range(_CORRECTIONS):
        if len(going) == len(T):
            at, farthest = correct(arm, at, T)
            moved = at
        else:
            moved, farthest = correct(arm, some_of(at, going), T[going])
            for whole, part in zip(at, moved):
                whole[going] = part
        near[going] &= farthest < _STRAY
        same = (np.abs(moved.left - before) < _SAME) & (farthest < _ALMOST)
        on = ~((farthest < np.maximum(_NEAR, _SHARE * np.abs(moved.left))) | same)
        going, before = going[on], moved.left[on]
        if not len(going):
            break
    converged = np.ones(len(T), dtype=bool)
    converged[going] = False
    return at, near, converged
