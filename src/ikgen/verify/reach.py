"""Poses that no configuration reaches, and inputs that are no pose."""

from __future__ import annotations

import numpy as np

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.task_space import TaskSpace

__all__ = ["farthest_configuration", "invalid_poses", "unreachable_poses"]


_MARGIN = 1.02
"""How far outside the largest reach found a "slightly unreachable" pose lies, as a factor."""


_POINT = 1e-6
"""Largest reach, in lengths of the arm, of a tip that stays where it is."""


def _candidates(arm: ArmUnderTest, j: int) -> Array:
    """Values of joint j whose distances determine the best one, or among which it is sought."""
    if arm.different[j]:
        turn = 2 * np.pi
        return np.linspace(arm.low[j] - turn, arm.high[j] + turn, 216)
    if not np.isfinite(arm.period[j]):
        return np.array([arm.low[j], arm.high[j]])
    simple = np.count_nonzero(arm.screws.A[:, j]) == 1 and arm.period[j] == 2 * np.pi
    turns = 3 if simple else 72
    return np.asarray(np.arange(turns) * arm.period[j] / turns)


def _improve(arm: ArmUnderTest, q: Array, j: int) -> Array:
    """Set joint j of each q (N, dof) to where the tip is farthest from the base, the others held.

    The squared distance is `a + b cos + c sin` of a simple revolute joint's value (three values give it),
    and convex in a prismatic one's; for the driver of mimic joints a grid is searched, of one whose turns
    are all different a turn beyond its limits.
    """
    values = _candidates(arm, j)
    tried = np.repeat(q[:, None], len(values), axis=1)
    tried[:, :, j] = values
    p = arm.screws.forward(tried.reshape(-1, arm.dof))[:, :3, 3]
    squared = np.einsum("ni,ni->n", p, p).reshape(len(q), len(values))
    out: Array = q.copy()
    if arm.revolute[j] and len(values) == 3:
        out[:, j] = np.arctan2(squared @ np.sin(values), squared @ np.cos(values))
    else:
        out[:, j] = values[np.argmax(squared, axis=1)]
    return out


def farthest_configuration(arm: ArmUnderTest, rng: np.random.Generator) -> Array | None:
    """The configuration (dof,) whose tip is farthest from the base, revolute limits disregarded.

    None for tasks that do not read the position, and for arms with slides that go farther than values
    are drawn.
    """
    unlimited = ~arm.revolute & ((arm.lower < arm.low) | (arm.high < arm.upper))
    if not arm.task.position or np.any(unlimited):
        return None
    q = arm.uniform(rng, 32, limits=False)
    for _ in range(12):
        for j in range(arm.dof):
            q = _improve(arm, q, j)
    distance = np.linalg.norm(arm.screws.forward(q)[:, :3, 3], axis=1)
    return np.asarray(q[int(np.argmax(distance))])


def unreachable_poses(arm: ArmUnderTest, count: int, rng: np.random.Generator) -> dict[str, Array]:
    """Sets (count, 4, 4) by label that have no solution whatever the revolute limits; may be empty.

    "far outside", "slightly outside" (2 % beyond the reach), and for arms with fewer joints than
    the task has equations "off the manifold" (a reachable pose turned and shifted at random).
    """
    sets = {}
    farthest = farthest_configuration(arm, rng)
    if farthest is not None:
        T = arm.screws.forward(farthest[None])[0]
        radius = float(np.linalg.norm(T[:3, 3]))
        poses = arm.screws.forward(arm.uniform(rng, count))
        far, slight = poses.copy(), np.repeat(T[None], count, axis=0)
        directions = rng.standard_normal((count, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        far[:, :3, 3] = directions * (5 * radius + 1)
        slight[:, :3, 3] *= np.linspace(_MARGIN, _MARGIN + 0.1, count)[:, None]
        sets = {"far outside": far}
        if radius > _POINT * arm.length:
            sets["slightly outside"] = slight
    if len(arm.active) < arm.rank:
        poses = arm.screws.forward(arm.uniform(rng, count))
        poses[:, :3, :3] = poses[:, :3, :3] @ _turn(0.3, 0.5)
        poses[:, :3, 3] += 0.1 * arm.length * rng.standard_normal((count, 3))
        sets["off the manifold"] = poses
    return sets


def _turn(about_x: float, about_y: float) -> Array:
    cx, sx, cy, sy = np.cos(about_x), np.sin(about_x), np.cos(about_y), np.sin(about_y)
    rx = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    return np.asarray(rx @ np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]))


def invalid_poses(task: TaskSpace, pose: Array) -> dict[str, Array]:
    """Inputs (4, 4) by label that are no pose to this task, made from a reachable `pose`."""

    def changed(rows: slice, columns: slice, values: float | Array) -> Array:
        out: Array = pose.copy()
        out[rows, columns] = values
        return out

    R, top, turn = pose[:3, :3], slice(0, 3), slice(0, 3)
    cases = {
        "all NaN": np.full((4, 4), np.nan),
        "all infinite": changed(top, slice(0, 4), np.inf),
    }
    if task.position:
        cases["NaN position"] = changed(slice(1, 2), slice(3, 4), np.nan)
        cases["infinite position"] = changed(slice(2, 3), slice(3, 4), -np.inf)
    if task.orientation:
        cases["NaN rotation"] = changed(top, turn, np.nan)
    if task.orientation in ("rotation", "direction"):
        cases["scaled rotation"] = changed(top, turn, 1.5 * R)
        cases["zero rotation"] = changed(top, turn, 0.0)
    if task.orientation == "rotation":
        cases["reflection"] = changed(top, turn, R @ np.diag([1.0, 1.0, -1.0]))
        cases["sheared rotation"] = changed(top, turn, R + 0.05 * np.eye(3)[[1, 0, 2]])
    return cases
