"""Singular configurations of an arm, found numerically without knowing what kind of arm it is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.search import converge

__all__ = ["SINGULAR_SIGMA", "on_continuum", "singular_configurations"]


SINGULAR_SIGMA = 1e-9
"""Smallest singular value below which a configuration counts as exactly singular."""

CONTINUUM_SIGMA = 1e-9
"""Smallest singular value below which a row is looked at for lying on a continuum."""

STEPS_ALONG = (0.2, 0.05, 0.01)
"""Steps (rad, or lengths of the arm) along the null direction, longest first. A long step may end at
another isolated solution; a short one is little off the noise of where an isolated one is."""

_ON_IT = 1e-13
"""Scaled residual of what is on a continuum: rounding, which slides that are far out make larger. An
isolated solution that is nearly singular leaves its singular value times the step."""

_ALL_ALONG = 1e-10
"""Scaled residual of what is a continuum wherever steps lead, one that a file's rounding breaks by far less
than rows may be off too. An isolated solution where several meet leaves a power of the way: for some steps
rounding, for more of them more than this."""

_SINGULAR_THERE = 1e-5
"""Smallest singular value that the rounding of a solution leaves on a continuum."""

_STEPS_ON = 40
"""Steps to a side that are looked at: the longest lead farther than a whole turn."""

_PROBE = 1e-6  # rad or m: step of the forward difference


def _descend(arm: ArmUnderTest, q: Array) -> Array:
    """One Newton step on the smallest singular value s: its derivative is `u' dJ v`, which keeps
    its sign through s = 0, so the step converges fast although s itself has a kink there."""
    active, n = list(arm.active), len(q)
    r = min(arm.rank, len(active)) - 1
    J = arm.scaled_jacobian(q)[1]
    u, s, vt = np.linalg.svd(J, full_matrices=False)
    moved = np.repeat(q[:, None], len(active), axis=1)
    moved[:, np.arange(len(active)), active] += _PROBE
    shifted = arm.scaled_jacobian(moved.reshape(-1, arm.dof))[1].reshape(
        n, len(active), *J.shape[1:]
    )
    gradient = np.einsum("ni,nkij,nj->nk", u[:, :, r], shifted - J[:, None], vt[:, r]) / _PROBE
    squared = np.einsum("nk,nk->n", gradient, gradient)
    step = np.clip(s[:, r] / np.maximum(squared, 1e-12), 0.0, 1.0)
    out: Array = q.copy()
    out[:, active] -= np.clip(step[:, None] * gradient, -0.5, 0.5)
    return out


def singular_configurations(arm: ArmUnderTest, count: int, rng: np.random.Generator) -> Array:
    """At most `count` exactly singular configurations (k, dof) inside the limits."""
    if not arm.active:
        return np.empty((0, arm.dof))
    q = arm.uniform(rng, 2 * count)
    for _ in range(14):
        q = _descend(arm, q)
    turned = arm.difference(q, (arm.low + arm.high) / 2) + (arm.low + arm.high) / 2
    good = (arm.sigma(turned) < SINGULAR_SIGMA) & arm.within(turned)
    return np.asarray(turned[good][:count])


def on_continuum(arm: ArmUnderTest, q: Array, targets: Array) -> NDArray[np.bool_]:
    """Which rows q (N, dof) lie on a continuum of solutions of their targets (N, 4, 4).

    Step along the null direction and return to the target: an isolated singular solution (a
    stretched elbow) falls back to where it was, one of a continuum (aligned wrist axes) does not.
    Steps of several lengths may all end at one other isolated solution, so the ends of a continuum
    must differ from each other too, and the shortest step must leave as well. Where several folds meet,
    steps may all leave an isolated solution and be off by rounding alone; but a continuum has no end, so
    steps must lead on along it, to both sides.
    """
    flags = np.zeros(len(q), dtype=bool)
    candidates = np.flatnonzero(arm.sigma(q) < CONTINUUM_SIGMA)
    if not len(candidates) or not arm.active:
        return flags
    start = q[candidates]
    aims, way = arm.aims(start, targets[candidates]), _way_along(arm, start)
    flags[candidates] = True
    passed = [start]  # where the steps before came from and went
    for size in STEPS_ALONG:
        ends, on = _step_along(arm, start, size * way, aims, _ON_IT)
        away = [np.max(np.abs(ends - one), axis=1, initial=0.0) > size / 4 for one in passed]
        flags[candidates] &= on & np.all(away, axis=0)
        passed.append(ends)
    left = flags[candidates]
    flags[candidates[left]] = _has_no_end(arm, start[left], way[left], aims[left])
    return flags


def _way_along(arm: ArmUnderTest, q: Array) -> Array:
    """Steps (N, dof) of length 1 along the null directions at q (N, dof). Where slides are far out,
    directions that differ by their inverse change the pose by rounding for many lengths of the arm: there
    steps are of the slides' own size."""
    active = list(arm.active)
    null = np.linalg.svd(arm.scaled_jacobian(q)[1], full_matrices=True)[2][:, -1]
    farther = np.abs(null).max(axis=1) / np.abs(null / _size_of(arm, q)).max(axis=1)
    way = np.zeros((len(q), arm.dof))
    way[:, active] = null * np.where(arm.revolute[active], 1.0, arm.length) * farther[:, None]
    return way


def _size_of(arm: ArmUnderTest, q: Array) -> Array:
    """What steps of the moving joints at q (N, dof) are relative to: 1, of slides far out their size."""
    active = list(arm.active)
    slides = np.abs(q[:, active]) / arm.length
    return np.asarray(np.where(arm.revolute[active], 1.0, np.maximum(slides, 1.0)))


def _step_along(
    arm: ArmUnderTest, q: Array, step: Array, aims: Array, enough: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Where the ways back to the aims end from a step (N, dof) beside q (N, dof), and which of these may be
    on a continuum (N,), by what is left: that of slides far out is relative to their size."""
    ends, reached = converge(arm, q + step, aims, enough=enough * _size_of(arm, q).max(axis=1))
    return ends, reached & (arm.sigma(ends) < _SINGULAR_THERE)


def _has_no_end(arm: ArmUnderTest, q: Array, way: Array, aims: Array) -> NDArray[np.bool_]:
    """From which rows q (N, dof) steps lead on, along `way` (N, dof) and against it, however often."""
    here, way, aims = np.tile(q, (2, 1)), np.concatenate([way, -way]), np.concatenate([aims, aims])
    going = np.arange(len(here))
    for _ in range(_STEPS_ON):
        if not len(going):
            break
        now = _way_along(arm, here[going])
        back = np.einsum("nj,nj->n", now, way[going]) < 0.0
        way[going] = np.where(back[:, None], -now, now)
        left = going
        for size in STEPS_ALONG:
            ends, on = _step_along(arm, here[left], size * way[left], aims[left], _ALL_ALONG)
            here[left[on]] = ends[on]
            left = left[~on]
        going = np.setdiff1d(going, left)
    out = np.zeros(len(here), dtype=bool)
    out[going] = True
    return np.asarray(out[: len(q)] & out[len(q) :])
