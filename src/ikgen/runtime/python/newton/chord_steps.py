"""Newton's method on a few rows of one pose, with the derivatives of where they start: in as few calls of
NumPy as can be, which is what so few rows take their time for.

A step of Newton's takes a second one along, for what the first leaves by the second derivatives
(Chebyshev's method; Traub 1964, 5.2); where that is not enough, others with the same derivatives follow.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Chain, link_motions
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.newton.arm_newton import moved_rows

__all__ = ["chord_steps"]

_OFF = np.array(  # of a pose's entries: metres and sines to the identity, (1 - cosine) / 2
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0],
        [0.0, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0],
        [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, -0.5, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25],
        [0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0],
        [0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0],
        [0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.25],
        [0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.75],
    ]
)
_CROSS = np.array(  # of products of a turn's and a twist's entries: cross products, of turns half
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        [0.0, -1.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.5],
        [0.0, 0.0, 0.0, 0.0, -0.5, 0.0],
        [0.0, 0.0, -1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, -0.5],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.5, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.5, 0.0],
        [0.0, 0.0, 0.0, -0.5, 0.0, 0.0],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ]
)
_QUARTER = 0.5  # (1 - cosine) / 2 of a quarter turn: half turns have small sines


def chord_steps(arm: Arm, q: Array, T: Array) -> Array | None:
    """Rows (k, dof) after steps towards the pose T (4, 4), where all arrive at the one solution near their
    start; else None. Near is what `refine_together` takes for it."""
    chain, policy, drive = arm.chain, arm.policy, _drive(arm)
    to_aim = chain.frames[0].copy()
    to_aim[:3, 3] -= T[:3, 3]
    to_aim[:3] = T[:3, :3].T @ to_aim[:3]
    tips = _tips(link_motions(chain, chain.links, q))
    error = (to_aim @ tips[0]).reshape(len(q), 16) @ _OFF
    twists = _twists(chain, tips)
    try:
        inverse: Array = np.asarray(np.linalg.inv(twists if drive is None else drive.T @ twists))
    except np.linalg.LinAlgError:
        return None
    step = _step(error, inverse)
    first, nearest = _sizes(step), _nearest(arm, inverse)
    if not max(error[:, 6].tolist()) < _QUARTER or not _begin(policy, first, nearest):
        return None
    more = _step(_bend(twists, step if drive is None else step @ drive.T), inverse)
    size, step = _sizes(more), step + more
    if _all_done(policy, first, size, nearest):
        return moved_rows(arm, q, step)
    before = size
    for _ in range(policy.lane_steps):
        q = moved_rows(arm, q, step)
        tip = _tip(to_aim, link_motions(chain, chain.links, q))
        step = _step(tip.reshape(len(q), 16) @ _OFF, inverse)
        size = _sizes(step)
        if not _contracted(policy, before, size):
            return None
        if all(2.0 * s * s <= policy.converged * b for b, s in zip(before, size)):
            return moved_rows(arm, q, step)
        before = size
    return None


def _drive(arm: Arm) -> Array | None:
    """The derivatives (n, 6) of the links' values by the joints that move; None where they are 1."""
    chain, moving = arm.chain, list(arm.moving)
    if chain.drive is not None:
        return chain.drive[:, moving]
    return None if not arm.free else np.eye(len(arm.lower))[:, moving]


def _begin(policy: Policy, size: list[float], nearest: list[float]) -> bool:
    """Whether first steps of this size (k,), with pivots as in `_nearest`, lead to the solutions near their
    starts; of longer ones others have to judge: see `begins`."""
    far, share, least = policy.farthest_start, policy.pivot_share**2, policy.least_pivot**-2
    return all(s < far and s * s * n < share and n < least for s, n in zip(size, nearest))


def _all_done(policy: Policy, first: list[float], size: list[float], nearest: list[float]) -> bool:
    """Whether what the third derivatives leave behind two steps is round-off."""
    enough = policy.converged
    return _contracted(policy, first, size) and all(
        2.0 * s * s <= enough * b and b**6 * n < enough * enough
        for b, s, n in zip(first, size, nearest)
    )


def _contracted(policy: Policy, before: list[float], size: list[float]) -> bool:
    share, enough = policy.contraction, policy.converged
    return all(s < share * b or s < enough for b, s in zip(before, size))


def _sizes(step: Array) -> list[float]:
    sizes: list[float] = np.maximum.reduce(np.abs(step), axis=1).tolist()
    return sizes


def _nearest(arm: Arm, inverse: Array) -> list[float]:
    """1 over the squared pivots (k,), by how far the nearest column of derivatives is from the span of the
    others, of transposed inverses (k, 6, n)."""
    square, size = inverse * inverse, arm.task.size
    if size != 1.0:
        square[:, :3] *= size * size
    nearest: list[float] = np.maximum.reduce(np.add.reduce(square, axis=1), axis=1).tolist()
    return nearest


def _step(error: Array, inverse: Array) -> Array:
    return np.asarray(np.matmul(error[:, None, :6], inverse)[:, 0])


def _tips(steps: Array) -> Array:
    """The tip's poses (n, k, 4, 4) in the frames on the axes, by the motions from each to the next."""
    out = np.empty_like(steps)
    out[-1] = steps[-1]
    for i in range(len(steps) - 2, -1, -1):
        np.matmul(steps[i], out[i + 1], out=out[i])
    return out


def _tip(first: Array, steps: Array) -> Array:
    """The tip's poses (k, 4, 4) behind a frame and motions (n, k, 4, 4), of which pairs are multiplied at
    once."""
    even = len(steps) // 2 * 2
    tip = first
    for pair in np.matmul(steps[0:even:2], steps[1:even:2]):
        tip = tip @ pair
    return tip if even == len(steps) else tip @ steps[-1]


def _twists(chain: Chain, tips: Array) -> Array:
    """Velocity and turn (k, n, 6) of the tip by the links' values, in its own frame."""
    out = np.empty((tips.shape[1], len(tips), 6))
    R = tips.transpose(1, 0, 2, 3)
    velocity, turn = out[:, :, :3], out[:, :, 3:]
    np.multiply(R[:, :, 1, :3], R[:, :, 0, 3:], out=velocity)
    velocity -= R[:, :, 0, :3] * R[:, :, 1, 3:]
    turn[:] = R[:, :, 2, :3]
    for i in chain.slides:
        velocity[:, i], turn[:, i] = turn[:, i], 0.0
    return out


def _bend(twists: Array, step: Array) -> Array:
    """What is left (k, 6) of the errors behind a step of Newton's (k, n), to second order: each twist as
    turned by those behind it, and by half of its own."""
    moved = twists * step[:, :, None]
    behind = np.matmul(_behind(step.shape[1]), moved[:, :, 3:])
    products = np.matmul(behind.transpose(0, 2, 1), moved)
    return np.asarray(products.reshape(len(step), 18) @ _CROSS)


@cache
def _behind(count: int) -> Array:
    """(n, n): 1 of those behind each, and 1 / 2 of its own."""
    return np.asarray(np.triu(np.ones((count, count)), 1) + 0.5 * np.eye(count))
