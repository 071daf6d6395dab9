"""An independent numerical solver: damped Newton from many starts at once, on the file's
kinematics.

Levenberg-Marquardt with the damping of Sugihara (IEEE T-RO 27(5), 2011): proportional to the
squared residual, so that it converges quadratically at the end and survives singular starts.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest

__all__ = ["CONVERGED", "converge", "find_solutions"]


CONVERGED = 1e-11
"""Scaled residual below which a start counts as converged."""

_HELD = 1e-8
"""Largest `held_off` of a solution that is kept. Newton aims at a line that both half planes contain; the
wrong half is off by far more."""

_LONGEST_STEP = 0.6  # rad, or lengths of the arm


def _step(arm: ArmUnderTest, q: Array, targets: Array) -> tuple[Array, Array]:
    """Scaled residual norms (N,) at q, and the next q (N, dof)."""
    T, J = arm.scaled_jacobian(q, targets)
    e = arm.residual(q, T, targets)
    squared = np.einsum("ni,ni->n", e, e)
    Jt = J.transpose(0, 2, 1)
    H = Jt @ J + (0.02 * squared + 1e-14)[:, None, None] * np.eye(J.shape[2])
    dq = np.linalg.solve(H, Jt @ e[:, :, None])[:, :, 0]
    longest = np.max(np.abs(dq), axis=1, keepdims=True)
    dq *= np.minimum(1.0, _LONGEST_STEP / np.maximum(longest, 1e-300))
    following = q.copy()
    active = list(arm.active)
    following[:, active] += dq * np.where(arm.revolute[active], 1.0, arm.length)
    return np.sqrt(squared), following


def converge(
    arm: ArmUnderTest,
    q: Array,
    targets: Array,
    iterations: int = 40,
    enough: float | Array = CONVERGED,
) -> tuple[Array, NDArray[np.bool_]]:
    """Run Newton from each q (N, dof) to its target (N, 4, 4), or its aim; free joints stay. Returns
    the end points and which of them reach the target, to a residual that is `enough`, one or (N,)."""
    q, done, bound = q.copy(), np.zeros(len(q), dtype=bool), np.broadcast_to(enough, len(q))
    alive = np.arange(len(q))
    for _ in range(iterations):
        residual, following = _step(arm, q[alive], targets[alive])
        reached = residual < bound[alive]
        done[alive[reached]] = True
        q[alive[~reached]] = following[~reached]
        alive = alive[~reached]
        if not len(alive):
            break
    return q, done


def find_solutions(
    arm: ArmUnderTest, targets: Array, held: Array, starts: int, rng: np.random.Generator
) -> list[Array]:
    """Solutions of each target (P, 4, 4), each (k, dof), found from `starts` random starts per
    target.

    `held` (P, dof): configurations from which the free joints' values are taken. Several starts may end
    in one solution; duplicates stay. A joint whose turns are all different, as of one that drives others
    by a gear of 5 : 4, takes values inside its limits.
    """
    q = arm.uniform(rng, len(targets) * starts, limits=False)
    owner = np.repeat(np.arange(len(targets)), starts)
    free = list(arm.free)
    q[:, free] = held[owner][:, free]
    q, done = converge(arm, q, arm.aims(held, targets)[owner])
    done &= np.all(~arm.different | ((q >= arm.low) & (q <= arm.high)), axis=1)
    done &= arm.held_off(q, held[owner], targets[owner]) < _HELD
    return [q[done & (owner == i)] for i in range(len(targets))]
