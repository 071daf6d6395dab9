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
    must differ from each other too, and the shortest step must leave as well. Where slides are far out,
    directions that differ by their inverse change the pose by rounding for many lengths of the arm: there
    steps are of the slides' own size.
    """
    flags = np.zeros(len(q), dtype=bool)
    candidates = np.flatnonzero(arm.sigma(q) < CONTINUUM_SIGMA)
    if not len(candidates) or not arm.active:
        return flags
    active = list(arm.active)
    J = arm.scaled_jacobian(q[candidates])[1]
    null = np.linalg.svd(J, full_matrices=True)[2][:, -1]
    slides = np.abs(q[candidates][:, active]) / arm.length
    size_of = np.where(arm.revolute[active], 1.0, np.maximum(slides, 1.0))
    farther = np.abs(null).max(axis=1) / np.abs(null / size_of).max(axis=1)
    step = np.zeros((len(candidates), arm.dof))
    step[:, active] = null * np.where(arm.revolute[active], 1.0, arm.length) * farther[:, None]
    flags[candidates] = True
    aims = arm.aims(q[candidates], targets[candidates])
    rounding = _ON_IT * size_of.max(axis=1)
    passed = [q[candidates]]  # where the steps before came from and went
    for size in STEPS_ALONG:
        ends, reached = converge(arm, q[candidates] + size * step, aims, enough=rounding)
        away = [np.max(np.abs(ends - one), axis=1, initial=0.0) > size / 4 for one in passed]
        flags[candidates] &= reached & np.all(away, axis=0) & (arm.sigma(ends) < 1e-5)
        passed.append(ends)
    return flags
