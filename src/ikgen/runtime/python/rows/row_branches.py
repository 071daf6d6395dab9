"""What distinguishes the rows of a pose: names of their branches, from the geometry of each row alone."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import cross, forward, joint_axes, tip_and_jacobian
from ikgen.runtime.python.arm.held_parameters import held_of
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.angles import within_periods
from ikgen.runtime.python.arrays.array_types import Array

__all__ = ["branch_names"]


def branch_names(arm: Arm, q: Array) -> tuple[str, ...]:
    """A name for each row (k, dof).

    Arms with a shoulder, an elbow and a wrist (`arm.branch_kind` "names") have sides of those. Others have
    the number of the closed form's branch on which the row lies ("number"), and those of an
    elimination, whose rows are all on one, the sign of the determinant of the Jacobian of its six joints
    ("orientation").
    """
    if not len(q):
        return ()
    if arm.branch_kind == "names":
        return _side_names(arm, q)
    if arm.branch_kind == "number":
        return tuple(f"branch {number}" for number in _branch_numbers(arm, q))
    tip, J = tip_and_jacobian(arm.chain, q)
    J = J[:, :, arm.moving]
    if J.shape[2] == 5:  # the elimination's last joint turns about the tool's axis
        turn = np.zeros((len(q), 6, 1))
        turn[:, 3:, 0] = tip[:, :3, arm.task.unit[0]]
        J = np.concatenate([J, turn], axis=2)
    return tuple(f"det J {'>' if sign > 0.0 else '<'} 0" for sign in np.linalg.det(J))


def _inner(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=-1))


def _side_names(arm: Arm, q: Array) -> tuple[str, ...]:
    """Branch names of six axes, the first at right angles to the second, which is parallel to the third.

    Seen from the first axis towards the wrist (where the last two axes meet), the second one points to the
    right or to the left; the elbow is above or below the line from the shoulder to the point that the
    third axis turns, where up is along the first axis; the wrist is flipped where the sixth axis is turned
    from the fourth by a negative angle about the fifth.
    """
    axes = joint_axes(arm.chain, q)[:-1].swapaxes(0, 1)
    z, p = axes[:, :, :3, 2], axes[:, :, :3, 3]
    up = z[:, 0] * np.where(z[:, :1, 2] < 0.0, -1.0, 1.0)
    right = _inner(cross(up, z[:, 1]), p[:, 5] - p[:, 0]) >= 0.0
    elbow, end = p[:, 2] - p[:, 1], p[:, arm.elbow_end] - p[:, 1]
    level = cross(z[:, 1], up)  # in the plane of the links
    above = _inner(z[:, 1], cross(end, elbow)) * _inner(level, end) <= 0.0
    plain = _inner(cross(z[:, 3], z[:, 5]), z[:, 4]) >= 0.0
    return tuple(
        f"shoulder {'right' if r else 'left'}, elbow {'up' if a else 'down'}, "
        f"wrist {'not flipped' if f else 'flipped'}"
        for r, a, f in zip(right.tolist(), above.tolist(), plain.tolist())
    )


def _branch_numbers(arm: Arm, q: Array) -> list[int]:
    """For each row the closed form's branch, of those for the row's own pose, that is nearest to it."""
    poses = forward(arm.chain, q)
    with np.errstate(all="ignore"):
        rows, valid, *_ = arm.branches_batch(poses, q, held_of(arm, q))
        gap = np.abs(within_periods(rows - q[:, None, :], arm.period))
        gap[:, :, list(arm.free)] = 0.0
        distance = np.where(valid, gap.max(axis=2), np.inf)
    distance[np.isnan(distance)] = np.inf
    nearest: list[int] = distance.argmin(axis=1).tolist()
    return nearest
